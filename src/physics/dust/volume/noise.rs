//! Perlin's noise in three dimensions.

use glam::DVec3;

use crate::numerics::streams::Stream;

/// Gradient noise: smooth, zero at every whole point, within -1 to 1, with one feature about every unit of length.
///
/// Perlin (1985), SIGGRAPH 19, 287, with the gradients and the fade 6 t^5 - 15 t^4 + 10 t^3 of Perlin (2002), "Improving noise", so
/// that second derivatives are continuous too.
#[derive(Debug, Clone, PartialEq)]
pub struct Noise {
    /// A permutation of 0 to 255, twice over.
    order: Vec<u8>,
}

impl Noise {
    /// The noise of a permutation of 0 to 255.
    #[must_use]
    pub fn of_permutation(order: &[u8; 256]) -> Noise {
        Noise { order: [&order[..], &order[..]].concat() }
    }

    /// The noise of a seed: Fisher and Yates' shuffle.
    #[must_use]
    pub fn seeded(stream: &mut Stream) -> Noise {
        let mut order: [u8; 256] = std::array::from_fn(|i| i as u8);
        for last in (1..256usize).rev() {
            order.swap(last, (stream.uniform() * (last + 1) as f64) as usize);
        }
        Noise::of_permutation(&order)
    }

    /// The noise at a point; it repeats after 256 units.
    #[must_use]
    pub fn at(&self, point: DVec3) -> f64 {
        let corner = point.floor();
        let DVec3 { x, y, z } = point - corner;
        // Through i64, which wraps for negative places as the permutation needs it.
        let [i, j, k] = corner.to_array().map(|c| (c as i64 & 255) as usize);
        let fade = |t: f64| t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        let (u, v, w) = (fade(x), fade(y), fade(z));
        let next = |index: usize, by: usize| usize::from(self.order[index]) + by;
        let (a, b) = (next(i, j), next(i + 1, j));
        // Sums stay below 512: an entry is at most 255, and so is a corner.
        let (aa, ab, ba, bb) = (next(a, k), next(a + 1, k), next(b, k), next(b + 1, k));
        let gradient = |index: usize, x: f64, y: f64, z: f64| dot(self.order[index & 511], x, y, z);
        let mix = |t: f64, a: f64, b: f64| a + t * (b - a);
        mix(
            w,
            mix(
                v,
                mix(u, gradient(aa, x, y, z), gradient(ba, x - 1.0, y, z)),
                mix(u, gradient(ab, x, y - 1.0, z), gradient(bb, x - 1.0, y - 1.0, z)),
            ),
            mix(
                v,
                mix(u, gradient(aa + 1, x, y, z - 1.0), gradient(ba + 1, x - 1.0, y, z - 1.0)),
                mix(u, gradient(ab + 1, x, y - 1.0, z - 1.0), gradient(bb + 1, x - 1.0, y - 1.0, z - 1.0)),
            ),
        )
    }
}

/// The product with one of the twelve directions to the middles of a cube's edges (four of them twice).
fn dot(hash: u8, x: f64, y: f64, z: f64) -> f64 {
    let hash = hash & 15;
    let u = if hash < 8 { x } else { y };
    let v = match hash {
        0..4 => y,
        12 | 14 => x,
        _ => z,
    };
    (if hash & 1 == 0 { u } else { -u }) + if hash & 2 == 0 { v } else { -v }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The permutation of Perlin's reference program (2002).
    const PERLIN: [u8; 256] = [
        151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225, 140, 36, 103, 30, 69, 142, 8, 99, 37,
        240, 21, 10, 23, 190, 6, 148, 247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32, 57, 177,
        33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175, 74, 165, 71, 134, 139, 48, 27, 166, 77, 146,
        158, 231, 83, 111, 229, 122, 60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54, 65, 25,
        63, 161, 1, 216, 80, 73, 209, 76, 132, 187, 208, 89, 18, 169, 200, 196, 135, 130, 116, 188, 159, 86, 164, 100,
        109, 198, 173, 186, 3, 64, 52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212, 207, 206,
        59, 227, 47, 16, 58, 17, 182, 189, 28, 42, 223, 183, 170, 213, 119, 248, 152, 2, 44, 154, 163, 70, 221, 153,
        101, 155, 167, 43, 172, 9, 129, 22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232, 178, 185, 112, 104, 218, 246,
        97, 228, 251, 34, 242, 193, 238, 210, 144, 12, 191, 179, 162, 241, 81, 51, 145, 235, 249, 14, 239, 107, 49,
        192, 214, 31, 181, 199, 106, 157, 184, 84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93,
        222, 114, 67, 29, 24, 72, 243, 141, 128, 195, 78, 66, 215, 61, 156, 180,
    ];

    #[test]
    #[expect(clippy::approx_constant, reason = "the published place is 3.14, not pi")]
    fn it_is_perlins_own() {
        // The value that implementations of Perlin's program are checked by (rosettacode.org/wiki/Perlin_noise).
        let noise = Noise::of_permutation(&PERLIN);
        assert!((noise.at(DVec3::new(3.14, 42.0, 7.0)) - 0.136_919_958_784_000_12).abs() < 1e-15);
    }

    #[test]
    fn one_seed_gives_one_noise() {
        let of = |seed| Noise::seeded(&mut Stream::seeded(seed));
        assert_eq!(of(1), of(1));
        assert_ne!(of(1), of(2));
        let mut sorted = of(3).order[..256].to_vec();
        sorted.sort_unstable();
        assert!(sorted.iter().zip(0..=255u8).all(|(a, b)| *a == b));
    }

    proptest! {
        #[test]
        fn it_is_bounded_and_zero_at_whole_points(place in prop::array::uniform3(-300.0f64..300.0)) {
            let noise = Noise::of_permutation(&PERLIN);
            let point = DVec3::from_array(place);
            prop_assert!(noise.at(point).abs() <= 1.0);
            prop_assert_eq!(noise.at(point.floor()), 0.0);
        }
    }
}
