//! The law of Henyey and Greenstein, by which a grain of dust turns light aside (thesis, equation 5.1).

use std::f64::consts::PI;

/// Beyond this the law is a needle that no f64 random number resolves; g is clipped here, as other codes do.
pub const STEEPEST: f64 = 1.0 - 1e-6;

/// Henyey and Greenstein (1941): one parameter g, the mean cosine of the angle turned through.
///
/// ```text
/// p(mu) = (1 - g^2) / (4 pi (1 + g^2 - 2 g mu)^(3/2))      per steradian; its integral over the sphere is 1
/// ```
///
/// The thesis' form is per unit of cosine, 2 pi times as large.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HenyeyGreenstein {
    g: f64,
}

impl HenyeyGreenstein {
    /// The law of an asymmetry g, clipped to +-[`STEEPEST`]; nothing for a g that is not a number from -1 to 1.
    #[must_use]
    pub fn new(g: f64) -> Option<HenyeyGreenstein> {
        (-1.0..=1.0).contains(&g).then(|| HenyeyGreenstein { g: g.clamp(-STEEPEST, STEEPEST) })
    }

    /// The asymmetry: mean cosine of the angle turned through, positive forwards.
    #[must_use]
    pub fn asymmetry(&self) -> f64 {
        self.g
    }

    /// Per steradian, for a cosine between the way before and the way after.
    #[must_use]
    pub fn per_steradian(&self, cosine: f64) -> f64 {
        let g = self.g;
        // (1 - |g|)^2 + ... keeps its digits where 1 + g^2 - 2 g mu would cancel.
        let base = (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - cosine);
        (1.0 - g * g) / (4.0 * PI * base * base.sqrt())
    }

    /// The cosine at a share u (0 to 1) of the cumulative law, least cosine first.
    #[must_use]
    pub fn cosine(&self, u: f64) -> f64 {
        self.turn(u).0
    }

    /// The cosine at a share u (0 to 1) of the cumulative law, and the sine beside it.
    ///
    /// The textbook's inverse divides by g and loses its digits for small g; multiplied out it loses them near |g| = 1. Written for the
    /// difference from the end at which the law is highest, it loses none:
    ///
    /// ```text
    /// 1 - mu = 2 (1 - g)^2 (1 - u) (1 + g u)       / (1 - g + 2 g u)^2      g >= 0
    /// 1 + mu = 2 (1 + g)^2 u       (1 - g (1 - u)) / (1 - g + 2 g u)^2      g < 0
    /// ```
    ///
    /// For g = 0.999999 the sine keeps its digits too, where the root of 1 - mu^2 would have lost half of them.
    #[must_use]
    #[inline]
    pub fn turn(&self, u: f64) -> (f64, f64) {
        let (g, a) = (self.g, self.g.abs());
        // By the law's mirror, g < 0 at u is -g at 1 - u.
        let share = if g < 0.0 { 1.0 - u } else { u };
        let below = 1.0 - a + 2.0 * a * share;
        let short = (1.0 - a) / below;
        let lack = (2.0 * short * short * (1.0 - share) * (1.0 + a * share)).clamp(0.0, 2.0);
        let cosine = if g < 0.0 { lack - 1.0 } else { 1.0 - lack };
        (cosine, (lack * (2.0 - lack)).sqrt())
    }

    /// [`HenyeyGreenstein::cosine`] in f32, for kernels of many lanes; good to 5e-7 for every g.
    #[must_use]
    #[inline]
    pub fn cosine_f32(&self, u: f32) -> f32 {
        let a = self.g.abs() as f32;
        let share = if self.g < 0.0 { 1.0 - u } else { u };
        // 1 - g is taken in f64: near 1 it is what the law depends on.
        let less = (1.0 - self.g.abs()) as f32;
        let short = less / (less + 2.0 * a * share);
        let lack = (2.0 * short * short * (1.0 - share) * (1.0 + a * share)).clamp(0.0, 2.0);
        if self.g < 0.0 { lack - 1.0 } else { 1.0 - lack }
    }

