//! The share of light that passes a sphere without meeting a grain, in closed form.

use super::Source;

/// Below this depth along a diameter the closed form loses digits, and the series has few terms.
const THIN: f64 = 1.0;

/// The share that a parallel beam loses, x the depth along a diameter:
///
/// ```text
/// 1 - f0 = 1 - (2 / x^2) (1 - (1 + x) e^-x) = 2x/3 - x^2/4 + x^3/15 - ... = -sum over k >= 1 of 2 (-x)^k / (k! (k + 2))
/// ```
#[must_use]
pub fn beam_met(x: f64) -> f64 {
    if x > THIN {
        // exp(-x) is 0 from 746 on, and its product with x too.
        return 1.0 - 2.0 / (x * x) * (1.0 - (1.0 + x) * (-x).exp());
    }
    let (mut power, mut sum) = (1.0, 0.0);
    for k in 1..=24 {
        let k = f64::from(k);
        power *= -x / k;
        sum -= 2.0 * power / (k + 2.0);
    }
    sum
}

/// The share that leaves without having met a grain; the depth is along a radius.
///
/// A source in all of the sphere is the beam's counterpart (Osterbrock 1974, appendix 2): `3 (1 - f0) / (4 t)`.
#[must_use]
pub fn unscattered(source: Source, depth: f64) -> f64 {
    match source {
        Source::Beam => 1.0 - beam_met(2.0 * depth),
        Source::Pencil => (-2.0 * depth).exp(),
        Source::Centre => (-depth).exp(),
        Source::Uniform if depth == 0.0 => 1.0,
        Source::Uniform => 0.75 * beam_met(2.0 * depth) / depth,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns: depth, beam, beam met, centre, uniform source.
    const REFERENCE: &str = include_str!("../../../../fixtures/reference/sphere_closed_form.csv");

    #[test]
    fn closed_forms_are_those_of_the_reference_from_depth_1e_6_to_1e3() {
        let mut rows = 0;
        for line in REFERENCE.lines().skip(1) {
            let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let near = |value: f64, reference: f64| (value - reference).abs() <= 2e-9 * reference.abs();
            assert!(near(unscattered(Source::Beam, row[0]), row[1]), "{line}");
            assert!(near(beam_met(2.0 * row[0]), row[2]), "{line}");
            assert!(near(unscattered(Source::Centre, row[0]), row[3]), "{line}");
            assert!(near(unscattered(Source::Uniform, row[0]), row[4]), "{line}");
            rows += 1;
        }
        assert_eq!(rows, 17);
    }

    #[test]
    fn series_and_closed_form_meet() {
        assert!((beam_met(THIN) - beam_met(THIN * (1.0 + 1e-15))).abs() < 1e-15);
        assert_eq!((unscattered(Source::Uniform, 0.0), unscattered(Source::Beam, 0.0)), (1.0, 1.0));
    }
}
