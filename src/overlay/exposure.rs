//! How much light a picture sends into the eye, as the cones and as the rods see it.

use crate::picture::Picture;

/// Light of the projector's primaries: shares of white's luminance for the cones (sRGB), and of each what the rods see of a
/// candela: red that of an ordinary screen, 0.206; green and blue in the ratio of the same screen's (Apple Studio Display,
/// from the CIE tables), so that white has D65's 2.46.
const PHOTOPIC: [f64; 3] = [0.2126, 0.7152, 0.0722];
const SCOTOPIC_OVER_PHOTOPIC: [f64; 3] = [0.206, 2.045, 13.21];

/// A pixel under this share of full drive counts as dark.
const DARK: f32 = 1.0 / 512.0;

/// Every so many rows and columns are looked at: it is asked for each frame.
const STEP: usize = 4;

/// Half of the side of the square in the middle where the object is, in shares of the picture's height.
const MIDDLE: f64 = 0.1;

/// What a picture sends into the eye. The means are over the lit part: adaptation is local on the retina.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Exposure {
    /// Photopic luminance of the lit part, cd/m2.
    pub photopic_cd_m2: f64,
    /// Scotopic luminance of the lit part, cd/m2.
    pub scotopic_cd_m2: f64,
    /// Share of the picture that is lit.
    pub lit: f64,
    /// Photopic luminance on the object in the middle, cd/m2: the veil that lowers its contrast.
    pub middle_cd_m2: f64,
}

/// What a picture sends into the eye through a projector whose full white is `full_cd_m2` at the eye.
#[must_use]
pub fn exposure(picture: &Picture, full_cd_m2: f64) -> Exposure {
    let (width, height) = (picture.width(), picture.height());
    let reach = MIDDLE * height as f64;
    let (mut photopic, mut scotopic, mut lit, mut looked) = (0.0, 0.0, 0.0f64, 0.0f64);
    let (mut middle, mut in_middle) = (0.0, 0.0f64);
    for y in (0..height).step_by(STEP) {
        let row = picture.row(y);
        for x in (0..width).step_by(STEP) {
            let light = row[x].map(f64::from);
            let seen: f64 = light.iter().zip(PHOTOPIC).map(|(drive, share)| drive * share).sum();
            let from_middle = (x as f64 - width as f64 / 2.0).abs().max((y as f64 - height as f64 / 2.0).abs());
            if from_middle <= reach {
                middle += seen;
                in_middle += 1.0;
            }
            looked += 1.0;
            if row[x].iter().any(|drive| *drive > DARK) {
                lit += 1.0;
                photopic += seen;
                let rods = light.iter().zip(PHOTOPIC).zip(SCOTOPIC_OVER_PHOTOPIC);
                scotopic += rods.map(|((drive, share), ratio)| drive * share * ratio).sum::<f64>();
            }
        }
    }
    Exposure {
        photopic_cd_m2: full_cd_m2 * photopic / lit.max(1.0),
        scotopic_cd_m2: full_cd_m2 * scotopic / lit.max(1.0),
        lit: lit / looked.max(1.0),
        middle_cd_m2: full_cd_m2 * middle / in_middle.max(1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn red_and_white_are_to_cones_and_rods_what_the_lamps_of_the_same_names_are() {
        let mut picture = Picture::black(64, 64);
        for y in 0..32 {
            picture.row_mut(y).fill([1.0, 0.0, 0.0]);
        }
        let red = exposure(&picture, 0.3);
        assert!((red.lit - 0.5).abs() < 1e-9 && (red.photopic_cd_m2 - 0.3 * 0.2126).abs() < 1e-9, "{red:?}");
        assert!((red.scotopic_cd_m2 / red.photopic_cd_m2 - 0.206).abs() < 1e-9);
        picture.pixels_mut().fill([1.0; 3]);
        let white = exposure(&picture, 0.3);
        assert!((white.photopic_cd_m2 - 0.3).abs() < 1e-9 && (white.middle_cd_m2 - 0.3).abs() < 1e-9);
        assert!((white.scotopic_cd_m2 / white.photopic_cd_m2 - 2.46).abs() < 0.001, "{white:?}");
    }

    #[test]
    fn black_and_nothing_at_all_send_nothing() {
        assert_eq!(exposure(&Picture::black(64, 64), 0.3), Exposure::default());
        assert_eq!(exposure(&Picture::black(0, 0), 0.3), Exposure::default());
    }
}
