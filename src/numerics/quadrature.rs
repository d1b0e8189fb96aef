//! Integrals by Gauss and Kronrod, several at once, each panel with its error.

/// Nodes (positive half, outermost first) and weights of a rule of Kronrod; every second node, counted from the second,
/// is Gauss'.
struct Rule<const N: usize> {
    nodes: [f64; N],
    kronrod: [f64; N],
    gauss: [f64; N],
}

/// 7 points of Kronrod over 3 of Gauss.
const SHORT: Rule<4> = Rule {
    nodes: [0.960_491_268_708_020_3, 0.774_596_669_241_483_4, 0.434_243_749_346_802_56, 0.0],
    kronrod: [0.104_656_226_026_467_27, 0.268_488_089_868_333_44, 0.401_397_414_775_962_2, 0.450_916_538_658_474_14],
    gauss: [0.0, 0.555_555_555_555_555_6, 0.0, 0.888_888_888_888_889],
};

/// 15 points of Kronrod over 7 of Gauss. Source: QUADPACK (Piessens et al. 1983), routine QK15.
const LONG: Rule<8> = Rule {
    nodes: [
        0.991_455_371_120_812_6,
        0.949_107_912_342_758_5,
        0.864_864_423_359_769_1,
        0.741_531_185_599_394_4,
        0.586_087_235_467_691_1,
        0.405_845_151_377_397_2,
        0.207_784_955_007_898_47,
        0.0,
    ],
    kronrod: [
        0.022_935_322_010_529_224,
        0.063_092_092_629_978_55,
        0.104_790_010_322_250_18,
        0.140_653_259_715_525_92,
        0.169_004_726_639_267_9,
        0.190_350_578_064_785_4,
        0.204_432_940_075_298_9,
        0.209_482_141_084_727_82,
    ],
    gauss: [
        0.0,
        0.129_484_966_168_869_7,
        0.0,
        0.279_705_391_489_276_64,
        0.0,
        0.381_830_050_505_118_9,
        0.0,
        0.417_959_183_673_469_4,
    ],
};

/// How fine a panel is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Points {
    /// For a panel over which the integrand hardly changes.
    Seven,
    /// For any other.
    Fifteen,
}

/// Integrals over one panel, each with an estimate of its error.
///
/// The estimate is QUADPACK's: the difference d between Kronrod's and Gauss' values, sharpened by how much of the integrand
/// it is.
///
/// ```text
/// error = A min(1, (200 d/A)^1.5)          A = ∫ |f - mean|
/// ```
#[must_use]
#[inline]
pub fn panel<const K: usize>(
    points: Points,
    from: f64,
    to: f64,
    f: impl FnMut(f64) -> [f64; K],
) -> ([f64; K], [f64; K]) {
    match points {
        Points::Seven => apply(&SHORT, from, to, f),
        Points::Fifteen => apply(&LONG, from, to, f),
    }
}

#[inline]
fn apply<const N: usize, const K: usize>(
    rule: &Rule<N>,
    from: f64,
    to: f64,
    mut f: impl FnMut(f64) -> [f64; K],
) -> ([f64; K], [f64; K]) {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut below = [[0.0; K]; N];
    let mut above = [[0.0; K]; N];
    let centre = f(middle);
    for i in 0..N - 1 {
        below[i] = f(middle - half * rule.nodes[i]);
        above[i] = f(middle + half * rule.nodes[i]);
    }
    let (mut value, mut error) = ([0.0; K], [0.0; K]);
    for k in 0..K {
        let (mut kronrod, mut gauss) = (rule.kronrod[N - 1] * centre[k], rule.gauss[N - 1] * centre[k]);
        for i in 0..N - 1 {
            let pair = below[i][k] + above[i][k];
            kronrod += rule.kronrod[i] * pair;
            gauss += rule.gauss[i] * pair;
        }
        let mean = 0.5 * kronrod;
        let mut spread = rule.kronrod[N - 1] * (centre[k] - mean).abs();
        for i in 0..N - 1 {
            spread += rule.kronrod[i] * ((below[i][k] - mean).abs() + (above[i][k] - mean).abs());
        }
        let (difference, spread) = (((kronrod - gauss) * half).abs(), spread * half.abs());
        value[k] = kronrod * half;
        let share = 200.0 * difference / spread;
        error[k] = if share < 1.0 { spread * share * share.sqrt() } else { difference };
    }
    (value, error)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kronrods_rules_are_exact_for_polynomials_of_their_degree() {
        for (points, degree) in [(Points::Seven, 10), (Points::Fifteen, 22)] {
            for power in 0..=degree {
                let ([got], _) = panel(points, 0.0, 2.0, |x| [x.powi(power)]);
                let truth = 2f64.powi(power + 1) / f64::from(power + 1);
                assert!((got / truth - 1.0).abs() < 1e-13, "{points:?}, power {power}: {got} {truth}");
            }
        }
    }

    #[test]
    fn the_error_is_not_below_the_truth_for_a_peak() {
        let truth = 2.0 * 5f64.atan() / 5.0;
        for points in [Points::Seven, Points::Fifteen] {
            let ([got], [error]) = panel(points, -1.0, 1.0, |x| [1.0 / (1.0 + 25.0 * x * x)]);
            assert!((got - truth).abs() <= error && error < 0.4, "{points:?}: {} {error}", (got - truth).abs());
        }
    }

    #[test]
    fn several_integrals_go_together() {
        let (values, _) = panel(Points::Fifteen, 0.0, 1.0, |x: f64| [x.exp(), x.cos()]);
        assert!((values[0] - 1f64.exp_m1()).abs() < 1e-15 && (values[1] - 1f64.sin()).abs() < 1e-15);
    }
}
