//! From linear light to the few codes of a display, by ordered dithering: the mean light of a patch is what was asked, also
//! between two codes and below the first one, and the same picture gives the same codes.

use std::sync::OnceLock;

use super::{Picture, srgb};

/// Bayer's 8 x 8 order of thresholds, 0 to 63.
///
/// ```text
/// M(2n) = | 4 M(n)      4 M(n) + 2 |        M(1) = 0
///         | 4 M(n) + 3  4 M(n) + 1 |
/// ```
///
/// B. E. Bayer (1973), IEEE Int. Conf. on Communications 1, 26-11.
const BAYER: [[u8; 8]; 8] = bayer();

const fn bayer() -> [[u8; 8]; 8] {
    let mut table = [[0; 8]; 8];
    let mut y = 0;
    while y < 8 {
        let mut x = 0;
        while x < 8 {
            // The recursion, unrolled: each of the three bits of a place adds its quarter, the lowest bit the largest.
            let (mut bit, mut value) = (0, 0);
            while bit < 3 {
                let quarter = match ((x >> bit) & 1, (y >> bit) & 1) {
                    (0, 0) => 0,
                    (1, 0) => 2,
                    (0, _) => 3,
                    _ => 1,
                };
                value += quarter << (2 * (2 - bit));
                bit += 1;
            }
            table[y][x] = value;
            x += 1;
        }
        y += 1;
    }
    table
}

/// Steps of the table that finds a code quickly; from there it is at most a few codes upwards.
const STEPS: usize = 4096;

/// The codes of a display of some bits a channel, on the sRGB curve.
#[derive(Debug)]
pub struct Codes {
    /// The light of each code.
    light: Vec<f32>,
    /// The highest code that is not brighter than each step of light.
    below: Vec<u8>,
}

impl Codes {
    /// The codes of 1 to 8 bits; other numbers are taken for the nearest of these.
    #[must_use]
    pub fn of(bits: u32) -> &'static Codes {
        static ALL: [OnceLock<Codes>; 8] = [const { OnceLock::new() }; 8];
        let bits = bits.clamp(1, 8);
        ALL[bits as usize - 1].get_or_init(|| Codes::new(bits))
    }

    fn new(bits: u32) -> Codes {
        let highest = (1u32 << bits) - 1;
        let light: Vec<f32> = (0..=highest).map(|code| srgb::decode(code as f32 / highest as f32)).collect();
        let below = (0..=STEPS)
            .map(|step| light.partition_point(|own| *own <= step as f32 / STEPS as f32).saturating_sub(1) as u8)
            .collect();
        Codes { light, below }
    }

    /// The code of some light (0 to 1) at a pixel. Black is always code 0, full light always the highest; NaN is black.
    ///
    /// ```text
    /// share = (L - L(c)) / (L(c + 1) - L(c))                         L(c) <= L < L(c + 1)
    /// code  = c + 1 if share > (M(x, y) + 1/2) / 64, else c
    /// ```
    ///
    /// The shares are of light, not of codes: over 8 x 8 pixels of one light the mean is right to 1/128 of a step.
    #[must_use]
    pub fn dithered(&self, light: f32, x: usize, y: usize) -> u8 {
        if light.is_nan() || light <= 0.0 {
            return 0;
        }
        let highest = self.light.len() - 1;
        let light = light.min(1.0);
        let mut code = usize::from(self.below[(light * STEPS as f32) as usize]);
        while code < highest && self.light[code + 1] <= light {
            code += 1;
        }
        if code < highest {
            let share = (light - self.light[code]) / (self.light[code + 1] - self.light[code]);
            let threshold = (f32::from(BAYER[y % 8][x % 8]) + 0.5) / 64.0;
            code += usize::from(share > threshold);
        }
        code as u8
    }

    /// The light of a code; of codes that are too high the highest.
    #[must_use]
    pub fn light(&self, code: u8) -> f32 {
        self.light[usize::from(code).min(self.light.len() - 1)]
    }
}

