//! How the sky lies on the canvas: tube, diagonal, splitter and projector, and what was measured of them, as one transform.

use serde::{Deserialize, Serialize};

use super::Instrument;
use crate::units::Angle;

/// From the tube's view to the canvas. Every mirror, every turn and every flip has been put together here, and nothing that
/// draws knows of any of them by itself.
///
/// ```text
/// canvas = middle + Rot(upper side) diag(-1 or +1, 1) (right, up of the tube) / scale
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Registration {
    /// Whether position angles grow clockwise on the canvas.
    pub mirrored: bool,
    /// Where the tube's upper side is on the canvas, from its top counter-clockwise.
    pub upper_side: Angle,
    /// Sky under one pixel of the canvas.
    pub scale: Angle,
    /// Where the optical axis falls on the canvas, pixels from its upper left corner.
    pub middle: (f64, f64),
}

/// What was measured of the registration, beyond what the instrument's file says: the drawn sky is to be made smaller by
/// `scale`, turned back by `turn_deg`, mirrored if `mirrored`, and moved. Measured by `scotopic calibrate moon`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// Drawn over seen size.
    pub scale: f64,
    /// One standard deviation of it.
    pub scale_error: f64,
    /// How far the drawn sky was turned, counter-clockwise as the observer sees it, degrees.
    pub turn_deg: f64,
    /// One standard deviation of it.
    pub turn_error_deg: f64,
    /// Whether the drawn sky was the seen one's mirror image, left and right exchanged.
    pub mirrored: bool,
    /// Where the optical axis falls, canvas pixels right of the canvas' middle.
    pub right_px: f64,
    /// The same, downwards.
    pub down_px: f64,
    /// One standard deviation of either.
    pub offset_error_px: f64,
}

impl Default for Calibration {
    /// Nothing measured: as the file says.
    fn default() -> Calibration {
        Calibration {
            scale: 1.0,
            scale_error: 0.0,
            turn_deg: 0.0,
            turn_error_deg: 0.0,
            mirrored: false,
            right_px: 0.0,
            down_px: 0.0,
            offset_error_px: 0.0,
        }
    }
}

/// A measured scale beyond these is a mistake sooner than a projector.
const SCALES: std::ops::RangeInclusive<f64> = 0.02..=50.0;
/// No optical axis is further from the canvas' middle, pixels.
const FARTHEST_PX: f64 = 4096.0;

impl Calibration {
    /// Whether these are numbers that a projector can have.
    #[must_use]
    pub fn is_sane(&self) -> bool {
        let finite = [self.turn_deg, self.scale_error, self.turn_error_deg, self.offset_error_px];
        SCALES.contains(&self.scale)
            && finite.iter().all(|number| number.is_finite())
            && [self.right_px, self.down_px].iter().all(|px| px.abs() <= FARTHEST_PX)
    }

    /// This one, after another that was measured of pictures drawn with it: the next is what is still left.
    #[must_use]
    pub fn then(&self, next: &Calibration) -> Calibration {
        // Turning a mirror image turns it the other way.
        let turn = if self.mirrored { -next.turn_deg } else { next.turn_deg };
        Calibration {
            scale: self.scale * next.scale,
            scale_error: self.scale * next.scale_error,
            turn_deg: (self.turn_deg + turn + 180.0).rem_euclid(360.0) - 180.0,
            turn_error_deg: next.turn_error_deg,
            mirrored: self.mirrored != next.mirrored,
            right_px: self.right_px + next.right_px,
            down_px: self.down_px + next.down_px,
            offset_error_px: next.offset_error_px,
        }
    }
}

impl Instrument {
    /// The one transform from the tube's view to the canvas.
    ///
    /// The telescope's mirrors say which way round the view is, the diagonal which way up; the unit's own turn moves the canvas,
    /// so that the sky turns back on it. What was measured comes last. (The splitter's mirror image is undone on the way to the
    /// unit, by [`must_mirror`](super::ProjectorGeometry::must_mirror), so that text reads rightly: seen from the eye the
    /// canvas is never mirrored.)
    #[must_use]
    pub fn registration(&self) -> Registration {
        let (projector, measured) = (&self.projector, &self.calibration);
        let turned = self.telescope.upper_side() - Angle::degrees(projector.angle_deg + measured.turn_deg);
        let (width, height) = (f64::from(projector.width_px), f64::from(projector.height_px));
        Registration {
            mirrored: self.telescope.mirrored() != measured.mirrored,
            upper_side: if measured.mirrored { -turned } else { turned }.wrapped(),
            scale: self.projector.pixel_scale(self.telescope.focal_length_mm) * measured.scale,
            middle: (width / 2.0 + measured.right_px, height / 2.0 + measured.down_px),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_a_measurement_the_file_alone_counts() {
        let plain = Instrument::default().registration();
        assert_eq!((plain.mirrored, plain.upper_side, plain.middle), (false, Angle::degrees(180.0), (512.0, 384.0)));
        assert!((plain.scale.to_arcseconds() - 1.129).abs() < 5e-4);
    }

    #[test]
    fn a_second_measurement_is_of_what_the_first_left() {
        let first = Calibration { scale: 0.6, turn_deg: 170.0, right_px: 10.0, ..Calibration::default() };
        let second =
            Calibration { scale: 1.01, turn_deg: 20.0, mirrored: true, right_px: -3.0, ..Calibration::default() };
        let both = first.then(&second);
        assert!((both.scale - 0.606).abs() < 1e-12 && (both.turn_deg + 170.0).abs() < 1e-9);
        assert!(both.mirrored && both.right_px == 7.0);
        // Through the mirror, a turn found later is the other way.
        assert!((both.then(&Calibration { turn_deg: 5.0, ..Calibration::default() }).turn_deg + 175.0).abs() < 1e-9);
    }

    #[test]
    fn numbers_that_no_projector_has_are_not_sane() {
        let plain = Calibration::default();
        assert!(plain.is_sane());
        for wrong in [
            Calibration { scale: f64::NAN, ..plain },
            Calibration { scale: 0.0, ..plain },
            Calibration { turn_deg: f64::INFINITY, ..plain },
            Calibration { down_px: 1e9, ..plain },
        ] {
            assert!(!wrong.is_sane(), "{wrong:?}");
        }
    }
}
