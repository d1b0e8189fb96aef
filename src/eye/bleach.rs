//! The pigment of the rods: bleached by light, made anew in the dark. Solved exactly, so no step size and nothing stiff.
//!
//! ```text
//! dB/dt = I (1 - B)/Q - v (1 + K) B/(B + K)
//! ```
//!
//! B is the bleached share, I the light in scotopic trolands. Lamb and Pugh (2004), Prog. Retin. Eye Res. 23, 307, as cited by
//! PMC1819465, figure 10: v = 0.09 per minute and K = 0.2. Q = 1e7 troland seconds is known to about a factor of 2.

/// Light that bleaches 63 % of the pigment, scotopic troland seconds; uncertain by 0.3 dex.
pub const BLEACHING_TD_S: f64 = 1e7;
/// The greatest rate at which pigment is made anew, a share each second.
pub const REGENERATION_PER_S: f64 = 0.09 / 60.0;
/// The bleached share at which half of that rate is reached.
pub const HALF_RATE: f64 = 0.2;

/// Rate of the term of regeneration: v (1 + K), each second.
const RATE_PER_S: f64 = REGENERATION_PER_S * (1.0 + HALF_RATE);

/// The bleached share after `seconds` under a light of `scotopic_td`, from a share `before`.
///
/// With light the equation is `(B + K) dB / (-a (B - B1)(B - B2)) = dt`, a = I/Q, B1 the steady share and B2 < 0; its integral
/// is two logarithms, and the share is found from the time by halving. In the dark it is `B + K ln B = B0 + K ln B0 - v(1+K) t`.
#[must_use]
pub fn after(before: f64, scotopic_td: f64, seconds: f64) -> f64 {
    let before = before.clamp(0.0, 1.0);
    let a = scotopic_td.max(0.0) / BLEACHING_TD_S;
    if seconds <= 0.0 {
        return before;
    }
    // So little light bleaches less than a part in 1e12 in a lifetime.
    if a < 1e-21 {
        return if before == 0.0 { 0.0 } else { in_the_dark(before, seconds) };
    }
    // Roots of a B^2 - (a (1 - K) - c) B - a K = 0, each by the form that does not cancel.
    let middle = a * (1.0 - HALF_RATE) - RATE_PER_S;
    let root = (middle * middle + 4.0 * a * a * HALF_RATE).sqrt();
    let (steady, other) = if middle < 0.0 {
        (2.0 * a * HALF_RATE / (root - middle), (middle - root) / (2.0 * a))
    } else {
        ((middle + root) / (2.0 * a), -2.0 * a * HALF_RATE / (middle + root))
    };
    let (towards, away) = ((steady + HALF_RATE) / (steady - other), (other + HALF_RATE) / (steady - other));
    let share = |y: f64| before + (steady - before) * -(-y).exp_m1();
    // Seconds until the way to the steady share has shrunk by e^-y.
    let time = |y: f64| (towards * y + away * ((share(y) - before) / (before - other)).ln_1p()) / a;
    let (mut low, mut high) = (0.0, 1.0);
    while time(high) < seconds && high < 800.0 {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..80 {
        let y = 0.5 * (low + high);
        if time(y) < seconds { low = y } else { high = y }
    }
    share(high).clamp(0.0, 1.0)
}

/// The bleached share after so many seconds in the dark.
fn in_the_dark(before: f64, seconds: f64) -> f64 {
    // In u = ln B the left side, e^u + K u, grows everywhere: Newton's steps from above never overshoot.
    let wanted = before + HALF_RATE * before.ln() - RATE_PER_S * seconds;
    let mut u = before.ln();
    for _ in 0..60 {
        let step = (u.exp() + HALF_RATE * u - wanted) / (u.exp() + HALF_RATE);
        u -= step;
        if step.abs() < 1e-15 {
            break;
        }
    }
    u.exp()
}

/// Seconds in the dark until a bleached share has fallen to another.
///
/// ```text
/// t = ((B - B_t) + K ln(B / B_t)) / (v (1 + K))
/// ```
#[must_use]
pub fn seconds_to(bleached: f64, target: f64) -> f64 {
    if bleached <= target { 0.0 } else { ((bleached - target) + HALF_RATE * (bleached / target).ln()) / RATE_PER_S }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The equation in small steps: slow, and shares nothing with the solution.
    fn in_steps(before: f64, td: f64, seconds: f64) -> f64 {
        let rate = |b: f64| td / 1e7 * (1.0 - b) - 0.0015 * 1.2 * b / (b + 0.2);
        let steps = 20_000;
        let h = seconds / f64::from(steps);
        (0..steps).fold(before, |b, _| {
            let k1 = rate(b);
            let k2 = rate(b + h / 2.0 * k1);
            let k3 = rate(b + h / 2.0 * k2);
            let k4 = rate(b + h * k3);
            b + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
        })
    }

    #[test]
    fn the_closed_form_is_what_small_steps_give() {
        for before in [0.0, 1e-4, 0.3, 0.99] {
            for td in [0.0, 1e-3, 1.0, 483.0, 2e4, 1e6] {
                for seconds in [1.0, 60.0, 900.0] {
                    let (exact, stepped) = (after(before, td, seconds), in_steps(before, td, seconds));
                    assert!(
                        (exact - stepped).abs() < 1e-9 * stepped.max(1e-9) + 1e-12,
                        "{before} {td} {seconds}: {exact} {stepped}"
                    );
                }
            }
        }
    }

    #[test]
    fn extreme_lights_and_times_stay_shares() {
        for td in [0.0, 1e-300, 1e-20, 1e-12, 1e8, 1e300] {
            for seconds in [0.0, 1e-6, 1e9] {
                for before in [0.0, 1e-300, 0.5, 1.0] {
                    let bleached = after(before, td, seconds);
                    assert!((0.0..=1.0).contains(&bleached), "{td} {seconds} {before}: {bleached}");
                }
            }
        }
        assert!((after(0.0, 1e300, 1.0) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn the_way_back_takes_as_long_as_it_is_said_to() {
        for bleached in [1e-5, 0.01, 0.5, 1.0] {
            let target = bleached / 7.0;
            let seconds = seconds_to(bleached, target);
            assert!((after(bleached, 0.0, seconds) / target - 1.0).abs() < 1e-9);
        }
        assert_eq!(seconds_to(0.1, 0.2), 0.0);
    }

    #[test]
    fn a_small_bleach_fades_by_0_234_powers_of_ten_a_minute() {
        // v (1 + K)/K = 0.54 a minute: the S2 slope that the literature puts at 0.24.
        let slope = (after(1e-6, 0.0, 60.0) / 1e-6).log10();
        assert!((slope + 0.2345).abs() < 1e-3, "{slope}");
    }
}
