//! How the overlay looks: mode, palette, brightness, sizes; and the eye and sky it is made for.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::facts::Choices;
use super::tone::{Display, Toning};
use crate::units::SurfaceBrightness;

/// Where the picture stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mode {
    /// Over the object that is seen.
    #[default]
    Over,
    /// Beside it, so that picture and sight can be compared; made smaller when both do not fit into the field.
    Beside,
    /// Nowhere: black.
    Off,
}

impl Mode {
    /// The next mode, round and round: what one key does.
    #[must_use]
    pub fn next(self) -> Mode {
        match self {
            Mode::Over => Mode::Beside,
            Mode::Beside => Mode::Off,
            Mode::Off => Mode::Over,
        }
    }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Mode::Over => "over",
            Mode::Beside => "beside",
            Mode::Off => "off",
        })
    }
}

impl FromStr for Mode {
    type Err = String;

    fn from_str(text: &str) -> Result<Mode, String> {
        match text {
            "over" => Ok(Mode::Over),
            "beside" => Ok(Mode::Beside),
            "off" => Ok(Mode::Off),
            _ => Err("a mode is over (the object), beside (it) or off".into()),
        }
    }
}

/// Which colours are used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Palette {
    /// Text and marks red, stars and photographs in their own colours.
    #[default]
    Natural,
    /// Everything red.
    Red,
}

/// How the overlay looks. Light is in parts of the projector's full drive, linear.
#[derive(Debug, Clone, PartialEq)]
pub struct Style {
    /// Where the picture stands.
    pub mode: Mode,
    /// Which colours are used.
    pub palette: Palette,
    /// Overall brightness: everything is multiplied by it. The observer's brightness keys change it.
    pub gain: f32,
    /// No pixel is ever brighter than this.
    pub ceiling: f32,
    /// Light of text and of the target's marks; never more than the photographs'.
    pub text: f32,
    /// Light of other objects' outlines and labels.
    pub marks: f32,
    /// Light of the brightest part of a photograph.
    pub photograph: f32,
    /// Height of a line of text at the eye, in arcminutes: text keeps its apparent size in every eyepiece, within 13 to 26
    /// pixels.
    pub text_arcmin: f32,
    /// Whether names are written.
    pub labels: bool,
    /// Whether the information block and the eyepiece's line are written.
    pub information: bool,
    /// Which facts stand in the information block.
    pub facts: Choices,
    /// Whether the circle of the field stop is drawn.
    pub field_circle: bool,
    /// Whether the uncertainty of the position is drawn.
    pub uncertainty: bool,
    /// Which operator tones it, and how bright it is relative to the object's own light.
    pub tone: Toning,
    /// What the projector gives at the eye, with gain or lamps already dimmed.
    pub display: Display,
}

impl Default for Style {
    fn default() -> Style {
        Style {
            mode: Mode::Over,
            palette: Palette::Natural,
            gain: 1.0,
            ceiling: 1.0,
            text: 0.60,
            marks: 0.30,
            photograph: 0.60,
            text_arcmin: 36.0,
            labels: true,
            information: true,
            facts: Choices::default(),
            field_circle: true,
            uncertainty: true,
            tone: Toning::default(),
            display: Display::default(),
        }
    }
}

/// The observer's eye and the sky above: what can be seen, and the contrast, depend on them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eye {
    /// Diameter of the dark-adapted pupil in millimetres: 7 when young, 5.5 at seventy.
    pub pupil_mm: f64,
    /// Brightness of the sky's background.
    pub sky: SurfaceBrightness,
}

impl Default for Eye {
    fn default() -> Eye {
        Eye { pupil_mm: 7.0, sky: SurfaceBrightness(21.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_are_read_written_and_gone_through() {
        for mode in [Mode::Over, Mode::Beside, Mode::Off] {
            assert_eq!(mode.to_string().parse(), Ok(mode));
            assert_eq!(mode.next().next().next(), mode);
        }
        assert!("under".parse::<Mode>().is_err());
    }
}
