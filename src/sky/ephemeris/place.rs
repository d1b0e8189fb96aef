//! Where a body is seen: light time, deflection, aberration, precession, nutation; then the parallax of a site.

use glam::DVec3;

use super::body::Body;
use super::{moon, planets};
use crate::sky::astrometry::Reduction;
use crate::sky::coords::{Equatorial, OfDate};
use crate::sky::site::Site;
use crate::sky::time::Moment;
use crate::units::Angle;

/// Kilometres in an astronomical unit (IAU 2012).
pub const AU_KM: f64 = 149_597_870.7;

/// Days that light takes for an astronomical unit.
pub const LIGHT_DAYS_PER_AU: f64 = 499.004_783_836 / 86_400.0;

/// Julian dates of TT that the ephemeris answers for: the years 1500 and 2500.
const SPAN: (f64, f64) = (2_268_923.5, 2_634_167.5);

/// Julian dates of TT in which the stated error is the measured one: the years 1900 and 2100.
const MEASURED: (f64, f64) = (2_415_020.5, 2_488_069.5);

/// Why there is no ephemeris.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum EphemerisError {
    /// Beyond the years that were held against another program.
    #[error(
        "{0} is beyond the years 1500 to 2500, for which the places of Sun, Moon and planets were checked: give a nearer date"
    )]
    Year(String),
}

/// Places of all bodies at one moment.
#[derive(Debug, Clone)]
pub struct Ephemeris {
    reduction: Reduction,
    jde: f64,
}

/// Where a body is seen from the centre of the Earth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The body.
    pub body: Body,
    /// Apparent place, geocentric, of date.
    pub apparent: Equatorial<OfDate>,
    /// Distance from the centre of the Earth that the light has come, astronomical units.
    pub distance_au: f64,
    /// From the Earth now to the body when the light left it, catalogue axes, astronomical units (no aberration).
    pub from_earth_au: DVec3,
    /// From the Sun to the body when the light left it, catalogue axes, astronomical units.
    pub from_sun_au: DVec3,
    /// Julian date of TT at which the light left the body.
    pub left_jde: f64,
}

/// Where a body is seen from a site.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Topocentric {
    /// Apparent place of date with the site's parallax; diurnal aberration (0.3 arcsecond) is left to
    /// [`Horizon`](crate::sky::horizon::Horizon).
    pub apparent: Equatorial<OfDate>,
    /// Distance from the site, astronomical units.
    pub distance_au: f64,
}

impl Ephemeris {
    /// The ephemeris of a moment.
    ///
    /// # Errors
    /// A moment before the year 1500 or after 2500, named.
    pub fn at(moment: &Moment) -> Result<Ephemeris, EphemerisError> {
        Ephemeris::from_reduction(Reduction::at(moment))
    }

    /// The ephemeris of a moment that has been reduced already.
    ///
    /// # Errors
    /// A moment before the year 1500 or after 2500, named.
    pub fn from_reduction(reduction: Reduction) -> Result<Ephemeris, EphemerisError> {
        let (day, fraction) = reduction.moment().tt();
        let jde = day + fraction;
        if !(SPAN.0..=SPAN.1).contains(&jde) {
            return Err(EphemerisError::Year(reduction.moment().utc.to_rfc3339()));
        }
        Ok(Ephemeris { reduction, jde })
    }

    /// The reduction that belongs to the moment.
    #[must_use]
    pub fn reduction(&self) -> &Reduction {
        &self.reduction
    }

    /// Julian date of TT.
    #[must_use]
    pub fn jde(&self) -> f64 {
        self.jde
    }

    /// The error to expect of a place, for a delta T that is right: measured from 1900 to 2100 against Swiss Ephemeris (Moshier),
    /// where it stays under 2 arcseconds; outside it is widened by an arcsecond a century. Against JPL's DE421 the Moon is
    /// within 0.1 arcsecond, the planets to Saturn within 0.3.
    #[must_use]
    pub fn error(&self) -> Angle {
        Angle::arcseconds(2.0 + self.centuries_outside())
    }

