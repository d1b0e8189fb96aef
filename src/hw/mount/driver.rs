//! The protocol as a state machine without I/O: bytes in, bytes out, a clock handed in.
//!
//! ```text
//! closed -> finding (quiet line, ACK answered) -> asking (who, which form, where, when) -> ready (orders, polls)
//!              ^------------------------ nothing answers: the port is opened anew ---------------+
//! ```
//!
//! One command is on the line at a time (`wire`); what is asked when no order waits is in `facts` (on connecting, and to
//! compare clock and site) and `watch` (positions, slews, stops, moves by hand); orders become commands in `jobs`.

mod facts;
mod jobs;
#[cfg(test)]
mod tests;
mod track;
mod watch;
mod wire;

use std::collections::VecDeque;
use std::time::Duration;

use self::facts::Facts;
use self::jobs::{Job, Verify};
use self::track::Track;
use self::watch::{Move, SlewWatch, StopWatch};
use self::wire::{Outcome, Probe, Wire};
use super::advice::Disagreement;
use super::belief::{Belief, LinkState, Precision};
use super::command::Command;
use super::dialect::Dialect;
use super::order::{Direction, Fault, Order, Rate, Report};
use super::reply::Reply;
use crate::hw::port::PortError;
use crate::sky::site::Site;
use crate::sky::time::Utc;
use crate::units::Angle;

/// What we know of place and time without the mount.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ours {
    /// Our clock's UTC when "now" was zero.
    pub utc_at_start: Utc,
    /// Our site, if we have one.
    pub site: Option<Site>,
}

/// How long to wait for what.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Timing {
    /// From the command to the first byte of its reply.
    pub first_byte: Duration,
    /// From one byte of a reply to the next.
    pub next_byte: Duration,
}

impl Timing {
    /// For a serial line: a reply begins within 50 ms and a USB adapter adds 16 ms; ten times that is a fault.
    pub const SERIAL: Timing = Timing { first_byte: Duration::from_millis(500), next_byte: Duration::from_millis(100) };
    /// For a bridge over TCP: its round trip is 100 to 280 ms, and a reply may be split over two packets.
    pub const TCP: Timing = Timing { first_byte: Duration::from_millis(1500), next_byte: Duration::from_millis(300) };
}

/// What the driver needs to be told once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// How long to wait for what.
    pub timing: Timing,
    /// A move by hand that is not renewed ends after this.
    pub move_bound: Duration,
    /// Place and time without the mount.
    pub ours: Ours,
}

impl Settings {
    /// The usual settings for a line.
    #[must_use]
    pub fn new(timing: Timing, ours: Ours) -> Settings {
        Settings { timing, move_bound: Duration::from_millis(1000), ours }
    }
}

/// Ends a command of which the mount has heard one half before the line was lost, and which would swallow the probe. Not a bare
/// `#`: that would carry out a go-to whose `:MS` it had heard.
const END_OF_HALF: &[u8] = b":#";
/// Orders that may wait.
const MOST_ORDERS: usize = 32;
/// Reports that may wait; older ones are dropped.
const MOST_REPORTS: usize = 512;
/// A mount that answers, but not with positions, is tried on a fresh line after this.
const NO_POSITION: Duration = Duration::from_secs(10);

/// Half a position.
#[derive(Debug, Clone, Copy, PartialEq)]
struct HalfPosition {
    ra: Angle,
    form: Precision,
    at: Duration,
}

/// How far the conversation has come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    Closed,
    Finding(Probe),
    Asking,
    Ready,
}

/// On whose behalf the command on the line was sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Purpose {
    Ask,
    Job,
    Poll,
}

/// The driver: feed it bytes and time, write what it drains, read what it reports.
#[derive(Debug)]
pub struct Driver {
    settings: Settings,
    belief: Belief,
    reports: VecDeque<Report>,
    wire: Wire,
    stage: Stage,
    purpose: Purpose,
    dialect: Dialect,
    reopen: bool,
    /// The fault that ended the last line, so that it is not reported at each new try.
    ended_by: Option<Fault>,
    /// Questions to ask before anything else, and how often the first has failed.
    questions: VecDeque<Command>,
    failures: u32,
    facts: Facts,
    toggles: u32,
    said: Vec<Disagreement>,
    compare_at: Duration,
    /// Orders that wait, the one under way, and what is to be checked when facts are read again.
    orders: VecDeque<Order>,
    job: Option<Job>,
    verify: Option<Verify>,
    /// Positions.
    track: Track,
    /// A right ascension that waits for its declination.
    ra: Option<HalfPosition>,
    /// Positions in a row whose halves had two forms.
    two_forms: u32,
    polls: VecDeque<Command>,
    poll_at: Duration,
    status_at: Duration,
    position_due: Duration,
    /// Motion of ours.
    slew: Option<SlewWatch>,
    stop: Option<StopWatch>,
    moves: Vec<Move>,
    ends: Vec<(Duration, Direction)>,
    rate: Option<Rate>,
}

