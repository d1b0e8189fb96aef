//! Test patterns for building and aligning the projector. Each is drawn on the canvas, dim and red unless asked otherwise.

use std::fmt;
use std::rc::Rc;
use std::str::FromStr;

use tiny_skia::Path;

use super::canvas::{Disc, Ink, Region, circle, lay_text, line};
use super::text::{Scribe, Weight, Written};
use crate::picture::Picture;
use crate::sky::optics::Instrument;

/// Steps of light, each half of the one before.
mod greys;
/// Grid, cross, ghosts: lines and dots at known places.
mod lines;
/// Which way up: one asymmetric picture, or all eight ways at once.
mod orientation;
/// The circles of the eyepieces.
mod stops;

/// A pattern.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pattern {
    /// Lines every 64 pixels, numbered, and the outermost pixels.
    Grid,
    /// A cross in the middle with a scale.
    Cross,
    /// The field stops of the eyepieces: figure 8.8.
    Eyepieces,
    /// An F, the names of the sides, one to four dots in the corners.
    Orientation,
    /// All eight ways to lay the picture, numbered: the one that reads rightly is the one to set.
    Finder,
    /// Bright dots with scales, to see and measure ghost images beside them.
    Ghost,
    /// Sixteen steps of light, each half of the one before, and a ramp below the first code.
    Greys,
    /// Everything lit alike, for photometry.
    Full,
}

impl Pattern {
    /// All of them.
    pub const ALL: [Pattern; 8] = [
        Pattern::Grid,
        Pattern::Cross,
        Pattern::Eyepieces,
        Pattern::Orientation,
        Pattern::Finder,
        Pattern::Ghost,
        Pattern::Greys,
        Pattern::Full,
    ];

    /// What the command line calls it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Pattern::Grid => "grid",
            Pattern::Cross => "cross",
            Pattern::Eyepieces => "eyepieces",
            Pattern::Orientation => "orientation",
            Pattern::Finder => "finder",
            Pattern::Ghost => "ghost",
            Pattern::Greys => "greys",
            Pattern::Full => "full",
        }
    }

    /// What it is for.
    #[must_use]
    pub fn purpose(self) -> &'static str {
        match self {
            Pattern::Grid => "lines every 64 pixels and the outermost pixels: is all of it there, straight and sharp?",
            Pattern::Cross => "a cross with a scale: bring its middle onto the optical axis",
            Pattern::Eyepieces => "the circles of the eyepieces' field stops: do they meet the rim that you see?",
            Pattern::Orientation => "an F and the names of the sides: does it read rightly in the eyepiece?",
            Pattern::Finder => "all eight ways to lay the picture, numbered: which one reads rightly?",
            Pattern::Ghost => "bright dots with scales: are there fainter ones beside them?",
            Pattern::Greys => "steps of light, each half of the one before: how many can be told from black?",
            Pattern::Full => "everything lit alike: for a luminance meter",
        }
    }
}

impl fmt::Display for Pattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Pattern {
    type Err = String;

    fn from_str(text: &str) -> Result<Pattern, String> {
        Pattern::ALL.into_iter().find(|pattern| pattern.name() == text).ok_or_else(|| {
            let names: Vec<&str> = Pattern::ALL.into_iter().map(Pattern::name).collect();
            format!("there is no such pattern: give {}", names.join(", "))
        })
    }
}

/// How bright a pattern is and which colour it has, linear light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// Parts of the projector's full drive, 0 to 1.
    pub light: f32,
    /// Shares of red, green and blue.
    pub colour: [f32; 3],
}

impl Default for Look {
    /// Red, as bright as the overlay's text.
    fn default() -> Look {
        Look { light: 0.6, colour: [1.0, 0.0, 0.0] }
    }
}

/// A pattern on the instrument's canvas. Black, if that has no pixels.
#[must_use]
pub fn draw(pattern: Pattern, instrument: &Instrument, look: Look) -> Picture {
    let (width, height) = (instrument.projector.width_px as usize, instrument.projector.height_px as usize);
    let Some(mut board) = Board::new(width, height, look) else { return Picture::black(width, height) };
    match pattern {
        Pattern::Grid => lines::grid(&mut board),
        Pattern::Cross => lines::cross(&mut board),
        Pattern::Eyepieces => stops::eyepieces(&mut board, instrument),
        Pattern::Orientation => orientation::one(&mut board),
        Pattern::Finder => orientation::all(&mut board, instrument.projector.must_mirror()),
        Pattern::Ghost => lines::ghost(&mut board),
        Pattern::Greys => greys::steps(&mut board),
        Pattern::Full => {
            let light = board.light(1.0);
            board.picture.pixels_mut().fill(light);
        }
    }
    board.picture
}

/// What a pattern is drawn on.
struct Board {
    picture: Picture,
    ink: Ink,
    scribe: Scribe,
    region: Region,
    look: Look,
}

impl Board {
    fn new(width: usize, height: usize, look: Look) -> Option<Board> {
        Some(Board {
            picture: Picture::black(width, height),
            ink: Ink::new(width, height)?,
            scribe: Scribe::default(),
            region: Region::new(width, height, Vec::new()),
            look,
        })
    }

    /// Columns and rows.
    fn size(&self) -> (f64, f64) {
        (self.picture.width() as f64, self.picture.height() as f64)
    }

    fn middle(&self) -> (f64, f64) {
        let (width, height) = self.size();
        (width / 2.0, height / 2.0)
    }

    /// A share of the look's light, in its colour.
    fn light(&self, share: f32) -> [f32; 3] {
        self.look.colour.map(|channel| (channel * self.look.light * share).clamp(0.0, 1.0))
    }

    /// Draws a line with the pen.
    fn line(&mut self, from: (f64, f64), to: (f64, f64), width: f32) {
        self.stroke(line(from, to), width);
    }

    /// Draws a circle with the pen.
    fn circle(&mut self, x: f64, y: f64, radius: f64, width: f32) {
        self.stroke(circle(Disc { x, y, radius }), width);
    }

    /// Fills a disc.
    fn dot(&mut self, x: f64, y: f64, radius: f64) {
        if let Some(path) = circle(Disc { x, y, radius }) {
            self.ink.fill(&path);
        }
    }

    fn stroke(&mut self, path: Option<Path>, width: f32) {
        if let Some(path) = path {
            self.ink.stroke(&path, width, None);
        }
    }

    /// Lays what was drawn with the pen on the picture.
    fn lay(&mut self, share: f32) {
        let light = self.light(share);
        self.ink.lay(&mut self.picture, &self.region, light);
    }

    fn written(&mut self, text: &str, em_px: f32) -> Rc<Written> {
        self.scribe.write(text, Weight::Bold, em_px)
    }

    /// Writes a line of text about a point.
    fn text(&mut self, text: &str, em_px: f32, x: f64, y: f64, share: f32) {
        let written = self.written(text, em_px);
        let (left, top) = (x - written.width as f64 / 2.0, y - written.height as f64 / 2.0);
        let light = self.light(share);
        lay_text(&mut self.picture, &written, left.round() as i64, top.round() as i64, light);
    }
}

#[cfg(test)]
mod tests;
