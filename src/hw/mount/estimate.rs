//! Where the mount points between two polls.

use std::time::Duration;

use crate::sky::coords::{Equatorial, OfDate};
use crate::sky::pointing::{Motion, Pointing};
use crate::units::Angle;

/// A smoothed position with its rate, good to look ahead from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    position: Equatorial<OfDate>,
    /// Rates in RA and Dec, radians a second.
    rate: (f64, f64),
    motion: Motion,
    uncertainty: Angle,
    at: Duration,
}

/// A position older than this is not drawn from.
pub const STALE_AFTER: Duration = Duration::from_secs(3);

impl Estimate {
    /// A first position.
    #[must_use]
    pub fn new(position: Equatorial<OfDate>, motion: Motion, uncertainty: Angle, at: Duration) -> Estimate {
        Estimate { position, rate: (0.0, 0.0), motion, uncertainty, at }
    }

    /// Where the telescope points at `now`.
    #[must_use]
    pub fn at(&self, now: Duration) -> Pointing {
        let age = now.saturating_sub(self.at);
        let ahead = age.min(STALE_AFTER).as_secs_f64();
        Pointing {
            position: Equatorial::new(
                self.position.ra() + Angle::radians(self.rate.0 * ahead),
                self.position.dec() + Angle::radians(self.rate.1 * ahead),
            ),
            uncertainty: self.uncertainty,
            motion: self.motion,
            stale: age > STALE_AFTER,
        }
    }
}
