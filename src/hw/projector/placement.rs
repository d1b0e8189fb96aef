//! Where the canvas lies on the module's own pixels: flipped, turned, scaled and moved, in this one place for every sink.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::picture::Picture;

/// The smallest and the largest scale that is taken, module pixels a canvas pixel.
const SCALES: std::ops::RangeInclusive<f64> = 0.05..=8.0;

/// Further than this nobody moves a picture: no module is larger.
const FARTHEST_PX: i32 = 8192;

/// How the canvas is laid on the module. First it is flipped, then turned, then scaled, then moved.
///
/// The canvas lies in the middle of the module, its upper left corner on a whole module pixel; what it does not reach is black.
/// At a scale of 1 it is copied pixel for pixel, enlarged it is bilinear, and reduced each module pixel is the mean light of
/// the canvas under it: thin lines grow dim and never vanish.
///
/// ```
/// use scotopic::hw::projector::{Placement, Rotation, Scale};
/// use scotopic::picture::Picture;
///
/// let mut canvas = Picture::black(4, 3);
/// canvas.row_mut(0)[3] = [1.0; 3];
/// let placement = Placement { rotation: Rotation::Clockwise90, scale: Scale::Times(1.0), ..Placement::default() };
/// let module = placement.apply(&canvas, (9, 8));
/// // Turned, it is 3 x 4 in the middle of 9 x 8; the upper right corner has become the lower right one.
/// assert_eq!(module.row(2 + 3)[3 + 2], [1.0; 3]);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Placement {
    /// How large.
    pub scale: Scale,
    /// To the right of the module's middle, in module pixels; negative is to the left.
    pub right_px: i32,
    /// Below the module's middle, in module pixels; negative is above.
    pub down_px: i32,
    /// How far it is turned.
    #[serde(rename = "rotation_deg")]
    pub rotation: Rotation,
    /// How it is mirrored, before it is turned.
    pub flip: Flip,
}

/// How large the canvas is on the module.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "ScaleText", into = "ScaleText")]
pub enum Scale {
    /// As large as all of it fits.
    #[default]
    Fit,
    /// So many module pixels a canvas pixel: 1 keeps every pixel as it was drawn.
    Times(f64),
}

/// A scale as it is written.
#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "scale is \"fit\" or a number of module pixels a canvas pixel, like 1.0")]
enum ScaleText {
    Word(String),
    Number(f64),
}

impl TryFrom<ScaleText> for Scale {
    type Error = String;

    fn try_from(text: ScaleText) -> Result<Scale, String> {
        match text {
            ScaleText::Word(word) if word == "fit" => Ok(Scale::Fit),
            ScaleText::Word(word) => {
                let word: String = word.chars().filter(|c| !c.is_control()).take(40).collect();
                Err(format!("scale = \"{word}\" is not understood: give \"fit\" or a number like 1.0"))
            }
            ScaleText::Number(times) => Ok(Scale::Times(times)),
        }
    }
}

impl From<Scale> for ScaleText {
    fn from(scale: Scale) -> ScaleText {
        match scale {
            Scale::Fit => ScaleText::Word("fit".into()),
            Scale::Times(times) => ScaleText::Number(times),
        }
    }
}

/// Turns by quarters, clockwise as one looks at the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(try_from = "f64", into = "f64")]
pub enum Rotation {
    /// As drawn.
    #[default]
    None,
    /// A quarter.
    Clockwise90,
    /// Upside down.
    Half,
    /// Three quarters: a quarter the other way.
    Clockwise270,
}

impl TryFrom<f64> for Rotation {
    type Error = String;

    fn try_from(degrees: f64) -> Result<Rotation, String> {
        [Rotation::None, Rotation::Clockwise90, Rotation::Half, Rotation::Clockwise270]
            .into_iter()
            .find(|rotation| f64::from(*rotation) == degrees)
            .ok_or_else(|| {
                format!(
                    "rotation_deg = {degrees} is not possible: give 0, 90, 180 or 270, and turn the unit for the rest"
                )
            })
    }
}

impl From<Rotation> for f64 {
    fn from(rotation: Rotation) -> f64 {
        f64::from(rotation.quarters()) * 90.0
    }
}

impl Rotation {
    /// Quarter turns clockwise.
    #[must_use]
    pub fn quarters(self) -> u8 {
        match self {
            Rotation::None => 0,
            Rotation::Clockwise90 => 1,
            Rotation::Half => 2,
            Rotation::Clockwise270 => 3,
        }
    }
}

