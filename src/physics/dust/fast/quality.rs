//! How much is done for a frame, and what cannot be done.

/// Why there is no flight.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum FastError {
    /// More bands than the kernel has lanes.
    #[error("{0} bands: one flies with 1 to 3; the renderer for pictures has any number")]
    Bands(usize),
    /// No pixels, or too many.
    #[error("a frame of {0} x {1} pixels: each side has 1 to 8192")]
    Size(usize, usize),
    /// Steps that are none.
    #[error("steps of {0} voxels: they are from 0.05 to 8")]
    Step(f64),
    /// A share that is none.
    #[error("rays end where a share of {0} comes through: it is from 0 to less than 1")]
    Opaque(f64),
}

/// How much is done for a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quality {
    /// Steps along rays, voxels.
    pub step: f64,
    /// A ray ends where no more than this share of the light behind comes through; 0 never.
    pub opaque: f64,
    /// Frames are cast with rays this many pixels apart, 1 to 8, and spread over the pixels between.
    pub coarse: usize,
    /// With rays two pixels apart: a pixel between them gets a ray of its own where its neighbours say by more than this share what it is,
    /// see `spread`; 0 for no such rays.
    pub refine: f64,
    /// Whether empty bricks are passed over.
    pub skip: bool,
    /// Pixels in which the error is looked for.
    pub probes: usize,
}

impl Quality {
    /// A ray for each pixel, steps of a voxel.
    pub const FULL: Quality =
        Quality { step: 1.0, opaque: 1.0 / 1024.0, coarse: 1, refine: 0.0, skip: true, probes: 0 };
    /// A ray for each pixel that its neighbours do not tell, steps of a voxel.
    pub const FLYING: Quality = Quality { coarse: 2, refine: 1.0 / 512.0, ..Quality::FULL };
    /// A ray for four pixels, steps of a voxel and a half: for keys held down.
    pub const MOVING: Quality =
        Quality { step: 1.5, opaque: 1.0 / 256.0, coarse: 2, refine: 0.0, skip: true, probes: 0 };
    /// A ray for 16 pixels, steps of two voxels: for slow machines.
    pub const DRAFT: Quality =
        Quality { step: 2.0, opaque: 1.0 / 128.0, coarse: 4, refine: 0.0, skip: true, probes: 0 };
    /// Half steps, and nothing left out.
    pub const EVERYTHING: Quality = Quality { step: 0.5, opaque: 0.0, coarse: 1, refine: 0.0, skip: false, probes: 0 };

    pub(super) fn check(&self) -> Result<(), FastError> {
        if !(0.05..=8.0).contains(&self.step) {
            return Err(FastError::Step(self.step));
        }
        if !(0.0..1.0).contains(&self.opaque) {
            return Err(FastError::Opaque(self.opaque));
        }
        Ok(())
    }
}
