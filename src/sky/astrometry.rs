//! From the catalogue to the place of date and back: proper motion, parallax, light deflection by the Sun, aberration,
//! frame bias, precession and nutation, by SOFA's routines.
//!
//! The place of date is equinox-based (right ascension from the true equinox, not from the CIO) and geocentric.

use glam::{DMat3, DVec3};
use sofars::astro::IauAstrom;

use super::coords::{Equatorial, J2000, OfDate};
use super::ephemeris::planets;
use super::time::Moment;
use crate::units::Angle;

/// A catalogue entry's place: where it is at epoch J2000.0 and how it moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Astrometry {
    /// Direction at epoch J2000.0.
    pub position: Equatorial<J2000>,
    /// Proper motion eastwards on the sky (that is, times the cosine of the declination), milliarcseconds a year.
    pub pm_east_mas_yr: f64,
    /// Proper motion northwards, milliarcseconds a year.
    pub pm_north_mas_yr: f64,
    /// Parallax in milliarcseconds; zero or less means "very far".
    pub parallax_mas: f64,
}

impl Astrometry {
    /// Something that stands still, very far away.
    #[must_use]
    pub fn fixed(position: Equatorial<J2000>) -> Astrometry {
        Astrometry { position, pm_east_mas_yr: 0.0, pm_north_mas_yr: 0.0, parallax_mas: 0.0 }
    }
}

/// All that the reduction of places needs to know of one moment: the Earth's place and velocity, and the matrix from the
/// catalogue's frame to the equator of date. Made once a moment (a tenth of a millisecond), used for every star.
#[derive(Debug, Clone)]
pub struct Reduction {
    moment: Moment,
    astrom: IauAstrom,
    /// The Earth as seen from the Sun, au.
    earth_from_sun_au: DVec3,
    sidereal_time: Angle,
}

impl Reduction {
    /// The Earth's place by SOFA `epv00` (1900 to 2100, 11 km) or, outside those years, VSOP87 (under an arcsecond; its
    /// barycentric velocity is then the heliocentric one: 0.01 arcsecond of aberration); the matrix is IAU 2006 precession with
    /// IAU 2000A nutation.
    #[must_use]
    pub fn at(moment: &Moment) -> Reduction {
        let (tt1, tt2) = moment.tt();
        let (ut1, ut2) = moment.ut1();
        let (heliocentric, barycentric) = sofars::eph::epv00(tt1, tt2).unwrap_or_else(|| {
            let earth = |later: f64| planets::earth(tt1 + tt2 + later);
            let velocity = (earth(0.5) - earth(-0.5)).to_array();
            let earth = [earth(0.0).to_array(), velocity];
            (earth, earth)
        });
        let mut astrom = IauAstrom::default();
        sofars::astro::apcg(tt1, tt2, &barycentric, &heliocentric[0], &mut astrom);
        astrom.bpn = sofars::pnp::pnm06a(tt1, tt2);
        let sidereal_time = Angle::radians(sofars::erst::gst06(ut1, ut2, tt1, tt2, &astrom.bpn));
        Reduction { moment: *moment, astrom, earth_from_sun_au: DVec3::from(heliocentric[0]), sidereal_time }
    }

    /// The moment that this belongs to.
    #[must_use]
    pub fn moment(&self) -> &Moment {
        &self.moment
    }

    /// Greenwich apparent sidereal time.
    #[must_use]
    pub fn greenwich_sidereal_time(&self) -> Angle {
        self.sidereal_time
    }

    /// The apparent place of a catalogue entry: SOFA's `atciq` with the equinox-based matrix. Radial velocity is taken as zero
    /// (it moves the nearest stars by a hundredth of an arcsecond a century).
    #[must_use]
    pub fn apparent(&self, entry: &Astrometry) -> Equatorial<OfDate> {
        let (ra, dec) = (entry.position.ra().to_radians(), entry.position.dec().to_radians());
        // SOFA wants the motion in right ascension itself; at the pole itself that has no meaning and none is used.
        let cos_dec = dec.cos();
        let east = Angle::arcseconds(entry.pm_east_mas_yr / 1000.0).to_radians();
        let pm_ra = if cos_dec > 1e-9 { east / cos_dec } else { 0.0 };
        let pm_dec = Angle::arcseconds(entry.pm_north_mas_yr / 1000.0).to_radians();
        let parallax_arcsec = entry.parallax_mas.max(0.0) / 1000.0;
        let (ra, dec) = sofars::astro::atciq(ra, dec, pm_ra, pm_dec, parallax_arcsec, 0.0, &mut self.astrom.clone());
        Equatorial::new(Angle::radians(ra), Angle::radians(dec))
    }

