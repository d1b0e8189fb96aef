//! Positions on the sky. Two meanings are two types: J2000 and of-date, true and apparent, mount and sky never mix
//! silently; only the named conversions cross.
//!
//! Right ascension grows eastwards. Azimuth runs from north through east. Hour angle grows westwards.

use std::marker::PhantomData;

use glam::DVec3;

use crate::units::Angle;

/// The catalogue frame: ICRS directions at epoch J2000.0.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum J2000 {}

/// The true equator and equinox of date, with aberration and light deflection: what an almanac calls apparent, and what a
/// mount calls right ascension and declination. Equinox-based, geocentric.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OfDate {}

/// Altitudes as geometry has them, without refraction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Airless {}

/// Altitudes as the eye sees them, lifted by refraction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Refracted {}

/// Right ascension and declination in the frame `F`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Equatorial<F> {
    ra: Angle,
    dec: Angle,
    frame: PhantomData<F>,
}

impl<F> Equatorial<F> {
    /// From right ascension (any turn) and declination (held at the poles).
    #[must_use]
    pub fn new(ra: Angle, dec: Angle) -> Equatorial<F> {
        let quarter = Angle::degrees(90.0);
        Equatorial { ra: ra.wrapped(), dec: dec.max(-quarter).min(quarter), frame: PhantomData }
    }

    /// Right ascension, 0 to 360 degrees.
    #[must_use]
    pub fn ra(&self) -> Angle {
        self.ra
    }

    /// Declination, -90 to 90 degrees.
    #[must_use]
    pub fn dec(&self) -> Angle {
        self.dec
    }

    /// Unit vector: x to the equinox, z to the north pole.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        let (sin_dec, cos_dec) = self.dec.sin_cos();
        let (sin_ra, cos_ra) = self.ra.sin_cos();
        DVec3::new(cos_dec * cos_ra, cos_dec * sin_ra, sin_dec)
    }

    /// From a vector of any length but zero.
    #[must_use]
    pub fn from_direction(v: DVec3) -> Equatorial<F> {
        Equatorial::new(Angle::atan2(v.y, v.x), Angle::atan2(v.z, v.x.hypot(v.y)))
    }

    /// Angle on the sky to `other`, good from zero to 180 degrees (by the half-angle chord, not an arccosine).
    #[must_use]
    pub fn separation(&self, other: &Equatorial<F>) -> Angle {
        separation(self.direction(), other.direction())
    }

    /// Position angle of `other` seen from here: from north through east.
    #[must_use]
    pub fn position_angle(&self, other: &Equatorial<F>) -> Angle {
        let (sin_d, cos_d) = self.dec.sin_cos();
        let (sin_o, cos_o) = other.dec.sin_cos();
        let (sin_a, cos_a) = (other.ra - self.ra).sin_cos();
        Angle::atan2(cos_o * sin_a, sin_o * cos_d - cos_o * sin_d * cos_a).wrapped()
    }
}

/// Azimuth and altitude; `R` says whether refraction is in the altitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Horizontal<R> {
    azimuth: Angle,
    altitude: Angle,
    kind: PhantomData<R>,
}

impl<R> Horizontal<R> {
    /// From azimuth (any turn, north through east) and altitude (held at zenith and nadir).
    #[must_use]
    pub fn new(azimuth: Angle, altitude: Angle) -> Horizontal<R> {
        let quarter = Angle::degrees(90.0);
        Horizontal { azimuth: azimuth.wrapped(), altitude: altitude.max(-quarter).min(quarter), kind: PhantomData }
    }

    /// Azimuth from north through east, 0 to 360 degrees.
    #[must_use]
    pub fn azimuth(&self) -> Angle {
        self.azimuth
    }

    /// Altitude above the horizon, -90 to 90 degrees.
    #[must_use]
    pub fn altitude(&self) -> Angle {
        self.altitude
    }

    /// Unit vector: x north, y east, z up.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        let (sin_alt, cos_alt) = self.altitude.sin_cos();
        let (sin_az, cos_az) = self.azimuth.sin_cos();
        DVec3::new(cos_alt * cos_az, cos_alt * sin_az, sin_alt)
    }

    /// From a vector of any length but zero.
    #[must_use]
    pub fn from_direction(v: DVec3) -> Horizontal<R> {
        Horizontal::new(Angle::atan2(v.y, v.x), Angle::atan2(v.z, v.x.hypot(v.y)))
    }

    /// Angle on the sky to `other`.
    #[must_use]
    pub fn separation(&self, other: &Horizontal<R>) -> Angle {
        separation(self.direction(), other.direction())
    }
}

/// Angle between two unit vectors.
#[must_use]
pub fn separation(a: DVec3, b: DVec3) -> Angle {
    Angle::atan2((a - b).length() / 2.0, (a + b).length() / 2.0) * 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn position_angle_runs_from_north_through_east() {
        let here: Equatorial<J2000> = Equatorial::new(Angle::degrees(10.0), Angle::degrees(41.0));
        let north = Equatorial::new(Angle::degrees(10.0), Angle::degrees(42.0));
        let east = Equatorial::new(Angle::degrees(10.1), Angle::degrees(41.0));
        assert!(here.position_angle(&north).to_degrees().abs() < 1e-9);
        assert!((here.position_angle(&east).to_degrees() - 90.0).abs() < 0.1);
    }

    #[test]
    fn separation_keeps_a_milliarcsecond_and_half_a_turn() {
        let here: Equatorial<J2000> = Equatorial::new(Angle::ZERO, Angle::ZERO);
        let close = Equatorial::new(Angle::arcseconds(0.001), Angle::ZERO);
        let opposite = Equatorial::new(Angle::degrees(180.0), Angle::ZERO);
        assert!((here.separation(&close).to_arcseconds() - 0.001).abs() < 1e-9);
        assert!((here.separation(&opposite).to_degrees() - 180.0).abs() < 1e-9);
    }
}
