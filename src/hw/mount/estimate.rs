//! Where the mount points between two polls.
//!
//! Following the sky, right ascension and declination are held; standing, right ascension grows. The mount's steps of
//! 15 arcseconds, 19 arcminutes at the eye, are smoothed by an alpha-beta filter.

use std::time::Duration;

use super::belief::Precision;
use crate::sky::coords::{Equatorial, OfDate};
use crate::sky::pointing::{Motion, Pointing};
use crate::units::Angle;

/// Share of a new position's surprise that goes into the position, and into the rate: between them they average the last
/// five polls or so. Kalata (1984), IEEE Trans. AES-20, 174, has the theory; the values are for a quiet mount.
const ALPHA: f64 = 0.3;
const BETA: f64 = 0.05;

/// A surprise beyond this is motion: the filter starts anew.
const SURPRISE: Angle = Angle::arcseconds(60.0);

/// How fast right ascension grows when the motors stand: a turn in 86164.1 s.
const SIDEREAL_RAD_PER_S: f64 = std::f64::consts::TAU / 86_164.1;

/// Uncertainty gained in a second without a position: as much as moving at guiding speed.
const UNWATCHED: Angle = Angle::arcseconds(15.0);

/// A position older than this is not drawn from.
pub const STALE_AFTER: Duration = Duration::from_secs(3);

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

impl Estimate {
    /// A first position: `uncertainty` is how well the mount knows where it points.
    #[must_use]
    pub fn new(position: Equatorial<OfDate>, motion: Motion, uncertainty: Angle, at: Duration) -> Estimate {
        Estimate { position, rate: (own_rate(motion), 0.0), motion, uncertainty, at }
    }

    /// The estimate after one more position.
    #[must_use]
    pub fn with(&self, position: Equatorial<OfDate>, motion: Motion, uncertainty: Angle, at: Duration) -> Estimate {
        let seconds = at.saturating_sub(self.at).as_secs_f64();
        let expected = self.moved(seconds);
        let anew = Estimate::new(position, motion, uncertainty, at);
        if seconds <= 0.0 || seconds > 10.0 {
            return anew;
        }
        let surprise = ((position.ra() - expected.ra()).wrapped_signed(), position.dec() - expected.dec());
        if motion == Motion::Slewing {
            let gone = ((position.ra() - self.position.ra()).wrapped_signed(), position.dec() - self.position.dec());
            return Estimate { rate: (gone.0.to_radians() / seconds, gone.1.to_radians() / seconds), ..anew };
        }
        if self.motion == Motion::Slewing || expected.separation(&position) > SURPRISE {
            return anew;
        }
        let kept = if motion == self.motion { self.rate } else { (own_rate(motion), 0.0) };
        Estimate {
            position: Equatorial::new(expected.ra() + surprise.0 * ALPHA, expected.dec() + surprise.1 * ALPHA),
            rate: (
                kept.0 + BETA * surprise.0.to_radians() / seconds,
                kept.1 + BETA * surprise.1.to_radians() / seconds,
            ),
            ..anew
        }
    }

    /// Where the telescope points at `now`.
    #[must_use]
    pub fn at(&self, now: Duration) -> Pointing {
        let age = now.saturating_sub(self.at);
        let ahead = age.min(STALE_AFTER).as_secs_f64();
        let (known, lost) = (self.uncertainty.to_radians(), UNWATCHED.to_radians() * age.as_secs_f64());
        Pointing {
            position: self.moved(ahead),
            uncertainty: Angle::radians(known.hypot(lost)),
            motion: self.motion,
            stale: age > STALE_AFTER,
        }
    }

    fn moved(&self, seconds: f64) -> Equatorial<OfDate> {
        Equatorial::new(
            self.position.ra() + Angle::radians(self.rate.0 * seconds),
            self.position.dec() + Angle::radians(self.rate.1 * seconds),
        )
    }
}

/// The rate of right ascension that a motion has by itself.
fn own_rate(motion: Motion) -> f64 {
    match motion {
        Motion::Tracking | Motion::Slewing => 0.0,
        Motion::Stopped => SIDEREAL_RAD_PER_S,
    }
}

