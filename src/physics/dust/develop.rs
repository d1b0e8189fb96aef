//! From linear light in any bands to the 8 bits of a display: normalised, with a gamma if wanted (thesis, section 5.7).

use crate::picture::srgb;

/// Share of the pixels that may be brighter than white when white is found by itself: a star's surroundings grow as 1/b, and one
/// pixel must not darken a picture.
pub const CLIPPED: f64 = 0.005;

/// How light is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Development {
    /// The light of a band that is shown as full.
    pub white: f64,
    /// Code = light^(1/gamma); nothing for sRGB's own curve, by which a display shows brightness as it was computed.
    pub gamma: Option<f64>,
}

/// A development that cannot be.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum DevelopError {
    /// White is no light.
    #[error("white is {0}: give the light that is shown as full, a number above 0")]
    White(f64),
    /// A gamma that is none.
    #[error("a gamma of {0}: give 0.1 to 10; 1 shows light as it is, 2.2 lifts what is faint")]
    Gamma(f64),
}

impl Development {
    /// A development.
    ///
    /// # Errors
    /// A white or a gamma that cannot be.
    pub fn new(white: f64, gamma: Option<f64>) -> Result<Development, DevelopError> {
        if !(white.is_finite() && white > 0.0) {
            return Err(DevelopError::White(white));
        }
        match gamma {
            Some(gamma) if !(0.1..=10.0).contains(&gamma) => Err(DevelopError::Gamma(gamma)),
            gamma => Ok(Development { white, gamma }),
        }
    }

    /// The codes of a pixel. What is brighter than white keeps its hue: all three are scaled until the brightest is full.
    #[must_use]
    pub fn codes(&self, light: [f32; 3]) -> [u8; 3] {
        let shares = light.map(|band| f64::from(band) / self.white);
        let most = shares.iter().copied().fold(1.0, f64::max);
        shares.map(|share| {
            let share = (share / most).max(0.0);
            match self.gamma {
                // A cast from float to integer saturates, and takes NaN to 0.
                Some(gamma) => (share.powf(1.0 / gamma) * 255.0).round() as u8,
                None => srgb::to_byte(share as f32),
            }
        })
    }
}

/// Red, green and blue of a pixel of any number of bands, the longest wave first: one band is grey, of two green is the mean, of more
/// each colour is the mean of a third of the bands.
#[must_use]
pub fn colours(bands: &[f32]) -> [f32; 3] {
    let mean = |some: &[f32]| some.iter().sum::<f32>() / some.len().max(1) as f32;
    match *bands {
        [] => [0.0; 3],
        [grey] => [grey; 3],
        [red, blue] => [red, 0.5 * (red + blue), blue],
        [red, green, blue] => [red, green, blue],
        _ => {
            let third = |i: usize| i * bands.len() / 3;
            [0, 1, 2].map(|i| mean(&bands[third(i)..third(i + 1)]))
        }
    }
}

/// Pixels of colours from planes of bands, the longest wave first.
#[must_use]
pub fn pixels(planes: &[Vec<f32>]) -> Vec<[f32; 3]> {
    let count = planes.iter().map(Vec::len).min().unwrap_or(0);
    let mut bands = vec![0.0; planes.len()];
    (0..count)
        .map(|i| {
            bands.iter_mut().zip(planes).for_each(|(band, plane)| *band = plane[i]);
            colours(&bands)
        })
        .collect()
}

/// The light that normalises a picture: only [`CLIPPED`] of the pixels that have light are brighter in any colour. 1 for a black picture.
#[must_use]
pub fn white_of(pixels: &[[f32; 3]]) -> f64 {
    let most = |pixel: &[f32; 3]| pixel.iter().copied().fold(0.0, f32::max);
    let mut levels: Vec<f32> = pixels.iter().map(most).filter(|level| *level > 0.0 && level.is_finite()).collect();
    if levels.is_empty() {
        return 1.0;
    }
    let place = ((levels.len() as f64 * (1.0 - CLIPPED)) as usize).min(levels.len() - 1);
    f64::from(*levels.select_nth_unstable_by(place, f32::total_cmp).1)
}

/// Light before what is behind the dust, each band dimmed by what it passes: `light + through * behind`.
#[must_use]
pub fn over(light: [f32; 3], through: [f32; 3], behind: [f32; 3]) -> [f32; 3] {
    [0, 1, 2].map(|c| light[c] + through[c] * behind[c])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_is_full_black_is_black_and_what_is_brighter_keeps_its_hue() {
        let plain = Development::new(2.0, Some(1.0)).unwrap();
        assert_eq!(plain.codes([2.0, 1.0, 0.0]), [255, 128, 0]);
        assert_eq!(plain.codes([8.0, 4.0, 0.0]), [255, 128, 0]);
        // A grey card of 18 % is 118 in sRGB (IEC 61966-2-1), and 117 by a gamma of 2.2: 0.18^(1/2.2) = 0.4587.
        assert_eq!(Development::new(1.0, None).unwrap().codes([0.18; 3]), [118; 3]);
        assert_eq!(Development::new(1.0, Some(2.2)).unwrap().codes([0.18, f32::NAN, -1.0]), [117, 0, 0]);
    }

    #[test]
    fn nonsense_is_refused_with_its_value() {
        assert_eq!(Development::new(0.0, None), Err(DevelopError::White(0.0)));
        assert_eq!(Development::new(1.0, Some(-2.2)), Err(DevelopError::Gamma(-2.2)));
        assert!(Development::new(f64::NAN, None).is_err());
    }

    #[test]
    fn any_number_of_bands_has_a_colour() {
        assert_eq!(colours(&[0.5]), [0.5; 3]);
        assert_eq!(colours(&[1.0, 0.0]), [1.0, 0.5, 0.0]);
        assert_eq!(colours(&[1.0, 2.0, 3.0, 5.0, 6.0, 8.0]), [1.5, 4.0, 7.0]);
        assert_eq!(pixels(&[vec![1.0, 2.0], vec![3.0, 4.0], vec![5.0, 6.0]]), [[1.0, 3.0, 5.0], [2.0, 4.0, 6.0]]);
    }

    #[test]
    fn one_bright_pixel_does_not_darken_a_picture() {
        let mut pixels: Vec<[f32; 3]> = (1..=1000u16).map(|i| [f32::from(i), 0.0, 0.0]).collect();
        pixels.push([1e9, 0.0, 0.0]);
        pixels.extend([[0.0; 3]; 5000]);
        assert_eq!(white_of(&pixels), 996.0);
        assert_eq!(white_of(&[[0.0; 3]; 9]), 1.0);
    }

    #[test]
    fn half_of_the_light_behind_comes_through() {
        assert_eq!(over([0.1, 0.0, 0.0], [0.5, 0.0, 1.0], [1.0; 3]), [0.6, 0.0, 1.0]);
    }
}
