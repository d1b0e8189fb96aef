//! Drawing in linear light: shapes and text as coverage, laid over the picture inside the part that can be seen.

use tiny_skia::{FillRule, LineCap, Mask, Path, PathBuilder, Stroke, StrokeDash, Transform};

use super::text::Written;
use crate::picture::Picture;

/// A disc on the canvas, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Middle, to the right.
    pub x: f64,
    /// Middle, downwards.
    pub y: f64,
    /// Radius.
    pub radius: f64,
}

/// The part of the canvas that can be seen: inside its edges and inside every disc.
#[derive(Debug, Clone, PartialEq)]
pub struct Region {
    width: usize,
    height: usize,
    discs: Vec<Disc>,
}

impl Region {
    /// All of a canvas inside some discs.
    #[must_use]
    pub fn new(width: usize, height: usize, discs: Vec<Disc>) -> Region {
        Region { width, height, discs }
    }

    /// The columns of a row that can be seen, by their pixels' middles.
    #[must_use]
    pub fn span(&self, y: usize) -> std::ops::Range<usize> {
        let (mut left, mut right) = (0.0f64, self.width as f64);
        for disc in &self.discs {
            let up = y as f64 + 0.5 - disc.y;
            let half = (disc.radius * disc.radius - up * up).max(0.0).sqrt();
            left = left.max((disc.x - half - 0.5).ceil());
            right = right.min((disc.x + half - 0.5).ceil());
        }
        let (left, right) = (left.max(0.0) as usize, right.max(0.0) as usize);
        left.min(right)..right
    }

    /// Whether a point can be seen.
    #[must_use]
    pub fn contains(&self, x: f64, y: f64) -> bool {
        (0.0..self.width as f64).contains(&x)
            && (0.0..self.height as f64).contains(&y)
            && self.discs.iter().all(|disc| (x - disc.x).hypot(y - disc.y) <= disc.radius)
    }

    /// Whether a box can be seen whole.
    #[must_use]
    pub fn contains_box(&self, area: &Area) -> bool {
        [(area.left, area.top), (area.right, area.top), (area.left, area.bottom), (area.right, area.bottom)]
            .iter()
            .all(|&(x, y)| self.contains(x, y))
    }
}

/// A box on the canvas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Area {
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Right edge.
    pub right: f64,
    /// Lower edge.
    pub bottom: f64,
}

impl Area {
    /// A box about a point.
    #[must_use]
    pub fn about(x: f64, y: f64, half_width: f64, half_height: f64) -> Area {
        Area { left: x - half_width, top: y - half_height, right: x + half_width, bottom: y + half_height }
    }

    /// Whether two boxes share a point.
    #[must_use]
    pub fn meets(&self, other: &Area) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }
}

/// Pixels that are looked at together for whether anything is drawn on them: lines leave most of a row empty.
const FEW: usize = 32;

/// Shapes of one colour: drawn as coverage, then laid over the picture at once.
pub struct Ink {
    mask: Mask,
    /// Rows that have been drawn on.
    rows: std::ops::Range<usize>,
}

impl Ink {
    /// For a canvas of a size; `None` when it has no pixels.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Option<Ink> {
        Some(Ink { mask: Mask::new(u32::try_from(width).ok()?, u32::try_from(height).ok()?)?, rows: 0..0 })
    }

    /// Columns and rows.
    #[must_use]
    pub fn size(&self) -> (usize, usize) {
        (self.mask.width() as usize, self.mask.height() as usize)
    }

    /// Draws along a path, `width` pixels wide; `dash` is (ink, gap) in pixels.
    pub fn stroke(&mut self, path: &Path, width: f32, dash: Option<(f32, f32)>) {
        let dash = dash.and_then(|(ink, gap)| StrokeDash::new(vec![ink, gap], 0.0));
        let pen = Stroke { width, line_cap: LineCap::Round, ..Stroke::default() };
        let dashed = dash.and_then(|dash| path.dash(&dash, 1.0));
        if let Some(outline) = dashed.as_ref().unwrap_or(path).stroke(&pen, 1.0) {
            self.fill(&outline);
        }
    }

    /// Fills a path.
    pub fn fill(&mut self, path: &Path) {
        let (top, bottom) = (path.bounds().top().floor() as usize, path.bounds().bottom().ceil().max(0.0) as usize);
        let (top, bottom) = (top.min(self.size().1), bottom.min(self.size().1));
        if top < bottom {
            self.rows =
                if self.rows.is_empty() { top..bottom } else { self.rows.start.min(top)..self.rows.end.max(bottom) };
            self.mask.fill_path(path, FillRule::Winding, true, Transform::identity());
        }
    }

    /// Lays what was drawn over the picture, where it can be seen, and begins anew.
    pub fn lay(&mut self, picture: &mut Picture, region: &Region, colour: [f32; 3]) {
        let width = self.size().0;
        for y in self.rows.clone() {
            let coverage = &mut self.mask.data_mut()[y * width..(y + 1) * width];
            let span = region.span(y);
            let pixels = picture.row_mut(y)[span.clone()].chunks_mut(FEW);
            for (pixels, covered) in pixels.zip(coverage[span].chunks(FEW)) {
                if covered.iter().fold(0, |any, &covered| any | covered) == 0 {
                    continue;
                }
                for (pixel, &covered) in pixels.iter_mut().zip(covered).filter(|(_, covered)| **covered > 0) {
                    over(pixel, colour, f32::from(covered) / 255.0);
                }
            }
            coverage.fill(0);
        }
        self.rows = 0..0;
    }
}

