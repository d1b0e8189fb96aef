//! What was found: each hazard carries its numbers, tells its reason in words, and says what to do.

use std::fmt;

use super::clock::ClockError;
use super::rules::ACKNOWLEDGEMENT;
use crate::units::Angle;

/// A degree in the text: one decimal, as an observer reads it.
struct Deg(Angle);

impl fmt::Display for Deg {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.1}°", self.0.to_degrees())
    }
}

/// Why a motion is not, or not without a word, allowed. The text is the reason; [`Hazard::advice`] is what to do.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum Hazard {
    /// The time cannot be believed, so the Sun may be anywhere.
    #[error("{0}, so the Sun may be anywhere")]
    Clock(#[from] ClockError),
    /// The site is unknown, so the Sun may be anywhere.
    #[error("the observing site is unknown, so the Sun may be anywhere")]
    SiteUnknown,
    /// Where the telescope points is unknown, so its way cannot be judged.
    #[error("where the telescope points is not known now, so its way cannot be judged")]
    PositionUnknown,
    /// The target is not a place on the sky.
    #[error("the target is not a place on the sky: its coordinates are not numbers")]
    TargetNotANumber,
    /// The target itself lies too close to the Sun.
    #[error("the target is {} from the Sun, inside the cone of {}", Deg(*separation), Deg(*cone))]
    SunAtTarget {
        /// Sun to target.
        separation: Angle,
        /// The cone in force.
        cone: Angle,
    },
    /// The Sun is down, and will have come up while the target is tracked.
    #[error("the Sun rises in {minutes:.0} min, and the target is {} from it, inside the cone of {}", Deg(*separation), Deg(*cone))]
    SunRises {
        /// Until the Sun counts.
        minutes: f64,
        /// Sun to target, or to where the telescope points.
        separation: Angle,
        /// The cone in force.
        cone: Angle,
    },
    /// The way leads past the Sun.
    #[error("on its way the telescope could pass {} from the Sun{}; {} must be kept", Deg(*closest), if *longer_way { " (the longer way round)" } else { "" }, Deg(*keep))]
    SunOnPath {
        /// The closest that any way of the two axes comes.
        closest: Angle,
        /// The cone and its slack.
        keep: Angle,
        /// Whether it is the longer way round in azimuth that passes there.
        longer_way: bool,
    },
    /// The telescope points into the cone now.
    #[error("the telescope points {} from the Sun, inside the cone of {}", Deg(*separation), Deg(*cone))]
    SunInField {
        /// Sun to where the telescope points.
        separation: Angle,
        /// The cone in force.
        cone: Angle,
    },
    /// The motion seen leads into the cone within the reaction time.
    #[error("the telescope moves towards the Sun: {} from it now, {} within {seconds:.0} s; the cone is {}", Deg(*separation), Deg(*closest), Deg(*cone))]
    SunAhead {
        /// Sun to where the telescope points now.
        separation: Angle,
        /// The closest it comes within the reaction time.
        closest: Angle,
        /// The reaction time.
        seconds: f64,
        /// The cone in force.
        cone: Angle,
    },
    /// Inside the cone, and on the way out.
    #[error("the telescope is {} from the Sun, inside the cone of {}, and on its way out", Deg(*separation), Deg(*cone))]
    LeavingSun {
        /// Sun to where the telescope points.
        separation: Angle,
        /// The cone in force.
        cone: Angle,
    },
    /// The telescope stands still and the Sun comes to it.
    #[error("the telescope stands still, and the Sun comes within {} of where it points in {minutes:.0} min", Deg(*cone))]
    SunDriftsIn {
        /// Until it is inside the cone.
        minutes: f64,
        /// The cone in force.
        cone: Angle,
    },
    /// Too low.
    #[error("it is {} high there, below the floor of {}", Deg(*altitude), Deg(*floor))]
    TooLow {
        /// Altitude (of the target, or where the motion leads).
        altitude: Angle,
        /// The floor in force.
        floor: Angle,
    },
    /// Too high.
    #[error("it is {} high there, above the ceiling of {}", Deg(*altitude), Deg(*ceiling))]
    TooHigh {
        /// Altitude (of the target, or where the motion leads).
        altitude: Angle,
        /// The ceiling in force.
        ceiling: Angle,
    },
    /// The motion leads outside the altitude limits only from further outside.
    #[error("the telescope is {} high, outside the limits of {} to {}, and on its way back", Deg(*altitude), Deg(*floor), Deg(*ceiling))]
    Returning {
        /// Altitude now.
        altitude: Angle,
        /// The floor in force.
        floor: Angle,
        /// The ceiling in force.
        ceiling: Angle,
    },
    /// What is tracked goes below the floor soon.
    #[error("the target sinks below {} in {minutes:.0} min", Deg(*floor))]
    Sets {
        /// Until then.
        minutes: f64,
        /// The floor in force.
        floor: Angle,
    },
    /// What is tracked climbs above the ceiling soon.
    #[error("the target climbs above {} in {minutes:.0} min", Deg(*ceiling))]
    Climbs {
        /// Until then.
        minutes: f64,
        /// The ceiling in force.
        ceiling: Angle,
    },
    /// What is tracked is, or comes, close to the zenith.
    #[error("the target comes within {} of the zenith in the next hour, where the azimuth axis runs fast and the field turns quickly", Deg(*distance))]
    NearZenith {
        /// The least distance from the zenith.
        distance: Angle,
    },
    /// The azimuth axis would be wound too far.
    #[error("the azimuth axis has turned {} since the cable was unwound and would reach {}; the limit is {} (the other way round it would end at {})", Deg(*turned), Deg(*after), Deg(*limit), Deg(*other_way))]
    Wound {
        /// The count now.
        turned: Angle,
        /// The count at the end of the shorter way.
        after: Angle,
        /// The count at the end of the longer way.
        other_way: Angle,
        /// The limit.
        limit: Angle,
    },
    /// The azimuth axis is wound, or will be, to the warning.
    #[error("the azimuth axis will have turned {} since the cable was unwound; at {} it is stopped", Deg(*after), Deg(*limit))]
    WindingUp {
        /// The count at the end.
        after: Angle,
        /// The limit.
        limit: Angle,
    },
    /// The count rests on a guess.
    #[error("the turns of the azimuth axis are a guess: it moved while nobody was counting")]
    TurnsUncertain,
}

