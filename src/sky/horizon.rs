//! From the equator of date to altitude and azimuth and back, for an observer on the turning Earth.
//!
//! Azimuth runs from north through east. Appendix B of the thesis writes the equations with the letter alpha; it stands for
//! the HOUR ANGLE there, not for right ascension.

use glam::DVec3;

use super::astrometry::Reduction;
use super::coords::{Airless, Equatorial, Horizontal, OfDate, Refracted};
use super::site::Site;
use super::time::Moment;
use crate::physics::refraction::{self, Air};
use crate::units::Angle;

/// An observer at one moment: the local sidereal time, the latitude, and the speed at which the Earth carries the site.
/// Made once a moment, used for every direction.
#[derive(Debug, Clone, Copy)]
pub struct Horizon {
    sidereal_time: Angle,
    latitude: Angle,
    /// Eastward speed of the site over the speed of light: 1.55e-6 on the equator, 0.32 arcsecond of diurnal aberration.
    diurnal: f64,
}

impl Horizon {
    /// The observer's frame at a moment that has been reduced already.
    #[must_use]
    pub fn new(reduction: &Reduction, site: &Site) -> Horizon {
        Horizon::with_sidereal_time(reduction.greenwich_sidereal_time() + site.longitude, site)
    }

    /// The observer's frame at a moment.
    #[must_use]
    pub fn at(moment: &Moment, site: &Site) -> Horizon {
        Horizon::with_sidereal_time(moment.sidereal_time(site.longitude), site)
    }

    /// The observer's frame when the local apparent sidereal time is known (from the mount, or to step through a night).
    #[must_use]
    pub fn with_sidereal_time(local: Angle, site: &Site) -> Horizon {
        let mut carried = [[0.0; 3]; 2];
        let (longitude, latitude) = (0.0, site.latitude.to_radians());
        sofars::astro::pvtob(longitude, latitude, site.elevation_m, 0.0, 0.0, 0.0, 0.0, &mut carried);
        let diurnal = carried[1][0].hypot(carried[1][1]) / sofars::consts::CMPS;
        Horizon { sidereal_time: local.wrapped(), latitude: site.latitude, diurnal }
    }

    /// Local apparent sidereal time.
    #[must_use]
    pub fn sidereal_time(&self) -> Angle {
        self.sidereal_time
    }

    /// Hour angle: grows westwards, -180 to 180 degrees, negative before the meridian.
    #[must_use]
    pub fn hour_angle(&self, position: &Equatorial<OfDate>) -> Angle {
        (self.sidereal_time - position.ra()).wrapped_signed()
    }

    /// Altitude and azimuth without refraction, with diurnal aberration.
    ///
    /// ```text
    /// sin E       = sin phi sin delta + cos phi cos delta cos alpha
    /// cos E cos A = cos phi sin delta - sin phi cos delta cos alpha
    /// cos E sin A = -cos delta sin alpha                               alpha: hour angle
    /// ```
    ///
    /// Source: thesis appendix B, after Weisstein; diurnal aberration as in SOFA `atioq`.
    #[must_use]
    pub fn airless(&self, position: &Equatorial<OfDate>) -> Horizontal<Airless> {
        let (sin_alpha, cos_alpha) = (self.sidereal_time - position.ra()).sin_cos();
        let (sin_delta, cos_delta) = position.dec().sin_cos();
        let (sin_phi, cos_phi) = self.latitude.sin_cos();
        let north = cos_phi * sin_delta - sin_phi * cos_delta * cos_alpha;
        let east = -cos_delta * sin_alpha;
        let up = sin_phi * sin_delta + cos_phi * cos_delta * cos_alpha;
        Horizontal::from_direction(DVec3::new(north, east + self.diurnal, up))
    }

