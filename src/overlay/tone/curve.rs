//! A power as a table, and a picture's light brought along it.

use glam::Vec3A;

use crate::overlay::colour::{LUMINANCE, in_palette, lifted};
use crate::overlay::style::Style;

/// A photograph's light, made brighter by `gain`, as the projector throws it: toned, in the palette.
pub fn as_thrown<'a>(style: &Style, curve: Option<&'a Curve>, gain: f32) -> impl Fn(Vec3A) -> Vec3A + use<'a> {
    let (palette, share) = (style.palette, style.photograph);
    move |light| {
        let light = lifted(in_palette(palette, light), gain);
        curve.map_or(light, |curve| curve.of(light)).min(Vec3A::ONE) * share
    }
}

/// A power of numbers up to 4, as a table: a few nanoseconds a pixel, right to 5e-4 of itself a unit of exponent from 1.
#[derive(Debug, Clone)]
pub struct Curve {
    exponent: f32,
    /// s^(exponent - 1) at the middles of 1024 places of each octave from 2^-24 on.
    gains: Vec<f32>,
}

/// An octave's places in [`Curve`], as a power of two; the bits of a float below them.
const PLACES_BITS: u32 = 10;
const BELOW: u32 = 23 - PLACES_BITS;
/// 2^-24 and 2^2 as the floats' exponents.
const LEAST_EXPONENT: i32 = -24;
const MOST_EXPONENT: i32 = 2;

impl Curve {
    /// The curve s^exponent.
    #[must_use]
    pub fn new(exponent: f32) -> Curve {
        let places = 1i32 << PLACES_BITS;
        let gain = |i: i32| {
            let octave = LEAST_EXPONENT + i.div_euclid(places);
            let share = 1.0 + (f64::from(i.rem_euclid(places)) + 0.5) / f64::from(places);
            ((share * f64::from(octave).exp2()).powf(f64::from(exponent) - 1.0)) as f32
        };
        let gains = if exponent == 1.0 {
            Vec::new()
        } else {
            (0..(MOST_EXPONENT - LEAST_EXPONENT) * places).map(gain).collect()
        };
        Curve { exponent, gains }
    }

    /// Its exponent.
    #[must_use]
    pub fn exponent(&self) -> f32 {
        self.exponent
    }

    /// A light brought along the curve by its luminance: its colour stays ("without blue shift").
    #[must_use]
    #[inline]
    pub fn of(&self, light: Vec3A) -> Vec3A {
        let Some(&last) = self.gains.last() else { return light };
        let luminance = light.dot(LUMINANCE);
        let least = (LEAST_EXPONENT as f32).exp2();
        // No number compares as too little.
        if luminance >= least {
            let place = (luminance.to_bits() >> BELOW) - (least.to_bits() >> BELOW);
            light * self.gains.get(place as usize).copied().unwrap_or(last)
        } else {
            Vec3A::ZERO
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_curve_is_the_power_and_keeps_colours(share in 1e-6..3.9f32, exponent in 0.2..4.0f32) {
            let before = Vec3A::new(share, share / 2.0, share / 4.0);
            let after = Curve::new(exponent).of(before);
            prop_assert!((after.y / after.x - 0.5).abs() < 1e-5 && (after.z / after.x - 0.25).abs() < 1e-5);
            let luminance = |light: Vec3A| f64::from(0.2126 * light.x + 0.7152 * light.y + 0.0722 * light.z);
            let ratio = luminance(after) / luminance(before).powf(f64::from(exponent));
            prop_assert!((ratio - 1.0).abs() < 5e-4 * f64::from((exponent - 1.0).abs()) + 1e-5, "{ratio}");
        }
    }

    #[test]
    fn no_light_and_no_number_are_no_light() {
        for light in [Vec3A::ZERO, Vec3A::new(f32::NAN, 0.1, 0.1), Vec3A::new(-1.0, 0.0, 0.0)] {
            assert_eq!(Curve::new(0.5).of(light), Vec3A::ZERO);
        }
        assert_eq!(Curve::new(1.0).of(Vec3A::new(0.3, 0.2, 0.1)), Vec3A::new(0.3, 0.2, 0.1));
        assert!(Curve::new(2.0).of(Vec3A::splat(1e9)).x.is_finite());
    }
}
