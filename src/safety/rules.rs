//! The rules and their limits. Enlarging is free; whatever weakens the Sun rule needs words typed in this session.

use serde::{Deserialize, Serialize};

use crate::units::Angle;

/// The words that a person must type before a weakened Sun rule holds. Never kept over a restart.
pub const ACKNOWLEDGEMENT: &str = "certified solar filter fitted";

/// Proof that the words were typed in this session. It is neither saved nor read from a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Acknowledgement(());

/// The words were not the right ones.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the Sun rule stays as it is: to weaken it for this session, type exactly '{ACKNOWLEDGEMENT}'")]
pub struct NotAcknowledged;

impl Acknowledgement {
    /// Reads what was typed; only the exact words count, whatever their case and the spaces around them.
    ///
    /// # Errors
    /// Any other words.
    pub fn typed(words: &str) -> Result<Acknowledgement, NotAcknowledged> {
        let typed: Vec<String> = words.split_whitespace().map(str::to_lowercase).collect();
        if typed.join(" ") == ACKNOWLEDGEMENT { Ok(Acknowledgement(())) } else { Err(NotAcknowledged) }
    }
}

/// The safety rules, as the settings file has them. Angles in degrees, times in seconds.
///
/// The defaults follow the practice of others: 30 degrees from the Sun is where PlaneWave mounts raise an alert and where
/// visual instruments are kept (INDI `planewave_mount.cpp`); one hour of safety ahead is the Simons Observatory's
/// `min_sun_time` (`socs`, acu/avoidance.py).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Rules {
    /// The telescope is kept at least this far from the Sun.
    pub sun_cone_deg: f64,
    /// The Sun counts while its altitude is above this: the cone is enforced through twilight.
    pub sun_counts_above_deg: f64,
    /// Added to the cone along the way: a mount's axes are tilted a little, it overshoots, and the Sun moves during a slew.
    pub path_slack_deg: f64,
    /// Judge both ways round in azimuth, since the mount chooses its way by itself.
    pub either_way_round: bool,
    /// No go-to below this altitude (without refraction).
    pub altitude_floor_deg: f64,
    /// No go-to above this altitude.
    pub altitude_ceiling_deg: f64,
    /// Warn when the azimuth axis has turned this far since the cable was unwound.
    pub turns_warn_deg: f64,
    /// Refuse to turn it further than this.
    pub turns_refuse_deg: f64,
    /// From seeing a motion to its end: the poll, the stop on the wire, the mount slowing down.
    pub reaction_s: f64,
}

impl Default for Rules {
    fn default() -> Rules {
        Rules {
            sun_cone_deg: 30.0,
            sun_counts_above_deg: -2.0,
            path_slack_deg: 1.0,
            either_way_round: true,
            altitude_floor_deg: 0.0,
            altitude_ceiling_deg: 90.0,
            turns_warn_deg: 270.0,
            turns_refuse_deg: 360.0,
            reaction_s: 2.0,
        }
    }
}

/// A rule with a number that makes no sense.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("rule {key} = {value} is out of range: give {least} to {most}")]
pub struct RuleError {
    /// The key, as in the settings file.
    pub key: &'static str,
    /// What it was.
    pub value: f64,
    /// The least that is taken.
    pub least: f64,
    /// The most that is taken.
    pub most: f64,
}

impl Rules {
    /// Holds every number against what makes sense.
    ///
    /// # Errors
    /// The first number out of range (not-a-number among them), by its key.
    pub fn checked(self) -> Result<Rules, RuleError> {
        let rows = [
            ("sun_cone_deg", self.sun_cone_deg, 0.0, 90.0),
            ("sun_counts_above_deg", self.sun_counts_above_deg, -18.0, 90.0),
            ("path_slack_deg", self.path_slack_deg, 0.0, 20.0),
            ("altitude_floor_deg", self.altitude_floor_deg, -10.0, 80.0),
            ("altitude_ceiling_deg", self.altitude_ceiling_deg, self.altitude_floor_deg, 90.0),
            ("turns_refuse_deg", self.turns_refuse_deg, 180.0, 3600.0),
            ("turns_warn_deg", self.turns_warn_deg, 0.0, self.turns_refuse_deg),
            ("reaction_s", self.reaction_s, 0.5, 30.0),
        ];
        match rows.into_iter().find(|(_, value, least, most)| !(least..=most).contains(&value)) {
            Some((key, value, least, most)) => Err(RuleError { key, value, least, most }),
            None => Ok(self),
        }
    }

