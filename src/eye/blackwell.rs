//! Blackwell's threshold contrasts as Clark tabulates them: the second opinion on an object.
//!
//! Blackwell (1946), J. Opt. Soc. Am. 36, 624: half of the observers' looks find the disc, looking time unlimited; as
//! carried by Clark, *Visual Astronomy of the Deep Sky* (1990), appendix F, and by Bartels' "Optimum Detection Magnification"
//! (ODM), whose numbers these are. **Outside the table the nearest edge is taken, and told**: programs that extend it as a
//! straight line are wrong by up to 1.5 dex (M31 at 500 times).

/// Diameters of the discs at the eye, arcminutes.
const DIAMETERS_ARCMIN: [f64; 7] = [0.595, 3.60, 9.68, 18.2, 55.2, 121.0, 360.0];

/// The first row's background, magnitudes per square arcsecond; each row is one magnitude darker.
const BRIGHTEST: f64 = 4.0;

/// Common logarithm of the threshold contrast: a row for each background, a column for each diameter.
#[rustfmt::skip]
const LOG10_THRESHOLD: [[f64; 7]; 24] = [
    [-0.3769, -1.8064, -2.3368, -2.4601, -2.5469, -2.561, -2.566],
    [-0.3315, -1.7747, -2.3337, -2.4608, -2.5465, -2.5607, -2.5658],
    [-0.2682, -1.7345, -2.331, -2.4605, -2.5467, -2.5608, -2.5658],
    [-0.1982, -1.6851, -2.314, -2.4572, -2.5481, -2.5615, -2.5665],
    [-0.1238, -1.6252, -2.2791, -2.4462, -2.5463, -2.5597, -2.5646],
    [-0.0424, -1.5529, -2.2297, -2.4214, -2.5343, -2.5501, -2.5552],
    [0.0498, -1.4655, -2.1659, -2.3763, -2.5047, -2.5269, -2.5333],
    [0.1596, -1.3581, -2.081, -2.3036, -2.4499, -2.4823, -2.4937],
    [0.2934, -1.2256, -1.9674, -2.1965, -2.3631, -2.4092, -2.4318],
    [0.4557, -1.0673, -1.8186, -2.0531, -2.2445, -2.3083, -2.3491],
    [0.65, -0.8841, -1.6292, -1.8741, -2.0989, -2.1848, -2.2505],
    [0.8808, -0.6687, -1.3967, -1.6611, -1.9284, -2.0411, -2.1375],
    [1.1558, -0.3952, -1.1264, -1.4176, -1.73, -1.8727, -2.0034],
    [1.4822, -0.0419, -0.8243, -1.1475, -1.5021, -1.6768, -1.842],
    [1.8559, 0.3458, -0.4924, -0.8561, -1.2661, -1.4721, -1.6624],
    [2.2669, 0.696, -0.1315, -0.551, -1.0562, -1.2892, -1.4827],
    [2.676, 1.088, 0.206, -0.321, -0.88, -1.137, -1.362],
    [2.7766, 1.2065, 0.3467, -0.1377, -0.7361, -0.9964, -1.2439],
    [2.9304, 1.3821, 0.5353, 0.0328, -0.5605, -0.8606, -1.1187],
    [3.1634, 1.6107, 0.7708, 0.2531, -0.3895, -0.703, -0.9681],
    [3.4643, 1.9034, 1.0338, 0.4943, -0.2033, -0.5259, -0.8288],
    [3.8211, 2.2564, 1.3265, 0.7605, 0.0172, -0.2992, -0.6394],
    [4.221, 2.632, 1.699, 1.132, 0.286, -0.051, -0.408],
    [4.61, 3.066, 2.132, 1.585, 0.652, 0.241, -0.121],
];

/// A threshold from the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Threshold {
    /// Common logarithm of the threshold contrast.
    pub log10: f64,
    /// Whether size or background lay outside the table, so that its edge was taken.
    pub clamped: bool,
}

/// The threshold contrast of a disc of `diameter_arcmin` at the eye over a background at the eye, in magnitudes per square
/// arcsecond; linear between the table's rows, and between its columns in the diameter's logarithm.
#[must_use]
pub fn threshold(diameter_arcmin: f64, background_mag_arcsec2: f64) -> Threshold {
    let (column, along, outside) = place(diameter_arcmin);
    let last = (LOG10_THRESHOLD.len() - 1) as f64;
    let wanted = background_mag_arcsec2 - BRIGHTEST;
    let row = wanted.clamp(0.0, last);
    let above = (row.floor() as usize).min(LOG10_THRESHOLD.len() - 2);
    let down = row - above as f64;
    let across = |row: &[f64; 7]| row[column] * (1.0 - along) + row[column + 1] * along;
    Threshold {
        log10: across(&LOG10_THRESHOLD[above]) * (1.0 - down) + across(&LOG10_THRESHOLD[above + 1]) * down,
        clamped: outside || wanted != row,
    }
}

/// The column at or before a diameter, the share of the way to the next, and whether it lies outside the table.
fn place(diameter_arcmin: f64) -> (usize, f64, bool) {
    let (first, last) = (DIAMETERS_ARCMIN[0], DIAMETERS_ARCMIN[DIAMETERS_ARCMIN.len() - 1]);
    let inside = diameter_arcmin.clamp(first, last);
    let column =
        DIAMETERS_ARCMIN.partition_point(|diameter| *diameter <= inside).clamp(1, DIAMETERS_ARCMIN.len() - 1) - 1;
    let (low, high) = (DIAMETERS_ARCMIN[column], DIAMETERS_ARCMIN[column + 1]);
    (column, (inside / low).ln() / (high / low).ln(), inside != diameter_arcmin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tables_own_rows_and_columns_are_given_back() {
        for (row, thresholds) in LOG10_THRESHOLD.iter().enumerate() {
            for (diameter, printed) in DIAMETERS_ARCMIN.iter().zip(thresholds) {
                let found = threshold(*diameter, row as f64 + 4.0);
                assert!((found.log10 - printed).abs() < 1e-9 && !found.clamped, "{row} {diameter}: {found:?}");
            }
        }
    }

    #[test]
    fn the_table_is_the_one_in_the_reference() {
        let text = include_str!("../../fixtures/reference/eye/blackwell_ltc.csv");
        for (row, ours) in text.lines().skip(1).zip(&LOG10_THRESHOLD) {
            let printed: Vec<f64> = row.split(',').skip(2).map(|cell| cell.parse().unwrap()).collect();
            assert_eq!(printed, ours);
        }
    }

    #[test]
    fn outside_the_table_its_edge_is_taken_and_told() {
        let edge = threshold(360.0, 27.0);
        for (diameter, background) in [(361.0, 27.0), (360.0, 27.7), (1e9, 99.0)] {
            assert_eq!(threshold(diameter, background), Threshold { log10: edge.log10, clamped: true });
        }
        assert_eq!(threshold(0.01, 3.0).log10, LOG10_THRESHOLD[0][0]);
        assert!(threshold(0.01, 3.0).clamped);
    }
}
