//! Pictures as PNG files in memory: 8 bits a channel, sRGB.

use std::io::Cursor;

use image::{ImageFormat, RgbImage};

use super::{Picture, dither, srgb};

/// Why a picture could not be written as PNG.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("a picture of {width} x {height} pixels cannot be written as PNG: {why}")]
pub struct PngError {
    width: usize,
    height: usize,
    why: String,
}

/// The bytes of a PNG file.
///
/// # Errors
/// A picture without pixels, or larger than PNG can be.
pub fn encode(picture: &Picture) -> Result<Vec<u8>, PngError> {
    let bytes = picture.pixels().iter().flatten().map(|&linear| srgb::to_byte(linear)).collect();
    of_bytes(picture.width(), picture.height(), bytes)
}

/// The bytes of a PNG file, as a display dithers the picture.
///
/// # Errors
/// As [`encode`].
pub fn encode_dithered(picture: &Picture) -> Result<Vec<u8>, PngError> {
    of_bytes(picture.width(), picture.height(), dither::rgb8(picture))
}

/// The bytes of a PNG file of ready codes, row by row from the top.
///
/// # Errors
/// No pixels, more or fewer than the sides say, or larger than PNG can be.
pub fn encode_codes(width: usize, height: usize, codes: &[[u8; 3]]) -> Result<Vec<u8>, PngError> {
    of_bytes(width, height, codes.as_flattened().to_vec())
}

fn of_bytes(width: usize, height: usize, bytes: Vec<u8>) -> Result<Vec<u8>, PngError> {
    let refused = |why: String| PngError { width, height, why };
    let sides = u32::try_from(width).ok().zip(u32::try_from(height).ok());
    let image = sides
        .and_then(|(width, height)| RgbImage::from_raw(width, height, bytes))
        .ok_or_else(|| refused("a side is too long, or pixels are missing".into()))?;
    let mut file = Cursor::new(Vec::new());
    image.write_to(&mut file, ImageFormat::Png).map_err(|error| refused(error.to_string()))?;
    Ok(file.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_what_another_reader_sees() {
        let mut picture = Picture::black(3, 2);
        picture.row_mut(1)[2] = [1.0, 0.18, 0.0];
        let read = image::load_from_memory(&encode(&picture).unwrap()).unwrap().to_rgb8();
        assert_eq!(read.dimensions(), (3, 2));
        assert_eq!(read.get_pixel(2, 1).0, [255, 118, 0]);
        assert_eq!(read.get_pixel(0, 0).0, [0, 0, 0]);
    }

    #[test]
    fn a_picture_without_pixels_is_refused() {
        assert!(encode(&Picture::black(0, 0)).is_err());
    }
}
