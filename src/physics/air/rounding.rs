//! Rounding the kinks of a profile: convolution with a Gaussian, sampled finely where it matters.

use super::profile::{ProfileError, Row};

/// Samples a standard deviation: a row each eighth of it.
const SAMPLES: f64 = 8.0;

/// How far a kink is felt, in standard deviations.
const REACH: f64 = 6.0;

/// Rows whose temperature kinks are rounded by a Gaussian of a standard deviation (metres).
///
/// ```text
/// T(z) = T_lines(z) + Σ ΔΓ_i [ s φ(u_i) - |z - z_i| Φ(-|u_i|) ]          u_i = (z - z_i)/s
/// ```
///
/// which is the convolution of the straight pieces with the Gaussian in closed form: at a kink ΔΓ the rounded curve lies
/// ΔΓ s/√(2π) beside the corner. Humidity keeps its straight pieces. Kinks nearer than six deviations to the ground feel
/// the lowest gradient running on below it.
///
/// # Errors
/// The width is negative, too wide or not a number.
pub fn rounded(rows: &[Row], deviation_m: f64) -> Result<Vec<Row>, ProfileError> {
    if !(0.0..=1000.0).contains(&deviation_m) {
        return Err(ProfileError::Rounding(deviation_m));
    }
    if deviation_m == 0.0 || rows.len() < 3 {
        return Ok(rows.to_vec());
    }
    let gradients: Vec<f64> = rows.windows(2).map(|w| slope(&w[0], &w[1])).collect();
    // Far kinks of the standard kind (tropopause and above) stay sharp: only kinks below 5 km shape mirages.
    let kinks: Vec<(f64, f64)> = (1..rows.len() - 1)
        .map(|i| (rows[i].height_m, gradients[i] - gradients[i - 1]))
        .filter(|kink| kink.0 < 5000.0)
        .collect();
    let mut heights: Vec<f64> = rows.iter().map(|row| row.height_m).collect();
    for &(at, _) in &kinks {
        let steps = (REACH * SAMPLES) as i32;
        heights.extend((-steps..=steps).map(|i| at + f64::from(i) * deviation_m / SAMPLES));
    }
    heights.retain(|z| (rows[0].height_m..=rows[rows.len() - 1].height_m).contains(z));
    heights.sort_by(f64::total_cmp);
    heights.dedup_by(|a, b| (*a - *b).abs() < 1e-6 * deviation_m);
    Ok(heights
        .into_iter()
        .map(|height_m| {
            let mut row = line(rows, height_m);
            row.temperature_k +=
                kinks.iter().map(|&(at, change)| change * bend(height_m - at, deviation_m)).sum::<f64>();
            row
        })
        .collect())
}

fn slope(a: &Row, b: &Row) -> f64 {
    (b.temperature_k - a.temperature_k) / (b.height_m - a.height_m)
}

/// The straight pieces at a height.
fn line(rows: &[Row], height_m: f64) -> Row {
    let above = rows.partition_point(|row| row.height_m <= height_m).clamp(1, rows.len() - 1);
    let (a, b) = (&rows[above - 1], &rows[above]);
    let share = (height_m - a.height_m) / (b.height_m - a.height_m);
    Row {
        height_m,
        temperature_k: a.temperature_k + share * (b.temperature_k - a.temperature_k),
        humidity_percent: a.humidity_percent + share * (b.humidity_percent - a.humidity_percent),
    }
}

/// How far a unit kink, rounded, lies above the corner.
fn bend(distance_m: f64, deviation_m: f64) -> f64 {
    let u = (distance_m / deviation_m).abs();
    let density = (-0.5 * u * u).exp() / std::f64::consts::TAU.sqrt();
    deviation_m * (density - u * upper_tail(u))
}

/// Probability that a normal deviate exceeds u >= 0.
///
/// ```text
/// Φ(-u) = φ(u) (b1 t + b2 t² + ... + b5 t⁵),   t = 1/(1 + 0.2316419 u),   |error| < 7.5e-8
/// ```
///
/// Source: Abramowitz & Stegun (1964), eq. 26.2.17.
fn upper_tail(u: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.231_641_9 * u);
    let series =
        t * (0.319_381_530 + t * (-0.356_563_782 + t * (1.781_477_937 + t * (-1.821_255_978 + t * 1.330_274_429))));
    (-0.5 * u * u).exp() / std::f64::consts::TAU.sqrt() * series
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner() -> Vec<Row> {
        [(0.0, 287.35), (30.0, 287.155), (50.0, 287.825), (11_000.0, 216.65)]
            .map(|(height_m, temperature_k)| Row { height_m, temperature_k, humidity_percent: 0.0 })
            .to_vec()
    }

    /// The weak mock mirage of A. T. Young's pages, rounded by a 2 m Gaussian in somebody else's program.
    #[test]
    fn the_weak_mock_mirage_is_rounded_as_in_the_reference() {
        let rows = rounded(&corner(), 2.0).unwrap();
        let table = include_str!("../../../fixtures/reference/profiles.csv");
        let mut checked = 0;
        for line_text in table.lines().filter(|l| l.starts_with("young")) {
            let fields: Vec<f64> = line_text.split(',').skip(1).map(|f| f.parse().unwrap()).collect();
            if fields[0] < 70.0 {
                let got = line(&rows, fields[0]).temperature_k;
                assert!((got - fields[1]).abs() < 2e-5, "{line_text}: {got}");
                checked += 1;
            }
        }
        assert!(checked > 150);
    }

    #[test]
    fn no_rounding_changes_nothing_and_nonsense_is_refused() {
        assert_eq!(rounded(&corner(), 0.0), Ok(corner()));
        for width in [-1.0, f64::NAN, 1e9] {
            assert!(matches!(rounded(&corner(), width), Err(ProfileError::Rounding(_))), "{width}");
        }
    }
}
