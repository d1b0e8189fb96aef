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

    /// The cosine at a share u (0 to 1) of the cumulative law.
    ///
    /// Two forms of one formula: the textbook's divides by g and loses its digits for small g, the other divides by (1 + g s)^2 and loses
    /// them for g near 1.
    #[must_use]
    pub fn cosine(&self, u: f64) -> f64 {
        let (g, s) = (self.g, 2.0 * u - 1.0);
        let cosine = if g.abs() < 0.5 {
            (2.0 * s + g * (3.0 + s * s) + 2.0 * g * g * s + g * g * g * (s * s - 1.0))
                / (2.0 * (1.0 + g * s) * (1.0 + g * s))
        } else {
            let part = (1.0 - g * g) / (1.0 + g * s);
            (1.0 + g * g - part * part) / (2.0 * g)
        };
        cosine.clamp(-1.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_per_steradian_are_those_of_the_literature() {
        let law = HenyeyGreenstein::new(0.6).unwrap();
        assert!((law.per_steradian(1.0) - 0.795_774_7).abs() < 1e-6);
        assert!((law.per_steradian(-1.0) - 0.012_434_0).abs() < 1e-6);
        assert!((HenyeyGreenstein::new(0.0).unwrap().per_steradian(0.3) - 0.25 / PI).abs() < 1e-15);
        assert!(HenyeyGreenstein::new(f64::NAN).is_none() && HenyeyGreenstein::new(1.5).is_none());
    }
}
