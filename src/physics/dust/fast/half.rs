//! Numbers of 16 bits (IEEE 754 binary16) for what each voxel sends to the eye: half the bytes to write and to fetch in each frame.
//!
//! A number in their normal range, 6e-5 to 65504, is off by a 4096th at most, smaller ones by 3e-8. What is kept in them is brought into
//! that range by a power of two, see [`power_of_two`], so that the same light has the same digits at any scale.

/// Largest number.
pub(super) const MOST: f32 = 65504.0;

/// 2^112, by which the two formats' exponents differ.
const UP: f32 = f32::from_bits((127 + 112) << 23);

/// The nearest number of 16 bits to one that is not negative; larger than [`MOST`] becomes that.
#[inline(always)]
pub(super) fn half(x: f32) -> u16 {
    let x = if x < MOST { x } else { MOST };
    let bits = (x * (1.0 / UP)).to_bits();
    // To the nearest, and of two as near the even one.
    (bits.wrapping_add(0x0fff + ((bits >> 13) & 1)) >> 13) as u16
}

/// The number that 16 bits stand for.
#[inline(always)]
pub(super) fn whole(half: u16) -> f32 {
    f32::from_bits(u32::from(half) << 13) * UP
}

/// The power of two that brings numbers up to `most` just below 16384; 1 for none.
pub(super) fn power_of_two(most: f32) -> f32 {
    if !(most > 0.0 && most.is_finite()) {
        return 1.0;
    }
    (13.0 - most.log2().floor()).clamp(-120.0, 120.0).exp2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_standard() {
        // IEEE 754-2019, binary16: 1, 2^-14 (smallest normal), 2^-24 (smallest of all), 65504, 1/3, and a tie that goes to the even one.
        let table = [
            (0.0, 0x0000),
            (1.0, 0x3c00),
            (6.103_515_6e-5, 0x0400),
            (5.960_464_5e-8, 0x0001),
            (65504.0, 0x7bff),
            (1e9, 0x7bff),
            (1.0 / 3.0, 0x3555),
            (2049.0, 0x6800),
            (2051.0, 0x6802),
        ];
        for (number, bits) in table {
            assert_eq!(half(number), bits, "{number}");
        }
    }

    #[test]
    fn each_number_of_16_bits_comes_back() {
        for bits in 0..0x7c00u16 {
            assert_eq!(half(whole(bits)), bits);
        }
    }

    #[test]
    fn any_light_is_brought_into_their_range() {
        for most in [1e-30f32, 3e-7, 1.0, 1e5, 1e28] {
            let brought = most * power_of_two(most);
            assert!((8192.0..16384.0).contains(&brought), "{most}: {brought}");
        }
        assert_eq!(power_of_two(0.0), 1.0);
    }
}
