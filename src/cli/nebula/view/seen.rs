//! How much there is to see in a frame: frames of little are quick.

use crate::physics::dust::fast::Frame;
use crate::physics::dust::volume::Volume;

/// What a frame shows of a volume.
pub(super) struct Seen {
    /// Share of the pixels that let less than 98 % through.
    pub(super) covered: f64,
    /// Share of the voxels with dust.
    pub(super) filled: f64,
    /// Median optical depth of the middle eighth of the frame.
    pub(super) depth: f64,
}

impl Seen {
    /// In one band.
    pub(super) fn of(frame: &Frame, volume: &Volume, band: usize) -> Seen {
        let through = |pixel: &[f32; 3]| pixel.get(band).copied().unwrap_or(1.0).max(f32::MIN_POSITIVE);
        let middle = |n: usize, size: usize| n * 16 >= size * 7 && n * 16 < (size * 9).max(16);
        let inside = |at: usize| middle(at % frame.width, frame.width) && middle(at / frame.width, frame.height);
        let pixels = frame.through.iter().enumerate().filter(|(at, _)| inside(*at));
        let mut depths: Vec<f32> = pixels.map(|(_, pixel)| -through(pixel).ln()).collect();
        depths.sort_unstable_by(f32::total_cmp);
        let share = |count: usize, all: usize| count as f64 / all.max(1) as f64;
        let (all, density) = (&frame.through, volume.density());
        Seen {
            covered: share(all.iter().filter(|pixel| through(pixel) < 0.98).count(), all.len()),
            filled: share(density.iter().filter(|density| **density > 0.0).count(), density.len()),
            depth: depths.get(depths.len() / 2).copied().map_or(0.0, f64::from),
        }
    }
}
