//! Sequences of pictures as animated PNG files in memory: 8 bits a channel.

use std::io::Write;

/// Why a sequence could not be written.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ApngError {
    /// The sides are none, or too long, or the number of frames.
    #[error("{frames} frames of {width} x {height} pixels cannot be an animated PNG: give 1 or more of each")]
    Shape {
        /// Frames.
        frames: usize,
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// The library refused.
    #[error("the animated PNG could not be written: {0}")]
    Library(String),
}

/// An animated PNG that is written frame by frame.
pub struct Apng<W: Write> {
    writer: png::Writer<W>,
}

impl<W: Write> Apng<W> {
    /// Begins a file of so many frames, each shown for a number of milliseconds, over and over.
    ///
    /// # Errors
    /// No frames, no pixels, or the file could not be written.
    pub fn begin(to: W, width: usize, height: usize, frames: usize, frame_ms: u16) -> Result<Apng<W>, ApngError> {
        let shape = ApngError::Shape { frames, width, height };
        let sides = [width, height, frames].map(|number| u32::try_from(number).ok().filter(|number| *number > 0));
        let [Some(columns), Some(rows), Some(count)] = sides else { return Err(shape) };
        let library = |error: png::EncodingError| ApngError::Library(error.to_string());
        let mut encoder = png::Encoder::new(to, columns, rows);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_animated(count, 0).map_err(library)?;
        encoder.set_frame_delay(frame_ms, 1000).map_err(library)?;
        Ok(Apng { writer: encoder.write_header().map_err(library)? })
    }

    /// Adds the next frame: codes row by row from the top.
    ///
    /// # Errors
    /// It has not the size of the others, or the file could not be written.
    pub fn frame(&mut self, codes: &[[u8; 3]]) -> Result<(), ApngError> {
        self.writer.write_image_data(codes.as_flattened()).map_err(|error| ApngError::Library(error.to_string()))
    }

    /// Ends the file.
    ///
    /// # Errors
    /// Frames are missing, or the file could not be written.
    pub fn end(self) -> Result<(), ApngError> {
        self.writer.finish().map_err(|error| ApngError::Library(error.to_string()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_frames_are_there_and_other_readers_see_the_first() {
        let mut file = Vec::new();
        let mut apng = Apng::begin(&mut file, 2, 1, 3, 100).unwrap();
        for level in [10, 20, 30] {
            apng.frame(&[[level; 3], [0; 3]]).unwrap();
        }
        apng.end().unwrap();
        let count = |chunk: &[u8]| file.windows(4).filter(|window| *window == chunk).count();
        assert_eq!((count(b"acTL"), count(b"fcTL")), (1, 3));
        let first = image::load_from_memory(&file).unwrap().to_rgb8();
        assert_eq!((first.dimensions(), first.get_pixel(0, 0).0), ((2, 1), [10; 3]));
    }

    #[test]
    fn no_frames_are_refused() {
        assert!(matches!(Apng::begin(Vec::new(), 2, 1, 0, 100), Err(ApngError::Shape { frames: 0, .. })));
    }
}
