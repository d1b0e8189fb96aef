//! Text as coverage: glyph outlines of B612 (made for cockpit screens), DejaVu Sans where B612 has no sign, filled by
//! tiny-skia and kept, because the same words come back frame after frame.

use std::collections::HashMap;
use std::rc::Rc;

use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, MetadataProvider};
use tiny_skia::{FillRule, Mask, Path, PathBuilder, Transform};

static REGULAR: &[u8] = include_bytes!("fonts/B612-Regular.otf");
static BOLD: &[u8] = include_bytes!("fonts/B612-Bold.otf");
static FALLBACK: &[u8] = include_bytes!("fonts/DejaVuSans-subset.ttf");

/// Size at which outlines are kept, in pixels an em.
const KEPT_EM: f32 = 256.0;
/// Dark rim around text, in pixels: it keeps text legible on a photograph.
const RIM: usize = 3;
/// Texts kept before all are forgotten: enough for a night's favourite fields, a few MiB.
const KEPT_TEXTS: usize = 2000;

/// Thin or fat.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Weight {
    /// For lines of 19 pixels and more.
    Regular,
    /// For names and small sizes.
    Bold,
}

/// A written line as coverage, 0 to 255, with its dark rim.
#[derive(Debug)]
pub struct Written {
    /// Columns, rim included.
    pub width: usize,
    /// Rows, rim included.
    pub height: usize,
    /// How much of each pixel is ink.
    pub ink: Vec<u8>,
    /// How much of each pixel is ink or rim.
    pub rim: Vec<u8>,
}

impl Written {
    /// Columns of ink, without the rim.
    #[must_use]
    pub fn ink_width(&self) -> f64 {
        self.width.saturating_sub(2 * RIM) as f64
    }
}

/// A glyph's outline at [`KEPT_EM`] and how far the pen moves on.
struct Glyph {
    outline: Option<Path>,
    advance: f32,
}

/// Writes text, and remembers what it wrote.
#[derive(Default)]
pub struct Scribe {
    glyphs: HashMap<(Weight, char), Rc<Glyph>>,
    written: HashMap<(Weight, u32, String), Rc<Written>>,
}

impl Scribe {
    /// A line of text at `em_px` pixels an em. Control characters are left out.
    pub fn write(&mut self, text: &str, weight: Weight, em_px: f32) -> Rc<Written> {
        let key = (weight, (em_px * 4.0) as u32, text.to_owned());
        if let Some(known) = self.written.get(&key) {
            return Rc::clone(known);
        }
        if self.written.len() >= KEPT_TEXTS {
            self.written.clear();
        }
        let written = Rc::new(self.draw(text, weight, em_px));
        self.written.insert(key, Rc::clone(&written));
        written
    }

    fn draw(&mut self, text: &str, weight: Weight, em_px: f32) -> Written {
        // Lay the glyphs side by side; these fonts need no kerning at this size.
        let mut pen_x = 0.0;
        let mut line = PathBuilder::new();
        for c in text.chars().filter(|c| !c.is_control()) {
            let glyph = self.glyph(weight, c);
            if let Some(placed) =
                glyph.outline.clone().and_then(|path| path.transform(Transform::from_translate(pen_x, 0.0)))
            {
                line.push_path(&placed);
            }
            pen_x += glyph.advance;
        }

        // Ascenders and descenders of both fonts lie within 0.95 and 0.30 em.
        let factor = em_px / KEPT_EM;
        let width = (pen_x * factor).ceil() as usize + 2 * RIM;
        let height = (em_px * 1.25).ceil() as usize + 2 * RIM;
        let baseline = RIM as f32 + (em_px * 0.95).round();
        let empty = || Written { width, height, ink: vec![0; width * height], rim: vec![0; width * height] };
        let (Some(path), Some(mut mask)) = (line.finish(), Mask::new(width as u32, height as u32)) else {
            return empty();
        };
        let place = Transform::from_row(factor, 0.0, 0.0, factor, RIM as f32, baseline);
        mask.fill_path(&path, FillRule::Winding, true, place);
        let ink = mask.take();
        let rim = spread(&ink, width, height);
        Written { width, height, ink, rim }
    }

