//! Coordinates: those of the tube, told and rounded, and those of the target.

use std::time::Duration;

use super::Controller;
use crate::hw::mount::sim::angles::{read_degrees, read_hours};
use crate::hw::mount::sim::answer::Answer;
use crate::hw::mount::sim::earth::horizontal;

/// What is kept for telling: the format, the target, and a frozen position.
#[derive(Debug)]
pub(super) struct Told {
    /// The long format, which `:U#` toggles; kept while clients come and go.
    pub(super) long: bool,
    high_precision_pointing: bool,
    /// Degrees.
    pub(super) target: (f64, f64),
    /// Azimuth and altitude of `:Sz` and `:Sa`, degrees.
    pub(super) ground_target: (f64, f64),
    frozen: Option<(f64, f64)>,
}

impl Told {
    pub(super) fn new(long: bool) -> Told {
        Told { long, high_precision_pointing: false, target: (0.0, 0.0), ground_target: (0.0, 0.0), frozen: None }
    }

    /// `:U#`.
    pub(super) fn toggle(&mut self, body: &[u8]) -> Option<Answer> {
        (body == b"U").then(|| {
            self.long = !self.long;
            Answer::silent()
        })
    }

    /// `:P#`: 14 bytes, two spaces in LOW, no `#`.
    pub(super) fn toggle_high_precision_pointing(&mut self, body: &[u8]) -> Option<Answer> {
        (body == b"P").then(|| {
            self.high_precision_pointing = !self.high_precision_pointing;
            Answer::bytes(if self.high_precision_pointing { *b"HIGH PRECISION" } else { *b"LOW  PRECISION" })
        })
    }

    /// `:Sr :Sd :Sa :Sz`.
    pub(super) fn set_target(&mut self, letter: u8, value: &[u8]) -> Option<Answer> {
        let (place, angle) = match letter {
            b'r' => (&mut self.target.0, read_hours(value).map(|hours| hours * 15.0)),
            b'd' => (&mut self.target.1, read_degrees(value, 90.0)),
            b'z' => (&mut self.ground_target.0, read_degrees(value, 360.0)),
            _ => (&mut self.ground_target.1, read_degrees(value, 90.0)),
        };
        if let Some(angle) = angle {
            *place = angle;
        }
        Some(Answer::accepted(angle.is_some()))
    }
}

impl Controller {
    /// `:GR :GD :GA :GZ :Gr :Gd`.
    pub(super) fn tell_position(&mut self, body: &[u8], at: Duration) -> Option<Answer> {
        let form = self.form();
        let (mut ra, mut dec) = self.position_to_tell(at);
        if matches!(body, b"GR" | b"GD") && self.random.chance(self.faults.jump) {
            ra = self.random.uniform() * 360.0;
            dec = self.random.uniform() * 180.0 - 90.0;
        }
        let answer = match body {
            b"GR" => form.hours(ra / 15.0),
            b"GD" => form.signed(dec),
            b"GA" if self.faults.wrong_altitude => form.signed(dec),
            b"GA" => form.signed(self.ground_to_tell((ra, dec), at).1),
            b"GZ" => form.turn(self.ground_to_tell((ra, dec), at).0),
            b"Gr" => form.hours(self.told.target.0 / 15.0),
            b"Gd" => form.signed(self.told.target.1),
            _ => return None,
        };
        Some(Answer::bytes(answer))
    }

    fn position_to_tell(&mut self, at: Duration) -> (f64, f64) {
        let live = self.tube.believed(at);
        match self.faults.frozen {
            Some(from) if at >= from => *self.told.frozen.get_or_insert(live),
            _ => live,
        }
    }

    /// Azimuth and altitude as the displayed clock and site have them.
    fn ground_to_tell(&self, (ra, dec): (f64, f64), at: Duration) -> (f64, f64) {
        let site = self.calendar.site();
        horizontal(self.calendar.sidereal_deg(at) - ra, dec, site.latitude_deg)
    }
}
