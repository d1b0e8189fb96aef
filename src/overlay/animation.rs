//! Moving pictures of an object: read, and which frame is due. Frames are kept as bytes, and become light when they are drawn.

use std::time::Duration;

use super::photograph::{Photograph, Plate};
use crate::picture::{Picture, srgb};

/// Reading animations from the bytes of files.
pub mod read;

/// A frame as bytes of red, green and blue, row by row.
type Frame = Vec<[u8; 3]>;

/// An animation and where it belongs.
#[derive(Debug, Clone, PartialEq)]
pub struct Animation {
    /// What can be told of it without its frames.
    pub playable: Playable,
    /// What it is called: its file's name without the ending.
    pub name: String,
    /// Who made it.
    pub credit: Option<String>,
    plate: Plate,
    width: usize,
    frames: Vec<Frame>,
}

impl Animation {
    /// A frame, ready to be drawn; the last one when there are not so many.
    #[must_use]
    pub fn frame(&self, index: usize) -> Option<Photograph> {
        let frame = self.frames.get(index).or(self.frames.last())?;
        let mut picture = Picture::black(self.width, frame.len() / self.width.max(1));
        for (light, bytes) in picture.pixels_mut().iter_mut().zip(frame) {
            *light = bytes.map(srgb::from_byte);
        }
        Some(Photograph::new(self.name.clone(), self.credit.clone(), self.plate, picture))
    }
}

/// An animation that can be played.
#[derive(Debug, Clone, PartialEq)]
pub struct Playable {
    /// The object's name as the catalogue has it.
    pub object: String,
    /// How many frames it has.
    pub frames: usize,
    /// How fast they follow each other.
    pub frames_per_second: f64,
}

impl Playable {
    /// The frame that is due after it has been played for so long; round and round.
    #[must_use]
    pub fn frame_at(&self, played: Duration) -> usize {
        let frame = (played.as_secs_f64() * self.frames_per_second).floor().max(0.0);
        (frame as u64 % self.frames.max(1) as u64) as usize
    }

    /// How long the frame that is due is still seen.
    #[must_use]
    pub fn until_next(&self, played: Duration) -> Duration {
        let frames = played.as_secs_f64() * self.frames_per_second;
        let rest = (frames.floor() + 1.0 - frames) / self.frames_per_second;
        Duration::try_from_secs_f64(rest.max(1e-3)).unwrap_or(Duration::from_secs(1))
    }
}
