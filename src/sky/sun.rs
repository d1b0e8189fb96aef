//! The Sun: where it is, and when the middle of the night comes.

use super::astrometry::Reduction;
use super::coords::{Airless, Equatorial, Horizontal, OfDate};
use super::horizon::Horizon;
use super::site::Site;
use super::time::{Moment, Utc};
use crate::units::Angle;

/// The Sun's apparent place, geocentric: within 0.1 arcsecond from 1900 to 2100 (SOFA `epv00`), some arcseconds outside.
/// Its parallax (8.8 arcseconds at the horizon) is left out.
#[must_use]
pub fn apparent(moment: &Moment) -> Equatorial<OfDate> {
    Reduction::at(moment).sun()
}

/// The Sun's apparent place at a moment that has been reduced already.
#[must_use]
pub fn apparent_at(reduction: &Reduction) -> Equatorial<OfDate> {
    reduction.sun()
}

/// The Sun's altitude and azimuth without refraction.
#[must_use]
pub fn horizontal(moment: &Moment, site: &Site) -> Horizontal<Airless> {
    let reduction = Reduction::at(moment);
    Horizon::new(&reduction, site).airless(&reduction.sun())
}

/// The middle of the coming night (or of the one that is now): the next time, from `utc` on, at which the Sun crosses the
/// lower meridian. Where the Sun does not set it is still the time of its lowest altitude.
#[must_use]
pub fn next_midnight(utc: Utc, site: &Site) -> Utc {
    // The Sun's hour angle grows by a turn in a solar day, within 30 s; three steps bring the answer within a millisecond.
    let until_lower_meridian = |at: Utc| {
        let moment = Moment::at(at);
        let reduction = Reduction::at(&moment);
        let past_noon = Horizon::new(&reduction, site).hour_angle(&reduction.sun());
        Angle::degrees(180.0) - past_noon
    };
    let seconds = |angle: Angle| angle.to_degrees() * 240.0;
    let mut midnight = utc.plus_seconds(seconds(until_lower_meridian(utc).wrapped()));
    for _ in 0..3 {
        midnight = midnight.plus_seconds(seconds(until_lower_meridian(midnight).wrapped_signed()));
    }
    midnight
}
