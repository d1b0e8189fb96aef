//! How bright the planets are: Mallama and Hilton (2018), *Computing apparent planetary magnitudes for The Astronomical
//! Almanac*, Astronomy and Computing 25, 10; the Moon after Allen (1976), the Sun -26.74 at one astronomical unit.

use crate::sky::ephemeris::Body;
use crate::units::{Angle, Magnitude};

/// What the brightness of a body depends on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lighting {
    /// Distance from the Sun, astronomical units.
    pub from_sun_au: f64,
    /// Distance from the observer, astronomical units.
    pub from_observer_au: f64,
    /// Angle at the body between Sun and observer.
    pub phase_angle: Angle,
    /// Planetocentric latitude under the observer.
    pub latitude_observer: Angle,
    /// Planetocentric latitude under the Sun.
    pub latitude_sun: Angle,
    /// Julian date.
    pub jde: f64,
}

/// Apparent visual magnitude of the whole body, Saturn with its rings. Mars without the bright and dark sides of its globe
/// (0.05 magnitude).
///
/// ```text
/// V = 5 log10(r d) + V1(phase angle, rings, tilt)
/// ```
#[must_use]
pub fn visual(body: Body, lit: &Lighting) -> Magnitude {
    let alpha = lit.phase_angle.to_degrees();
    let distances = 5.0 * (lit.from_sun_au * lit.from_observer_au).log10();
    let reduced = match body {
        Body::Sun => return Magnitude(-26.74 + 5.0 * lit.from_observer_au.log10()),
        // At mean distance; scaled with both distances.
        Body::Moon => -12.73 + 0.026 * alpha + 4e-9 * alpha.powi(4) - 5.0 * 0.002_57_f64.log10(),
        Body::Mercury => series(alpha, &[-0.613, 6.3280e-2, -1.6336e-3, 3.3644e-5, -3.4265e-7, 1.6893e-9, -3.0334e-12]),
        Body::Venus if alpha <= 163.7 => series(alpha, &[-4.384, -1.044e-3, 3.687e-4, -2.814e-6, 8.938e-9]),
        Body::Venus => series(alpha, &[236.058_28, -2.819_14, 8.390_34e-3]),
        Body::Mars if alpha <= 50.0 => series(alpha, &[-1.601, 0.022_67, -0.000_130_2]),
        Body::Mars => series(alpha, &[-0.367, -0.025_73, 0.000_344_5]),
        Body::Jupiter => series(alpha, &[-9.395, -3.7e-4, 6.16e-4]),
        Body::Saturn => saturn(alpha, lit),
        Body::Uranus => {
            let latitude = (lit.latitude_observer.abs() + lit.latitude_sun.abs()).to_degrees() / 2.0;
            series(alpha, &[-7.110 - 8.4e-4 * latitude, 6.587e-3, 1.045e-4])
        }
        // It brightened by a tenth of a magnitude from 1980 to 2000.
        Body::Neptune => {
            let year = 2000.0 + (lit.jde - 2_451_545.0) / 365.25;
            -6.89 - 0.0054 * (year - 1980.0).clamp(0.0, 20.0)
        }
    };
    Magnitude(distances + reduced)
}

/// Globe and rings, for ring tilts up to 27 degrees; where Sun and observer see different faces the rings are dark.
fn saturn(alpha: f64, lit: &Lighting) -> f64 {
    let (observer, sun) = (lit.latitude_observer.to_degrees(), lit.latitude_sun.to_degrees());
    let tilt = Angle::degrees(if observer * sun > 0.0 { (observer * sun).sqrt() } else { 0.0 });
    -8.914 - 1.825 * tilt.sin() + 0.026 * alpha - 0.378 * tilt.sin() * (-2.25 * alpha).exp()
}

fn series(x: f64, coefficients: &[f64]) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}
