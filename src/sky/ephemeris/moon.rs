//! The Moon round the Earth: ELP/MPP02 (Chapront and Francou 2003, A&A 404, 735), fitted to DE405.
//!
//! The series are held at 2 mas in longitude and latitude and 5 m in distance: 2394 terms. `fixtures/reference/make_elp.mjs`
//! made them from the npm package astronomia (MIT).

#![expect(clippy::approx_constant, reason = "a phase of a quarter turn is printed to as many digits as the others")]

use glam::{DMat3, DVec3};

use crate::units::Angle;

/// One term: amplitude (arcseconds or kilometres), then the polynomial of its argument in radians and Julian centuries.
type Term = [f64; 6];

/// Terms by the power of time that multiplies them.
type Series = [&'static [Term]; 4];

static LONGITUDE: Series = include!("moon/longitude.in");
static LATITUDE: Series = include!("moon/latitude.in");
static DISTANCE: Series = include!("moon/distance.in");

/// The Moon's mean longitude W1 in radians, by powers of Julian centuries (DE405 fit, corrected for 6000 years).
const MEAN_LONGITUDE: [f64; 5] = [
    3.810_344_090_830_880_3,
    8_399.684_730_071_93,
    -0.000_033_189_520_425_500_94,
    3.110_249_449_106_061_6e-8,
    -2.032_823_764_892_284_5e-10,
];

/// Laskar's ecliptic of date in the inertial ecliptic of J2000, by powers of Julian centuries (paper, section 6).
const P: [f64; 6] = [0.0, 0.101_803_91e-4, 0.470_204_39e-6, -0.541_736_7e-9, -0.250_794_8e-11, 0.463_486e-14];
const Q: [f64; 6] = [0.0, -0.113_469_002e-3, 0.123_726_74e-6, 0.126_541_70e-8, -0.137_180_8e-11, -0.320_334e-14];

/// Obliquity of the inertial ecliptic of J2000 to the equator of DE405, and the arc between the origins of right ascension
/// (paper, table 6).
const OBLIQUITY: Angle = Angle::arcseconds(84_381.409_60);
const ORIGIN: Angle = Angle::arcseconds(-0.050_28);

/// From the centre of the Earth to the centre of the Moon in kilometres, on the axes of the catalogue, where it is at that
/// moment; `jde` is a Julian date of TDB (TT will do).
#[must_use]
pub fn from_earth_km(jde: f64) -> DVec3 {
    let t = (jde - 2_451_545.0) / 36_525.0;
    let longitude = polynomial(t, &MEAN_LONGITUDE) + Angle::arcseconds(sum(t, &LONGITUDE)).to_radians();
    let latitude = Angle::arcseconds(sum(t, &LATITUDE)).to_radians();
    let distance = sum(t, &DISTANCE);
    let of_date =
        distance * DVec3::new(latitude.cos() * longitude.cos(), latitude.cos() * longitude.sin(), latitude.sin());
    let (p, q) = (polynomial(t, &P), polynomial(t, &Q));
    let root = (1.0 - p * p - q * q).sqrt();
    let to_j2000 = DMat3::from_cols(
        DVec3::new(1.0 - 2.0 * p * p, 2.0 * p * q, -2.0 * p * root),
        DVec3::new(2.0 * p * q, 1.0 - 2.0 * q * q, 2.0 * q * root),
        DVec3::new(2.0 * p * root, -2.0 * q * root, 1.0 - 2.0 * p * p - 2.0 * q * q),
    );
    let to_equator = DMat3::from_rotation_z(ORIGIN.to_radians()) * DMat3::from_rotation_x(OBLIQUITY.to_radians());
    to_equator * (to_j2000 * of_date)
}

fn polynomial(t: f64, coefficients: &[f64]) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * t + coefficient)
}

fn sum(t: f64, series: &Series) -> f64 {
    let power =
        |terms: &[Term]| -> f64 { terms.iter().rev().map(|term| term[0] * polynomial(t, &term[1..]).sin()).sum() };
    series.iter().rev().fold(0.0, |total, terms| total * t + power(terms))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Meeus, *Astronomical Algorithms*, example 47.a (1992 April 12, 0h TD): 368409.7 km from the truncated ELP-2000/82.
    #[test]
    fn the_moon_is_as_far_as_in_the_textbook() {
        let distance = from_earth_km(2_448_724.5).length();
        assert!((distance - 368_409.7).abs() < 5.0, "{distance} km");
    }
}
