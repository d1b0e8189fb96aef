//! Roots and exponentials of many numbers at once, by sums, products and the digits of an f32: the same bits on every processor that fuses.

/// a b + c: in one step where the processor has it, which the caller knows.
#[inline(always)]
pub(super) fn fused<const FUSED: bool>(a: f32, b: f32, c: f32) -> f32 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

/// The larger of two: one instruction, where `f32::max` looks for NaN too.
#[inline(always)]
pub(super) fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// 1 / sqrt(x) for a normal x above 0, to 2e-7 of itself: half the exponent with its sign turned (Lomont 2003), then three steps of Newton's.
#[inline(always)]
pub(super) fn inverse_root<const FUSED: bool>(x: f32) -> f32 {
    let guess = f32::from_bits(0x5f37_5a86u32.wrapping_sub(x.to_bits() >> 1));
    let half = 0.5 * x;
    let step = |y: f32| y * fused::<FUSED>(-half * y, y, 1.5);
    step(step(step(guess)))
}

/// 2^x for x of 0 or less, to 3e-6 of itself; about 1e-38 below x = -126.
#[inline(always)]
pub(super) fn power_of_2<const FUSED: bool>(x: f32) -> f32 {
    /// Adding 1.5 x 2^23 leaves the nearest integer, of either sign, in the last bits of an f32.
    const MAGIC: f32 = 12_582_912.0;
    let x = larger(x, -126.0);
    let whole = x + MAGIC;
    let part = x - (whole - MAGIC);
    // The polynomial of degree 4 with the least relative error from -1/2 to 1/2 (Remez).
    let series = fused::<FUSED>(part, 0.009_570_102, 0.055_917_86);
    let series = fused::<FUSED>(part, series, 0.240_247_45);
    let series = fused::<FUSED>(part, series, 0.693_121_8);
    let series = fused::<FUSED>(part, series, 0.999_999_3);
    f32::from_bits(series.to_bits().wrapping_add(whole.to_bits().wrapping_sub(MAGIC.to_bits()) << 23))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_and_powers_are_those_of_the_library() {
        for n in -4000..4000 {
            let x = (n as f32 * 0.0101).exp2();
            let exact = 1.0 / f64::from(x).sqrt();
            for root in [inverse_root::<true>(x), inverse_root::<false>(x)] {
                assert!((f64::from(root) / exact - 1.0).abs() < 2e-7, "{x}: {root}");
            }
            let x = n.min(0) as f32 * 0.0301;
            for power in [power_of_2::<true>(x), power_of_2::<false>(x)] {
                assert!((f64::from(power) / f64::from(x).exp2() - 1.0).abs() < 3e-6, "{x}: {power}");
            }
        }
        assert!(power_of_2::<true>(-1e9) < 2e-38);
    }
}