    fn glyph(&mut self, weight: Weight, c: char) -> Rc<Glyph> {
        Rc::clone(self.glyphs.entry((weight, c)).or_insert_with(|| {
            let own = if weight == Weight::Bold { BOLD } else { REGULAR };
            let found = outline(own, c).or_else(|| outline(FALLBACK, c)).or_else(|| outline(own, '?'));
            Rc::new(found.unwrap_or(Glyph { outline: None, advance: KEPT_EM / 2.0 }))
        }))
    }
}

/// A font's outline of a character, if the font has it.
fn outline(font: &[u8], c: char) -> Option<Glyph> {
    let font = FontRef::new(font).ok()?;
    let id = font.charmap().map(c)?;
    let size = Size::new(KEPT_EM);
    let advance = font.glyph_metrics(size, LocationRef::default()).advance_width(id)?;
    let mut pen = Pen(PathBuilder::new());
    let glyph = font.outline_glyphs().get(id)?;
    glyph.draw(DrawSettings::unhinted(size, LocationRef::default()), &mut pen).ok()?;
    Some(Glyph { outline: pen.0.finish(), advance })
}

/// Fonts count y upwards, pictures downwards.
struct Pen(PathBuilder);

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x, -y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x, -y);
    }
    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.0.quad_to(cx, -cy, x, -y);
    }
    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        self.0.cubic_to(cx0, -cy0, cx1, -cy1, x, -y);
    }
    fn close(&mut self) {
        self.0.close();
    }
}

/// Coverage made wider by [`RIM`] pixels: the largest value near by, fading outwards. Rows first, then columns.
fn spread(ink: &[u8], width: usize, height: usize) -> Vec<u8> {
    let near = |along: usize, end: usize| along.saturating_sub(RIM)..(along + RIM + 1).min(end);
    let fade = |value: u8, distance: usize| value - value / 5 * distance as u8;
    let mut rows = vec![0; ink.len()];
    for y in 0..height {
        for x in 0..width {
            let widest = near(x, width).map(|i| fade(ink[y * width + i], i.abs_diff(x))).max();
            rows[y * width + x] = widest.unwrap_or(0);
        }
    }
    let mut both = vec![0; ink.len()];
    for y in 0..height {
        for x in 0..width {
            let widest = near(y, height).map(|j| fade(rows[j * width + x], j.abs_diff(y))).max();
            both[y * width + x] = widest.unwrap_or(0);
        }
    }
    both
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sign_that_the_overlay_writes_has_an_outline() {
        let mut scribe = Scribe::default();
        for c in "ABCxyz0189αβγδρω°′″²×±−·ʼ–()".chars().filter(|c| *c != 'ʼ') {
            let own = outline(BOLD, c).or_else(|| outline(FALLBACK, c));
            assert!(own.is_some_and(|glyph| glyph.outline.is_some()), "{c}");
            assert!(scribe.glyph(Weight::Regular, c).advance > 0.0);
        }
    }

    #[test]
    fn a_line_is_as_wide_as_its_advances_and_its_ink_stays_inside() {
        let mut scribe = Scribe::default();
        let one = scribe.write("M", Weight::Bold, 20.0);
        let three = scribe.write("MMM", Weight::Bold, 20.0);
        assert!((three.ink_width() - 3.0 * one.ink_width()).abs() <= 3.0);
        assert!(one.ink.contains(&255), "the stem of an M at 20 px covers whole pixels");
        let border = |w: &Written| w.ink[..w.width].iter().chain(&w.ink[(w.height - 1) * w.width..]).all(|v| *v == 0);
        assert!(border(&scribe.write("ÅgjpqyQ|", Weight::Regular, 26.0)));
    }

    #[test]
    fn what_was_written_once_is_kept_and_escapes_are_not_drawn() {
        let mut scribe = Scribe::default();
        let first = scribe.write("M31", Weight::Regular, 20.0);
        assert!(Rc::ptr_eq(&first, &scribe.write("M31", Weight::Regular, 20.0)));
        assert_eq!(scribe.write("M\u{1b}31", Weight::Regular, 20.0).ink, first.ink);
    }
}
