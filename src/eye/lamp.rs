//! What of a light the rods see, and how wide it leaves the pupil.

use std::fmt;
use std::str::FromStr;

/// A light by its colour: what the rods see of it for each candela that the cones see.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lamp {
    /// A red light-emitting diode of 635 nm, 18 nm wide.
    Led635,
    /// The red primary of an ordinary liquid-crystal screen: most of its harm is the tail below 600 nm.
    LcdRed,
    /// White as D65: a projector's or a screen's own.
    White,
}

impl Lamp {
    /// All of them.
    pub const ALL: [Lamp; 3] = [Lamp::Led635, Lamp::LcdRed, Lamp::White];

    /// Scotopic over photopic luminance.
    ///
    /// ```text
    /// S/P = 1700 integral(V' L) / (683 integral(V L))          CIE 1951 and CIE 1924
    /// ```
    #[must_use]
    pub fn scotopic_over_photopic(self) -> f64 {
        match self {
            Lamp::Led635 => 0.0299,
            Lamp::LcdRed => 0.206,
            Lamp::White => 2.46,
        }
    }

    /// Its name on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Lamp::Led635 => "led635",
            Lamp::LcdRed => "lcd-red",
            Lamp::White => "white",
        }
    }

    /// Its name in a sentence.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Lamp::Led635 => "a red LED of 635 nm",
            Lamp::LcdRed => "the red of a screen",
            Lamp::White => "white light",
        }
    }
}

impl fmt::Display for Lamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Lamp {
    type Err = String;

    fn from_str(text: &str) -> Result<Lamp, String> {
        let named = Lamp::ALL.into_iter().find(|lamp| lamp.name() == text);
        named.ok_or_else(|| String::from("a light is led635, lcd-red or white"))
    }
}

/// Scotopic over photopic luminance of a star's light by its colour.
///
/// ```text
/// log10(S/P) = 0.4378 - 0.1094 (B - V)          Crumey (2014)
/// ```
#[must_use]
pub fn scotopic_over_photopic_of_star(colour_bv: f64) -> f64 {
    10f64.powf(0.4378 - 0.1094 * colour_bv)
}

/// Diameter in millimetres that a light of a photopic luminance leaves the pupil: 7 to 0.03 cd/m2, 6 to 0.5, 5 above.
#[must_use]
pub fn pupil_mm(luminance_cd_m2: f64) -> f64 {
    if luminance_cd_m2 <= 0.03 {
        7.0
    } else if luminance_cd_m2 <= 0.5 {
        6.0
    } else {
        5.0
    }
}

/// Light on the retina in scotopic trolands: scotopic luminance times the pupil's area in square millimetres.
#[must_use]
pub fn scotopic_trolands(scotopic_cd_m2: f64, pupil_mm: f64) -> f64 {
    scotopic_cd_m2 * std::f64::consts::FRAC_PI_4 * pupil_mm * pupil_mm
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lamps_are_read_as_they_are_written() {
        for lamp in Lamp::ALL {
            assert_eq!(lamp.to_string().parse(), Ok(lamp));
        }
        assert!("green".parse::<Lamp>().unwrap_err().contains("led635"));
    }

    #[test]
    fn the_ratios_are_those_computed_from_the_cie_tables() {
        let text = include_str!("../../fixtures/reference/eye/sp_ratio.csv");
        for (source, ratio) in [
            ("LED gaussian peak 635 nm FWHM 18,", Lamp::Led635.scotopic_over_photopic()),
            ("Apple Studio Display R primary,", Lamp::LcdRed.scotopic_over_photopic()),
            ("\"D65 (sRGB white, approx.)\",", Lamp::White.scotopic_over_photopic()),
        ] {
            let row = text.lines().find(|row| row.starts_with(source)).unwrap();
            let published: f64 = row[source.len()..].parse().unwrap();
            assert!((ratio / published - 1.0).abs() < 2.5e-3, "{row}: {ratio}");
        }
    }

    #[test]
    fn a_star_of_the_colour_of_2850_k_has_the_ratio_of_2850_k() {
        // Crumey: m* - m_2850 = 0.72 - 0.27 (B-V) vanishes at B-V = 2.67, where S/P = 1.408.
        assert!((scotopic_over_photopic_of_star(2.67) / 1.408 - 1.0).abs() < 0.01);
    }
}