    /// The share of the law below a cosine: what [`HenyeyGreenstein::cosine`] inverts.
    #[must_use]
    pub fn below(&self, cosine: f64) -> f64 {
        let g = self.g;
        if g.abs() < 1e-4 {
            // To second order in g; the next term is g^3.
            let m = cosine;
            return 0.5 * (1.0 + m) - 0.75 * g * (1.0 - m * m) - 1.25 * g * g * m * (1.0 - m * m);
        }
        let root = |lack: f64| ((1.0 - g) * (1.0 - g) + 2.0 * g * lack).sqrt();
        ((1.0 - g * g) / root(1.0 - cosine) - (1.0 - g)) / (2.0 * g)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASYMMETRIES: [f64; 13] =
        [0.0, 1e-8, 1e-6, -1e-6, 1e-3, 0.1, 0.4999, 0.5, 0.6, -0.75, 0.99, -0.9999, 0.999_999];

    #[test]
    fn samples_are_the_inverse_of_the_cumulative_law_for_every_g() {
        for g in ASYMMETRIES {
            let law = HenyeyGreenstein::new(g).unwrap();
            for i in 0..=1000 {
                let u = f64::from(i) / 1000.0;
                let (cosine, sine) = law.turn(u);
                assert!((cosine * cosine + sine * sine - 1.0).abs() < 1e-15, "g {g} u {u}");
                // A cosine is known to 1e-16, and the law there may be as steep as 2 / (1 - g)^2.
                let steep = 4.0 * PI * law.per_steradian(cosine);
                assert!((law.below(cosine) - u).abs() < 1e-11 + 2e-16 * steep, "g {g} u {u}: {}", law.below(cosine));
            }
        }
    }

    #[test]
    fn the_law_integrates_to_one_and_its_mean_cosine_is_g() {
        for g in ASYMMETRIES {
            // Over the share u each direction is as likely as any: the mean of 1/p is the sphere, that of the cosine g.
            let law = HenyeyGreenstein::new(g).unwrap();
            let count = 200_000;
            let (mut sphere, mut mean) = (0.0, 0.0);
            for i in 0..count {
                let cosine = law.cosine((f64::from(i) + 0.5) / f64::from(count));
                mean += cosine / f64::from(count);
                sphere += 1.0 / law.per_steradian(cosine) / f64::from(count);
            }
            assert!((mean - law.asymmetry()).abs() < 1e-5, "g {g}: {mean}");
            if g.abs() < 0.9 {
                assert!((sphere / (4.0 * PI) - 1.0).abs() < 1e-5, "g {g}: {sphere}");
            }
        }
    }

    #[test]
    fn f32_samples_are_good_for_every_g() {
        for g in ASYMMETRIES {
            let law = HenyeyGreenstein::new(g).unwrap();
            let error = |i: u16| {
                let u = (f32::from(i) + 0.5) / 4096.0;
                (f64::from(law.cosine_f32(u)) - law.cosine(f64::from(u))).abs()
            };
            let worst = (0..4096).map(error).fold(0.0, f64::max);
            assert!(worst < 5e-7, "g {g}: {worst}");
        }
    }

    #[test]
    fn values_per_steradian_are_those_of_the_literature() {
        let law = HenyeyGreenstein::new(0.6).unwrap();
        assert!((law.per_steradian(1.0) - 0.795_774_7).abs() < 1e-6);
        assert!((law.per_steradian(-1.0) - 0.012_434_0).abs() < 1e-6);
        assert!((HenyeyGreenstein::new(0.0).unwrap().per_steradian(0.3) - 0.25 / PI).abs() < 1e-15);
        assert!(HenyeyGreenstein::new(f64::NAN).is_none() && HenyeyGreenstein::new(1.5).is_none());
    }
}
