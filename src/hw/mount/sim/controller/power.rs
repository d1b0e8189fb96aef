//! Awake, asleep, parked, starting up, and the states that only the power switch ends.

use std::time::Duration;

use super::Controller;
use crate::hw::mount::sim::angles::digits;
use crate::hw::mount::sim::answer::Answer;

/// How long the start-up takes before the controller says `X`.
const START_UP: Duration = Duration::from_secs(10);
/// How long a home search takes.
const HOME_SEARCH: Duration = Duration::from_secs(30);

/// The state of the whole mount.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Power {
    Awake,
    Asleep,
    Parking,
    Parked,
    /// Starting up until then.
    Starting(Duration),
    /// Up again, and the hand controller asks about daylight saving.
    Asking,
    /// In the firmware loader: only ACK is answered.
    Downloader,
    /// Deaf until the power is switched off: another baud rate.
    Deaf,
}

impl Controller {
    /// Whether a command is heard at all in this state.
    pub(super) fn listens_to(&mut self, body: &[u8]) -> bool {
        match self.power {
            Power::Awake | Power::Asking | Power::Parking => true,
            Power::Parked => !self.faults.park_silence,
            Power::Asleep => {
                if body == b"hW" || body.starts_with(b"EK") {
                    self.power = Power::Awake;
                }
                false
            }
            Power::Starting(_) | Power::Downloader | Power::Deaf => false,
        }
    }

    /// Whether commands are answered in this state.
    pub(in crate::hw::mount::sim) fn answers(&self) -> bool {
        match self.power {
            Power::Awake | Power::Asking | Power::Parking => true,
            Power::Parked => !self.faults.park_silence,
            Power::Asleep | Power::Starting(_) | Power::Downloader | Power::Deaf => false,
        }
    }

    /// What becomes of a state as time passes.
    pub(super) fn power_tick(&mut self, now: Duration) {
        match self.power {
            Power::Starting(until) if now >= until => {
                self.power = Power::Asking;
                self.handset.ask_daylight();
                self.unasked.push(Answer::bytes(*b"X"));
            }
            Power::Parking if !self.tube.moving() => {
                self.power = Power::Parked;
                self.aligned = b'P';
                self.tube.set_tracking(false);
                self.handset.say("Scope parked.", "Turn scope off.");
            }
            _ => {}
        }
    }

    /// `:h.# :I# :A.#`.
    pub(super) fn power_command(&mut self, body: &[u8], at: Duration) -> Option<Answer> {
        match body {
            b"I" => self.restart(at),
            b"hP" => {
                self.tube.park();
                self.goto_began = at;
                self.power = Power::Parking;
                self.handset.say("Parking Scope", "");
            }
            b"hN" => {
                self.tube.stop();
                self.power = Power::Asleep;
            }
            b"hW" | b"hS" | b"hC" => {}
            b"hF" => self.odds.home_search = Some(at + HOME_SEARCH),
            b"h?" => {
                let running = self.odds.home_search.is_some_and(|until| until > at);
                return Some(Answer::bytes(if running { *b"2" } else { *b"1" }));
            }
            [b'h', b'I', date @ ..] => {
                return Some(Answer::accepted(self.power == Power::Asking && self.answer_questions(date, at)));
            }
            b"AA" => self.align(b'A'),
            b"AP" => self.align(b'P'),
            b"AL" => self.align(b'L'),
            b"Aa" => return Some(Answer::default().then(Duration::from_secs(60), *b"1")),
            _ => return None,
        }
        Some(Answer::silent())
    }

    /// Another mounting: land mode does not track.
    fn align(&mut self, mounting: u8) {
        self.mounting = mounting;
        self.tube.set_tracking(mounting != b'L');
    }

    /// `:hIYYMMDDHHMMSS#` answers the questions after the start.
    fn answer_questions(&mut self, date: &[u8], at: Duration) -> bool {
        let pair = |n: usize| date.get(2 * n..2 * n + 2).filter(|_| date.len() == 12).and_then(digits);
        let parts: Option<Vec<f64>> = (0..6).map(pair).collect();
        let Some([year, month, day, hour, minute, second]) = parts.as_deref() else { return false };
        let set = self.calendar.set_all([*year, *month, *day, *hour, *minute, *second], at);
        if set {
            self.power = Power::Awake;
            self.handset.home();
        }
        set
    }

    /// As after the power switch: the alignment is gone.
    pub(super) fn restart(&mut self, now: Duration) {
        self.tube.stop();
        self.tube.set_tracking(false);
        self.aligned = b'0';
        self.power = Power::Starting(now.saturating_add(START_UP));
    }

    /// A park that is stopped leaves the mount awake.
    pub(super) fn parking_stopped(&mut self) {
        if self.power == Power::Parking {
            self.power = Power::Awake;
            self.handset.home();
        }
    }

    /// EOT: the firmware loader, which only the power switch leaves.
    pub(super) fn enter_downloader(&mut self) -> Answer {
        self.tube.stop();
        self.power = Power::Downloader;
        Answer::silent()
    }

    /// `:SBn#`: with any other speed than 9600 the link is dead.
    pub(super) fn set_baud(&mut self, value: &[u8]) -> Answer {
        let known = matches!(value, [b'1'..=b'9']);
        if known && value != b"6" {
            self.power = Power::Deaf;
        }
        Answer::accepted(known)
    }
}