    /// The place of date of a direction that stands still in the catalogue's frame.
    #[must_use]
    pub fn of_date(&self, position: &Equatorial<J2000>) -> Equatorial<OfDate> {
        let (ra, dec) =
            sofars::astro::atciqz(position.ra().to_radians(), position.dec().to_radians(), &mut self.astrom.clone());
        Equatorial::new(Angle::radians(ra), Angle::radians(dec))
    }

    /// The direction in the catalogue's frame whose place of date this is: the inverse of [`Reduction::of_date`], by SOFA's
    /// `aticq` (which iterates to a nanoarcsecond away from the Sun).
    #[must_use]
    pub fn j2000(&self, position: &Equatorial<OfDate>) -> Equatorial<J2000> {
        let (ra, dec) =
            sofars::astro::aticq(position.ra().to_radians(), position.dec().to_radians(), &mut self.astrom.clone());
        Equatorial::new(Angle::radians(ra), Angle::radians(dec))
    }

    /// From the Sun to the Earth on the catalogue's axes, astronomical units.
    #[must_use]
    pub fn earth_from_sun_au(&self) -> DVec3 {
        self.earth_from_sun_au
    }

    /// The Earth's velocity against the barycentre over the speed of light, catalogue axes.
    #[must_use]
    pub fn earth_velocity_c(&self) -> DVec3 {
        DVec3::from(self.astrom.v)
    }

    /// The matrix from the catalogue's axes to the equator and equinox of date.
    #[must_use]
    pub fn to_of_date(&self) -> DMat3 {
        DMat3::from_cols_array_2d(&self.astrom.bpn).transpose()
    }

    /// The place of date of a body of the solar system that lies at `from_earth` from here and at `from_sun` from the Sun
    /// (catalogue axes, any unit): deflection by the Sun for a source at a finite distance (SOFA `ld`), then aberration.
    pub(super) fn of_date_past_the_sun(&self, from_earth: DVec3, from_sun: DVec3) -> Equatorial<OfDate> {
        let (p, q) = (from_earth.normalize_or(DVec3::X), from_sun.normalize_or(DVec3::X));
        // SOFA's own limit, where deflection would grow beyond the Sun's limb.
        let limit = 1e-6 / (self.astrom.em * self.astrom.em).max(1.0);
        let bent = sofars::astro::ld(1.0, p.to_array(), q.to_array(), self.astrom.eh, self.astrom.em, limit);
        self.of_date_without_deflection(DVec3::from(bent))
    }

    /// The place of date of a direction on the catalogue's axes: aberration, then precession and nutation.
    pub(super) fn of_date_without_deflection(&self, direction: DVec3) -> Equatorial<OfDate> {
        let direction = direction.normalize_or(DVec3::X);
        let seen = sofars::astro::ab(&direction.to_array(), &self.astrom.v, self.astrom.em, self.astrom.bm1);
        Equatorial::from_direction(self.to_of_date() * DVec3::from(seen))
    }

    /// The apparent place of the Sun: where the Earth was, seen from the Sun, a light time ago, and aberration.
    pub(super) fn sun(&self) -> Equatorial<OfDate> {
        // The light that arrives now left when the Sun stood where it does now against the barycentre, within 13 m/s times 8
        // minutes = 0.01 arcsecond: so the direction is -(Earth from Sun) now, and aberration does all the rest.
        self.of_date_without_deflection(-self.earth_from_sun_au)
    }
}

/// [`Reduction::apparent`] for a single star; for many at one moment make the [`Reduction`] once.
#[must_use]
pub fn apparent(entry: &Astrometry, moment: &Moment) -> Equatorial<OfDate> {
    Reduction::at(moment).apparent(entry)
}

/// [`Reduction::of_date`] for a single direction.
#[must_use]
pub fn of_date(position: &Equatorial<J2000>, moment: &Moment) -> Equatorial<OfDate> {
    Reduction::at(moment).of_date(position)
}

/// [`Reduction::j2000`] for a single direction.
#[must_use]
pub fn j2000(position: &Equatorial<OfDate>, moment: &Moment) -> Equatorial<J2000> {
    Reduction::at(moment).j2000(position)
}