    /// Whether the Sun rule asks for less than the default does.
    #[must_use]
    pub fn weakened(&self) -> bool {
        let default = Rules::default();
        self.sun_cone_deg < default.sun_cone_deg
            || self.sun_counts_above_deg > default.sun_counts_above_deg
            || self.path_slack_deg < default.path_slack_deg
            || self.reaction_s < default.reaction_s
            || !self.either_way_round
    }

    /// The rules that hold: as they stand if nothing is weakened or the words were typed, else with the default's Sun rule
    /// wherever that is the stricter one.
    #[must_use]
    pub fn in_force(&self, acknowledged: Option<Acknowledgement>) -> Rules {
        if acknowledged.is_some() {
            return *self;
        }
        let default = Rules::default();
        Rules {
            sun_cone_deg: self.sun_cone_deg.max(default.sun_cone_deg),
            sun_counts_above_deg: self.sun_counts_above_deg.min(default.sun_counts_above_deg),
            path_slack_deg: self.path_slack_deg.max(default.path_slack_deg),
            reaction_s: self.reaction_s.max(default.reaction_s),
            either_way_round: true,
            ..*self
        }
    }

    /// The cone round the Sun.
    #[must_use]
    pub fn sun_cone(&self) -> Angle {
        Angle::degrees(self.sun_cone_deg)
    }

    /// The lowest altitude of a go-to.
    #[must_use]
    pub fn altitude_floor(&self) -> Angle {
        Angle::degrees(self.altitude_floor_deg)
    }

    /// The highest altitude of a go-to.
    #[must_use]
    pub fn altitude_ceiling(&self) -> Angle {
        Angle::degrees(self.altitude_ceiling_deg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smaller_cone_holds_only_after_the_words_were_typed() {
        let asked = Rules { sun_cone_deg: 5.0, ..Rules::default() };
        assert!(asked.weakened());
        assert_eq!(asked.in_force(None).sun_cone_deg, 30.0);
        assert!(Acknowledgement::typed("yes").is_err());
        let words = Acknowledgement::typed(" Certified  solar filter fitted\n").unwrap();
        assert_eq!(asked.in_force(Some(words)).sun_cone_deg, 5.0);
    }

    #[test]
    fn a_larger_cone_and_an_earlier_dawn_need_no_words() {
        let asked = Rules { sun_cone_deg: 45.0, sun_counts_above_deg: -6.0, ..Rules::default() };
        assert!(!asked.weakened());
        assert_eq!(asked.in_force(None), asked);
    }

    #[test]
    fn weakening_one_part_does_not_lose_the_enlargement_of_another() {
        let asked =
            Rules { sun_cone_deg: 45.0, sun_counts_above_deg: 10.0, either_way_round: false, ..Rules::default() };
        let held = asked.in_force(None);
        assert_eq!((held.sun_cone_deg, held.sun_counts_above_deg, held.either_way_round), (45.0, -2.0, true));
    }

    #[test]
    fn numbers_that_make_no_sense_are_refused_by_their_key() {
        for (rules, key) in [
            (Rules { sun_cone_deg: f64::NAN, ..Rules::default() }, "sun_cone_deg"),
            (Rules { altitude_ceiling_deg: -5.0, ..Rules::default() }, "altitude_ceiling_deg"),
            (Rules { turns_warn_deg: 400.0, ..Rules::default() }, "turns_warn_deg"),
            (Rules { reaction_s: 0.0, ..Rules::default() }, "reaction_s"),
        ] {
            assert_eq!(rules.checked().unwrap_err().key, key);
        }
        assert!(Rules::default().checked().is_ok());
    }
}