/// How well a mount knows where it points (one standard deviation), by its alignment and the form of its coordinates.
///
/// The manual: 5 arcminutes casually aligned, 2 on two stars. The format adds its step over the square root of 12.
#[must_use]
pub fn uncertainty(stars: Option<u8>, precision: Precision) -> Angle {
    let aligned = match stars {
        Some(0) => Angle::degrees(1.0),
        Some(1) => Angle::arcminutes(5.0),
        Some(_) | None => Angle::arcminutes(2.0),
    };
    let step = match precision {
        Precision::Long => Angle::arcseconds(15.0),
        Precision::Short => Angle::arcseconds(90.0),
    };
    Angle::radians(aligned.to_radians().hypot(step.to_radians() / 12f64.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(s: f64) -> Duration {
        Duration::from_secs_f64(s)
    }

    fn run(motion: Motion, true_rate_arcsec: f64) -> (Estimate, impl Fn(f64) -> f64) {
        let truth = move |t: f64| 3_600.0 + true_rate_arcsec * t;
        let read = |t: f64| (truth(t) / 15.0).round() * 15.0;
        let place = |arcsec: f64| Equatorial::new(Angle::arcseconds(arcsec), Angle::degrees(10.0));
        let mut estimate = Estimate::new(place(read(0.0)), motion, Angle::arcminutes(2.0), Duration::ZERO);
        for poll in 1..120 {
            let t = f64::from(poll) * 0.5;
            estimate = estimate.with(place(read(t)), motion, Angle::arcminutes(2.0), seconds(t));
        }
        (estimate, truth)
    }

    #[test]
    fn a_standing_mount_is_followed_to_a_third_of_its_step() {
        let (estimate, truth) = run(Motion::Stopped, 15.041);
        for ahead in [0.0, 0.1, 0.3, 0.5] {
            let ra = estimate.at(seconds(59.5 + ahead)).position.ra().to_arcseconds();
            assert!((ra - truth(59.5 + ahead)).abs() < 5.0, "{ra}");
        }
    }

    #[test]
    fn a_following_mount_stands_still_on_the_sky() {
        let (estimate, _) = run(Motion::Tracking, 0.0);
        assert!((estimate.at(seconds(60.4)).position.ra().to_arcseconds() - 3600.0).abs() < 1e-6);
    }

    #[test]
    fn a_quarter_arcsecond_a_second_of_drift_is_smoothed_below_the_step() {
        let (estimate, truth) = run(Motion::Tracking, 0.25);
        assert!((estimate.at(seconds(59.5)).position.ra().to_arcseconds() - truth(59.5)).abs() < 7.5);
    }

    #[test]
    fn a_position_is_stale_after_three_seconds_and_its_uncertainty_grows() {
        let (estimate, _) = run(Motion::Tracking, 0.0);
        assert!(!estimate.at(seconds(62.4)).stale);
        assert!(estimate.at(seconds(62.6)).stale);
        assert!(estimate.at(seconds(62.0)).uncertainty > estimate.at(seconds(59.5)).uncertainty);
    }

    #[test]
    fn after_a_slew_the_first_still_position_is_taken_as_it_is() {
        let there = Equatorial::new(Angle::degrees(100.0), Angle::degrees(-20.0));
        let estimate = Estimate::new(
            Equatorial::new(Angle::degrees(90.0), Angle::ZERO),
            Motion::Slewing,
            Angle::arcminutes(2.0),
            Duration::ZERO,
        )
        .with(there, Motion::Tracking, Angle::arcminutes(2.0), seconds(0.5));
        assert_eq!(estimate.at(seconds(0.5)).position, there);
    }

    #[test]
    fn the_short_form_and_a_missing_alignment_are_less_certain() {
        assert!(uncertainty(Some(2), Precision::Short) > uncertainty(Some(2), Precision::Long));
        assert!(uncertainty(Some(0), Precision::Long) > uncertainty(Some(1), Precision::Long));
    }
}
