//! Everything that moves the tube, or tells that it moves.

use std::time::Duration;

use super::Controller;
use super::power::Power;
use crate::hw::mount::sim::angles::{decimal, digits, read_hours};
use crate::hw::mount::sim::answer::Answer;
use crate::hw::mount::sim::earth::SIDEREAL_DEG_PER_S;
use crate::hw::mount::sim::tube::{Arrow, Goal, SIDEREAL_HZ};

/// Handset speeds 1 to 9 in degrees a second: 1, 2, 8, 16, 64, 128 times sidereal, 1.5 and 3 degrees, and the fastest.
const SPEEDS: [f64; 9] = [
    SIDEREAL_DEG_PER_S,
    2.0 * SIDEREAL_DEG_PER_S,
    8.0 * SIDEREAL_DEG_PER_S,
    16.0 * SIDEREAL_DEG_PER_S,
    64.0 * SIDEREAL_DEG_PER_S,
    128.0 * SIDEREAL_DEG_PER_S,
    1.5,
    3.0,
    8.0,
];

impl Controller {
    /// `:M...# :Q...# :R...# :D# :C.#`.
    pub(super) fn move_by(&mut self, body: &[u8], at: Duration) -> Option<Answer> {
        match body {
            b"MS" => Some(self.go_to_target(at)),
            b"MA" => Some(self.go_to_ground(at)),
            b"D" => Some(self.bars(at)),
            b"CM" => Some(self.sync()),
            b"CL" => Some(Answer::silent()),
            [b'M', letter] => self.arrow(*letter),
            [b'M', b'g', letter, milliseconds @ ..] => self.pulse(*letter, milliseconds, at),
            [b'Q'] => self.stop(None),
            [b'Q', letter] => self.stop(Some(Arrow::of(*letter)?)),
            [b'R', rate @ ..] => self.arrow_rate(rate),
            _ => None,
        }
    }

    /// `:MS#`: `0` without `#`, or a digit and a text.
    fn go_to_target(&mut self, at: Duration) -> Answer {
        let (ra, dec) = self.told.target;
        let altitude = self.tube.ground_of((ra, dec), at).1;
        let refusal = self.faults.refuse.unwrap_or(match altitude {
            low if low < self.odds.lowest_deg => 1,
            high if high > self.odds.highest_deg => 2,
            _ => 0,
        });
        match refusal {
            0 => self.begin(Goal::Sky(ra, dec), at),
            1 => Answer::text("1Object Below Horizon"),
            2 => Answer::text("2Object Above Limit"),
            3 => Answer::text("3Object Can Hit Tripod"),
            _ => Answer::text("4Object Below Lower Limit"),
        }
    }

    fn go_to_ground(&mut self, at: Duration) -> Answer {
        let (azimuth, altitude) = self.told.ground_target;
        if altitude < self.odds.lowest_deg || altitude > self.odds.highest_deg {
            return Answer::accepted(true);
        }
        self.begin(Goal::Ground(azimuth, altitude), at)
    }

    /// Begins a go-to. A parked mount says yes and stays.
    pub(super) fn begin(&mut self, goal: Goal, at: Duration) -> Answer {
        if matches!(self.power, Power::Awake | Power::Asking) {
            self.tube.go(goal);
            self.goto_began = at;
        }
        Answer::bytes(*b"0")
    }

    /// `:D#`: one bar while a go-to lasts, nothing for moves by hand.
    fn bars(&self, at: Duration) -> Answer {
        let shown = at >= self.goto_began.saturating_add(self.faults.late_bar);
        Answer::bytes(if self.tube.slewing() && shown { b"\x7F#".to_vec() } else { b"#".to_vec() })
    }

    /// `:CM#`: a static text.
    fn sync(&mut self) -> Answer {
        let (ra, dec) = self.told.target;
        self.tube.sync(ra, dec);
        Answer { held: self.faults.hold_sync, ..Answer::text(" M31 EX GAL MAG 3.5 SZ178.0'") }
    }

    fn arrow(&mut self, letter: u8) -> Option<Answer> {
        let arrow = Arrow::of(letter)?;
        if matches!(self.power, Power::Awake | Power::Asking) {
            let (azimuth, altitude) = self.arrow_deg_s;
            let speed = if matches!(arrow, Arrow::East | Arrow::West) { azimuth } else { altitude };
            self.tube.press(self.felt(arrow), speed, None);
        }
        Some(Answer::silent())
    }

