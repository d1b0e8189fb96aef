//! Between linear light and the 8 bits that displays and files take.

use std::sync::OnceLock;

/// Steps of the table: the curve's steepest slope is 12.92, so 16384 steps are a fifth of an 8-bit code.
const STEPS: usize = 16_384;

/// Linear light (0 to 1) as an sRGB code value 0 to 1.
///
/// ```text
/// V = 12.92 L                       L <= 0.0031308
/// V = 1.055 L^(1/2.4) - 0.055       else
/// ```
///
/// IEC 61966-2-1:1999.
#[must_use]
pub fn encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { 12.92 * linear.max(0.0) } else { 1.055 * linear.min(1.0).powf(1.0 / 2.4) - 0.055 }
}

/// An sRGB code value 0 to 1 as linear light: the inverse of [`encode`].
#[must_use]
pub fn decode(code: f32) -> f32 {
    if code <= 0.040_45 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
}

/// Linear light as an 8-bit sRGB code, by table; within one code of the curve, and exactly 0 for 0. NaN is 0.
#[must_use]
pub fn to_byte(linear: f32) -> u8 {
    static TABLE: OnceLock<Vec<u8>> = OnceLock::new();
    let table =
        TABLE.get_or_init(|| (0..=STEPS).map(|i| (encode(i as f32 / STEPS as f32) * 255.0).round() as u8).collect());
    // A float-to-integer cast saturates, and takes NaN to 0.
    table[((linear * STEPS as f32 + 0.5) as usize).min(STEPS)]
}

/// An 8-bit sRGB code as linear light, by table.
#[must_use]
pub fn from_byte(code: u8) -> f32 {
    static TABLE: OnceLock<Vec<f32>> = OnceLock::new();
    TABLE.get_or_init(|| (0..=255u8).map(|i| decode(f32::from(i) / 255.0)).collect())[usize::from(code)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grey_card_of_18_percent_is_118() {
        // IEC 61966-2-1: 0.18 -> 0.4613 -> 117.6.
        assert_eq!(to_byte(0.18), 118);
        assert_eq!((to_byte(0.0), to_byte(1.0), to_byte(7.0), to_byte(-1.0), to_byte(f32::NAN)), (0, 255, 255, 0, 0));
    }

    #[test]
    fn every_byte_comes_back() {
        for code in 0..=255u8 {
            assert_eq!(to_byte(from_byte(code)), code);
        }
    }
}
