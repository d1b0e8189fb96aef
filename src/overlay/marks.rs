//! The marks: outlines of deep-sky objects in their true size and angle, the target's reticle, north and east, the scale.

use tiny_skia::Path;

use super::canvas::{Disc, Ink, ellipse, line};
use crate::sky::catalogue::{FieldObject, Kind};
use crate::sky::project::Projection;
use crate::units::Angle;

/// Half axes below which an outline is drawn as a circle of this radius, in pixels.
const SMALLEST_PX: f64 = 5.0;

/// A deep-sky object on the canvas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outline {
    /// Middle.
    pub x: f64,
    /// Downwards.
    pub y: f64,
    /// Half major axis as a vector, in pixels.
    pub major: (f64, f64),
    /// Half minor axis as a vector.
    pub minor: (f64, f64),
    /// Whether the edge is drawn broken: clusters have none.
    pub broken: bool,
}

impl Outline {
    /// The outline of an object; `None` when it is on the other side of the sky. An object of unknown size is a small circle.
    ///
    /// The axes are laid off from the middle along the position angle: a degree away the error is 1e-4.
    #[must_use]
    pub fn of(object: &FieldObject, projection: &Projection) -> Option<Outline> {
        let (x, y) = projection.pixel(&object.position)?;
        let (a, b) = object.axes_arcmin.unwrap_or((0.0, 0.0));
        let half = |axis: f64| projection.pixels(Angle::arcminutes(axis)) / 2.0;
        let (a, b) = (half(a).max(SMALLEST_PX), half(b).max(SMALLEST_PX.min(half(a).max(SMALLEST_PX))));
        let angle = object.position_angle.unwrap_or(Angle::ZERO);
        let along = projection.direction_of(angle);
        let across = projection.direction_of(angle + Angle::degrees(90.0));
        let clusters = [Kind::OpenCluster, Kind::GlobularCluster, Kind::Association, Kind::ClusterWithNebula];
        Some(Outline {
            x,
            y,
            major: (along.0 * a, along.1 * a),
            minor: (across.0 * b, across.1 * b),
            broken: clusters.contains(&object.kind),
        })
    }

    /// Half the major axis in pixels.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.major.0.hypot(self.major.1)
    }

    /// Half the minor axis in pixels.
    #[must_use]
    pub fn minor_radius(&self) -> f64 {
        self.minor.0.hypot(self.minor.1)
    }

    /// Draws the outline.
    pub fn draw(&self, ink: &mut Ink, width: f32) {
        if let Some(path) = ellipse((self.x, self.y), self.major, self.minor) {
            ink.stroke(&path, width, self.broken.then_some((6.0, 6.0)));
        }
    }

    /// Draws the major axis as a broken line through the middle, which stays free: for objects larger than the view.
    pub fn draw_axis(&self, ink: &mut Ink, free: f64, reach: f64) {
        let (dx, dy) = (self.major.0 / self.radius(), self.major.1 / self.radius());
        for side in [-1.0, 1.0] {
            let at = |r: f64| (self.x + side * dx * r, self.y + side * dy * r);
            stroke(ink, line(at(free), at(reach)), 1.2, Some((2.0, 9.0)));
        }
    }
}

/// Four ticks about a point, from `free` pixels outwards.
pub fn reticle(ink: &mut Ink, x: f64, y: f64, free: f64) {
    for (dx, dy) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
        let at = |r: f64| (x + dx * r, y + dy * r);
        stroke(ink, line(at(free), at(free + 12.0)), 1.6, None);
    }
}

/// Arrows to north and east from a point. Gives where the letters N and E go (their middles).
pub fn compass(ink: &mut Ink, projection: &Projection, x: f64, y: f64, length: f64) -> [(f64, f64); 2] {
    [0.0, 90.0].map(|position_angle| {
        let (dx, dy) = projection.direction_of(Angle::degrees(position_angle));
        let tip = (x + dx * length, y + dy * length);
        stroke(ink, line((x, y), tip), 1.5, None);
        for side in [-1.0, 1.0] {
            let barb = (tip.0 - 7.0 * dx - side * 4.0 * dy, tip.1 - 7.0 * dy + side * 4.0 * dx);
            stroke(ink, line(tip, barb), 1.5, None);
        }
        (x + dx * (length + 11.0), y + dy * (length + 11.0))
    })
}

/// A bar of a round angle, ending at `right`, at most `most` pixels long. Gives its left end and the angle's words.
pub fn scale_bar(ink: &mut Ink, projection: &Projection, right: f64, y: f64, most: f64) -> (f64, String) {
    const ROUND_ARCSEC: [(f64, &str); 9] = [
        (1800.0, "30′"),
        (600.0, "10′"),
        (300.0, "5′"),
        (120.0, "2′"),
        (60.0, "1′"),
        (30.0, "30″"),
        (10.0, "10″"),
        (5.0, "5″"),
        (1.0, "1″"),
    ];
    let length = |arcsec: f64| projection.pixels(Angle::arcseconds(arcsec));
    let (arcsec, words) = ROUND_ARCSEC.into_iter().find(|(arcsec, _)| length(*arcsec) <= most).unwrap_or((1.0, "1″"));
    let left = right - length(arcsec);
    stroke(ink, line((left, y), (right, y)), 1.5, None);
    for x in [left, right] {
        stroke(ink, line((x, y - 4.0), (x, y + 4.0)), 1.5, None);
    }
    (left, words.into())
}

/// A circle, broken.
pub fn broken_circle(ink: &mut Ink, disc: Disc, width: f32, dash: (f32, f32)) {
    stroke(ink, super::canvas::circle(disc), width, Some(dash));
}

fn stroke(ink: &mut Ink, path: Option<Path>, width: f32, dash: Option<(f32, f32)>) {
    if let Some(path) = path {
        ink.stroke(&path, width, dash);
    }
}
