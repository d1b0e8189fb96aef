//! One command on the line at a time: framing, timeouts, NAK, and finding a lost conversation again with ACK.

use std::time::Duration;

use super::Timing;
use crate::hw::mount::command::{Command, STOP};
use crate::hw::mount::frame::{Framer, NAK, Shape, Step, printable};
use crate::hw::mount::order::Fault;
use crate::hw::mount::reply::{self, Reply};

/// A busy mount is asked this often more.
const NAK_RETRIES: u32 = 3;
const NAK_PAUSE: Duration = Duration::from_millis(100);
/// After a silent command: 10 ms for a NAK, 16 ms of a USB adapter, and a margin.
const LISTEN: Duration = Duration::from_millis(60);
/// For a `#` that only some firmware sends.
const LISTEN_FOR_HASH: Duration = Duration::from_millis(120);
/// The line counts as quiet after this.
const QUIET: Duration = Duration::from_millis(60);
/// The same after a probe that was not answered: its answer may still come.
const LONG_QUIET: Duration = Duration::from_millis(500);
const PROBE_WAIT: Duration = Duration::from_millis(1000);
/// A line that does not become quiet in this time babbles.
const BABBLE: Duration = Duration::from_secs(3);
/// An older Autostar holds its reply to `:CM#` back until another byte comes.
const PUSH_SYNC: Duration = Duration::from_millis(1000);

/// What came of a command.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Outcome {
    /// It was answered.
    Answer(Command, Reply),
    /// It was not; the line is being mended.
    Failed(Command, Fault),
    /// The mount was busy; the command is sent again after a pause.
    Nak(Command),
    /// The mount answers to the probe alone: the conversation can go on.
    InStep,
    /// The mount cannot be brought to answer.
    Dead(Fault),
}

/// The probe that finds a lost conversation again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Probe {
    /// ACK, which every Meade answers with one letter.
    Ack,
    /// Right ascension, for a mount that does not answer ACK.
    Ra,
}

#[derive(Debug, Clone)]
enum State {
    Idle,
    Waiting { command: Command, framer: Framer, naks: u32, sent: Duration, last: Option<Duration>, pushed: bool },
    Listening { command: Command, reply: Reply, naks: u32, until: Duration, for_hash: bool },
    Pausing { command: Command, naks: u32, until: Duration },
    Draining { since: Duration, last: Duration, bytes: u64 },
    Probing { framer: Framer, sent: Duration, last: Option<Duration>, good: bool, extra: bool },
}

/// The line as one exchange at a time. Holds at most one reply and the bytes not yet drained.
#[derive(Debug)]
pub(super) struct Wire {
    timing: Timing,
    state: State,
    out: Vec<u8>,
    outcomes: Vec<Outcome>,
    probe: Probe,
    probes: u32,
    most_probes: u32,
    /// How long the last probe took to be answered: a slow bridge is waited for longer.
    latency: Duration,
    /// Bytes that came unasked.
    pub(super) stray: u64,
}

impl Wire {
    pub(super) fn new(timing: Timing) -> Wire {
        Wire {
            timing,
            state: State::Idle,
            out: Vec::new(),
            outcomes: Vec::new(),
            probe: Probe::Ack,
            probes: 0,
            most_probes: 4,
            latency: Duration::ZERO,
            stray: 0,
        }
    }

    pub(super) fn idle(&self) -> bool {
        matches!(self.state, State::Idle) && self.outcomes.is_empty()
    }

    /// Begins a line: forgets all, waits for quiet, probes.
    pub(super) fn open(&mut self, probe: Probe, now: Duration) {
        self.out.clear();
        self.outcomes.clear();
        self.probe = probe;
        self.most_probes = 2;
        self.mend(now);
    }

    /// The line is gone.
    pub(super) fn close(&mut self) {
        self.out.clear();
        self.outcomes.clear();
        self.state = State::Idle;
    }

    /// Waits for quiet and probes.
    fn mend(&mut self, now: Duration) {
        self.probes = 0;
        self.state = State::Draining { since: now, last: now, bytes: 0 };
    }

    /// Sends a command; the line is idle.
    pub(super) fn send(&mut self, command: Command, now: Duration) {
        self.transmit(command, 0, now);
    }

    fn transmit(&mut self, command: Command, naks: u32, now: Duration) {
        let bytes = command.bytes();
        if let Some(why) = crate::hw::mount::table::forbidden(&bytes) {
            let fault = Fault::Garbled { command: command.name(), got: why.into() };
            self.outcomes.push(Outcome::Failed(command, fault));
            return;
        }
        self.out.extend(bytes);
        self.state = match command.shape() {
            Shape::Nothing => {
                State::Listening { command, reply: Reply::Done, naks, until: now + LISTEN, for_hash: false }
            }
            shape => State::Waiting { command, framer: Framer::new(shape), naks, sent: now, last: None, pushed: false },
        };
    }

