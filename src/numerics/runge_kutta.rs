//! One step of Dormand and Prince's pair of orders 5 and 4.

/// Butcher's tableau: one row a stage, the last is the solution of order 5.
///
/// Source: Dormand & Prince (1980), J. Comput. Appl. Math. 6, 19, table 2 (RK5(4)7M).
const A: [[f64; 6]; 6] = [
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19_372.0 / 6561.0, -25_360.0 / 2187.0, 64_448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46_732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18_656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];

/// Weights of the difference between the solutions of order 5 and 4.
const E: [f64; 7] =
    [71.0 / 57_600.0, 0.0, -71.0 / 16_695.0, 71.0 / 1920.0, -17_253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];

/// What one step gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step<const D: usize> {
    /// The solution of order 5 at the end.
    pub state: [f64; D],
    /// Its slope there, which the next step begins with.
    pub slope: [f64; D],
    /// The difference to the solution of order 4.
    pub error: [f64; D],
}

/// Steps a system y' = f(y) from a state, whose slope is known, by a length. It asks for the slope six times.
#[must_use]
#[inline]
pub fn step<const D: usize>(
    state: &[f64; D],
    slope: &[f64; D],
    length: f64,
    mut f: impl FnMut(&[f64; D]) -> [f64; D],
) -> Step<D> {
    let mut slopes = [*slope; 7];
    let mut end = *state;
    for (stage, row) in A.iter().enumerate() {
        for i in 0..D {
            let mut sum = 0.0;
            for (weight, slope) in row.iter().zip(&slopes).take(stage + 1) {
                sum += weight * slope[i];
            }
            end[i] = state[i] + length * sum;
        }
        slopes[stage + 1] = f(&end);
    }
    let mut error = [0.0; D];
    for (weight, slope) in E.iter().zip(&slopes) {
        for i in 0..D {
            error[i] += length * weight * slope[i];
        }
    }
    Step { state: end, slope: slopes[6], error }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Halving the step makes the error of one step 2⁶ times smaller, and its estimate 2⁵ times.
    #[test]
    fn the_step_has_order_five_and_its_estimate_order_four() {
        let oscillator = |y: &[f64; 2]| [y[1], -y[0]];
        let start = [1.0, 0.0];
        let [long, short] = [0.2, 0.1].map(|h: f64| {
            let step = step(&start, &oscillator(&start), h, oscillator);
            ((step.state[0] - h.cos()).hypot(step.state[1] + h.sin()), step.error[0].hypot(step.error[1]))
        });
        assert!((long.0 / short.0).log2() > 5.7 && (long.1 / short.1).log2() > 4.7, "{long:?} {short:?}");
        assert!(long.0 < long.1);
    }
}