    /// The place of date that stands at an airless altitude and azimuth: the inverse of [`Horizon::airless`].
    #[must_use]
    pub fn of_date(&self, direction: &Horizontal<Airless>) -> Equatorial<OfDate> {
        let seen = direction.direction();
        // Take off the aberration: seen is parallel to true + diurnal * east with |true| = 1.
        let along = seen.y * self.diurnal;
        let length = along + (along * along + 1.0 - self.diurnal * self.diurnal).sqrt();
        let (north, east, up) = (seen.x * length, seen.y * length - self.diurnal, seen.z * length);
        let (sin_phi, cos_phi) = self.latitude.sin_cos();
        let sin_delta = sin_phi * up + cos_phi * north;
        let cos_delta_cos_alpha = cos_phi * up - sin_phi * north;
        let hour_angle = Angle::atan2(-east, cos_delta_cos_alpha);
        Equatorial::new(self.sidereal_time - hour_angle, Angle::atan2(sin_delta, cos_delta_cos_alpha.hypot(east)))
    }

    /// Parallactic angle: the position angle of the zenith, from north through east; negative before the meridian (in the
    /// northern hemisphere, south of the zenith). Zero at the poles of the Earth's sky is a convention, not a fact.
    ///
    /// ```text
    /// q = atan2(sin H, tan phi cos delta - sin delta cos H)
    /// ```
    ///
    /// Source: Meeus, *Astronomical Algorithms*, eq. 14.1; multiplied by cos phi, so that it holds at the poles.
    #[must_use]
    pub fn parallactic_angle(&self, position: &Equatorial<OfDate>) -> Angle {
        let (sin_h, cos_h) = self.hour_angle(position).sin_cos();
        let (sin_delta, cos_delta) = position.dec().sin_cos();
        let (sin_phi, cos_phi) = self.latitude.sin_cos();
        Angle::atan2(sin_h * cos_phi, sin_phi * cos_delta - sin_delta * cos_h * cos_phi)
    }

    /// How fast the field turns in an alt-azimuth mount: the parallactic angle's growth, radians a second. At the zenith itself
    /// it has no bound: the number is then infinite, never NaN.
    ///
    /// ```text
    /// dq/dt = -w cos phi cos A / cos h          w = 15.041 degrees an hour, A from north through east
    /// ```
    ///
    /// Source: the derivative of Meeus, *Astronomical Algorithms*, eq. 14.1. Checked: 11.60 degrees an hour in the meridian at 60.17
    /// north, declination +20.
    #[must_use]
    pub fn field_rotation(&self, position: &Equatorial<OfDate>) -> f64 {
        const SIDEREAL: f64 = 7.292_115_146_7e-5;
        let seen = self.airless(position);
        let from_zenith = (Angle::degrees(90.0) - seen.altitude()).sin().abs();
        let rate = -SIDEREAL * self.latitude.cos() * seen.azimuth().cos() / from_zenith;
        if rate.is_nan() { 0.0 } else { rate }
    }
}

/// [`Horizon::airless`] for a single direction; for many at one moment make the [`Horizon`] once.
#[must_use]
pub fn airless(position: &Equatorial<OfDate>, moment: &Moment, site: &Site) -> Horizontal<Airless> {
    Horizon::at(moment, site).airless(position)
}

/// [`Horizon::of_date`] for a single direction.
#[must_use]
pub fn of_date(direction: &Horizontal<Airless>, moment: &Moment, site: &Site) -> Equatorial<OfDate> {
    Horizon::at(moment, site).of_date(direction)
}

/// [`Horizon::hour_angle`] for a single direction.
#[must_use]
pub fn hour_angle(position: &Equatorial<OfDate>, moment: &Moment, site: &Site) -> Angle {
    Horizon::at(moment, site).hour_angle(position)
}

/// [`Horizon::parallactic_angle`] for a single direction.
#[must_use]
pub fn parallactic_angle(position: &Equatorial<OfDate>, moment: &Moment, site: &Site) -> Angle {
    Horizon::at(moment, site).parallactic_angle(position)
}

/// As the eye sees it: lifted by the air.
#[must_use]
pub fn refracted(direction: &Horizontal<Airless>, air: &Air) -> Horizontal<Refracted> {
    Horizontal::new(direction.azimuth(), refraction::refracted(direction.altitude(), air))
}

/// What the eye sees, with the air's lift taken off.
#[must_use]
pub fn unrefracted(direction: &Horizontal<Refracted>, air: &Air) -> Horizontal<Airless> {
    Horizontal::new(direction.azimuth(), refraction::airless(direction.altitude(), air))
}
