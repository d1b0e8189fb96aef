//! Schaefer's limiting magnitude: a second opinion on stars.

use super::Viewing;
use crate::units::{Magnitude, SurfaceBrightness};

/// Backgrounds brighter than this are seen by the cones, nanolamberts.
const DAY_NL: f64 = 1500.0;

/// The faintest star to the naked eye over a background in nanolamberts, in foot-candles.
///
/// ```text
/// I = C (1 + (K B)^1/2)^2          night: lg C = -9.80, lg K = -1.90;   day (B > 1500 nL): lg C = -8.35, lg K = -5.90
/// ```
///
/// Hecht (1947) as Schaefer (1990), PASP 102, 212, uses it.
fn threshold_foot_candles(nanolambert: f64) -> f64 {
    let (c, k): (f64, f64) = if nanolambert < DAY_NL { (1.584_9e-10, 0.012_589) } else { (4.466_8e-9, 1.258_9e-6) };
    c * (1.0 + (k * nanolambert).sqrt()).powi(2)
}

/// The magnitude of so many foot-candles: Schaefer's zero point.
fn of_foot_candles(foot_candles: f64) -> Magnitude {
    Magnitude(-16.57 - 2.5 * foot_candles.log10())
}

/// Nanolamberts of a sky: Garstang's constants.
fn nanolambert(sky: SurfaceBrightness) -> f64 {
    34.08 * (20.7233 - 0.92104 * sky.0).exp()
}

/// The faintest star to the naked eye, above the air. Unihedron's formula for its meter is the same curve.
#[must_use]
pub fn naked_eye(sky: SurfaceBrightness) -> Magnitude {
    of_foot_candles(threshold_foot_candles(nanolambert(sky)))
}

/// The faintest star through a telescope, above the air, for an observer of ordinary acuity and experience.
///
/// ```text
/// I = I* F_b F_t F_p F_a,   B_eye = B / (F_b F_t F_p F_a F_m)
/// F_b = 2^1/2 one eye;  F_t = 1/T;  F_p = max(1, (d/p)^2) light that misses the pupil;  F_a = (p/D)^2;  F_m = M^2
/// ```
///
/// Schaefer (1990); his factors of extinction, seeing, colour and Stiles and Crawford are left at 1. Crumey (2014) shows that
/// Hecht's form is the less accurate one: this is a second opinion.
#[must_use]
pub fn through_telescope(viewing: &Viewing, sky: SurfaceBrightness) -> Magnitude {
    let one_eye = std::f64::consts::SQRT_2;
    let missed = (viewing.exit_pupil_mm() / viewing.pupil_mm).powi(2).max(1.0);
    let gathered = (viewing.pupil_mm / viewing.aperture_mm).powi(2);
    let factors = one_eye / viewing.transmission * missed * gathered;
    let background = nanolambert(sky) / (factors * viewing.magnification.powi(2));
    of_foot_candles(threshold_foot_candles(background) * factors)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unihedron: NELM = 7.93 - 5 lg(1 + 10^(4.316 - SQM/5)).
    #[test]
    fn the_naked_eyes_limit_is_that_of_the_sky_meters_maker() {
        for sky in [18.5, 20.0, 21.0, 21.83, 22.2] {
            let unihedron = 7.93 - 5.0 * (1.0 + 10f64.powf(4.316 - sky / 5.0)).log10();
            assert!((naked_eye(SurfaceBrightness(sky)).0 - unihedron).abs() < 0.01, "{sky}");
        }
    }

    #[test]
    fn through_254_mm_it_is_within_a_magnitude_of_crumeys_and_goes_the_same_way() {
        let limit = |power: f64, sky: f64| {
            let viewing = Viewing::typical(254.0, power);
            let sky = SurfaceBrightness(sky);
            (through_telescope(&viewing, sky).0, crate::eye::limit::through_telescope(&viewing, sky).0)
        };
        for sky in [18.5, 20.0, 21.5] {
            for power in [78.125, 104.17, 250.0] {
                let (schaefer, crumey) = limit(power, sky);
                assert!((schaefer - crumey).abs() < 1.2, "{power} {sky}: {schaefer} {crumey}");
            }
            assert!(limit(250.0, sky).0 > limit(78.125, sky).0);
        }
        for sky in [4.0, 10.0, 16.0, 25.0] {
            assert!(limit(104.0, sky).0.is_finite());
        }
    }
}
