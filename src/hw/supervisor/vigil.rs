//! The supervisor's mind: beats and time go in, duties come out. No pipe, no line, no clock.

use std::time::Duration;

/// A session that moves the mount and has not been heard for this long hangs.
pub const HANGS_AFTER: Duration = Duration::from_secs(2);

/// The stop is sent again after this time...
pub const STOP_EVERY: Duration = Duration::from_millis(250);

/// ... so many times: for three seconds, in which an LX200GPS comes to rest from 8 degrees a second.
pub const STOPS: u32 = 12;

/// What stops an LX200GPS. The first `#` ends a command that the dead session may have left half sent, which would take the
/// next `:` for data; then the slew is stopped, then each direction of a move by hand.
pub const STOP: &[u8] = b"#:Q#:Qn#:Qs#:Qe#:Qw#";

/// What the session says once per turn of its loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beat {
    /// It lives, the mount does not move (or only tracks).
    Still,
    /// It lives, the mount moves.
    Moving,
    /// The supervisor is not needed any more.
    Release,
}

impl Beat {
    /// The byte in the pipe.
    #[must_use]
    pub fn to_byte(self) -> u8 {
        match self {
            Beat::Still => b's',
            Beat::Moving => b'm',
            Beat::Release => b'q',
        }
    }

    /// The beat of a byte.
    #[must_use]
    pub fn from_byte(byte: u8) -> Option<Beat> {
        [Beat::Still, Beat::Moving, Beat::Release].into_iter().find(|beat| beat.to_byte() == byte)
    }
}

/// How a vigil ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// There was nothing to stop.
    Quiet,
    /// The session died while the mount moved: the stop was sent.
    SessionDied,
    /// The session hung while the mount moved: the stop was sent.
    SessionHung,
}

/// What is to be done now.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Duty {
    /// Listen to the pipe, at most so long (`None`: as long as it takes).
    Listen(Option<Duration>),
    /// Do nothing for so long: nothing that comes through the pipe matters any more.
    Pause(Duration),
    /// Send the stop, then ask again.
    SendStop,
    /// The vigil is over.
    Leave(Outcome),
}

/// A vigil over one open line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Vigil(State);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    Still,
    Moving { heard: Duration },
    Stopping { since: Duration, sent: u32, because: Outcome },
    Over(Outcome),
}

impl Vigil {
    /// The session has just opened the line; nothing moves by its order.
    #[must_use]
    pub fn begun() -> Vigil {
        Vigil(State::Still)
    }

    /// A byte came through the pipe. What is no beat is a sign of life that changes nothing. Once the stop is being sent, a
    /// session that wakes up is too late: it is told by the closed pipe, and must look at the mount afresh.
    pub fn hear(&mut self, byte: u8, now: Duration) {
        self.0 = match (self.0, Beat::from_byte(byte)) {
            (over @ (State::Stopping { .. } | State::Over(_)), _) => over,
            (_, Some(Beat::Moving)) | (State::Moving { .. }, None) => State::Moving { heard: now },
            (_, Some(Beat::Still)) | (State::Still, None) => State::Still,
            (_, Some(Beat::Release)) => State::Over(Outcome::Quiet),
        };
    }

    /// The pipe was closed: the session is dead, or has dropped its guard.
    pub fn session_gone(&mut self, now: Duration) {
        self.0 = match self.0 {
            State::Still => State::Over(Outcome::Quiet),
            State::Moving { .. } => State::Stopping { since: now, sent: 0, because: Outcome::SessionDied },
            going_on => going_on,
        };
    }

