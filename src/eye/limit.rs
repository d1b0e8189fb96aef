//! The faintest star that can be seen, with the naked eye and through a telescope.

use super::Viewing;
use super::crumey::{Range, threshold_lux};
use crate::units::{Magnitude, SurfaceBrightness};

/// Above this background at the eye, cd/m2, the night form of Crumey's threshold does not hold.
pub const NIGHT_CD_M2: f64 = 0.07;

/// The faintest star through a telescope.
///
/// ```text
/// B_a = T (min(d, p) / p)^2 B                               background at the eye, cd/m2
/// dI  = (max(d, p) / D)^2 phi (r1 B_a^(1/4) + r2 B_a^(1/2))^2 / T    threshold at the aperture, lux
/// m   = -2.5 log10(dI) - 13.99
/// ```
///
/// Crumey (2014), MNRAS 442, 2600, with the night's coefficients; above [`NIGHT_CD_M2`] at the eye those for all levels.
/// Checked against 68 values for 100, 200 and 254 mm under skies of 18.5 to 22: within half of the last printed digit
/// (0.0005 mag; the table's light loss is F_t = 1.33).
#[must_use]
pub fn through_telescope(viewing: &Viewing, sky: SurfaceBrightness) -> Magnitude {
    let background = viewing.background_cd_m2(sky);
    let range = if background < NIGHT_CD_M2 { Range::Night } else { Range::All };
    let collected = (viewing.exit_pupil_mm().max(viewing.pupil_mm) / viewing.aperture_mm).powi(2);
    of_lux(collected / viewing.transmission * threshold_lux(background, viewing.field_factor, range))
}

/// The faintest star to the naked eye under a sky: Crumey (2014) with his field factor F, both eyes.
///
/// Checked: 6.933 under 21.83 for F = 1, 6.181 for F = 2, and skies of 16 to 22.5 within 0.0005.
#[must_use]
pub fn naked_eye(sky: SurfaceBrightness, field_factor: f64) -> Magnitude {
    let background = sky.to_candela_per_m2();
    let range = if background < NIGHT_CD_M2 { Range::Night } else { Range::All };
    of_lux(threshold_lux(background, field_factor, range))
}

/// The V magnitude of a star that gives so many lux: Crumey's zero point.
fn of_lux(lux: f64) -> Magnitude {
    Magnitude(-2.5 * lux.log10() - 13.99)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_through_three_telescopes_are_the_tables_to_the_last_printed_digit() {
        let text = include_str!("../../fixtures/reference/eye/crumey_telescope_limit.csv");
        let mut compared = 0;
        for row in text.lines().skip(1) {
            let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
            let viewing = Viewing::typical(cells[0], cells[2]);
            let limit = through_telescope(&viewing, SurfaceBrightness(cells[1])).0;
            assert!((limit - cells[6]).abs() < 6e-4, "{row}: {limit}");
            compared += 1;
        }
        assert!(compared >= 60);
    }

    #[test]
    fn the_naked_eye_sees_what_the_paper_says() {
        for (sky, factor, published) in [(21.83, 1.0, 6.933), (21.83, 2.0, 6.181)] {
            assert!((naked_eye(SurfaceBrightness(sky), factor).0 - published).abs() < 6e-4);
        }
        let text = include_str!("../../fixtures/reference/eye/sqm_conversion.csv");
        for row in text.lines().skip(1) {
            let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
            assert!((naked_eye(SurfaceBrightness(cells[0]), 2.0).0 - cells[5]).abs() < 6e-4, "{row}");
        }
    }

    #[test]
    fn a_city_sky_and_the_darkest_one_give_sane_limits() {
        let viewing = Viewing::typical(254.0, 104.0);
        let limits: Vec<f64> = [10.0, 16.0, 18.5, 21.5, 22.2]
            .iter()
            .map(|sky| through_telescope(&viewing, SurfaceBrightness(*sky)).0)
            .collect();
        assert!(limits.windows(2).all(|pair| pair[1] > pair[0]), "{limits:?}");
        assert!(limits.iter().all(|limit| (5.0..16.0).contains(limit)), "{limits:?}");
    }
}
