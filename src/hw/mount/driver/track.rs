//! From positions as they come to what is believed: the gate against jumps, standing still, and what the mount is doing.

use std::collections::VecDeque;
use std::time::Duration;

use crate::hw::mount::belief::Precision;
use crate::sky::coords::{Equatorial, OfDate};
use crate::sky::pointing::Motion;
use crate::units::Angle;

/// One turn in a sidereal day: how fast right ascension grows when the motors stand.
pub(super) const SIDEREAL_ARCSEC_PER_S: f64 = 15.041;

/// The fastest that an LX200GPS slews is 8 degrees a second; nothing is faster than this.
const FASTEST_DEG_PER_S: f64 = 9.0;
/// The mount renews its position about once a second (thesis, section 8.4): that much may have been saved up.
const RENEWAL_S: f64 = 1.0;
/// A step beyond this between two polls is motion.
const STEP: Angle = Angle::arcseconds(60.0);
/// Still means still for longer than the mount takes to renew its position.
const STILL_FOR: Duration = Duration::from_millis(1200);
const WINDOW: Duration = Duration::from_secs(5);
const MOST_SAMPLES: usize = 64;
/// Rates are measured over no less than this: in 3 s a standing mount gains three steps of 15 arcseconds.
const RATE_WINDOW: Duration = Duration::from_secs(3);

/// A position and when it was read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    pub(super) position: Equatorial<OfDate>,
    pub(super) at: Duration,
}

/// What the gate made of a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Gate {
    /// Believed.
    Passed,
    /// Not believed before the next says so too; far enough to be worth a word, or not.
    Held {
        /// Distance from the last believed position.
        jump: Angle,
        /// Seconds since then.
        seconds: f64,
        /// Whether no telescope is that fast.
        impossible: bool,
    },
}

/// The last positions.
#[derive(Debug, Default)]
pub(super) struct Track {
    samples: VecDeque<Sample>,
    held: Option<Sample>,
    settling: bool,
    /// Until when any position is believed.
    jump_until: Option<Duration>,
}

impl Track {
    pub(super) fn forget(&mut self) {
        *self = Track::default();
    }

    /// The position may jump once until then: the mount was synchronised.
    pub(super) fn allow_jump(&mut self, until: Duration) {
        self.jump_until = Some(until);
    }

    /// Whether a position waits to be confirmed.
    pub(super) fn waits(&self) -> bool {
        self.held.is_some()
    }

    /// Takes a position; `moving` when motion was ordered or is known.
    pub(super) fn take(&mut self, sample: Sample, moving: bool) -> Gate {
        let Some(last) = self.samples.back().copied() else {
            self.samples.push_back(sample);
            return Gate::Passed;
        };
        let jump = last.position.separation(&sample.position);
        let seconds = sample.at.saturating_sub(last.at).as_secs_f64();
        let impossible = jump > reach(&last, &sample);
        let unexpected = jump > STEP + Angle::arcseconds(SIDEREAL_ARCSEC_PER_S * seconds) && !moving && !self.settling;
        let confirmed = self.held.is_some_and(|held| {
            held.position.separation(&sample.position) <= reach(&held, &sample)
                && held.position.separation(&sample.position) <= jump
        });
        let allowed = jump > STEP && self.jump_until.is_some_and(|until| sample.at <= until);
        if (impossible || unexpected) && !confirmed && !allowed {
            self.held = Some(sample);
            return Gate::Held { jump, seconds, impossible };
        }
        if allowed || (impossible && confirmed) {
            self.jump_until = None;
            self.samples.clear();
        }
        if jump > STEP {
            self.settling = true;
        }
        self.held = None;
        self.samples.push_back(sample);
        while self.samples.len() > MOST_SAMPLES
            || self.samples.front().is_some_and(|first| sample.at.saturating_sub(first.at) > WINDOW)
        {
            self.samples.pop_front();
        }
        if self.settling && self.still_since(Duration::ZERO, Precision::Long) {
            self.settling = false;
        }
        Gate::Passed
    }

    /// Whether the position has stood still, against the sky or against the ground, for over a second after `since`.
    pub(super) fn still_since(&self, since: Duration, precision: Precision) -> bool {
        let Some(newest) = self.samples.back() else { return false };
        let (ra_step, dec_step) = match precision {
            Precision::Long => (16.0, 2.0),
            Precision::Short => (91.0, 61.0),
        };
        let mut span = Duration::ZERO;
        for sample in self.samples.iter().rev().take_while(|sample| sample.at >= since) {
            let age = newest.at.saturating_sub(sample.at);
            let grown = (newest.position.ra() - sample.position.ra()).wrapped_signed().to_arcseconds();
            let climbed = (newest.position.dec() - sample.position.dec()).to_arcseconds();
            let by_the_ground = SIDEREAL_ARCSEC_PER_S * age.as_secs_f64();
            if climbed.abs() > dec_step || grown < -ra_step || grown > ra_step + by_the_ground {
                return false;
            }
            span = age;
            if span >= STILL_FOR {
                return true;
            }
        }
        span >= STILL_FOR
    }

