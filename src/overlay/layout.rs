//! Where things go on the canvas: the text's size and lines, and in which part the sky's picture stands.

use std::rc::Rc;

use super::canvas::{Area, Disc, Region};
use super::style::Style;
use super::text::{Scribe, Weight, Written};
use crate::sky::field::FieldOfView;
use crate::sky::project::Projection;

/// Least and largest text in pixels an em: what an XGA chip can show, and what leaves room for the sky.
const TEXT_PX: (f64, f64) = (13.0, 26.0);
/// Distance of text from the edge of what is seen.
const MARGIN: f64 = 10.0;

/// Text size for the eyepiece in use: a pixel grows with the magnification, so the same apparent size needs fewer.
#[must_use]
pub fn text_px(field: &FieldOfView, style: &Style) -> f32 {
    let pixel_arcmin = field.instrument.pixel_scale().to_arcminutes() * field.instrument.magnification();
    (f64::from(style.text_arcmin) / pixel_arcmin).clamp(TEXT_PX.0, TEXT_PX.1) as f32
}

/// The weight that is legible at a size.
#[must_use]
pub fn weight(em_px: f32) -> Weight {
    if em_px < 19.0 { Weight::Bold } else { Weight::Regular }
}

/// A written line and where its upper left corner goes.
pub struct Line {
    /// What is written.
    pub text: Rc<Written>,
    /// Columns from the left.
    pub left: i64,
    /// Rows from the top.
    pub top: i64,
}

impl Line {
    /// A line in the middle of `x`, from `top` downwards.
    #[must_use]
    pub fn centred(text: Rc<Written>, x: f64, top: f64) -> Line {
        let left = (x - text.width as f64 / 2.0).round() as i64;
        Line { text, left, top: top.round() as i64 }
    }

    /// Its box.
    #[must_use]
    pub fn area(&self) -> Area {
        let (left, top) = (self.left as f64, self.top as f64);
        Area { left, top, right: left + self.text.width as f64, bottom: top + self.text.height as f64 }
    }
}

/// Lines one under another in the middle, as high up as each of them can be seen whole. Lines that cannot be seen in the upper
/// two fifths are left out, the last first.
#[must_use]
pub fn block(scribe: &mut Scribe, lines: &[String], em_px: f32, field: &FieldOfView, region: &Region) -> Vec<Line> {
    let middle = field.width_px as f64 / 2.0;
    let written: Vec<Rc<Written>> = lines
        .iter()
        .enumerate()
        .map(|(i, line)| {
            let (weight, size) = if i == 0 { (Weight::Bold, em_px * 1.2) } else { (weight(em_px), em_px) };
            scribe.write(line, weight, size)
        })
        .collect();
    for kept in (1..=written.len()).rev() {
        for top in (MARGIN as i64..(field.height_px * 2 / 5) as i64).step_by(4) {
            let mut y = top as f64;
            let lines: Vec<Line> = written[..kept]
                .iter()
                .map(|text| {
                    let line = Line::centred(Rc::clone(text), middle, y);
                    y += text.height as f64 - 5.0;
                    line
                })
                .collect();
            if lines.iter().all(|line| region.contains_box(&line.area())) {
                return lines;
            }
        }
    }
    Vec::new()
}

/// One line in the middle, as low as it can be seen whole.
#[must_use]
pub fn bottom_line(scribe: &mut Scribe, text: &str, em_px: f32, field: &FieldOfView, region: &Region) -> Option<Line> {
    let written = scribe.write(text, weight(em_px), em_px);
    let lowest = field.height_px as f64 - MARGIN - written.height as f64;
    (0..field.height_px / 2)
        .step_by(4)
        .map(|up| Line::centred(Rc::clone(&written), field.width_px as f64 / 2.0, lowest - up as f64))
        .find(|line| region.contains_box(&line.area()))
}

/// Where the sky's picture stands beside the object.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beside {
    /// From the sky to its place beside.
    pub projection: Projection,
    /// The picture's edge.
    pub window: Disc,
    /// How much smaller it is: 1 when both fit at true size.
    pub factor: f64,
}

/// Finds room beside an object at `(x, y)` that is `radius` pixels large: the picture is as large as the object, and made
/// smaller when the visible field does not hold both (section 8.7: "both images have to fit into the field of view").
#[must_use]
pub fn beside(field: &FieldOfView, x: f64, y: f64, radius: f64) -> Beside {
    const GAP: f64 = 16.0;
    let (middle_x, middle_y) = (field.width_px as f64 / 2.0, field.height_px as f64 / 2.0);
    let visible = middle_x.min(field.circle_px()) - 4.0;
    // The side of the middle on which there is more room; about the middle always the right, so that it does not change
    // sides from frame to frame.
    let side = if x <= middle_x + 40.0 { 1.0 } else { -1.0 };
    let room = visible - side * (x - middle_x);

    let radius = radius.max(60.0);
    let object = radius.min(0.3 * room);
    let window = (1.15 * radius).min((room - GAP - object) / 2.0).min(0.55 * middle_y).max(20.0);
    let factor = (window / (1.15 * radius)).min(1.0);
    let (window_x, window_y) = (x + side * (object + GAP + window), y);

    // Scaling is about the projection's middle: carry the object to the middle of the window.
    let right = window_x - (middle_x + (x - middle_x) * factor);
    let down = window_y - (middle_y + (y - middle_y) * factor);
    Beside {
        projection: field.projection.moved(right, down, factor),
        window: Disc { x: window_x, y: window_y, radius: window },
        factor,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::coords::Equatorial;
    use crate::sky::optics::Instrument;
    use crate::units::Angle;

    fn field(eyepiece_mm: f64) -> FieldOfView {
        let centre = Equatorial::new(Angle::degrees(10.0), Angle::degrees(41.0));
        FieldOfView::towards(&centre, Angle::ZERO, &Instrument::default().with_eyepiece(eyepiece_mm))
    }

    #[test]
    fn text_keeps_its_apparent_size_until_the_pixels_are_too_few() {
        let style = Style::default();
        let apparent = |mm: f64| f64::from(text_px(&field(mm), &style)) * 1.1287 / 60.0 * (2500.0 / mm);
        assert!((apparent(32.0) - 36.0).abs() < 0.1 && (apparent(24.0) - 36.0).abs() < 0.1);
        assert_eq!(text_px(&field(5.0), &style), 13.0);
    }

    #[test]
    fn object_and_picture_beside_it_both_fit_into_the_field_and_do_not_overlap() {
        for mm in [32.0, 24.0, 10.0, 5.0] {
            for radius in [5.0, 80.0, 200.0, 5000.0] {
                let field = field(mm);
                let (x, y) = (512.0, 384.0);
                let beside = beside(&field, x, y, radius);
                let visible = 512f64.min(field.circle_px());
                assert!(beside.window.x + beside.window.radius <= 512.0 + visible, "{mm} mm, {radius}");
                assert!(beside.window.x - beside.window.radius > x, "{mm} mm, {radius}");
                let (px, py) = beside.projection.pixel(&field.centre()).unwrap();
                assert!((px - beside.window.x).abs() < 1e-6 && (py - beside.window.y).abs() < 1e-6);
                assert!(beside.factor <= 1.0);
            }
        }
        assert_eq!(beside(&field(24.0), 512.0, 384.0, 60.0).factor, 1.0);
    }
}
