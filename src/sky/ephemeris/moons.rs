//! The moons of Mars, Jupiter, Saturn and Uranus: where they stand beside their planet, and whether planet or shadow hides
//! them.

/// Io, Europa, Ganymede, Callisto.
pub mod jupiter;
/// Phobos, Deimos.
pub mod mars;
/// Mimas to Iapetus.
pub mod saturn;
/// Miranda to Oberon.
pub mod uranus;

use glam::{DMat3, DVec2, DVec3};

use super::body::Body;
use super::place::{AU_KM, Ephemeris, Place};
use crate::sky::coords::{Equatorial, OfDate};
use crate::sky::physical::Rotation;
use crate::sky::project::tangent_basis;
use crate::units::{Angle, Magnitude};

/// A moon beside its planet, seen from the centre of the Earth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moon {
    /// The English name.
    pub name: &'static str,
    /// Offset from the planet's centre eastwards, on the tangent plane of the equator of date.
    pub east: Angle,
    /// Offset northwards.
    pub north: Angle,
    /// Nearer to the Earth than the planet's centre.
    pub in_front: bool,
    /// Behind the planet's disc.
    pub hidden: bool,
    /// In the planet's shadow: from there the middle of the Sun is behind the planet.
    pub eclipsed: bool,
    /// Apparent magnitude when lit, at mean phase.
    pub magnitude: Magnitude,
}

impl Moon {
    /// Where the moon is when its planet is there: on the tangent plane of date.
    #[must_use]
    pub fn beside(&self, planet: &Equatorial<OfDate>) -> Equatorial<OfDate> {
        let basis = tangent_basis(&Equatorial::new(planet.ra(), planet.dec()));
        let towards = DVec3::new(self.east.to_radians(), self.north.to_radians(), 1.0);
        Equatorial::from_direction(basis.transpose() * towards)
    }
}

/// Names and magnitudes at one astronomical unit from Sun and Earth (*Explanatory Supplement to the Astronomical Almanac*, 3rd
/// edition, table 10.6). Iapetus swings by 0.9 around its own.
const MARS: [(&str, f64); 2] = [("Phobos", 11.8), ("Deimos", 12.89)];
const JUPITER: [(&str, f64); 4] = [("Io", -1.68), ("Europa", -1.41), ("Ganymede", -2.09), ("Callisto", -1.05)];
const SATURN: [(&str, f64); 8] = [
    ("Mimas", 3.3),
    ("Enceladus", 2.1),
    ("Tethys", 0.6),
    ("Dione", 0.8),
    ("Rhea", 0.1),
    ("Titan", -1.28),
    ("Hyperion", 4.63),
    ("Iapetus", 1.5),
];
const URANUS: [(&str, f64); 5] =
    [("Miranda", 3.6), ("Ariel", 1.45), ("Umbriel", 2.10), ("Titania", 1.02), ("Oberon", 1.23)];

