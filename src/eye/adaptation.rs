//! The state of the eye: what the overlay costs while it is on, and how long until the eye is back.
//!
//! The threshold after the light goes off is tied to the bleached share by **our own calibration**, not a published
//! constant: a full bleach must cross the plateau of the cones, 3.6 powers of ten above the rods' threshold, at about
//! 12 minutes. It is uncertain by 0.3 dex. The slow last part of a full recovery is left out: real eyes take 40 minutes,
//! this one 30.

use super::bleach;
use super::lamp::{self, Lamp, scotopic_trolands};
use super::rods::rod_elevation_dex;

/// Threshold elevation for each bleached share: log10(1 + KAPPA B). **Our own calibration**, +-0.3 dex.
pub const KAPPA: f64 = 3.2e4;

/// The words that stand wherever a number made with [`KAPPA`] is shown.
pub const CALIBRATION_NOTE: &str = "our own calibration, good to a factor of 2";

/// So near to full sensitivity the eye counts as back, in powers of ten.
pub const BACK_DEX: f64 = 0.1;

/// The eye's pigment.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Adaptation {
    bleached: f64,
}

impl Adaptation {
    /// The bleached share of the rods' pigment, 0 (dark adapted) to 1.
    #[must_use]
    pub fn bleached(&self) -> f64 {
        self.bleached
    }

    /// The eye after `seconds` with a light on it: its photopic luminance, averaged over the retina that it falls on, its
    /// colour, and the pupil ([`lamp::pupil_mm`] unless it is known).
    #[must_use]
    pub fn after(self, light: Lamp, luminance_cd_m2: f64, pupil_mm: Option<f64>, seconds: f64) -> Adaptation {
        let pupil = pupil_mm.unwrap_or_else(|| lamp::pupil_mm(luminance_cd_m2));
        let trolands = scotopic_trolands(light.scotopic_over_photopic() * luminance_cd_m2, pupil);
        Adaptation { bleached: bleach::after(self.bleached, trolands, seconds) }
    }

    /// The same for a light of mixed colours: its scotopic luminance, and the photopic one that sets the pupil.
    #[must_use]
    pub fn after_scotopic(self, scotopic_cd_m2: f64, photopic_cd_m2: f64, seconds: f64) -> Adaptation {
        let trolands = scotopic_trolands(scotopic_cd_m2, lamp::pupil_mm(photopic_cd_m2));
        Adaptation { bleached: bleach::after(self.bleached, trolands, seconds) }
    }

    /// By how many powers of ten the threshold stands above a dark-adapted eye's once the light is off.
    #[must_use]
    pub fn elevation_dex(&self) -> f64 {
        (KAPPA * self.bleached).ln_1p() / std::f64::consts::LN_10
    }

    /// The same in magnitudes: so much brighter must a star be.
    #[must_use]
    pub fn loss_magnitudes(&self) -> f64 {
        2.5 * self.elevation_dex()
    }

    /// Minutes in the dark until the threshold stands only `dex` powers of ten too high.
    #[must_use]
    pub fn minutes_to(&self, dex: f64) -> f64 {
        bleach::seconds_to(self.bleached, (dex * std::f64::consts::LN_10).exp_m1() / KAPPA) / 60.0
    }

    /// Minutes in the dark until the eye is back, to 0.1 dex.
    #[must_use]
    pub fn minutes_until_back(&self) -> f64 {
        self.minutes_to(BACK_DEX)
    }
}

/// By how many powers of ten a light raises the rods' threshold **while it is on**: neural, gone within seconds.
#[must_use]
pub fn cost_while_on_dex(light: Lamp, luminance_cd_m2: f64) -> f64 {
    rod_elevation_dex(light.scotopic_over_photopic() * luminance_cd_m2)
}

/// By how many powers of ten a veil of light over an object lowers its contrast.
///
/// ```text
/// C' = C B / (B + L)          B the background at the eye, L the veil
/// ```
#[must_use]
pub fn veil_dex(background_cd_m2: f64, veil_cd_m2: f64) -> f64 {
    (veil_cd_m2 / background_cd_m2).ln_1p() / std::f64::consts::LN_10
}

