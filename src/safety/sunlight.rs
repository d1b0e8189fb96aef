//! The Sun and the horizon at one moment and through the hour after it.

use crate::sky::astrometry::Reduction;
use crate::sky::coords::{Airless, Equatorial, Horizontal, OfDate};
use crate::sky::horizon::Horizon;
use crate::sky::site::Site;
use crate::sky::sun;
use crate::sky::time::{Moment, Utc};
use crate::units::Angle;

/// How far ahead is looked.
pub(super) const HOUR_S: f64 = 3600.0;

/// The time between two looks within the hour.
const STEP_S: f64 = 60.0;

/// The sky turns by 15.041 arcseconds a second.
const TURN_ARCSEC_PER_S: f64 = 15.041_067;

/// The Sun moves at most 61.2 arcminutes a day among the stars (in January): 0.043 degree in the hour. Its place is taken
/// at the hour's begin, and this is what that may be wrong.
pub(super) const SUN_DRIFT: Angle = Angle::degrees(0.05);

/// No direction on the turning sky is further than this from where it stood at the nearest look: half a step of turning,
/// 30 s x 15.04 arcseconds = 0.125 degree, and the Sun's own drift. Each look is judged with this added, so that nothing
/// slips through between two of them.
pub(super) const BETWEEN_LOOKS: Angle = Angle::degrees(TURN_ARCSEC_PER_S * STEP_S / 2.0 / 3600.0 + 0.05);

/// The Sun and the observer's horizon from a moment on.
pub(super) struct Sunlight {
    sun: Equatorial<OfDate>,
    sidereal: Angle,
    site: Site,
}

impl Sunlight {
    pub(super) fn at(utc: Utc, site: &Site) -> Sunlight {
        let reduction = Reduction::at(&Moment::at(utc));
        Sunlight {
            sun: sun::apparent_at(&reduction),
            sidereal: reduction.greenwich_sidereal_time() + site.longitude,
            site: *site,
        }
    }

    /// The Sun, of date.
    pub(super) fn sun(&self) -> &Equatorial<OfDate> {
        &self.sun
    }

    /// The site's latitude.
    pub(super) fn latitude(&self) -> Angle {
        self.site.latitude
    }

    /// The observer's frame some seconds later, or earlier.
    pub(super) fn horizon(&self, after_s: f64) -> Horizon {
        Horizon::with_sidereal_time(self.sidereal + Angle::arcseconds(TURN_ARCSEC_PER_S * after_s), &self.site)
    }

    /// Where a position stands some seconds later.
    pub(super) fn seen(&self, position: &Equatorial<OfDate>, after_s: f64) -> Horizontal<Airless> {
        self.horizon(after_s).airless(position)
    }

    /// The looks from now to `seconds` ahead: (seconds from now, the frame then).
    pub(super) fn looks(&self, seconds: f64) -> impl Iterator<Item = (f64, Horizon)> {
        let steps = (seconds / STEP_S).ceil() as u32;
        (0..=steps).map(|step| f64::from(step) * STEP_S).map(|after_s| (after_s, self.horizon(after_s)))
    }

    /// When the Sun first counts within `seconds` from now, if it does: its altitude above `above` at any time from now on.
    /// Erring by no more than [`BETWEEN_LOOKS`], and always towards yes.
    pub(super) fn counts_within(&self, seconds: f64, above: Angle) -> Option<f64> {
        self.looks(seconds)
            .find(|(_, horizon)| horizon.airless(&self.sun).altitude() + BETWEEN_LOOKS > above)
            .map(|(after_s, _)| after_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sunrise_is_found_at_the_minute_the_almanac_gives() {
        // U.S. Naval Observatory's definition puts sunrise at -0.833 degrees. Greenwich, 2026-03-20: 06:02 UTC (timeanddate.com).
        let site = Site::new(51.4779, 0.0, 0.0).unwrap();
        let light = Sunlight::at(Utc::from_rfc3339("2026-03-20T05:30:00Z").unwrap(), &site);
        let rises_s = light.counts_within(HOUR_S, Angle::degrees(-0.833)).unwrap();
        assert!((rises_s / 60.0 - 32.0).abs() <= 2.0, "{} min", rises_s / 60.0);
    }

    #[test]
    fn the_polar_night_has_no_sun_and_the_polar_day_always() {
        let site = Site::new(78.2, 15.6, 0.0).unwrap();
        let winter = Sunlight::at(Utc::from_rfc3339("2026-12-21T11:00:00Z").unwrap(), &site);
        assert_eq!(winter.counts_within(24.0 * HOUR_S, Angle::degrees(-2.0)), None);
        let summer = Sunlight::at(Utc::from_rfc3339("2026-06-21T23:00:00Z").unwrap(), &site);
        assert_eq!(summer.counts_within(HOUR_S, Angle::degrees(-2.0)), Some(0.0));
    }

    #[test]
    fn an_hour_of_stepping_agrees_with_an_hour_of_computing() {
        let site = Site::new(-33.9, 151.2, 0.0).unwrap();
        let start = Utc::from_rfc3339("2026-08-12T18:00:00Z").unwrap();
        let stepped = Sunlight::at(start, &site);
        let computed = Sunlight::at(start.plus_seconds(HOUR_S), &site);
        let apart = stepped.seen(stepped.sun(), HOUR_S).separation(&computed.seen(computed.sun(), 0.0));
        assert!(apart < SUN_DRIFT, "{} degrees", apart.to_degrees());
    }
}