/// Mirrorings.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Flip {
    /// As drawn.
    #[default]
    None,
    /// Left and right change places.
    Horizontal,
    /// Top and bottom change places.
    Vertical,
    /// Both: the same as half a turn.
    Both,
}

impl Flip {
    /// Whether left and right change places.
    #[must_use]
    pub fn horizontal(self) -> bool {
        matches!(self, Flip::Horizontal | Flip::Both)
    }

    /// Whether top and bottom change places.
    #[must_use]
    pub fn vertical(self) -> bool {
        matches!(self, Flip::Vertical | Flip::Both)
    }

    /// The flip that does one or the other or both.
    #[must_use]
    pub fn new(horizontal: bool, vertical: bool) -> Flip {
        match (horizontal, vertical) {
            (false, false) => Flip::None,
            (true, false) => Flip::Horizontal,
            (false, true) => Flip::Vertical,
            (true, true) => Flip::Both,
        }
    }
}

/// Why a placement is refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PlacementError {
    /// No scale.
    #[error("placement: scale = {0} is out of range: give \"fit\", or 0.05 to 8 module pixels a canvas pixel")]
    Scale(f64),
    /// Off every module.
    #[error("placement: {key} = {value} is out of range: give -8192 to 8192 module pixels")]
    Offset {
        /// `right_px` or `down_px`.
        key: &'static str,
        /// What was given.
        value: i32,
    },
    /// The picture would lie beside the module.
    #[error(
        "placement: nothing of the picture would lie on the module's {} x {} pixels; it would lie {} to {} across and {} to {} down: \
         make right_px and down_px smaller",
        module.0, module.1, across.0, across.1, down.0, down.1
    )]
    Beside {
        /// Columns and rows of the module.
        module: (usize, usize),
        /// First and last column of the picture.
        across: (i64, i64),
        /// First and last row of the picture.
        down: (i64, i64),
    },
}

impl Placement {
    /// Holds every number against what can be.
    ///
    /// # Errors
    /// The first number that cannot be.
    pub fn checked(self) -> Result<Placement, PlacementError> {
        if let Scale::Times(times) = self.scale
            && !SCALES.contains(&times)
        {
            return Err(PlacementError::Scale(times));
        }
        for (key, value) in [("right_px", self.right_px), ("down_px", self.down_px)] {
            if !(-FARTHEST_PX..=FARTHEST_PX).contains(&value) {
                return Err(PlacementError::Offset { key, value });
            }
        }
        Ok(self)
    }

    /// Holds it against a canvas and a module: something must be seen.
    ///
    /// # Errors
    /// As [`Placement::checked`]; the picture would lie wholly beside the module.
    pub fn seen(self, canvas: (usize, usize), module: (usize, usize)) -> Result<Placement, PlacementError> {
        let placement = self.checked()?;
        let (across, down) = placement.place(canvas, module);
        let apart = |place: &Place, side: usize| place.end() <= 0.0 || place.start >= side as f64;
        if apart(&across, module.0) || apart(&down, module.1) {
            let ends = |place: &Place| (place.start as i64, place.end().ceil() as i64 - 1);
            return Err(PlacementError::Beside { module, across: ends(&across), down: ends(&down) });
        }
        Ok(placement)
    }

    /// The same with left and right changed once more on the canvas, if `mirror`: for a unit that does not mirror its picture
    /// itself.
    #[must_use]
    pub fn mirrored(self, mirror: bool) -> Placement {
        Placement { flip: Flip::new(self.flip.horizontal() != mirror, self.flip.vertical()), ..self }
    }