    fn pulse(&mut self, letter: u8, milliseconds: &[u8], at: Duration) -> Option<Answer> {
        let arrow = self.felt(Arrow::of(letter)?);
        let milliseconds = digits(milliseconds).filter(|_| milliseconds.len() <= 4)?;
        if self.power == Power::Awake && !self.tube.slewing() {
            let until = at.saturating_add(Duration::from_secs_f64(milliseconds / 1000.0));
            self.tube.press(arrow, self.guide_deg_s, Some(until));
        }
        Some(Answer::silent())
    }

    /// `:Q#` for everything, `:Qn#` for one direction; one direction ends a go-to as well.
    fn stop(&mut self, arrow: Option<Arrow>) -> Option<Answer> {
        if self.stops_to_ignore > 0 {
            self.stops_to_ignore -= 1;
            return Some(Answer::silent());
        }
        match arrow {
            None => self.tube.stop(),
            Some(arrow) => self.tube.let_go(self.felt(arrow)),
        }
        self.parking_stopped();
        Some(Answer::silent())
    }

    /// `:RG :RC :RM :RS`, `:R1` to `:R9`, `:RADD.D :REDD.D :RgSS.S`.
    fn arrow_rate(&mut self, rate: &[u8]) -> Option<Answer> {
        let both = |speed: f64| (speed, speed);
        match rate {
            b"G" => self.arrow_deg_s = both(SPEEDS[0]),
            b"C" => self.arrow_deg_s = both(SPEEDS[3]),
            b"M" => self.arrow_deg_s = both(SPEEDS[7]),
            b"S" => self.arrow_deg_s = both(self.tube.fastest_deg_s),
            [digit @ b'1'..=b'9'] => self.arrow_deg_s = both(SPEEDS[usize::from(digit - b'1')]),
            [b'A', speed @ ..] => self.arrow_deg_s.0 = decimal(speed)?.clamp(0.0, 8.0),
            [b'E', speed @ ..] => self.arrow_deg_s.1 = decimal(speed)?.clamp(0.0, 8.0),
            [b'g', speed @ ..] => self.guide_deg_s = decimal(speed)?.clamp(0.0, 15.0417) / 3600.0,
            _ => return None,
        }
        Some(Answer::silent())
    }

    /// `:SwN#` the fastest slew, `:STdd.d#` the tracking rate, `:SBn#` the baud rate.
    pub(super) fn set_rate(&mut self, letter: u8, value: &[u8]) -> Option<Answer> {
        let number = decimal(value);
        match letter {
            b'w' => {
                let speed = number.filter(|speed| (2.0..=8.0).contains(speed));
                if let Some(speed) = speed {
                    self.tube.fastest_deg_s = speed;
                }
                Some(Answer::accepted(speed.is_some()))
            }
            b'T' => {
                let hertz = number.filter(|hertz| (50.0..=70.0).contains(hertz));
                if let Some(hertz) = hertz {
                    self.tube.set_rate_hz(hertz);
                }
                Some(Answer::accepted(hertz.is_some()))
            }
            _ => Some(self.set_baud(value)),
        }
    }

    /// `:T.#`.
    pub(super) fn rate_command(&mut self, body: &[u8]) -> Option<Answer> {
        match body {
            b"TQ" => self.tube.set_rate_hz(SIDEREAL_HZ),
            b"TL" => self.tube.set_rate_hz(57.9),
            b"TS" => self.tube.set_rate_hz(60.0),
            b"T+" => self.tube.set_rate_hz((self.tube.rate_hz() + 0.1).min(70.0)),
            b"T-" => self.tube.set_rate_hz((self.tube.rate_hz() - 0.1).max(50.0)),
            b"TM" => {}
            _ => return None,
        }
        Some(Answer::silent())
    }

    /// `:SSHH:MM:SS#` shifts sidereal time, and with it every later go-to.
    pub(super) fn set_sidereal_time(&mut self, value: &[u8], at: Duration) -> Option<Answer> {
        let hours = read_hours(value);
        if let Some(hours) = hours {
            self.tube.sidereal_shift_deg += hours * 15.0 - self.tube.sidereal_deg(at);
            self.tube.set_tracking(self.tube.tracking());
        }
        Some(Answer::accepted(hours.is_some()))
    }
}
