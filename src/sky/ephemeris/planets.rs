//! The planets round the Sun: VSOP87A (Bretagnon and Francou 1988, A&A 202, 309).
//!
//! The series are held at 3 mas as seen from the Earth at its nearest (within five centuries of J2000): 10500 terms, by
//! `fixtures/reference/make_vsop87.py`.

#![expect(clippy::approx_constant, reason = "a phase of half a turn is printed to as many digits as its term needs")]

use glam::DVec3;

use super::body::Body;
use crate::units::Angle;

/// One term: amplitude in astronomical units, phase in radians, frequency in radians a millennium.
type Term = [f64; 3];

/// For x, y and z: terms by the power of time (Julian millennia from J2000) that multiplies them.
type Series = [[&'static [Term]; 6]; 3];

static MERCURY: Series = include!("planets/mercury.in");
static VENUS: Series = include!("planets/venus.in");
static EARTH: Series = include!("planets/earth.in");
static MARS: Series = include!("planets/mars.in");
static JUPITER: Series = include!("planets/jupiter.in");
static SATURN: Series = include!("planets/saturn.in");
static URANUS: Series = include!("planets/uranus.in");
static NEPTUNE: Series = include!("planets/neptune.in");

/// From the dynamical ecliptic and equinox J2000 of VSOP87 to the equator and equinox of FK5 J2000 (within 0.02 arcsecond the
/// ICRS): the file vsop87.doc that comes with the theory, section "reference systems".
const TO_EQUATOR: [[f64; 3]; 3] = [
    [1.0, 0.000_000_440_360, -0.000_000_190_919],
    [-0.000_000_479_966, 0.917_482_137_087, -0.397_776_982_902],
    [0.0, 0.397_776_982_902, 0.917_482_137_087],
];

/// From VSOP87's ecliptic of J2000 to the axes of the catalogue.
#[must_use]
pub fn from_ecliptic(v: DVec3) -> DVec3 {
    let [x, y, z] = TO_EQUATOR.map(DVec3::from);
    DVec3::new(x.dot(v), y.dot(v), z.dot(v))
}

/// From the Sun to the centre of the Earth in astronomical units, equator and equinox J2000; `jde` is a Julian date of TDB
/// (TT will do: they differ by 2 ms).
#[must_use]
pub fn earth(jde: f64) -> DVec3 {
    from_ecliptic(sum(&EARTH, jde))
}

/// From the Sun to the planet in astronomical units, equator and equinox J2000. The Sun is at the centre; the Moon is not a
/// planet and is found from the Earth: both give zero here.
///
/// VSOP87 was fitted to DE200. It keeps 1 arcsecond, seen from the Sun, for 4000 years around J2000 (Mercury to Mars), 2000
/// years (Jupiter, Saturn) and 6000 years (Uranus, Neptune) by its authors' account, but for what is mended here.
#[must_use]
pub fn from_sun(body: Body, jde: f64) -> DVec3 {
    from_ecliptic(match body {
        Body::Sun | Body::Moon => DVec3::ZERO,
        Body::Mercury => sum(&MERCURY, jde),
        Body::Venus => sum(&VENUS, jde),
        Body::Mars => sum(&MARS, jde),
        Body::Jupiter => sum(&JUPITER, jde),
        Body::Saturn => sum(&SATURN, jde),
        Body::Uranus => FOR_URANUS.apply(jde, sum(&URANUS, jde)),
        Body::Neptune => FOR_NEPTUNE.apply(jde, sum(&NEPTUNE, jde)),
    })
}

/// The series at a Julian date: dynamical ecliptic of J2000, astronomical units.
///
/// ```text
/// x = sum over n of T^n sum of A cos(B + C T)
/// ```
fn sum(series: &Series, jde: f64) -> DVec3 {
    let t = (jde - 2_451_545.0) / 365_250.0;
    let axis = |powers: &[&[Term]; 6]| {
        powers.iter().rev().fold(0.0, |total, terms| {
            total * t + terms.iter().rev().map(|[a, b, c]| a * (b + c * t).cos()).sum::<f64>()
        })
    };
    DVec3::new(axis(&series[0]), axis(&series[1]), axis(&series[2]))
}

/// What to add to the orbit that VSOP87 gives a planet, because DE200, to which it was fitted, had Neptune wrong by 2
/// arcseconds in 2050 and Uranus by 1.5. The six numbers are the first-order change of a nearly round orbit, fitted by least
/// squares to DE421 (Folkner et al. 2009) from 1900 to 2050 (`fixtures/reference/fit_outer.py`); they leave 0.06 arcsecond of
/// Neptune and 0.5 of Uranus.
struct Correction {
    /// Mean longitude at J2000, arcseconds.
    longitude: f64,
    /// Its growth in a Julian century, arcseconds.
    motion: f64,
    /// Eccentricity times cosine and sine of the longitude of perihelion, arcseconds.
    eccentricity: [f64; 2],
    /// Inclination times cosine and sine of the node, arcseconds.
    inclination: [f64; 2],
    /// Mean motion, radians a Julian century.
    mean_motion: f64,
}

const FOR_URANUS: Correction = Correction {
    longitude: 0.3916,
    motion: 0.6852,
    eccentricity: [0.2271, -0.0351],
    inclination: [0.0122, 0.0261],
    mean_motion: 7.478_16,
};

const FOR_NEPTUNE: Correction = Correction {
    longitude: -1.0089,
    motion: -1.6817,
    eccentricity: [-0.1898, -0.0165],
    inclination: [-0.0291, 0.0732],
    mean_motion: 3.813_30,
};

impl Correction {
    /// The corrected place; ecliptic of J2000.
    ///
    /// ```text
    /// d lambda = a + b T + 2 (k sin lambda - h cos lambda)
    /// d r / r  = -(2/3) b / n - (k cos lambda + h sin lambda)
    /// d beta   = p sin lambda - q cos lambda
    /// ```
    fn apply(&self, jde: f64, ecliptic: DVec3) -> DVec3 {
        let centuries = (jde - 2_451_545.0) / 36_525.0;
        let (sin, cos) = ecliptic.y.atan2(ecliptic.x).sin_cos();
        let [k, h] = self.eccentricity;
        let [p, q] = self.inclination;
        let east = self.longitude + self.motion * centuries + 2.0 * (k * sin - h * cos);
        let out = -2.0 / 3.0 * self.motion / self.mean_motion - (k * cos + h * sin);
        let north = p * sin - q * cos;
        let outwards = ecliptic.normalize_or(DVec3::X);
        let eastwards = DVec3::Z.cross(outwards).normalize_or(DVec3::Y);
        let change = eastwards * east + outwards * out + outwards.cross(eastwards) * north;
        ecliptic + change * ecliptic.length() * Angle::arcseconds(1.0).to_radians()
    }
}
