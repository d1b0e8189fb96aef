//! The average of a darkened disc over a stretch of a horizontal line, in closed form.

use super::limb::Darkening;

/// A horizontal line through the disc: mu^2 = (w^2 - x^2)/s^2 at a distance x from its middle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Chord {
    /// Half the length of the line inside the disc, squared; not positive where the line misses it.
    pub(super) half_squared: f64,
    /// The disc's radius in units of x, squared.
    pub(super) radius_squared: f64,
}

impl Chord {
    /// Half the length inside the disc.
    pub(super) fn half(&self) -> f64 {
        self.half_squared.max(0.0).sqrt()
    }

    /// The darkening integrated from the middle to x.
    ///
    /// ```text
    /// Ik = ∫ (w² - x²)^(k/2) dx:  I0 = x,  I1 = (x q + w² asin(x/w))/2,  Ik = (x q^k + k w² Ik-2)/(k + 1)     q² = w² - x²
    /// ```
    pub(super) fn integral(&self, darkening: &Darkening, x: f64) -> f64 {
        let square = self.half_squared;
        if square <= 0.0 {
            return 0.0;
        }
        let half = square.sqrt();
        let x = x.clamp(-half, half);
        let q = (square - x * x).max(0.0).sqrt();
        let per_radius = 1.0 / self.radius_squared.sqrt();
        let (mut before, mut last) = (x, 0.5 * (x * q + square * (x / half).asin()));
        let (mut sum, mut power, mut scale) = (darkening.0[0] * before, q, per_radius);
        for (k, a) in darkening.0.iter().enumerate().skip(1) {
            if k > 1 {
                power *= q;
                scale *= per_radius;
                (before, last) = (last, (x * power + k as f64 * square * before) / (k as f64 + 1.0));
            }
            sum += a * scale * last;
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::sun::limb::Law;

    #[test]
    fn lines_over_the_whole_disc_add_up_to_its_mean() {
        for nm in [400.0, 550.0, 700.0] {
            let darkening = Law::NeckelLabs.at(nm);
            let lines = 20_000;
            let mut sum = 0.0;
            for i in 0..lines {
                let y = (f64::from(i) + 0.5) / f64::from(lines);
                let chord = Chord { half_squared: 1.0 - y * y, radius_squared: 1.0 };
                sum += chord.integral(&darkening, 1.0) / f64::from(lines);
            }
            let mean = 4.0 * sum / std::f64::consts::PI;
            assert!((mean - darkening.mean()).abs() < 1e-6, "{nm}: {mean}");
        }
    }

    #[test]
    fn the_integral_is_that_of_a_thousand_points() {
        let (darkening, chord) = (Law::NeckelLabs.at(500.0), Chord { half_squared: 7.3, radius_squared: 11.0 });
        let (from, to) = (0.4, 2.6);
        let points = 100_000;
        let mut sum = 0.0;
        for i in 0..points {
            let x: f64 = from + (to - from) * (f64::from(i) + 0.5) / f64::from(points);
            sum += darkening.at(((7.3 - x * x) / 11.0).sqrt()) * (to - from) / f64::from(points);
        }
        let exact = chord.integral(&darkening, to) - chord.integral(&darkening, from);
        assert!((exact - sum).abs() < 1e-9, "{exact} {sum}");
        assert_eq!(Chord { half_squared: -1.0, radius_squared: 1.0 }.integral(&darkening, 1.0), 0.0);
    }
}
