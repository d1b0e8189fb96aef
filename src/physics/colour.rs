//! From spectra to colours: the CIE 1964 standard observer, sRGB's primaries, the thesis' tone.

mod tables;

use std::str::FromStr;

use tables::CIE_1964;

use crate::picture::srgb;

/// First wavelength and step of the table, nanometres.
const FIRST_NM: f64 = 360.0;
const STEP_NM: f64 = 5.0;

/// Lumens per watt where the eye sees best.
pub const LUMENS_PER_WATT: f64 = 683.0;

/// X, Y, Z. Of a radiance in W/(m2 sr), times [`LUMENS_PER_WATT`], Y is in cd/m2 (as the 10 degree observer weighs it).
pub type Xyz = [f64; 3];

/// The colour matching functions of the CIE 1964 standard observer (10 degrees), linear between steps of 5 nm; zero outside
/// 360 to 830 nm.
#[must_use]
pub fn matching(wavelength_nm: f64) -> Xyz {
    let place = (wavelength_nm - FIRST_NM) / STEP_NM;
    let last = CIE_1964.len() - 1;
    if !(0.0..=last as f64).contains(&place) {
        return [0.0; 3];
    }
    let below = (place as usize).min(last - 1);
    let share = place - below as f64;
    std::array::from_fn(|i| CIE_1964[below][i] + share * (CIE_1964[below + 1][i] - CIE_1964[below][i]))
}

/// Chromaticity x, y; none where there is no light.
#[must_use]
pub fn chromaticity([x, y, z]: Xyz) -> Option<(f64, f64)> {
    let sum = x + y + z;
    (sum > 0.0).then(|| (x / sum, y / sum))
}

/// Linear light of sRGB's primaries with the white of D65. Colours outside the triangle have negative parts.
///
/// Source: IEC 61966-2-1:1999, eq. 7 (primaries of ITU-R BT.709).
#[must_use]
pub fn linear_srgb([x, y, z]: Xyz) -> [f64; 3] {
    [3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z, 0.0557 * x - 0.2040 * y + 1.0570 * z]
}

/// How light becomes codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Tone {
    /// The thesis': Y^(1/2.5), codes straight from XYZ. Hues come out redder on a display than they were computed.
    #[default]
    Thesis,
    /// sRGB's curve on linear light: on a display brightness (up to white) and hue are as computed.
    Srgb,
}

/// A tone that is not there.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("no tone '{0}': there are thesis and srgb")]
pub struct UnknownTone(String);

impl FromStr for Tone {
    type Err = UnknownTone;

    fn from_str(text: &str) -> Result<Tone, UnknownTone> {
        match text {
            "thesis" => Ok(Tone::Thesis),
            "srgb" => Ok(Tone::Srgb),
            _ => Err(UnknownTone(text.to_owned())),
        }
    }
}

impl Tone {
    /// A colour as three 8-bit codes; Y equal to `white` is full.
    #[must_use]
    pub fn codes(self, xyz: Xyz, white: f64) -> [u8; 3] {
        match self {
            Tone::Thesis => thesis_codes(xyz, white),
            Tone::Srgb => {
                let rgb = linear_srgb(xyz.map(|part| part / white)).map(|part| part.max(0.0));
                let most = rgb.iter().copied().fold(1.0, f64::max);
                rgb.map(|part| srgb::to_byte((part / most) as f32))
            }
        }
    }
}

/// The exponent of the thesis' tone.
const EXPONENT: f64 = 2.5;

/// A colour as three 8-bit codes, in the thesis' tone.
///
/// ```text
/// Y' = (Y/white)^(1/2.5),  x and y kept, then XYZ -> RGB: the codes
/// ```
///
/// Source: the thesis, section 4.4.6. The codes are the RGB of the last step, with no further curve. What lies outside the
/// triangle of sRGB is brought to its border (negative parts become none); what is brighter than a display can show keeps
/// its hue.
#[must_use]
pub fn thesis_codes(xyz: Xyz, white: f64) -> [u8; 3] {
    let y = xyz[1] / white;
    if y.is_nan() || y <= 0.0 {
        return [0; 3];
    }
    // (Y/white)^(1/2.5) / Y; a Y of 1e-30 is black in any tone.
    let gain = if y < 1e-30 { 0.0 } else { y.powf(1.0 / EXPONENT) / xyz[1] };
    let rgb = linear_srgb(xyz.map(|part| part * gain)).map(|part| part.max(0.0));
    let most = rgb.iter().copied().fold(1.0, f64::max);
    // A cast from float to integer saturates.
    rgb.map(|part| (part / most * 255.0).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_observer_has_the_integral_and_the_values_of_the_standard() {
        // The integral of ybar by way of colour-science's 1 nm table.
        let sum: f64 = CIE_1964.iter().map(|row| row[1]).sum();
        assert!((sum * STEP_NM - 116.660_383).abs() < 1e-5, "{sum}");
        // The standard's row of 555 nm.
        assert!((matching(555.0)[1] - 0.99911).abs() < 1e-6);
        assert_eq!((matching(359.0), matching(831.0)), ([0.0; 3], [0.0; 3]));
    }

    #[test]
    fn d65_is_white_and_the_equal_energy_spectrum_is_not() {
        // White of D65: IEC 61966-2-1 gives x = 0.3127, y = 0.3290.
        let white = linear_srgb([0.3127 / 0.3290, 1.0, 0.3583 / 0.3290]);
        assert!(white.iter().all(|part| (part - 1.0).abs() < 2e-3), "{white:?}");
        assert!(linear_srgb([1.0; 3])[0] > 1.1);
    }

    #[test]
    fn the_thesis_tone_halves_the_code_for_5_66_times_less_light() {
        // 0.5^2.5 = 0.1768.
        let d65 = [0.9505, 1.0, 1.0890];
        assert_eq!(thesis_codes(d65, 1.0), [255; 3]);
        let half = thesis_codes(d65.map(|part| part * 0.176_776_7), 1.0);
        assert!(half.iter().all(|code| (127..=128).contains(code)), "{half:?}");
        assert_eq!(thesis_codes([0.0; 3], 1.0), [0; 3]);
        assert_eq!(thesis_codes([f64::NAN; 3], 1.0), [0; 3]);
    }

    #[test]
    fn the_other_tone_is_that_of_displays() {
        // IEC 61966-2-1: 0.18 of the white is 118.
        let grey = [0.9505, 1.0, 1.0890].map(|part| part * 0.18);
        assert!(Tone::Srgb.codes(grey, 1.0).iter().all(|code| code.abs_diff(118) <= 1));
        assert_eq!("srgb".parse(), Ok(Tone::Srgb));
        assert!("gamma".parse::<Tone>().unwrap_err().to_string().contains("gamma"));
    }

    #[test]
    fn light_too_bright_for_the_display_keeps_its_hue() {
        let orange = [0.6, 0.5, 0.05];
        let (dim, bright) = (thesis_codes(orange, 1.0), thesis_codes(orange, 1e-4));
        assert_eq!(bright[0], 255);
        let ratio = |codes: [u8; 3]| f64::from(codes[1]) / f64::from(codes[0]);
        assert!((ratio(dim) - ratio(bright)).abs() < 0.01, "{dim:?} {bright:?}");
    }
}
