//! Where a function of one variable is zero.

/// A zero between two places at which the function has opposite signs (or is zero).
///
/// The Illinois form of false position, with a bisection whenever it gains too little; it ends when the bracket cannot be
/// halved any more, or is narrower than `width`.
#[must_use]
pub fn bracketed(mut low: f64, mut high: f64, width: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
    let (mut at_low, mut at_high) = (f(low), f(high));
    if at_low == 0.0 {
        return low;
    }
    for round in 0..200 {
        if at_high == 0.0 || (high - low).abs() <= width {
            return high;
        }
        let secant = high - at_high * (high - low) / (at_high - at_low);
        let middle = 0.5 * (low + high);
        let inside = (secant - low) * (secant - high) < 0.0;
        let x = if inside && round % 4 != 3 { secant } else { middle };
        let at = f(x);
        if (at < 0.0) == (at_high < 0.0) && at != 0.0 {
            at_low *= 0.5;
        } else {
            (low, at_low) = (high, at_high);
        }
        if x == high {
            return x;
        }
        (high, at_high) = (x, at);
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_found_to_the_last_digits() {
        assert!((bracketed(0.0, 2.0, 0.0, |x| x * x - 2.0) - 2f64.sqrt()).abs() < 4e-16);
        assert!((bracketed(0.0, 3.0, 0.0, f64::cos) - std::f64::consts::FRAC_PI_2).abs() < 4e-16);
        assert_eq!(bracketed(1.0, 5.0, 0.0, |x| x - 1.0), 1.0);
        assert_eq!(bracketed(1.0, 5.0, 0.0, |x| x - 5.0), 5.0);
        // A step: only halving helps.
        assert!((bracketed(-1.0, 7.0, 1e-12, |x| if x < 0.3 { -1.0 } else { 1e9 }) - 0.3).abs() < 1e-11);
    }
}
