//! Sunlight above the air: three published spectra.

mod tables;

use std::fmt;
use std::str::FromStr;

use tables::IRRADIANCE;

/// First wavelength and step of the table, nanometres.
const FIRST_NM: f64 = 330.0;
const STEP_NM: f64 = 5.0;

/// Whose spectrum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Spectrum {
    /// Kurucz' model fluxes (2000), the thesis' author of choice.
    #[default]
    Kurucz,
    /// ASTM G173-03, its column above the air.
    G173,
    /// ASTM E490-00a (2014).
    E490,
}

/// A spectrum that is not there.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no spectrum '{0}': there are kurucz, g173 and e490")]
pub struct UnknownSpectrum(String);

impl Spectrum {
    /// All of them.
    pub const ALL: [Spectrum; 3] = [Spectrum::Kurucz, Spectrum::G173, Spectrum::E490];

    /// The name on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Spectrum::Kurucz => "kurucz",
            Spectrum::G173 => "g173",
            Spectrum::E490 => "e490",
        }
    }

    /// Irradiance at 1 au, W/(m2 nm): means over 5 nm, linear between; held beyond 330 and 830 nm.
    #[must_use]
    pub fn at(self, wavelength_nm: f64) -> f64 {
        let last = IRRADIANCE.len() - 1;
        let place = ((wavelength_nm - FIRST_NM) / STEP_NM).clamp(0.0, last as f64);
        let below = (place as usize).min(last - 1);
        let column = self as usize;
        let [low, high] = [IRRADIANCE[below][column], IRRADIANCE[below + 1][column]];
        low + (high - low) * (place - below as f64)
    }
}

impl fmt::Display for Spectrum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Spectrum {
    type Err = UnknownSpectrum;

    fn from_str(text: &str) -> Result<Spectrum, UnknownSpectrum> {
        let found = Spectrum::ALL.into_iter().find(|spectrum| spectrum.name() == text);
        found.ok_or_else(|| UnknownSpectrum(text.to_owned()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::colour::{LUMENS_PER_WATT, chromaticity, matching};

    fn illuminance(spectrum: Spectrum) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for nm in 360..=830 {
            let nm = f64::from(nm);
            for (part, matching) in sum.iter_mut().zip(matching(nm)) {
                *part += LUMENS_PER_WATT * matching * spectrum.at(nm);
            }
        }
        sum
    }

    /// The solar illuminance constant is 133.1 klx (Darula, Kittler & Gueymard 2005, Solar Energy 79, 559: 133.334 klx), by
    /// the 2 degree observer; the 10 degree observer's broader curve gives some more.
    #[test]
    fn sunlight_above_the_air_is_130_to_150_kilolux_and_nearly_white() {
        for spectrum in Spectrum::ALL {
            let xyz = illuminance(spectrum);
            assert!((130e3..150e3).contains(&xyz[1]), "{spectrum}: {}", xyz[1]);
            // A black body of 5800 K has x = 0.326, y = 0.335.
            let (x, y) = chromaticity(xyz).unwrap();
            assert!((x - 0.326).abs() < 0.01 && (y - 0.337).abs() < 0.01, "{spectrum}: {x} {y}");
        }
    }
}
