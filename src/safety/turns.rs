//! The turns of the azimuth axis, counted since the cable was last unwound and kept over restarts. A wound cable has torn
//! plugs out of mounts (seeing-things/track, issue 55).

use std::time::Duration;

use serde::{Deserialize, Serialize};

use crate::units::Angle;

/// The fastest that an LX200GPS slews: 8 degrees a second.
pub const FASTEST_DEG_PER_S: f64 = 8.0;

/// A longer silence could hide half a turn, after which the way it went can no longer be told.
const BLIND_S: f64 = 180.0 / FASTEST_DEG_PER_S;

/// After a silence, so much change is taken as tracking or a nudge and not as an unknown turn.
const UNSUSPICIOUS: Angle = Angle::degrees(30.0);

/// Cumulative azimuth since the cable was unwound: positive clockwise seen from above (north through east).
///
/// Saved as TOML: `turned_deg`, `last_azimuth_deg` and `certain`; the time of the last position is not kept, so that a
/// restart counts as a silence.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TurnCounter {
    turned_deg: f64,
    last_azimuth_deg: Option<f64>,
    certain: bool,
    #[serde(skip)]
    last_at: Option<Duration>,
}

impl Default for TurnCounter {
    fn default() -> TurnCounter {
        TurnCounter::unwound()
    }
}

impl TurnCounter {
    /// The cable hangs free.
    #[must_use]
    pub fn unwound() -> TurnCounter {
        TurnCounter { turned_deg: 0.0, last_azimuth_deg: None, certain: true, last_at: None }
    }

    /// Nobody knows how the cable hangs.
    #[must_use]
    pub fn guess() -> TurnCounter {
        TurnCounter { certain: false, ..TurnCounter::unwound() }
    }

    /// Sets the mark: the observer has looked, and the cable hangs free where the telescope stands now.
    pub fn mark_unwound(&mut self) {
        self.turned_deg = 0.0;
        self.certain = true;
    }

    /// Counts on to a new azimuth. Between two positions the shorter way is taken, which is right as long as they are less
    /// than half a turn (22 s at 8 degrees a second) apart; after a longer silence with a marked change the count goes on,
    /// and is called a guess from then on. What is not a number is ignored.
    pub fn observe(&mut self, azimuth: Angle, at: Duration) {
        if !azimuth.is_finite() {
            return;
        }
        if let Some(last) = self.last_azimuth_deg {
            let step = (azimuth - Angle::degrees(last)).wrapped_signed();
            let silence_s = self.last_at.map_or(f64::INFINITY, |last| at.saturating_sub(last).as_secs_f64());
            if silence_s >= BLIND_S && step.abs() > UNSUSPICIOUS {
                self.certain = false;
            }
            self.turned_deg += step.to_degrees();
        }
        self.last_azimuth_deg = Some(azimuth.wrapped().to_degrees());
        self.last_at = Some(at);
    }

    /// Nothing is known of the time that passes now (a lost link, a suspended machine): the next position ends a silence.
    pub fn lose_sight(&mut self) {
        self.last_at = None;
    }

    /// How far the axis has turned since the mark: positive clockwise.
    #[must_use]
    pub fn turned(&self) -> Angle {
        Angle::degrees(self.turned_deg)
    }

    /// Whether the count rests on positions alone, or on a guess across a silence.
    #[must_use]
    pub fn is_certain(&self) -> bool {
        self.certain
    }

    /// Where the count would stand after going to an azimuth: (the shorter way, the longer way).
    #[must_use]
    pub fn after_going_to(&self, here: Angle, there: Angle) -> (Angle, Angle) {
        let shorter = (there - here).wrapped_signed();
        let turn = Angle::degrees(if shorter > Angle::ZERO { -360.0 } else { 360.0 });
        (self.turned() + shorter, self.turned() + shorter + turn)
    }

    /// Holds what was read from a file against what makes sense: a count that is no number is a guess of zero.
    #[must_use]
    pub fn sane(self) -> TurnCounter {
        if self.turned_deg.is_finite() && self.last_azimuth_deg.is_none_or(f64::is_finite) {
            self
        } else {
            TurnCounter::guess()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seconds(s: f64) -> Duration {
        Duration::from_secs_f64(s)
    }

    #[test]
    fn the_count_runs_on_through_north_both_ways() {
        let mut turns = TurnCounter::unwound();
        for (i, azimuth) in [350.0, 355.0, 2.0, 10.0].into_iter().enumerate() {
            turns.observe(Angle::degrees(azimuth), seconds(i as f64));
        }
        assert!((turns.turned().to_degrees() - 20.0).abs() < 1e-9);
        turns.observe(Angle::degrees(340.0), seconds(5.0));
        assert!((turns.turned().to_degrees() + 10.0).abs() < 1e-9);
        assert!(turns.is_certain());
    }

    #[test]
    fn two_whole_turns_are_720_degrees_and_the_mark_sets_them_to_nothing() {
        let mut turns = TurnCounter::unwound();
        for i in 0..=360 {
            turns.observe(Angle::degrees(f64::from(i) * 2.0), seconds(f64::from(i) * 0.25));
        }
        assert!((turns.turned().to_degrees() - 720.0).abs() < 1e-9);
        turns.mark_unwound();
        assert_eq!(turns.turned(), Angle::ZERO);
        turns.observe(Angle::degrees(5.0), seconds(91.0));
        assert!((turns.turned().to_degrees() - 5.0).abs() < 1e-9);
    }

    #[test]
    fn a_saved_count_goes_on_after_a_restart() {
        let mut turns = TurnCounter::unwound();
        for i in 0..=150 {
            turns.observe(Angle::degrees(f64::from(i) * 2.0), seconds(f64::from(i)));
        }
        let saved = toml::to_string(&turns).unwrap();
        let mut read: TurnCounter = toml::from_str(&saved).unwrap();
        read.observe(Angle::degrees(301.0), seconds(0.0));
        assert!((read.turned().to_degrees() - 301.0).abs() < 1e-9);
        assert!(read.is_certain(), "one degree of change over a restart is no turn");
    }

    #[test]
    fn a_silence_with_a_large_change_makes_the_count_a_guess() {
        let mut turns = TurnCounter::unwound();
        turns.observe(Angle::degrees(0.0), seconds(0.0));
        turns.observe(Angle::degrees(170.0), seconds(60.0));
        assert!(!turns.is_certain());
        turns.mark_unwound();
        turns.lose_sight();
        turns.observe(Angle::degrees(90.0), seconds(61.0));
        assert!(!turns.is_certain(), "a lost link hides how the axis went");
    }

    #[test]
    fn both_ways_to_a_target_are_a_whole_turn_apart() {
        let mut turns = TurnCounter::unwound();
        turns.observe(Angle::degrees(10.0), seconds(0.0));
        let (shorter, longer) = turns.after_going_to(Angle::degrees(10.0), Angle::degrees(300.0));
        assert!((shorter.to_degrees() + 70.0).abs() < 1e-9);
        assert!((longer.to_degrees() - 290.0).abs() < 1e-9);
    }

    #[test]
    fn a_file_with_no_number_becomes_a_guess_not_a_trap() {
        let read: TurnCounter = toml::from_str("turned_deg = nan\ncertain = true").unwrap();
        let sane = read.sane();
        assert!(!sane.is_certain() && sane.turned() == Angle::ZERO);
    }
}