impl Hazard {
    /// What to do about it: a sentence for a cold person in the dark.
    #[must_use]
    pub fn advice(&self) -> String {
        match self {
            Hazard::Clock(ClockError::Unknown) => {
                "set date and time (or wait for the mount's GPS), then order again".into()
            }
            Hazard::Clock(_) => "set date and time on this machine or on the mount, then order again".into(),
            Hazard::SiteUnknown => "give the site (settings, or --site LAT,LON,ELEV), then order again".into(),
            Hazard::PositionUnknown => "wait for the mount's position, then order again".into(),
            Hazard::TargetNotANumber => "choose another target".into(),
            Hazard::SunAtTarget { .. } | Hazard::SunRises { .. } => {
                format!(
                    "choose another target, or wait; with a filter on the tube, type '{ACKNOWLEDGEMENT}' and set a smaller cone"
                )
            }
            Hazard::SunOnPath { .. } => {
                "go there in steps that keep away from the Sun (first high up, then round), or wait for sunset".into()
            }
            Hazard::SunInField { .. } | Hazard::SunAhead { .. } => {
                "cover the tube and do not look in; then move away from the Sun with the hand controller".into()
            }
            Hazard::LeavingSun { .. } => "keep the tube covered until it has left the cone".into(),
            Hazard::SunDriftsIn { .. } => "move the telescope away from the Sun's path, or cover the tube".into(),
            Hazard::TooLow { .. } => "choose something higher, or wait until it has risen".into(),
            Hazard::TooHigh { .. } => "choose something lower, or wait until it has passed the zenith".into(),
            Hazard::Returning { .. } => "nothing: motion back inside is allowed".into(),
            Hazard::Sets { .. } => "look at it now".into(),
            Hazard::Climbs { .. } => "look at it now; the telescope is stopped a degree above the ceiling".into(),
            Hazard::NearZenith { .. } => "expect the picture to turn; wait until it has passed for a quiet view".into(),
            Hazard::Wound { turned, .. } => format!(
                "turn the telescope back with the hand controller, {} from above, until the cable hangs free, then mark it unwound",
                if turned.to_radians() > 0.0 { "anticlockwise" } else { "clockwise" }
            ),
            Hazard::WindingUp { .. } => "unwind the cable soon: turn back a whole turn, then mark it unwound".into(),
            Hazard::TurnsUncertain => "look at the cable; if it hangs free, mark it unwound".into(),
        }
    }
}

/// A judgement.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// Nothing stands against it.
    Allowed,
    /// It may go on, and the observer should know this. Never empty.
    Warned(Vec<Hazard>),
    /// It must not happen; if it is happening already, stop it and sound the alarm.
    Refused(Hazard),
}

impl Verdict {
    /// Allowed, or warned if there is something to say.
    #[must_use]
    pub fn with(warnings: Vec<Hazard>) -> Verdict {
        if warnings.is_empty() { Verdict::Allowed } else { Verdict::Warned(warnings) }
    }

    /// Whether the motion must not happen, or must be stopped.
    #[must_use]
    pub fn is_refused(&self) -> bool {
        matches!(self, Verdict::Refused(_))
    }

    /// All that was found.
    #[must_use]
    pub fn hazards(&self) -> &[Hazard] {
        match self {
            Verdict::Allowed => &[],
            Verdict::Warned(hazards) => hazards,
            Verdict::Refused(hazard) => std::slice::from_ref(hazard),
        }
    }
}
