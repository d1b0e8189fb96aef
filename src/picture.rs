//! An image in memory: linear light, one f32 per channel.

use std::fmt;

/// Sequences of pictures as animated PNG files in memory.
pub mod apng;
/// Numbers on a grid of three axes.
pub mod cube;
/// From linear light to a display's few codes.
pub mod dither;
/// Linear light as OpenEXR.
pub mod exr;
/// A picture between its pixels, half as large, mirrored, turned.
mod fit;
/// A small bounded reader of FITS images, and a writer.
pub mod fits;
/// Arrays of NumPy.
pub mod npy;
/// Raw numbers with a header of words.
pub mod nrrd;
/// Pictures as PNG files in memory.
pub mod png;
/// Between linear light and 8-bit codes.
pub mod srgb;

/// A rectangle of linear-light RGB pixels, row 0 on top, 0 black to 1 the projector's full drive.
///
/// f32: the projector has 8 bits and the eye 2 % steps; 24 bits of mantissa leave room for blending.
#[derive(Clone, PartialEq)]
pub struct Picture {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 3]>,
}

impl Picture {
    /// A black picture.
    #[must_use]
    pub fn black(width: usize, height: usize) -> Picture {
        Picture { width, height, pixels: vec![[0.0; 3]; width * height] }
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// All pixels, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels
    }

    /// All pixels, to be changed.
    pub fn pixels_mut(&mut self) -> &mut [[f32; 3]] {
        &mut self.pixels
    }

    /// One row.
    #[must_use]
    pub fn row(&self, y: usize) -> &[[f32; 3]] {
        &self.pixels[y * self.width..(y + 1) * self.width]
    }

    /// One row, to be changed.
    pub fn row_mut(&mut self, y: usize) -> &mut [[f32; 3]] {
        &mut self.pixels[y * self.width..(y + 1) * self.width]
    }

    /// Whether every pixel is exactly black.
    #[must_use]
    pub fn is_black(&self) -> bool {
        self.pixels.iter().all(|pixel| *pixel == [0.0; 3])
    }
}

impl fmt::Debug for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Picture({} x {})", self.width, self.height)
    }
}