    /// Sends bytes that have no reply, at once, whatever is under way.
    pub(super) fn interject(&mut self, bytes: &[u8]) {
        self.out.extend(bytes);
    }

    /// Sends the stop ahead of everything. A reply that may be long in coming is no longer waited for.
    pub(super) fn stop(&mut self, now: Duration) {
        let unsent = !self.out.is_empty();
        let slow = match &self.state {
            State::Waiting { command, .. } => command.patience() > Duration::from_millis(600),
            State::Pausing { .. } => true,
            _ => false,
        };
        if unsent || slow {
            self.mend(now);
        }
        self.out.clear();
        self.out.extend(STOP);
    }

    pub(super) fn drain(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.out)
    }

    pub(super) fn outcome(&mut self) -> Option<Outcome> {
        (!self.outcomes.is_empty()).then(|| self.outcomes.remove(0))
    }

    pub(super) fn feed(&mut self, bytes: &[u8], now: Duration) {
        for byte in bytes {
            self.take(*byte, now);
        }
    }

    fn take(&mut self, byte: u8, now: Duration) {
        match &mut self.state {
            State::Idle | State::Pausing { .. } => {
                // Nothing was asked: whatever it is, the next reply might be mistaken for another's.
                self.stray += 1;
                if let State::Pausing { command, .. } = &self.state {
                    let command = command.clone();
                    self.fail(command, Fault::Garbled { command: "nothing".into(), got: printable(&[byte]) }, now);
                } else if let Some(index) = self.outcomes.iter().position(|o| matches!(o, Outcome::Answer(..))) {
                    // Two replies glued together: which of them answered?
                    if let Outcome::Answer(command, _) = self.outcomes.remove(index) {
                        let got = printable(&[byte]);
                        let fault = Fault::Garbled { command: command.name(), got: format!("{got} behind the reply") };
                        self.fail(command, fault, now);
                    }
                } else {
                    self.mend(now);
                }
            }
            State::Listening { command, naks, until, for_hash, .. } => {
                if byte == NAK && !*for_hash {
                    let (command, naks) = (command.clone(), *naks);
                    self.busy(command, naks, now);
                } else if byte == b'#' && *for_hash {
                    *until = now;
                } else {
                    self.stray += 1;
                }
            }
            State::Draining { last, bytes, .. } => {
                *last = now;
                *bytes += 1;
                self.stray += 1;
            }
            State::Probing { framer, sent, last, good, extra } => {
                *last = Some(now);
                if *good {
                    *extra = true;
                    return;
                }
                if byte == NAK {
                    return; // busy, but there: the probe is sent again
                }
                let command = if self.probe == Probe::Ack { Command::Ack } else { Command::Ra };
                if framer.push(byte) != Step::More {
                    if reply::parse(&command, framer.reply()).is_some() {
                        *good = true;
                        self.latency = now.saturating_sub(*sent);
                    } else if framer.reply() == command.bytes() {
                        self.outcomes.push(Outcome::Dead(Fault::Looped));
                        self.state = State::Idle;
                    } else {
                        *extra = true;
                        *framer = Framer::new(command.shape());
                    }
                }
            }
            State::Waiting { command, framer, naks, last, pushed, .. } => {
                *last = Some(now);
                match framer.push(byte) {
                    Step::More => {}
                    Step::Nak => {
                        let (command, naks) = (command.clone(), *naks);
                        self.busy(command, naks, now);
                    }
                    Step::TooLong => {
                        let fault = Fault::Garbled { command: command.name(), got: printable(framer.reply()) };
                        let command = command.clone();
                        self.fail(command, fault, now);
                    }
                    Step::Whole => {
                        let (command, bytes, pushed) = (command.clone(), framer.reply().to_vec(), *pushed);
                        self.whole(command, &bytes, pushed, now);
                    }
                }
            }
        }
    }

    fn whole(&mut self, command: Command, bytes: &[u8], pushed: bool, now: Duration) {
        if bytes == command.bytes() {
            self.outcomes.push(Outcome::Dead(Fault::Looped));
            self.state = State::Idle;
            return;
        }
        let Some(reply) = reply::parse(&command, bytes) else {
            let fault = Fault::Garbled { command: command.name(), got: printable(bytes) };
            self.fail(command, fault, now);
            return;
        };
        if matches!(command.shape(), Shape::Fixed { hash: true, .. }) || pushed {
            self.state = State::Listening { command, reply, naks: 0, until: now + LISTEN_FOR_HASH, for_hash: true };
        } else {
            self.outcomes.push(Outcome::Answer(command, reply));
            self.state = State::Idle;
        }
    }

    fn busy(&mut self, command: Command, naks: u32, now: Duration) {
        if naks < NAK_RETRIES {
            self.outcomes.push(Outcome::Nak(command.clone()));
            self.state = State::Pausing { command, naks: naks + 1, until: now + NAK_PAUSE };
        } else {
            let fault = Fault::Busy { command: command.name(), tries: naks + 1 };
            self.fail(command, fault, now);
        }
    }

    fn fail(&mut self, command: Command, fault: Fault, now: Duration) {
        self.outcomes.retain(|outcome| !matches!(outcome, Outcome::Answer(..)));
        self.outcomes.push(Outcome::Failed(command, fault));
        self.most_probes = 4;
        self.mend(now);
    }

    pub(super) fn tick(&mut self, now: Duration) {
        if now < self.wake_at() {
            return;
        }
        match std::mem::replace(&mut self.state, State::Idle) {
            State::Idle => {}
            State::Listening { command, reply, .. } => self.outcomes.push(Outcome::Answer(command, reply)),
            State::Pausing { command, naks, .. } => self.transmit(command, naks, now),
            State::Waiting { command, framer, naks, sent, last, pushed } => {
                let overdue = last.is_some() || pushed || command != Command::Sync;
                if framer.silence_ends_it() {
                    self.whole(command, framer.reply(), false, now);
                } else if overdue {
                    let waited_ms = now.saturating_sub(sent).as_millis() as u64;
                    let fault = Fault::TimedOut { command: command.name(), waited_ms };
                    self.fail(command, fault, now);
                } else {
                    self.out.push(0x06);
                    self.state = State::Waiting { command, framer, naks, sent, last, pushed: true };
                }
            }
            State::Draining { since, last, bytes } => {
                if now.saturating_sub(last) >= self.quiet() {
                    self.probe(now);
                } else if now.saturating_sub(since) >= BABBLE {
                    self.outcomes.push(Outcome::Dead(Fault::Babbling { bytes }));
                } else {
                    self.state = State::Draining { since, last, bytes };
                }
            }
            State::Probing { good: true, extra: false, .. } => {
                self.most_probes = 4;
                self.outcomes.push(Outcome::InStep);
            }
            // Answered with something before or after it: whose answer was it? Ask once more.
            State::Probing { .. } if self.probes >= self.most_probes => {
                self.outcomes.push(Outcome::Dead(Fault::Silent));
            }
            State::Probing { good, extra, .. } => {
                if good && extra {
                    self.state = State::Draining { since: now, last: now, bytes: 0 };
                } else {
                    self.probe(now);
                }
            }
        }
    }

    fn probe(&mut self, now: Duration) {
        let command = if self.probe == Probe::Ack { Command::Ack } else { Command::Ra };
        self.probes += 1;
        self.out.extend(command.bytes());
        self.state =
            State::Probing { framer: Framer::new(command.shape()), sent: now, last: None, good: false, extra: false };
    }

    fn quiet(&self) -> Duration {
        if self.probes > 1 { LONG_QUIET } else { QUIET }
    }

    /// Twice what the probe took, where that is more than is usual on such a line.
    fn first_byte(&self) -> Duration {
        self.timing.first_byte.max(self.latency * 2)
    }

    /// When [`Wire::tick`] has something to do.
    pub(super) fn wake_at(&self) -> Duration {
        match &self.state {
            State::Idle => Duration::MAX,
            State::Listening { until, .. } | State::Pausing { until, .. } => *until,
            State::Waiting { command, sent, last, pushed, framer, .. } => match last {
                Some(_) if command_is_slow(command, framer) => *sent + command.patience(),
                Some(last) => *last + self.timing.next_byte,
                None if *command == Command::Sync && !pushed => *sent + PUSH_SYNC,
                None => *sent + self.first_byte().max(command.patience()),
            },
            State::Draining { since, last, .. } => (*last + self.quiet()).min(*since + BABBLE),
            State::Probing { sent, last, good, .. } => match last {
                Some(last) if *good => *last + self.quiet(),
                _ => *sent + PROBE_WAIT.max(self.first_byte()),
            },
        }
    }
}

/// Whether pauses within the reply are ordinary: between the two strings of `:SC`, and before the text of `:MS#`.
fn command_is_slow(command: &Command, framer: &Framer) -> bool {
    match command {
        Command::SetDate(_) => true,
        Command::Slew => framer.reply().len() <= 1,
        _ => false,
    }
}
