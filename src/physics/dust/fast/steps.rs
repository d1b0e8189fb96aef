//! How long steps can be.

use super::Flyer;
use super::quality::{FastError, Quality};
use crate::physics::dust::camera::Camera;

/// Steps to choose from, voxels.
const STEPS: [f64; 8] = [0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0];

/// Pixels across and down of a look at what steps do.
const LOOK: usize = 64;

/// How much further off the worst pixel of a picture is than the worst of a look: of 512 x 512 pixels a look sees one in 64, and
/// the worst of all was 1.04 to 2.9 times as far off (the bench's nebula of 128^3, steps of 2 to 3 voxels, two directions).
const UNSEEN: f32 = 3.0;

impl Flyer {
    /// The longest steps, up to three voxels, with which no pixel is further than `tolerance` of the brightest from what half voxels show,
    /// and pixels on average no further than `tolerance` of their mean: a smooth nebula on a fine grid needs no more. Looked for in 64 x 64
    /// pixels of what the camera sees.
    ///
    /// # Errors
    /// A quality that cannot be.
    pub fn longest_step(&mut self, camera: &Camera, quality: &Quality, tolerance: f32) -> Result<f64, FastError> {
        let mut seen = |step| {
            let quality = Quality { step, coarse: 1, probes: 0, ..*quality };
            self.frame(camera, LOOK, LOOK, &quality).map(|frame| frame.pixels)
        };
        let fine = seen(STEPS[0])?;
        let white = fine.iter().flatten().fold(0.0f32, |a, b| a.max(*b));
        let light: f32 = fine.iter().flatten().sum();
        for step in STEPS[1..].iter().rev() {
            let there = seen(*step)?;
            let off = fine.iter().flatten().zip(there.iter().flatten()).map(|(a, b)| (a - b).abs());
            let (worst, sum) = off.fold((0.0f32, 0.0f32), |(worst, sum), off| (worst.max(off), sum + off));
            if UNSEEN * worst <= tolerance * white && sum <= tolerance * light {
                return Ok(*step);
            }
        }
        Ok(STEPS[0])
    }
}