/// The brightest light, photopic cd/m2, under which the eye may stay for `seconds_on` and be back within `minutes`.
///
/// The pupil is the greatest that any luminance of the answer's order may have, so that a wider one is no worse.
#[must_use]
pub fn brightest_for(light: Lamp, seconds_on: f64, minutes: f64, pupil_mm: Option<f64>) -> f64 {
    let back_in_time = |luminance: f64| {
        Adaptation::default().after(light, luminance, pupil_mm, seconds_on).minutes_until_back() <= minutes
    };
    // Within one width of the pupil brighter is worse; where the pupil narrows, the brighter light may do less.
    let (mut low, mut high): (f64, f64) = (1e-9, 1e6);
    for edge in [0.03, 0.5] {
        if !back_in_time(edge) {
            high = high.min(edge);
        }
    }
    for _ in 0..100 {
        let middle = (low * high).sqrt();
        if back_in_time(middle) { low = middle } else { high = middle }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn losses_and_times_are_those_of_an_independent_integration() {
        let text = include_str!("../../fixtures/reference/eye/adaptation_check.csv");
        for row in text.lines().skip(1) {
            let cells: Vec<&str> = row.split(',').collect();
            let n = |i: usize| cells[i].parse::<f64>().unwrap();
            assert_eq!(lamp::pupil_mm(n(2)), n(4), "{row}");
            let scotopic = n(1) * n(2);
            let eye = Adaptation { bleached: bleach::after(0.0, scotopic_trolands(scotopic, n(4)), n(3)) };
            let close = |ours: f64, theirs: f64, half_digit: f64, what: &str| {
                let off = (ours - theirs).abs();
                assert!(off <= half_digit * 1.001 || off <= 1e-3 * theirs, "{row}\n{what}: {ours} not {theirs}");
            };
            close(eye.bleached(), n(7), 1e-12, "bleached");
            close(rod_elevation_dex(scotopic), n(8), 5e-4, "while on");
            close(eye.elevation_dex(), n(9), 5e-4, "at off");
            close(eye.loss_magnitudes(), n(10), 5e-3, "magnitudes");
            close(eye.minutes_to(0.3), n(11), 5e-3, "minutes to 0.3");
            close(eye.minutes_until_back(), n(12), 5e-3, "minutes to 0.1");
        }
        let ratios: Vec<&str> = text.lines().skip(1).filter_map(|row| row.split(',').nth(1)).collect();
        for lamp in Lamp::ALL {
            assert!(ratios.contains(&lamp.scotopic_over_photopic().to_string().as_str()), "{lamp} is not in the table");
        }
        assert!(ratios.len() > 120);
    }

    #[test]
    fn a_minute_of_white_projector_light_costs_the_published_minutes() {
        let white =
            |luminance: f64| Adaptation::default().after(Lamp::White, luminance, None, 60.0).minutes_until_back();
        for (luminance, minutes) in [(0.03, 0.9), (0.1, 2.6), (1.8, 7.2), (10.0, 10.4)] {
            assert!((white(luminance) - minutes).abs() < 0.06, "{luminance}: {}", white(luminance));
        }
    }

    #[test]
    fn the_brightest_light_for_a_minute_is_back_in_a_minute_and_a_brighter_one_is_not() {
        for light in Lamp::ALL {
            let most = brightest_for(light, 600.0, 1.0, None);
            let minutes = |luminance: f64| {
                Adaptation::default().after(light, luminance, Some(lamp::pupil_mm(most)), 600.0).minutes_until_back()
            };
            assert!(minutes(most) <= 1.0 && minutes(most * 1.01) > 1.0, "{light}: {most}");
        }
        assert!(brightest_for(Lamp::Led635, 600.0, 1.0, None) > 40.0 * brightest_for(Lamp::White, 600.0, 1.0, None));
    }

    #[test]
    fn a_veil_of_a_quarter_of_the_sky_takes_a_fifth_of_the_contrast() {
        assert!((10f64.powf(-veil_dex(4e-5, 1e-5)) - 0.8).abs() < 1e-12);
        assert_eq!(veil_dex(4e-5, 0.0), 0.0);
    }

    proptest::proptest! {
        #[test]
        fn more_light_and_more_time_never_cost_less(
            lg in -8.0..4.0f64, seconds in 0.1..3600.0f64, lamp in 0usize..3,
        ) {
            let light = Lamp::ALL[lamp];
            let loss = |lg: f64, seconds: f64| Adaptation::default().after(light, 10f64.powf(lg), Some(6.0), seconds).loss_magnitudes();
            proptest::prop_assert!(loss(lg, seconds).is_finite());
            proptest::prop_assert!(loss(lg + 0.1, seconds) >= loss(lg, seconds));
            proptest::prop_assert!(loss(lg, seconds * 1.5) >= loss(lg, seconds));
        }
    }
}