/// A picture as 8-bit RGB, row by row.
#[must_use]
pub fn rgb8(picture: &Picture) -> Vec<u8> {
    let codes = Codes::of(8);
    let mut bytes = Vec::with_capacity(picture.pixels().len() * 3);
    for y in 0..picture.height() {
        for (x, pixel) in picture.row(y).iter().enumerate() {
            bytes.extend(pixel.map(|light| codes.dithered(light, x, y)));
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Mean light of a patch of 8 x 8.
    fn mean(bits: u32, light: f32, at: (usize, usize)) -> f64 {
        let codes = Codes::of(bits);
        let places = (0..64).map(|i| (at.0 + i % 8, at.1 + i / 8));
        places.map(|(x, y)| f64::from(codes.light(codes.dithered(light, x, y)))).sum::<f64>() / 64.0
    }

    #[test]
    fn the_thresholds_are_bayers() {
        // Two rows as every textbook prints them.
        assert_eq!(BAYER[0], [0, 32, 8, 40, 2, 34, 10, 42]);
        assert_eq!(BAYER[1], [48, 16, 56, 24, 50, 18, 58, 26]);
        let mut all: Vec<u8> = BAYER.into_iter().flatten().collect();
        all.sort_unstable();
        assert!(all.into_iter().eq(0..64));
    }

    #[test]
    fn black_is_exactly_black_and_full_light_is_full_wherever_it_is() {
        for bits in [5, 6, 8] {
            let codes = Codes::of(bits);
            for place in 0..64 {
                let code = |light| codes.dithered(light, place % 8, place / 8);
                assert_eq!((code(0.0), code(-1.0), code(f32::NAN), code(-0.0)), (0, 0, 0, 0));
                let highest = ((1u16 << bits) - 1) as u8;
                assert_eq!((code(1.0), code(9.0), code(f32::INFINITY)), (highest, highest, highest));
            }
        }
    }

    #[test]
    fn a_code_keeps_its_own_light() {
        for code in 0..=255u8 {
            let light = srgb::from_byte(code);
            assert!((0..64).all(|i| Codes::of(8).dithered(light, i % 8, i / 8) == code), "{code}");
        }
    }

    #[test]
    fn light_below_the_first_code_is_still_there_as_single_pixels() {
        // A quarter of the first code's light: 16 pixels of 64.
        let light = srgb::from_byte(1) / 4.0;
        let lit = (0..64).filter(|i| Codes::of(8).dithered(light, i % 8, i / 8) == 1).count();
        assert_eq!(lit, 16);
        assert_eq!(srgb::to_byte(light), 0, "which rounding loses");
    }

    proptest! {
        #[test]
        fn the_mean_light_is_what_was_asked_to_a_hundredth_of_a_step_and_no_code_is_further_than_the_next(
            light in prop_oneof![0f32..0.01, 0f32..=1.0], bits in 1..=8u32, at in (0..2000usize, 0..2000usize),
        ) {
            let codes = Codes::of(bits);
            let own = codes.dithered(light, at.0, at.1);
            let step = |code: u8| codes.light(code.saturating_add(1)) - codes.light(code.saturating_sub(1));
            prop_assert!((codes.light(own) - light).abs() <= step(own));
            let error = (mean(bits, light, at) - f64::from(light)).abs();
            prop_assert!(error <= f64::from(step(own)) / 100.0 + 1e-6, "{error} of a step of {}", step(own));
        }

        #[test]
        fn the_same_picture_gives_the_same_bytes(lights in prop::collection::vec(0f32..0.02, 12)) {
            let mut picture = Picture::black(4, 3);
            picture.pixels_mut().iter_mut().zip(&lights).for_each(|(pixel, light)| *pixel = [*light; 3]);
            prop_assert_eq!(rgb8(&picture), rgb8(&picture));
        }
    }
}
