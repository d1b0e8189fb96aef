//! All that a judgement needs to know, gathered by the session before it asks.

use std::time::Duration;

use super::{Acknowledgement, Clock, Rules, TurnCounter};
use crate::sky::coords::{Equatorial, OfDate};
use crate::sky::pointing::Motion;
use crate::sky::site::Site;

/// How the mount's axes stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mounting {
    /// Azimuth and altitude: the LX200GPS on its tripod. Taken when the mount has not said.
    #[default]
    AltAzimuth,
    /// Hour angle and declination: on a wedge.
    Equatorial,
}

/// Where the telescope was at an instant, as the mount said.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fix {
    /// Since the program started.
    pub at: Duration,
    /// The reported position (without nudge: safety judges the tube).
    pub position: Equatorial<OfDate>,
}

/// What is known when a judgement is asked for. Whatever is unknown counts against the motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Situation {
    /// Where the telescope points, if that is known and fresh.
    pub position: Option<Equatorial<OfDate>>,
    /// What the mount is doing.
    pub motion: Motion,
    /// Where it was ordered to go, while that order runs.
    pub ordered: Option<Equatorial<OfDate>>,
    /// Where the observer stands.
    pub site: Option<Site>,
    /// Date and time now.
    pub clock: Clock,
    /// How the axes stand.
    pub mounting: Mounting,
    /// The turns of the azimuth axis.
    pub turns: TurnCounter,
    /// The rules, as the settings have them.
    pub rules: Rules,
    /// Whether the weakening words were typed in this session.
    pub acknowledged: Option<Acknowledgement>,
}

impl Situation {
    /// Nothing known, default rules.
    #[must_use]
    pub fn unknown() -> Situation {
        Situation {
            position: None,
            motion: Motion::Stopped,
            ordered: None,
            site: None,
            clock: Clock::Unknown,
            mounting: Mounting::AltAzimuth,
            turns: TurnCounter::unwound(),
            rules: Rules::default(),
            acknowledged: None,
        }
    }
}