    /// Centuries by which the moment lies outside 1900 to 2100.
    #[must_use]
    pub fn centuries_outside(&self) -> f64 {
        (MEASURED.0 - self.jde).max(self.jde - MEASURED.1).max(0.0) / 36_525.0
    }

    /// Where the body is seen from the centre of the Earth.
    #[must_use]
    pub fn place(&self, body: Body) -> Place {
        match body {
            Body::Sun => self.sun(),
            Body::Moon => self.moon(),
            planet => self.planet(planet),
        }
    }

    fn sun(&self) -> Place {
        let from_earth_au = -self.reduction.earth_from_sun_au();
        let distance_au = from_earth_au.length();
        Place {
            body: Body::Sun,
            apparent: self.reduction.sun(),
            distance_au,
            from_earth_au,
            from_sun_au: DVec3::ZERO,
            left_jde: self.jde - distance_au * LIGHT_DAYS_PER_AU,
        }
    }

    fn moon(&self) -> Place {
        let mut distance_au = 0.002_57;
        let mut geocentric = DVec3::ZERO;
        for _ in 0..2 {
            geocentric = moon::from_earth_km(self.jde - distance_au * LIGHT_DAYS_PER_AU) / AU_KM;
            distance_au = geocentric.length();
        }
        // While the light came the Earth went on, and the Moon with it: aberration takes this back again.
        let from_earth_au = geocentric - self.reduction.earth_velocity_c() * distance_au;
        Place {
            body: Body::Moon,
            apparent: self.reduction.of_date_without_deflection(from_earth_au),
            distance_au,
            from_earth_au,
            from_sun_au: self.reduction.earth_from_sun_au() + from_earth_au,
            left_jde: self.jde - distance_au * LIGHT_DAYS_PER_AU,
        }
    }

    fn planet(&self, body: Body) -> Place {
        let earth = self.reduction.earth_from_sun_au();
        let mut left_jde = self.jde;
        let mut from_sun_au = DVec3::ZERO;
        // The first step leaves the planet's speed over that of light, squared, times its distance: a milliarcsecond.
        for _ in 0..2 {
            from_sun_au = planets::from_sun(body, left_jde);
            left_jde = self.jde - (from_sun_au - earth).length() * LIGHT_DAYS_PER_AU;
        }
        let from_earth_au = from_sun_au - earth;
        Place {
            body,
            apparent: self.reduction.of_date_past_the_sun(from_earth_au, from_sun_au),
            distance_au: from_earth_au.length(),
            from_earth_au,
            from_sun_au,
            left_jde,
        }
    }
}

impl Place {
    /// Where the body is seen from a site: the site's own vector, turned with the Earth, taken off.
    #[must_use]
    pub fn topocentric(&self, reduction: &Reduction, site: &Site) -> Topocentric {
        let seen = self.apparent.direction() * self.distance_au - site_au(reduction, site);
        Topocentric { apparent: Equatorial::from_direction(seen), distance_au: seen.length() }
    }

    /// The angle that the body's equator subtends at a distance in astronomical units.
    ///
    /// ```text
    /// diameter = 2 asin(radius / distance)
    /// ```
    #[must_use]
    pub fn angular_diameter(&self, distance_au: f64) -> Angle {
        Angle::asin(self.body.equatorial_radius_km() / AU_KM / distance_au) * 2.0
    }
}

/// From the centre of the Earth to the site in astronomical units, equator and equinox of date.
#[must_use]
pub fn site_au(reduction: &Reduction, site: &Site) -> DVec3 {
    let mut carried = [[0.0; 3]; 2];
    let (longitude, latitude) = (site.longitude.to_radians(), site.latitude.to_radians());
    let turned = reduction.greenwich_sidereal_time().to_radians();
    sofars::astro::pvtob(longitude, latitude, site.elevation_m, 0.0, 0.0, 0.0, turned, &mut carried);
    DVec3::from(carried[0]) / (AU_KM * 1000.0)
}