    /// What to do now.
    pub fn duty(&mut self, now: Duration) -> Duty {
        if let State::Moving { heard } = self.0
            && now.saturating_sub(heard) > HANGS_AFTER
        {
            self.0 = State::Stopping { since: now, sent: 0, because: Outcome::SessionHung };
        }
        match &mut self.0 {
            State::Still => Duty::Listen(None),
            State::Moving { heard } => {
                Duty::Listen(Some((*heard + HANGS_AFTER).saturating_sub(now) + Duration::from_millis(1)))
            }
            State::Stopping { sent, because, .. } if *sent >= STOPS => Duty::Leave(*because),
            State::Stopping { since, sent, .. } => {
                let due = *since + STOP_EVERY * *sent;
                if now >= due {
                    *sent += 1;
                    Duty::SendStop
                } else {
                    Duty::Pause(due - now)
                }
            }
            State::Over(outcome) => Duty::Leave(*outcome),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    /// Lets time pass until the vigil is over: (when each stop was sent, the outcome). Pauses are jumped over.
    fn to_the_end(vigil: &mut Vigil, mut now: Duration) -> (Vec<Duration>, Outcome) {
        let mut stops = Vec::new();
        loop {
            match vigil.duty(now) {
                Duty::Leave(outcome) => return (stops, outcome),
                Duty::SendStop => stops.push(now),
                Duty::Pause(wait) | Duty::Listen(Some(wait)) => now += wait,
                Duty::Listen(None) => panic!("it would listen for ever"),
            }
        }
    }

    #[test]
    fn a_session_that_dies_at_rest_needs_no_stop() {
        let mut vigil = Vigil::begun();
        vigil.hear(b's', ms(10));
        assert_eq!(vigil.duty(ms(10_000)), Duty::Listen(None));
        vigil.session_gone(ms(10_001));
        assert_eq!(vigil.duty(ms(10_001)), Duty::Leave(Outcome::Quiet));
    }

    #[test]
    fn a_session_that_dies_while_moving_is_followed_by_twelve_stops_in_three_seconds() {
        let mut vigil = Vigil::begun();
        vigil.hear(b'm', ms(10));
        vigil.session_gone(ms(300));
        let (stops, outcome) = to_the_end(&mut vigil, ms(300));
        assert_eq!(outcome, Outcome::SessionDied);
        assert_eq!((stops.len(), stops[0], stops[11]), (12, ms(300), ms(300 + 2750)));
    }

    #[test]
    fn a_session_that_falls_silent_while_moving_is_stopped_after_two_seconds() {
        let mut vigil = Vigil::begun();
        vigil.hear(b'm', ms(1000));
        assert_eq!(vigil.duty(ms(3000)), Duty::Listen(Some(ms(1))));
        let (stops, outcome) = to_the_end(&mut vigil, ms(3000));
        assert_eq!((stops[0], outcome), (ms(3001), Outcome::SessionHung));
    }

    #[test]
    fn a_session_that_beats_is_never_stopped() {
        let mut vigil = Vigil::begun();
        for i in 0..1000 {
            vigil.hear(b'm', ms(i * 1900));
            assert!(matches!(vigil.duty(ms(i * 1900)), Duty::Listen(Some(_))));
        }
        vigil.hear(b's', ms(2_000_000));
        assert_eq!(vigil.duty(ms(9_000_000)), Duty::Listen(None));
    }

    #[test]
    fn a_session_that_wakes_up_too_late_does_not_end_the_stopping() {
        let mut vigil = Vigil::begun();
        vigil.hear(b'm', ms(0));
        assert_eq!(vigil.duty(ms(2500)), Duty::SendStop);
        vigil.hear(b'm', ms(2501));
        vigil.hear(b'q', ms(2502));
        vigil.session_gone(ms(2503));
        assert_eq!(to_the_end(&mut vigil, ms(2503)).1, Outcome::SessionHung);
    }

    #[test]
    fn a_released_supervisor_leaves_the_mount_alone_even_while_it_moves() {
        let mut vigil = Vigil::begun();
        vigil.hear(b'm', ms(0));
        vigil.hear(b'q', ms(1));
        vigil.session_gone(ms(2));
        assert_eq!(vigil.duty(ms(2)), Duty::Leave(Outcome::Quiet));
    }
}