    /// Rate of right ascension in arcseconds a second, once the window is long enough to tell.
    fn ra_rate(&self) -> Option<f64> {
        let (first, last) = (self.samples.front()?, self.samples.back()?);
        let span = last.at.saturating_sub(first.at);
        (span >= RATE_WINDOW)
            .then(|| (last.position.ra() - first.position.ra()).wrapped_signed().to_arcseconds() / span.as_secs_f64())
    }

    /// What the mount is doing. `told`: whether it says that it tracks, if it says.
    pub(super) fn motion(&self, ordered: bool, told: Option<bool>) -> Motion {
        if ordered || self.settling {
            return Motion::Slewing;
        }
        let standing = match self.ra_rate() {
            Some(rate) if rate > 10.0 => true,
            Some(rate) if rate < 5.0 => false,
            _ => told == Some(false),
        };
        if standing { Motion::Stopped } else { Motion::Tracking }
    }

    /// How many positions are remembered.
    #[cfg(test)]
    pub(super) fn len(&self) -> usize {
        self.samples.len()
    }
}

/// How far the mount can have gone between two positions.
fn reach(from: &Sample, to: &Sample) -> Angle {
    let seconds = to.at.saturating_sub(from.at).as_secs_f64() + RENEWAL_S;
    Angle::degrees(FASTEST_DEG_PER_S * seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(seconds: f64, ra_arcsec: f64, dec_arcsec: f64) -> Sample {
        Sample {
            position: Equatorial::new(
                Angle::degrees(80.0) + Angle::arcseconds(ra_arcsec),
                Angle::degrees(20.0) + Angle::arcseconds(dec_arcsec),
            ),
            at: Duration::from_secs_f64(seconds),
        }
    }

    #[test]
    fn one_wild_position_is_not_believed_and_two_that_agree_are() {
        let mut track = Track::default();
        assert_eq!(track.take(at(0.0, 0.0, 0.0), false), Gate::Passed);
        assert!(matches!(track.take(at(0.5, 360_000.0, 0.0), false), Gate::Held { impossible: true, .. }));
        assert_eq!(track.take(at(0.7, 0.0, 0.0), false), Gate::Passed);
        assert!(matches!(track.take(at(1.2, 360_000.0, 0.0), false), Gate::Held { .. }));
        assert_eq!(track.take(at(1.4, 360_000.0, 0.0), false), Gate::Passed);
    }

    #[test]
    fn two_wild_positions_that_do_not_agree_are_both_refused() {
        let mut track = Track::default();
        track.take(at(0.0, 0.0, 0.0), false);
        assert!(matches!(track.take(at(0.5, 360_000.0, 0.0), false), Gate::Held { .. }));
        assert!(matches!(track.take(at(0.7, -200_000.0, 90_000.0), false), Gate::Held { .. }));
        assert_eq!(track.take(at(0.9, 0.0, 0.0), false), Gate::Passed);
    }

    #[test]
    fn a_small_step_that_nobody_ordered_is_asked_again_and_an_ordered_one_is_not() {
        let mut track = Track::default();
        track.take(at(0.0, 0.0, 0.0), false);
        assert!(matches!(track.take(at(0.5, 900.0, 0.0), false), Gate::Held { impossible: false, .. }));
        let mut moving = Track::default();
        moving.take(at(0.0, 0.0, 0.0), true);
        assert_eq!(moving.take(at(0.5, 900.0, 0.0), true), Gate::Passed);
    }

    #[test]
    fn a_slew_at_full_speed_passes_though_the_mount_renews_once_a_second() {
        let mut track = Track::default();
        for poll in 0..50 {
            let t = f64::from(poll) * 0.2;
            let renewed = t.floor();
            assert_eq!(track.take(at(t, 0.0, renewed * 2.0 * 3600.0), true), Gate::Passed, "{t}");
        }
        assert!(track.len() <= MOST_SAMPLES);
    }

    #[test]
    fn standing_motors_are_seen_by_the_growth_of_right_ascension() {
        let (mut standing, mut following) = (Track::default(), Track::default());
        for poll in 0..10 {
            let t = f64::from(poll) * 0.5;
            standing.take(at(t, (t * SIDEREAL_ARCSEC_PER_S / 15.0).floor() * 15.0, 0.0), false);
            following.take(at(t, 0.0, 0.0), false);
        }
        assert_eq!(standing.motion(false, Some(true)), Motion::Stopped);
        assert_eq!(following.motion(false, Some(false)), Motion::Tracking);
        assert!(standing.still_since(Duration::ZERO, Precision::Long));
        assert_eq!(Track::default().motion(false, Some(false)), Motion::Stopped);
    }

    #[test]
    fn still_needs_more_than_the_second_in_which_the_mount_renews() {
        let mut track = Track::default();
        for poll in 0..6 {
            track.take(at(f64::from(poll) * 0.2, 0.0, 0.0), true);
        }
        assert!(!track.still_since(Duration::ZERO, Precision::Long));
        track.take(at(1.2, 0.0, 0.0), true);
        assert!(track.still_since(Duration::ZERO, Precision::Long));
        assert!(!track.still_since(Duration::from_millis(300), Precision::Long));
    }
}
