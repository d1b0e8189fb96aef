//! How the disc of the Sun darkens towards its limb.

mod tables;

use std::fmt;
use std::str::FromStr;

use tables::NECKEL_LABS;

/// By which law.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Law {
    /// Polynomials of the fifth degree in mu, by wavelength: Neckel & Labs (1994), Solar Physics 153, 91.
    #[default]
    NeckelLabs,
    /// 1 - u (1 - mu) with u = 0.6 at all wavelengths: the thesis, section 4.2.4, after Bruton (1996).
    Linear,
}

/// A law that is not there.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no limb darkening '{0}': there are neckel-labs and linear")]
pub struct UnknownLaw(String);

impl Law {
    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Law::NeckelLabs => "neckel-labs",
            Law::Linear => "linear",
        }
    }

    /// The darkening at a wavelength: the table's polynomials, linear between its wavelengths and held beyond its ends, 303
    /// and 812 nm.
    #[must_use]
    pub fn at(self, wavelength_nm: f64) -> Darkening {
        match self {
            Law::Linear => Darkening([0.4, 0.6, 0.0, 0.0, 0.0, 0.0]),
            Law::NeckelLabs => {
                let above = NECKEL_LABS.partition_point(|row| row.0 <= wavelength_nm).clamp(1, NECKEL_LABS.len() - 1);
                let ((low_nm, low), (high_nm, high)) = (NECKEL_LABS[above - 1], NECKEL_LABS[above]);
                let share = ((wavelength_nm - low_nm) / (high_nm - low_nm)).clamp(0.0, 1.0);
                Darkening(std::array::from_fn(|k| low[k] + share * (high[k] - low[k])))
            }
        }
    }
}

impl fmt::Display for Law {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Law {
    type Err = UnknownLaw;

    fn from_str(text: &str) -> Result<Law, UnknownLaw> {
        let found = [Law::NeckelLabs, Law::Linear].into_iter().find(|law| law.name() == text);
        found.ok_or_else(|| UnknownLaw(text.to_owned()))
    }
}

/// Brightness over the disc, relative to its centre: A0 + A1 mu + ... + A5 mu^5, mu the cosine of the angle between the light
/// and the Sun's vertical.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Darkening(pub [f64; 6]);

impl Darkening {
    /// At a mu.
    #[must_use]
    pub fn at(&self, mu: f64) -> f64 {
        self.0.iter().rev().fold(0.0, |sum, a| sum * mu + a)
    }

    /// Mean over the disc.
    ///
    /// ```text
    /// 2 ∫ I(mu) mu dmu = Σ 2 Ak/(k + 2)
    /// ```
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.0.iter().zip(2..).map(|(a, k)| 2.0 * a / f64::from(k)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The means that the paper prints beside its polynomials.
    #[test]
    fn the_centre_is_one_and_the_mean_is_the_printed_one() {
        for (nm, mean) in [(365.875, 0.7445), (401.97, 0.7303), (541.76, 0.8002), (559.95, 0.8061), (700.875, 0.8434)] {
            let darkening = Law::NeckelLabs.at(nm);
            assert!((darkening.at(1.0) - 1.0).abs() < 3e-5, "{nm}");
            assert!((darkening.mean() - mean).abs() < 6e-5, "{nm}: {}", darkening.mean());
        }
    }

    /// Neckel (2005), Solar Physics 229, 13, is an independent fit of the same observations: at 600 nm its A0 is 0.31004 and
    /// its mean 0.8199.
    #[test]
    fn between_the_wavelengths_of_the_table_it_is_that_of_neckels_later_fit() {
        let darkening = Law::NeckelLabs.at(600.0);
        assert!((darkening.at(0.0) - 0.310_04).abs() < 0.011 && (darkening.mean() - 0.8199).abs() < 0.002);
    }

    #[test]
    fn the_thesis_law_is_0_4_at_the_limb() {
        assert!((Law::Linear.at(550.0).at(0.0) - 0.4).abs() < 1e-15);
        assert!((Law::Linear.at(550.0).mean() - 0.8).abs() < 1e-15);
    }
}
