//! Where the telescope points, as far as it is known.

use super::coords::{Equatorial, OfDate};
use crate::units::Angle;

/// What the mount is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Motion {
    /// Following the sky: right ascension stands still.
    Tracking,
    /// Moving, by our order or by the hand controller.
    Slewing,
    /// Standing still against the ground: right ascension grows by 15.041 arcseconds a second.
    Stopped,
}

/// Where the telescope points now. The position is what the mount says (equator of date) with the observer's nudge added.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pointing {
    /// Right ascension and declination of date.
    pub position: Equatorial<OfDate>,
    /// One standard deviation of the position on the sky: 2 arcminutes for a well aligned LX200GPS, less after a nudge.
    pub uncertainty: Angle,
    /// What the mount is doing.
    pub motion: Motion,
    /// Whether the position is too old to draw from.
    pub stale: bool,
}

impl Pointing {
    /// Whether a picture may be drawn: not while the mount slews, not from a stale position.
    #[must_use]
    pub fn may_draw(&self) -> bool {
        !self.stale && self.motion != Motion::Slewing
    }
}
