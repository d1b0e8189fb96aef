//! Crumey's threshold: how bright a disc, or a point, must be to be seen half of the time.
//!
//! ```text
//! x     = B^(-1/4)                                            B the background in cd/m2
//! R     = (sqrt(a1 x^2 + a2 x + a3) + a4 x + a5)^2             steradian: Ricco's area
//! C_inf = sqrt(b1 x^2 + b2 x + b3) + b4 x + b5                threshold of a very large disc
//! q     = 0.6 (B < 0.193), 0.8861 + 0.4 lg B (to 3.40), 1.146 - 0.0885 lg B
//! C_th  = F ((R/A)^q + C_inf^q)^(1/q)                         A the disc's area in steradian
//! ```
//!
//! Crumey (2014), MNRAS 442, 2600. A public copy of the paper's code has other b2 to b5; at 3000 cd/m2 it gives nearly
//! twice Blackwell's threshold and is not used.

/// Below this background, cd/m2 (25.08 mag per square arcsecond), the eye's own light rules: thresholds stay as they are here.
pub const DARKEST_CD_M2: f64 = 1e-5;

/// The factor of a telescope: one eye looks. Crumey's F_T.
pub const ONE_EYE: f64 = std::f64::consts::SQRT_2;

/// Crumey's field factor of a typical observer; 1 in the laboratory, 1.4 for a good one, up to 2.4.
pub const TYPICAL_OBSERVER: f64 = 2.0;

/// Which set of coefficients.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Range {
    /// Night only, under about 0.07 cd/m2: the simple form, which the star limits of the paper use.
    Night,
    /// From night to day.
    All,
}

/// Ricco's area in steradian and the threshold contrast of a very large disc, over a background in cd/m2.
fn area_and_floor(background_cd_m2: f64, range: Range) -> (f64, f64) {
    let x = background_cd_m2.powf(-0.25);
    match range {
        Range::Night => {
            let (r1, r2, k1, k2) = (6.505e-4, -8.461e-4, 7.633e-3, -7.174e-3);
            ((r1 * x + r2).powi(2), k1 * x + k2)
        }
        Range::All => {
            let (a1, a2, a3, a4, a5) = (5.949e-8, -2.389e-7, 2.459e-7, 4.120e-4, -4.225e-4);
            let (b1, b2, b3, b4, b5) = (9.606e-6, -4.112e-5, 5.019e-5, 4.837e-3, -4.884e-3);
            let area = ((a1 * x * x + a2 * x + a3).sqrt() + a4 * x + a5).powi(2);
            (area, (b1 * x * x + b2 * x + b3).sqrt() + b4 * x + b5)
        }
    }
}

/// The exponent that joins small discs to large ones.
fn joining(background_cd_m2: f64) -> f64 {
    let lg = background_cd_m2.log10();
    if background_cd_m2 < 0.193 {
        0.6
    } else if background_cd_m2 < 3.40 {
        0.8861 + 0.4 * lg
    } else {
        1.146 - 0.0885 * lg
    }
}

/// Common logarithm of the threshold contrast of a disc of `area_sr` at the eye over a background.
///
/// `field_factor` is all that makes the observer worse than Blackwell's: Crumey's F, times [`ONE_EYE`] at a telescope.
/// Backgrounds under [`DARKEST_CD_M2`] are taken as that, those above 1e4 cd/m2 as 1e4.
/// Checked against 167 values of an independent implementation: within 2e-4 dex.
#[must_use]
pub fn log10_threshold(area_sr: f64, background_cd_m2: f64, field_factor: f64, range: Range) -> f64 {
    let background = background_cd_m2.clamp(DARKEST_CD_M2, 1e4);
    let (ricco, floor) = area_and_floor(background, range);
    let q = joining(background);
    (field_factor * ((ricco / area_sr).powf(q) + floor.powf(q)).powf(1.0 / q)).log10()
}

/// Threshold illuminance of a point over a background, lux at the eye.
///
/// ```text
/// dI = F B R          = F (r1 B^(1/4) + r2 B^(1/2))^2 by night
/// ```
///
/// Crumey (2014), the same paper. Under [`DARKEST_CD_M2`] it stays at 1.150e-9 lux for F = 1.
#[must_use]
pub fn threshold_lux(background_cd_m2: f64, field_factor: f64, range: Range) -> f64 {
    let background = background_cd_m2.clamp(DARKEST_CD_M2, 1e4);
    field_factor * background * area_and_floor(background, range).0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::SurfaceBrightness;
    use std::f64::consts::PI;

    const CHECK: &str = include_str!("../../fixtures/reference/eye/crumey_check.csv");

    fn disc_sr(diameter_arcmin: f64) -> f64 {
        PI / 4.0 * (diameter_arcmin / 60.0).to_radians().powi(2)
    }

    #[test]
    fn thresholds_are_those_of_an_independent_implementation_from_night_to_day() {
        let mut compared = 0;
        for row in CHECK.lines().skip(1) {
            let cells: Vec<&str> = row.split(',').collect();
            let number = |i: usize| cells[i].parse::<f64>().unwrap();
            let background = SurfaceBrightness(number(0)).to_candela_per_m2();
            for (column, range) in [(3, Range::All), (4, Range::Night)] {
                if cells[column].is_empty() {
                    continue;
                }
                let ours = log10_threshold(disc_sr(number(2)), background, 1.0, range);
                assert!((ours - number(column)).abs() < 3e-4, "{row}: {ours}");
                compared += 1;
            }
        }
        assert!(compared > 200, "{compared}");
    }

    #[test]
    fn the_papers_own_numbers_come_out() {
        // Large discs under 21.83: C_inf; the darkest point: zeta = 1.150e-9 lux; xi1 = 1.150e-4 sr; xi2 = 0.1286.
        let (area, floor) = area_and_floor(DARKEST_CD_M2, Range::Night);
        assert!((threshold_lux(0.0, 1.0, Range::Night) / 1.150e-9 - 1.0).abs() < 1e-3);
        assert!((area / 1.150e-4 - 1.0).abs() < 1e-3, "{area}");
        assert!((floor / 0.1286 - 1.0).abs() < 1e-3, "{floor}");
    }

    #[test]
    fn the_coefficients_for_all_levels_agree_with_blackwell_by_day() {
        // Blackwell and Taylor at 3000 cd/m2: 2.72e-3 for very large discs.
        let day = 10f64.powf(log10_threshold(disc_sr(360.0), 3000.0, 1.0, Range::All));
        assert!((day / 2.72e-3).log10().abs() < 0.06, "{day}");
    }

    proptest::proptest! {
        #[test]
        fn a_larger_disc_a_brighter_sky_and_a_better_observer_need_less_contrast(
            lg_area in -8.0..-1.0f64, lg_background in -8.0..3.5f64, factor in 1.0..3.0f64,
        ) {
            let (area, background) = (10f64.powf(lg_area), 10f64.powf(lg_background));
            let here = log10_threshold(area, background, factor, Range::All);
            proptest::prop_assert!(here.is_finite());
            proptest::prop_assert!(log10_threshold(area * 1.5, background, factor, Range::All) <= here);
            proptest::prop_assert!(log10_threshold(area, background, factor * 1.1, Range::All) > here);
            if background < 0.1 {
                proptest::prop_assert!(log10_threshold(area, background * 1.5, factor, Range::All) <= here + 1e-12);
            }
        }
    }
}