impl Driver {
    /// A driver without a line.
    #[must_use]
    pub fn new(settings: Settings) -> Driver {
        Driver {
            settings,
            belief: Belief::default(),
            reports: VecDeque::new(),
            wire: Wire::new(settings.timing),
            stage: Stage::Closed,
            purpose: Purpose::Ask,
            dialect: Dialect::LX200GPS,
            reopen: false,
            ended_by: None,
            questions: VecDeque::new(),
            failures: 0,
            facts: Facts::default(),
            toggles: 0,
            said: Vec::new(),
            compare_at: Duration::MAX,
            orders: VecDeque::new(),
            job: None,
            verify: None,
            track: Track::default(),
            ra: None,
            two_forms: 0,
            polls: VecDeque::new(),
            poll_at: Duration::ZERO,
            status_at: Duration::ZERO,
            position_due: Duration::MAX,
            slew: None,
            stop: None,
            moves: Vec::new(),
            ends: Vec::new(),
            rate: None,
        }
    }

    /// The port is open: find out who is there. A stop that could not be sent, or a move that could not be ended, is sent
    /// the end first; a slew is never ordered again.
    pub fn link_opened(&mut self, now: Duration) {
        self.wire.open(Probe::Ack, now);
        if self.belief.counters.reconnects > 0 {
            self.wire.interject(END_OF_HALF);
        }
        self.stage = Stage::Finding(Probe::Ack);
        self.belief.link = LinkState::Connecting;
        self.reopen = false;
        if self.stop.is_some() || !self.moves.is_empty() {
            self.moves.clear();
            self.begin_stop(now);
        }
    }

    /// The port is gone. Orders that wait are dropped; what was believed keeps its age.
    pub fn link_lost(&mut self, why: PortError, now: Duration) {
        let was_open = self.stage != Stage::Closed;
        self.let_go();
        self.stage = Stage::Closed;
        self.belief.link = LinkState::Closed;
        if was_open {
            self.report(Report::Lost(why));
        }
        self.warn_of_motion(now);
    }

    /// The line is gone while a stop, or the end of a move, is still owed: say so at once.
    fn warn_of_motion(&mut self, now: Duration) {
        if self.stop.is_some() || !self.moves.is_empty() {
            let after = self.stop.map_or(Duration::ZERO, |stop| stop.age(now));
            self.report(Report::StopNotObeyed { after, answers: false });
        }
    }

    /// Counts a port that was opened again.
    pub(crate) fn count_reconnect(&mut self) {
        self.belief.counters.reconnects += 1;
    }

    /// Adds a report of the line itself.
    pub(crate) fn report_line(&mut self, report: Report) {
        self.report(report);
    }

    /// Whether the port should be closed and opened anew: nothing answers on it.
    #[must_use]
    pub fn wants_reopening(&self) -> bool {
        self.reopen
    }

    /// Forgets everything believed, with what is now known of place and time without the mount: after a suspend, or when our
    /// own clock or site has changed. Everything is asked again.
    pub fn forget(&mut self, ours: Ours, now: Duration) {
        self.settings.ours = ours;
        self.belief = Belief { link: self.belief.link, counters: self.belief.counters, ..Belief::default() };
        self.said.clear();
        self.slew = None;
        self.track.forget();
        let open = self.stage != Stage::Closed;
        self.let_go();
        if open {
            self.link_opened(now);
        }
    }

    /// Takes bytes that came from the mount.
    pub fn feed(&mut self, bytes: &[u8], now: Duration) {
        if self.stage == Stage::Closed {
            return;
        }
        self.wire.feed(bytes, now);
        self.go_on(now);
    }

    /// Lets time pass.
    pub fn tick(&mut self, now: Duration) {
        if self.stage == Stage::Closed {
            return;
        }
        self.wire.tick(now);
        self.keep_watch(now);
        self.go_on(now);
    }

    /// The bytes to write now; they are handed out once.
    #[must_use]
    pub fn drain(&mut self) -> Vec<u8> {
        self.wire.drain()
    }

    /// The next report.
    pub fn poll(&mut self) -> Option<Report> {
        self.reports.pop_front()
    }

    /// Everything believed of the mount.
    #[must_use]
    pub fn belief(&self) -> &Belief {
        &self.belief
    }

    /// How the mount differs from its family.
    #[must_use]
    pub fn dialect(&self) -> Dialect {
        self.dialect
    }

