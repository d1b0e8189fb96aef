//! How much more light a rod or cone needs while the field is lit: threshold against luminance.

/// Threshold of the rods over a field of a scotopic luminance, both in cd/m2.
///
/// ```text
/// lg T = -2.86                                 lg L <= -3.94
///      = (0.405 lg L + 1.6)^2.18 - 2.86
///      = lg L - 0.395                          lg L >= -1.44
/// ```
///
/// Ferwerda, Pattanaik, Shirley and Greenberg (1996), Proc. SIGGRAPH 249. Checked against 19 values of the table.
#[must_use]
pub fn rod_threshold_cd_m2(scotopic_cd_m2: f64) -> f64 {
    let lg = scotopic_cd_m2.max(1e-30).log10();
    10f64.powf(if lg <= -3.94 {
        -2.86
    } else if lg >= -1.44 {
        lg - 0.395
    } else {
        (0.405 * lg + 1.6).powf(2.18) - 2.86
    })
}

/// Threshold of the cones over a field of a photopic luminance, both in cd/m2.
///
/// ```text
/// lg T = -0.72                                 lg L <= -2.6
///      = (0.249 lg L + 0.65)^2.7 - 0.72
///      = lg L - 1.255                          lg L >= 1.9
/// ```
///
/// The same source.
#[must_use]
pub fn cone_threshold_cd_m2(photopic_cd_m2: f64) -> f64 {
    let lg = photopic_cd_m2.max(1e-30).log10();
    10f64.powf(if lg <= -2.6 {
        -0.72
    } else if lg >= 1.9 {
        lg - 1.255
    } else {
        (0.249 * lg + 0.65).powf(2.7) - 0.72
    })
}

/// By how many powers of ten a lit field raises the rods' threshold over that of a dark one.
#[must_use]
pub fn rod_elevation_dex(scotopic_cd_m2: f64) -> f64 {
    (rod_threshold_cd_m2(scotopic_cd_m2) / rod_threshold_cd_m2(0.0)).log10()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_are_those_of_the_published_curves() {
        let text = include_str!("../../fixtures/reference/eye/tvi_check.csv");
        for row in text.lines().skip(1) {
            let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
            // The table prints its luminances with five digits.
            assert!((rod_threshold_cd_m2(cells[0]) / cells[1] - 1.0).abs() < 1e-3, "{row}");
            assert!((cone_threshold_cd_m2(cells[0]) / cells[2] - 1.0).abs() < 1e-3, "{row}");
            assert!((rod_elevation_dex(cells[0]) - cells[3]).abs() < 6e-4, "{row}");
        }
    }
}
