//! The faintest star that can be seen through the telescope.

use std::f64::consts::SQRT_2;

use super::{Eyepiece, Telescope};
use crate::units::{Magnitude, SurfaceBrightness};

/// Field factor of a typical observer: 1 in the laboratory, 1.4 for a good one, 2 typical.
const FIELD_FACTOR: f64 = 2.0;

/// The faintest star that an eye of pupil `pupil_mm` sees under a sky.
///
/// ```text
/// B_a = (min(d, p) / p)^2 B / F_t                                  background at the eye, cd/m2
/// dI  = (max(d, p) / D)^2 F_t phi (r1 B_a^(1/4) + r2 B_a^(1/2))^2    threshold at the aperture, lux
/// m   = -2.5 log10(dI) - 13.99
/// ```
///
/// Crumey (2014), MNRAS 442, 2600: scotopic coefficients r1 = 6.505e-4, r2 = -8.461e-4, phi = F sqrt(2) (one eye),
/// F_t = 1/T; d is the exit pupil. Below B_a = 1e-5 cd/m2 the threshold is held at zeta = 1.150e-9 lux. Valid for
/// night skies (B_a under 0.07 cd/m2). Checked: 254 mm, T = 0.75, p = 7 mm, F = 2 under 21.5: 13.99, 14.27 and 14.72 at
/// 78x, 104x and 200x; under 18.5: 12.77, 13.00, 13.58.
#[must_use]
pub fn limiting_magnitude(
    telescope: &Telescope,
    eyepiece: &Eyepiece,
    pupil_mm: f64,
    sky: SurfaceBrightness,
) -> Magnitude {
    let (r1, r2, zeta) = (6.505e-4, -8.461e-4, 1.150e-9);
    let d = eyepiece.exit_pupil_mm(telescope);
    let p = pupil_mm;
    let f_t = 1.0 / telescope.transmission;
    let phi = FIELD_FACTOR * SQRT_2;
    let b_a = (d.min(p) / p).powi(2) * sky.to_candela_per_m2() / f_t;
    let threshold = if b_a < 1e-5 { zeta } else { (r1 * b_a.powf(0.25) + r2 * b_a.sqrt()).powi(2) };
    let lux = (d.max(p) / telescope.aperture_mm).powi(2) * f_t * phi * threshold;
    Magnitude(-2.5 * lux.log10() - 13.99)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limits_of_a_254_mm_telescope_are_those_published_for_crumeys_model() {
        let telescope = Telescope::default();
        for (sky, focal_length_mm, published) in [
            (21.5, 32.0, 13.99),
            (21.5, 24.0, 14.27),
            (21.5, 12.5, 14.72),
            (18.5, 32.0, 12.77),
            (18.5, 24.0, 13.00),
            (18.5, 12.5, 13.58),
            (18.5, 5.0, 14.46),
        ] {
            let eyepiece = Eyepiece::plossl(focal_length_mm);
            let limit = limiting_magnitude(&telescope, &eyepiece, 7.0, SurfaceBrightness(sky)).0;
            assert!((limit - published).abs() < 0.015, "{sky} {focal_length_mm} mm: {limit} not {published}");
        }
    }
}
