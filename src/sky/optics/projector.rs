//! The projector's rectangle in the focal plane, where the beam splitter lays it over the sky.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use crate::units::Angle;

/// The projector as the eyepiece sees it. The default is the thesis' own: a 0.7 inch XGA micromirror chip.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ProjectorGeometry {
    /// Columns of the picture.
    pub width_px: u32,
    /// Rows of the picture.
    pub height_px: u32,
    /// Distance between mirrors of the chip in micrometres: 13.68 makes 14.01 x 10.51 mm of 1024 x 768.
    pub pitch_um: f64,
    /// How many times larger the projection lens makes the chip in the focal plane. This is the calibration of section
    /// 8.7.1: photograph the Moon and the projected Moon, and multiply by their ratio. 1 until measured; 1.93 spreads
    /// the picture over a 27 mm field stop as figure 8.8 shows it.
    pub relay_magnification: f64,
    /// How far the projection unit is turned about the optical axis, counter-clockwise as the observer sees it, in degrees.
    pub angle_deg: f64,
    /// Reflections between the chip and the eye: 1, the beam splitter.
    pub reflections: u32,
    /// Whether the unit mirrors its picture itself, as projectors do for rear projection. The thesis' own unit, made for
    /// its splitter, does: text sent to it reads rightly. Set `false` if text stands back to front in the eyepiece.
    pub mirrors_itself: bool,
    /// Share of the telescope's light that passes the beam splitter.
    pub splitter_transmission: f64,
}

impl Default for ProjectorGeometry {
    fn default() -> ProjectorGeometry {
        ProjectorGeometry {
            width_px: 1024,
            height_px: 768,
            pitch_um: 13.68,
            relay_magnification: 1.0,
            angle_deg: 0.0,
            reflections: 1,
            mirrors_itself: true,
            splitter_transmission: 0.9,
        }
    }
}

/// How the projector's rectangle and the eyepiece's circle share the view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coverage {
    /// Share of the field's circle that the picture covers, 0 to 1.
    pub of_field: f64,
    /// Share of the picture that lies inside the circle, 0 to 1.
    pub of_picture: f64,
}

impl ProjectorGeometry {
    /// Millimetres in the focal plane that one pixel takes.
    #[must_use]
    pub fn pixel_mm(&self) -> f64 {
        self.pitch_um * 1e-3 * self.relay_magnification
    }

    /// Width and height of the picture in the focal plane, in millimetres.
    #[must_use]
    pub fn size_mm(&self) -> (f64, f64) {
        (f64::from(self.width_px) * self.pixel_mm(), f64::from(self.height_px) * self.pixel_mm())
    }

    /// Sky under one pixel at the middle of the picture, behind a focal length in millimetres.
    #[must_use]
    pub fn pixel_scale(&self, focal_length_mm: f64) -> Angle {
        Angle::radians(self.pixel_mm() / focal_length_mm)
    }

    /// How picture and field stop (in millimetres) cover each other: section 8.5, figure 8.8.
    ///
    /// ```text
    /// A = 4 * integral over x from 0 to min(w, r) of min(h, sqrt(r^2 - x^2)) dx        w, h half sides, r the circle's radius
    /// ```
    ///
    /// Checked: stops of 27, 24, 22, 17.5, 14 and 10.5 mm are covered by 25.7, 32.6, 38.8, 61, 86 and 100 % at 1:1.
    #[must_use]
    pub fn coverage(&self, field_stop_mm: f64) -> Coverage {
        let (width, height) = self.size_mm();
        let shared = shared_area(width / 2.0, height / 2.0, field_stop_mm / 2.0);
        Coverage {
            of_field: shared / (PI * field_stop_mm * field_stop_mm / 4.0),
            of_picture: shared / (width * height),
        }
    }

    /// The relay magnification that makes the picture as wide as a field stop: as figure 8.8 has it for the 24 mm
    /// eyepiece, the top and bottom of the circle stay uncovered and only the picture's four corners are lost.
    #[must_use]
    pub fn relay_for_width(&self, field_stop_mm: f64) -> f64 {
        field_stop_mm / (f64::from(self.width_px) * self.pitch_um * 1e-3)
    }

    /// Whether the picture must be mirrored left to right before it is sent to the unit.
    #[must_use]
    pub fn must_mirror(&self) -> bool {
        (self.reflections % 2 == 1) != self.mirrors_itself
    }
}

/// Area that a rectangle of half sides `w` and `h` shares with a circle of radius `r` about its middle.
fn shared_area(w: f64, h: f64, r: f64) -> f64 {
    // Primitive of sqrt(r^2 - x^2).
    let under_arc = |x: f64| (x * (r * r - x * x).max(0.0).sqrt() + r * r * (x / r).clamp(-1.0, 1.0).asin()) / 2.0;
    // Up to `flat` the rectangle's side is the roof, from there on the circle.
    let flat = (r * r - h * h).max(0.0).sqrt().min(w);
    let end = w.min(r);
    4.0 * (flat * h + under_arc(end) - under_arc(flat))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_chip_measures_14_01_by_10_51_mm_and_a_pixel_1_129_arcseconds() {
        let projector = ProjectorGeometry::default();
        let (width, height) = projector.size_mm();
        assert!((width - 14.01).abs() < 0.005 && (height - 10.51).abs() < 0.005);
        let scale = projector.pixel_scale(2500.0);
        assert!((scale.to_arcseconds() - 1.129).abs() < 5e-4);
        assert!((scale.to_arcminutes() * 1024.0 - 19.26).abs() < 0.01);
        assert!((scale.to_arcminutes() * 768.0 - 14.45).abs() < 0.01);
    }

    #[test]
    fn the_picture_covers_the_published_shares_of_each_field_stop() {
        let projector = ProjectorGeometry::default();
        for (stop_mm, share) in [(27.0, 0.257), (24.0, 0.326), (22.0, 0.388), (17.5, 0.61), (14.0, 0.86), (10.5, 1.0)] {
            let covered = projector.coverage(stop_mm).of_field;
            assert!((covered - share).abs() < 0.006, "{stop_mm} mm: {covered}");
        }
        assert!((projector.coverage(30.0).of_picture - 1.0).abs() < 1e-12);
    }

    #[test]
    fn figure_8_8_leaves_the_top_and_bottom_of_the_circle_and_the_corners_of_the_picture() {
        let bare = ProjectorGeometry::default();
        let fitted = ProjectorGeometry { relay_magnification: bare.relay_for_width(27.0), ..bare };
        let (width, height) = fitted.size_mm();
        assert!((fitted.relay_magnification - 1.927).abs() < 1e-3);
        assert!((width - 27.0).abs() < 1e-9 && height < 27.0);
        let coverage = fitted.coverage(27.0);
        assert!(coverage.of_field > 0.8 && coverage.of_field < 1.0, "{coverage:?}");
        assert!(coverage.of_picture > 0.8 && coverage.of_picture < 1.0, "{coverage:?}");
    }

    #[test]
    fn a_unit_that_does_not_mirror_itself_must_be_sent_a_mirrored_picture() {
        let own = ProjectorGeometry::default();
        assert!(!own.must_mirror());
        assert!(ProjectorGeometry { mirrors_itself: false, ..own }.must_mirror());
    }
}