    /// The canvas on a module of so many columns and rows.
    #[must_use]
    pub fn apply<'a>(&self, canvas: &'a Picture, module: (usize, usize)) -> Cow<'a, Picture> {
        let (across, down) = self.place((canvas.width(), canvas.height()), module);
        let turned = self.oriented(canvas);
        let whole =
            |place: &Place, side: usize| place.scale == 1.0 && place.start == 0.0 && place.length == side as f64;
        if whole(&across, module.0) && whole(&down, module.1) {
            return turned;
        }
        let (columns, rows) = (Taps::new(&across, module.0), Taps::new(&down, module.1));
        // Each canvas row that is needed, made as wide as the module; then each module row from those.
        let mut wide = Picture::black(module.0, turned.height());
        for y in rows.reach() {
            let (from, to) = (turned.row(y), wide.row_mut(y));
            for (x, pixel) in to.iter_mut().enumerate() {
                for (tap, weight) in columns.of(x) {
                    add(pixel, from[tap], weight);
                }
            }
        }
        let mut placed = Picture::black(module.0, module.1);
        for y in 0..module.1 {
            for (tap, weight) in rows.of(y) {
                placed.row_mut(y).iter_mut().zip(wide.row(tap)).for_each(|(pixel, light)| add(pixel, *light, weight));
            }
        }
        Cow::Owned(placed)
    }

    /// The canvas flipped and turned.
    fn oriented<'a>(&self, canvas: &'a Picture) -> Cow<'a, Picture> {
        if self.flip == Flip::None && self.rotation == Rotation::None {
            return Cow::Borrowed(canvas);
        }
        Cow::Owned(
            canvas.clone().flipped(self.flip.horizontal(), self.flip.vertical()).turned(self.rotation.quarters()),
        )
    }

    /// Where the canvas lies on the module, across and down.
    fn place(&self, canvas: (usize, usize), module: (usize, usize)) -> (Place, Place) {
        let (width, height) = if self.rotation.quarters() % 2 == 1 { (canvas.1, canvas.0) } else { canvas };
        let (width, height) = (width as f64, height as f64);
        let room = (module.0 as f64, module.1 as f64);
        let scale = match self.scale {
            Scale::Fit => (room.0 / width).min(room.1 / height),
            Scale::Times(times) => times,
        };
        let place = |side: f64, room: f64, offset: i32| Place {
            start: ((room - side * scale) / 2.0).floor() + f64::from(offset),
            length: side,
            scale,
        };
        (place(width, room.0, self.right_px), place(height, room.1, self.down_px))
    }
}

fn add(pixel: &mut [f32; 3], light: [f32; 3], weight: f32) {
    pixel.iter_mut().zip(light).for_each(|(own, more)| *own += more * weight);
}

/// One side of the canvas on one side of the module.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// Where it begins, a whole module pixel.
    start: f64,
    /// Its canvas pixels.
    length: f64,
    /// Module pixels a canvas pixel.
    scale: f64,
}

impl Place {
    /// Where it ends, in module pixels.
    fn end(&self) -> f64 {
        self.start + self.length * self.scale
    }
}

/// For each module pixel of one side: from which canvas pixels it is made.
struct Taps {
    /// The first canvas pixel, and where its weights stand.
    spans: Vec<(usize, std::ops::Range<usize>)>,
    weights: Vec<f32>,
}

impl Taps {
    fn new(place: &Place, side: usize) -> Taps {
        let mut taps = Taps { spans: Vec::with_capacity(side), weights: Vec::new() };
        for pixel in 0..side {
            let from = (pixel as f64 - place.start) / place.scale;
            let to = (pixel as f64 + 1.0 - place.start) / place.scale;
            let begin = taps.weights.len();
            let first = if place.scale < 1.0 {
                taps.mean(from, to, place.length)
            } else {
                taps.between((from + to) / 2.0, place.length)
            };
            taps.spans.push((first, begin..taps.weights.len()));
        }
        taps
    }

    /// All canvas pixels under a module pixel, each by the share that it has of it.
    fn mean(&mut self, from: f64, to: f64, length: f64) -> usize {
        let (left, right) = (from.max(0.0), to.min(length));
        if left >= right {
            return 0;
        }
        let (first, end) = (left.floor() as usize, right.ceil() as usize);
        for pixel in first..end {
            let shared = right.min(pixel as f64 + 1.0) - left.max(pixel as f64);
            self.weights.push((shared / (to - from)) as f32);
        }
        first
    }

    /// The two canvas pixels whose middles lie about a module pixel's middle; one at the rim or right on a middle.
    fn between(&mut self, middle: f64, length: f64) -> usize {
        if !(0.0..length).contains(&middle) {
            return 0;
        }
        let place = (middle - 0.5).clamp(0.0, length - 1.0);
        let part = (place - place.floor()) as f32;
        self.weights.push(1.0 - part);
        if part > 0.0 {
            self.weights.push(part);
        }
        place.floor() as usize
    }

    /// The canvas pixels of a module pixel and their weights.
    fn of(&self, pixel: usize) -> impl Iterator<Item = (usize, f32)> {
        let (first, range) = self.spans[pixel].clone();
        (first..).zip(self.weights[range].iter().copied())
    }

    /// All canvas pixels that are needed.
    fn reach(&self) -> std::ops::Range<usize> {
        let used = self.spans.iter().filter(|(_, range)| !range.is_empty());
        let ends = used.map(|(first, range)| (*first, first + range.len()));
        ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).map_or(0..0, |(first, end)| first..end)
    }
}

#[cfg(test)]
mod tests;