/// The moons of a planet as its light shows them: all at the light time of the planet's centre. Empty for bodies without moons
/// here (Neptune's Triton is left out).
#[must_use]
pub fn beside(ephemeris: &Ephemeris, place: &Place) -> Vec<Moon> {
    let view = View::of(ephemeris, place);
    let moons = |names: &[(&'static str, f64)], centres: &[DVec3]| {
        names.iter().zip(centres).map(|((name, magnitude), centre)| view.moon(name, *magnitude, *centre)).collect()
    };
    match place.body {
        Body::Mars => moons(&MARS, &mars::centres(place.left_jde)),
        Body::Jupiter => moons(&JUPITER, &jupiter::centres(place.left_jde)),
        Body::Saturn => moons(&SATURN, &saturn::centres(place.left_jde)),
        Body::Uranus => moons(&URANUS, &uranus::centres(place.left_jde)),
        _ => Vec::new(),
    }
}

/// The planet and the name of a moon that is called so, whatever its case.
#[must_use]
pub fn named(text: &str) -> Option<(Body, &'static str)> {
    let all = [
        (Body::Mars, &MARS[..]),
        (Body::Jupiter, &JUPITER[..]),
        (Body::Saturn, &SATURN[..]),
        (Body::Uranus, &URANUS[..]),
    ];
    let mut moons = all.into_iter().flat_map(|(body, moons)| moons.iter().map(move |(name, _)| (body, *name)));
    moons.find(|(_, name)| name.eq_ignore_ascii_case(text.trim()))
}

/// The error to expect of a moon's offset: measured from 1990 to 2050 against other theories (1.5 arcseconds; Titan 2, Iapetus
/// and Hyperion 4); beyond 1900 to 2100 it is widened by 3 arcseconds a century, an estimate.
#[must_use]
pub fn error(ephemeris: &Ephemeris, name: &str) -> Angle {
    let near = match name {
        "Titan" => 2.0,
        "Hyperion" | "Iapetus" => 4.0,
        _ => 1.5,
    };
    Angle::arcseconds(near + 3.0 * ephemeris.centuries_outside())
}

/// The planet as seen and as lit, to set moons beside it.
struct View {
    planet_km: DVec3,
    /// Eastwards, northwards and away, of date, on catalogue axes.
    east: DVec3,
    north: DVec3,
    away: DVec3,
    from_sun: DVec3,
    pole: DVec3,
    radii_km: (f64, f64),
    distances: f64,
}

impl View {
    fn of(ephemeris: &Ephemeris, place: &Place) -> View {
        let to_of_date = ephemeris.reduction().to_of_date();
        let away = place.from_earth_au.normalize_or(DVec3::X);
        let celestial_pole = to_of_date.transpose() * DVec3::Z;
        let east = celestial_pole.cross(away).normalize_or(DVec3::Y);
        View {
            planet_km: place.from_earth_au * AU_KM,
            east,
            north: away.cross(east),
            away,
            from_sun: place.from_sun_au.normalize_or(DVec3::X),
            pole: Rotation::of(place.body, place.left_jde).pole,
            radii_km: (place.body.equatorial_radius_km(), place.body.polar_radius_km()),
            distances: 5.0 * (place.distance_au * place.from_sun_au.length()).log10(),
        }
    }

    fn moon(&self, name: &'static str, magnitude: f64, centre_km: DVec3) -> Moon {
        let seen = self.planet_km + centre_km;
        let depth = seen.dot(self.away);
        let in_front = centre_km.dot(self.away) < 0.0;
        Moon {
            name,
            east: Angle::radians(seen.dot(self.east) / depth),
            north: Angle::radians(seen.dot(self.north) / depth),
            in_front,
            hidden: !in_front && self.covered(centre_km, self.away),
            eclipsed: centre_km.dot(self.from_sun) > 0.0 && self.covered(centre_km, self.from_sun),
            magnitude: Magnitude(magnitude + self.distances),
        }
    }

    /// Whether the planet's flattened globe stands in the way of a line through `point` along `line`.
    ///
    /// ```text
    /// (x / a)^2 + (y / b)^2 < 1,   b^2 = polar^2 cos^2 B + equatorial^2 sin^2 B
    /// ```
    fn covered(&self, point: DVec3, line: DVec3) -> bool {
        let (equatorial, polar) = self.radii_km;
        let sin_tilt = self.pole.dot(line);
        let up = (self.pole - line * sin_tilt).normalize_or(DVec3::Z);
        let across = line.cross(up);
        let (a, tilt2) = (equatorial, sin_tilt * sin_tilt);
        let b = (polar * polar * (1.0 - tilt2) + equatorial * equatorial * tilt2).sqrt();
        DVec2::new(point.dot(across) / a, point.dot(up) / b).length() < 1.0
    }
}

/// Mean obliquity of the ecliptic at B1950, degrees (IAU 1976).
const OBLIQUITY_B1950: f64 = 23.445_788;

/// From the equator and equinox of B1950 to the catalogue's axes, by precession alone.
fn b1950_to_catalogue() -> DMat3 {
    DMat3::from_cols_array_2d(&sofars::pnp::pmat76(2_433_282.423, 0.0))
}

/// A place on an ellipse with its pericentre on the x axis, in the unit of its axis.
///
/// ```text
/// E - e sin E = M,   x = a (cos E - e),   y = a sqrt(1 - e^2) sin E
/// ```
fn on_ellipse(axis: f64, eccentricity: f64, mean_anomaly: f64) -> DVec3 {
    let mut anomaly = mean_anomaly;
    // Eccentricities here are below 0.05: each step brings 1e-2 of the last one's error squared.
    for _ in 0..5 {
        let (sin, cos) = anomaly.sin_cos();
        anomaly -= (anomaly - eccentricity * sin - mean_anomaly) / (1.0 - eccentricity * cos);
    }
    let (sin, cos) = anomaly.sin_cos();
    DVec3::new(axis * (cos - eccentricity), axis * (1.0 - eccentricity * eccentricity).sqrt() * sin, 0.0)
}
