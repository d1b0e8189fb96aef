//! Tumblin and Rushmeier's operator of 1993.

use std::f64::consts::PI;

/// Lambert for each cd/m2.
const LAMBERT: f64 = PI * 1e-4;

/// Exponent of Stevens' law for an eye adapted to a luminance in cd/m2.
pub(super) fn alpha(adaptation_cd_m2: f64) -> f64 {
    0.4 * (LAMBERT * adaptation_cd_m2).log10() + 2.92
}

/// Its other constant.
pub(super) fn beta(adaptation_cd_m2: f64) -> f64 {
    let lg = (LAMBERT * adaptation_cd_m2).log10();
    -0.4 * lg * lg - 2.584 * lg + 2.0208
}

/// The luminance to display.
///
/// ```text
/// L_d = 10^((beta_w - beta_d) / alpha_d) L^(alpha_w / alpha_d)          in lambert
/// alpha = 0.4 lg L_a + 2.92,  beta = -0.4 lg^2 L_a - 2.584 lg L_a + 2.0208
/// ```
///
/// Tumblin and Rushmeier (1993), IEEE CG&A 13(6), 42. alpha is 0 at 1.6e-4 cd/m2: hand in no less than 0.01.
pub(super) fn display(world_cd_m2: f64, display_cd_m2: f64, luminance_cd_m2: f64) -> f64 {
    let (world, shown) = (alpha(world_cd_m2), alpha(display_cd_m2));
    let scale = 10f64.powf((beta(world_cd_m2) - beta(display_cd_m2)) / shown);
    scale * (LAMBERT * luminance_cd_m2).powf(world / shown) / LAMBERT
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_constants_are_those_of_the_table() {
        let text = include_str!("../../../fixtures/reference/eye/tumblin_rushmeier_check.csv");
        for row in text.lines().skip(1) {
            let cells: Vec<&str> = row.split(',').collect();
            let n = |i: usize| cells[i].parse::<f64>().unwrap();
            for (ours, theirs) in [(alpha(n(0)), n(3)), (beta(n(0)), n(4)), (alpha(n(1)), n(5)), (beta(n(1)), n(6))] {
                assert!((ours - theirs).abs() < 6e-6, "{row}: {ours} {theirs}");
            }
        }
    }
}