/// A colour over a pixel, covering part of it.
fn over(pixel: &mut [f32; 3], colour: [f32; 3], part: f32) {
    for (light, own) in pixel.iter_mut().zip(colour) {
        *light += (own - *light) * part;
    }
}

/// Lays a written line on the picture, its upper left corner (rim included) at whole pixels; what is outside is lost.
pub fn lay_text(picture: &mut Picture, text: &Written, left: i64, top: i64, colour: [f32; 3]) {
    for row in 0..text.height {
        let Ok(y) = usize::try_from(top + row as i64) else { continue };
        if y >= picture.height() {
            break;
        }
        let skipped = usize::try_from(-left).unwrap_or(0).min(text.width);
        let from = usize::try_from(left).unwrap_or(0);
        let line = row * text.width + skipped..(row + 1) * text.width;
        let Some(pixels) = picture.row_mut(y).get_mut(from..) else { continue };
        for ((pixel, &ink), &rim) in pixels.iter_mut().zip(&text.ink[line.clone()]).zip(&text.rim[line]) {
            if rim > 0 {
                let kept = 1.0 - f32::from(rim) / 255.0 * 0.85;
                pixel.iter_mut().for_each(|light| *light *= kept);
                over(pixel, colour, f32::from(ink) / 255.0);
            }
        }
    }
}

/// A straight line.
#[must_use]
pub fn line(from: (f64, f64), to: (f64, f64)) -> Option<Path> {
    let mut path = PathBuilder::new();
    path.move_to(from.0 as f32, from.1 as f32);
    path.line_to(to.0 as f32, to.1 as f32);
    path.finish()
}

/// A circle.
#[must_use]
pub fn circle(disc: Disc) -> Option<Path> {
    PathBuilder::from_circle(disc.x as f32, disc.y as f32, disc.radius as f32)
}

/// An ellipse from its middle and two half axes as vectors.
#[must_use]
pub fn ellipse(middle: (f64, f64), major: (f64, f64), minor: (f64, f64)) -> Option<Path> {
    let unit = PathBuilder::from_circle(0.0, 0.0, 1.0)?;
    let [a, b, c, d, e, f] = [major.0, major.1, minor.0, minor.1, middle.0, middle.1].map(|value| value as f32);
    unit.transform(Transform::from_row(a, b, c, d, e, f))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drawn(path: &Path, width: f32, region: &Region) -> Picture {
        let mut picture = Picture::black(64, 64);
        let mut ink = Ink::new(64, 64).unwrap();
        ink.stroke(path, width, None);
        ink.lay(&mut picture, region, [1.0, 0.5, 0.0]);
        picture
    }

    fn everywhere() -> Region {
        Region::new(64, 64, Vec::new())
    }

    /// Light of a picture's red, summed.
    fn sum(picture: &Picture) -> f32 {
        picture.pixels().iter().map(|pixel| pixel[0]).sum()
    }

    #[test]
    fn a_line_has_the_area_of_its_length_and_width_and_lies_where_it_should() {
        let picture = drawn(&line((10.0, 20.5), (40.0, 20.5)).unwrap(), 1.0, &everywhere());
        // 30 long and 1 wide, with a half disc at each end.
        assert!((sum(&picture) - 30.8).abs() < 0.6, "{}", sum(&picture));
        assert!((picture.row(20)[25][0] - 1.0).abs() < 0.02 && (picture.row(20)[25][1] - 0.5).abs() < 0.02);
        assert_eq!(picture.row(22)[25], [0.0; 3]);
    }

    #[test]
    fn a_circle_has_the_area_of_its_rim() {
        let disc = Disc { x: 32.0, y: 32.0, radius: 20.0 };
        let picture = drawn(&circle(disc).unwrap(), 2.0, &everywhere());
        let expected = std::f32::consts::TAU * 20.0 * 2.0;
        assert!((sum(&picture) - expected).abs() < 0.02 * expected);
    }

    #[test]
    fn an_ellipse_reaches_its_half_axes() {
        let picture = drawn(&ellipse((32.0, 32.0), (0.0, 25.0), (10.0, 0.0)).unwrap(), 2.0, &everywhere());
        for (x, y) in [(32, 57), (32, 6), (42, 32), (21, 32)] {
            assert!(picture.row(y)[x][0] > 0.4, "{x} {y}");
        }
        assert_eq!(picture.row(32)[32], [0.0; 3]);
    }

    #[test]
    fn nothing_is_drawn_outside_the_region() {
        let region = Region::new(64, 64, vec![Disc { x: 32.0, y: 32.0, radius: 10.0 }]);
        let picture = drawn(&line((0.0, 32.0), (64.0, 32.0)).unwrap(), 3.0, &region);
        let seen: Vec<usize> = (0..64).filter(|&x| picture.row(32)[x][0] > 0.0).collect();
        assert_eq!((seen[0], seen[seen.len() - 1], seen.len()), (22, 41, 20));
        assert!(!region.contains(45.0, 32.0) && region.contains(41.0, 32.0) && region.span(10).is_empty());
    }

    #[test]
    fn text_beyond_every_edge_is_cut_not_wrapped() {
        let text = Written { width: 4, height: 4, ink: vec![255; 16], rim: vec![255; 16] };
        for (left, top, pixels) in [(-2, -2, 4), (62, 62, 4), (30, 30, 16), (-9, 0, 0), (90, 90, 0), (0, -90, 0)] {
            let mut picture = Picture::black(64, 64);
            lay_text(&mut picture, &text, left, top, [1.0, 0.0, 0.0]);
            assert_eq!(sum(&picture).round() as i32, pixels, "{left} {top}");
        }
    }
}
