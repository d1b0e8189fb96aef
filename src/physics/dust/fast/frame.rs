//! A picture seen in flight.

use rayon::prelude::*;

use super::cast::Work;
use super::shade::BANDS;

/// What a frame's pixels may be off by, as shares of the mean light of the pixels probed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Believed {
    /// Mean error.
    pub mean: f32,
    /// Worst error.
    pub worst: f32,
    /// Pixels probed.
    pub probes: usize,
}

/// A picture seen in flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// Pixels across.
    pub width: usize,
    /// Pixels down.
    pub height: usize,
    /// Radiance, row 0 on top; bands that the scene does not have are 0.
    pub pixels: Vec<[f32; 3]>,
    /// The share of the light from behind the dust that comes through each pixel.
    pub through: Vec<[f32; 3]>,
    /// No pixel lacks more radiance than this for what was passed over or ended early.
    pub left_out: f32,
    /// How far from finer steps without the grid's light; nothing where no pixel was probed.
    pub believed: Option<Believed>,
    /// What was done.
    pub work: Work,
}

/// A frame of few pixels spread over many, linearly between their centres.
pub(super) fn spread(frame: &Frame, width: usize, height: usize, coarse: usize) -> Frame {
    let along = |at: usize, size: usize| {
        let place = ((at as f32 + 0.5) / coarse as f32 - 0.5).clamp(0.0, (size - 1) as f32);
        (place as usize, (place as usize + 1).min(size - 1), place.fract())
    };
    let between = |from: &[[f32; BANDS]]| {
        let mut to = vec![[0.0; BANDS]; width * height];
        to.par_chunks_mut(width).enumerate().for_each(|(row, to)| {
            let (top, bottom, v) = along(row, frame.height);
            let (top, bottom) = (&from[top * frame.width..], &from[bottom * frame.width..]);
            for (column, to) in to.iter_mut().enumerate() {
                let (left, right, u) = along(column, frame.width);
                for (band, to) in to.iter_mut().enumerate() {
                    let line = |from: &[[f32; BANDS]]| from[left][band] * (1.0 - u) + from[right][band] * u;
                    *to = line(top) * (1.0 - v) + line(bottom) * v;
                }
            }
        });
        to
    };
    let (pixels, through) = (between(&frame.pixels), between(&frame.through));
    Frame { width, height, pixels, through, ..*frame }
}