    /// When [`Driver::tick`] wants to be called at the latest.
    #[must_use]
    pub fn wake_at(&self) -> Duration {
        if self.stage == Stage::Closed {
            return Duration::MAX;
        }
        let idle = match self.stage {
            Stage::Ready if self.wire.idle() => {
                let waiting = !self.questions.is_empty() || self.job.is_some() || !self.orders.is_empty();
                if waiting && self.stop.is_none() { Duration::ZERO } else { self.poll_at }
            }
            _ => Duration::MAX,
        };
        idle.min(self.wire.wake_at()).min(self.watch_at())
    }

    fn report(&mut self, report: Report) {
        if matches!(report, Report::Fault(_)) {
            self.belief.counters.faults += 1;
        }
        if self.reports.len() >= MOST_REPORTS {
            self.reports.pop_front();
        }
        self.reports.push_back(report);
    }

    /// Drops everything that waits for the line.
    fn let_go(&mut self) {
        self.wire.close();
        self.questions.clear();
        self.orders.clear();
        self.polls.clear();
        self.job = None;
        self.verify = None;
        self.rate = None;
        self.position_due = Duration::MAX;
    }

    /// Takes what came of the command on the line, and sends the next.
    fn go_on(&mut self, now: Duration) {
        while let Some(outcome) = self.wire.outcome() {
            self.belief.counters.stray_bytes = self.wire.stray;
            match outcome {
                Outcome::Answer(command, reply) => self.answered(&command, reply, now),
                Outcome::Failed(command, fault) => self.failed(&command, fault, now),
                Outcome::Nak(command) => {
                    self.belief.counters.retries += 1;
                    self.report(Report::BusyNak { command: command.name() });
                }
                Outcome::InStep => self.in_step(now),
                Outcome::Dead(fault) => self.dead(fault, now),
            }
        }
        if now >= self.position_due {
            self.dead(Fault::Silent, now);
        }
        if self.wire.idle() {
            self.begin_next(now);
        }
    }

    fn begin_next(&mut self, now: Duration) {
        let (purpose, command) = match self.stage {
            Stage::Closed | Stage::Finding(_) => return,
            Stage::Asking | Stage::Ready if self.stop.is_none() || self.stage == Stage::Asking => {
                match self.questions.front() {
                    Some(question) => (Purpose::Ask, question.clone()),
                    None if self.stage == Stage::Asking => return,
                    None => match self.next_of_job(now) {
                        Some(command) => (Purpose::Job, command),
                        None => match self.next_poll(now) {
                            Some(command) => (Purpose::Poll, command),
                            None => return,
                        },
                    },
                }
            }
            _ => match self.next_poll(now) {
                Some(command) => (Purpose::Poll, command),
                None => return,
            },
        };
        self.purpose = purpose;
        self.wire.send(command, now);
    }

    fn answered(&mut self, command: &Command, reply: Reply, now: Duration) {
        match self.purpose {
            Purpose::Ask => self.question_answered(command, reply, now),
            Purpose::Job => self.job_answered(command, reply, now),
            Purpose::Poll => self.poll_answered(command, reply, now),
        }
    }

    fn failed(&mut self, command: &Command, fault: Fault, now: Duration) {
        self.belief.link = if self.stage == Stage::Ready { LinkState::Mending } else { self.belief.link };
        match self.purpose {
            Purpose::Ask => self.question_failed(command, fault, now),
            Purpose::Job => self.job_failed(command, fault, now),
            Purpose::Poll => {
                self.polls.clear();
                self.poll_at = now;
                self.report(Report::Fault(fault));
            }
        }
    }

    /// The mount answers to the probe alone.
    fn in_step(&mut self, now: Duration) {
        match self.stage {
            Stage::Finding(_) => self.ask_everything(now),
            Stage::Asking => {}
            Stage::Ready => {
                self.belief.link = LinkState::Ready;
                self.belief.counters.resyncs += 1;
                self.report(Report::Resynchronised);
            }
            Stage::Closed => {}
        }
    }

    /// The mount cannot be brought to answer: another probe, or another line.
    fn dead(&mut self, fault: Fault, now: Duration) {
        if self.stage == Stage::Finding(Probe::Ack) && fault == Fault::Silent {
            self.stage = Stage::Finding(Probe::Ra);
            self.wire.open(Probe::Ra, now);
            return;
        }
        self.belief.link = if fault == Fault::Looped { LinkState::Looped } else { LinkState::Silent };
        if self.ended_by.as_ref() != Some(&fault) {
            self.report(Report::Fault(fault.clone()));
            self.ended_by = Some(fault);
        }
        self.fail_job("the mount does not answer");
        self.let_go();
        self.stage = Stage::Closed;
        self.reopen = true;
        self.warn_of_motion(now);
    }

    /// Our clock now.
    fn utc(&self, now: Duration) -> Utc {
        self.settings.ours.utc_at_start.plus_seconds(now.as_secs_f64())
    }
}
