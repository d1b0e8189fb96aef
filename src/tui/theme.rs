//! The reds, and how many of them a terminal has. There is no other colour to be had here.

use ratatui::style::{Color, Style};

/// How many reds the terminal can show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Depth {
    /// 256 of them.
    True,
    /// Five, of the 256-colour cube: indexes 52, 88, 124, 160 and 196; 16 is black.
    Indexed,
    /// One.
    Sixteen,
}

impl Depth {
    /// What `COLORTERM` and `TERM` promise. In doubt fewer.
    #[must_use]
    pub fn of(colorterm: Option<&str>, term: Option<&str>) -> Depth {
        let term = term.unwrap_or_default();
        match colorterm {
            Some("truecolor" | "24bit") => Depth::True,
            _ if term.ends_with("-direct") => Depth::True,
            _ if term.contains("256color") => Depth::Indexed,
            _ => Depth::Sixteen,
        }
    }
}

/// How loud a text is. Few, because the eye tells few reds apart in the dark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Level {
    /// Rules and hints.
    Faint,
    /// Labels.
    Dim,
    /// What is read.
    Normal,
    /// What is looked for, and warnings.
    Bright,
}

impl Level {
    fn share(self) -> f32 {
        match self {
            Level::Faint => 0.35,
            Level::Dim => 0.55,
            Level::Normal => 0.8,
            Level::Bright => 1.0,
        }
    }
}

/// The number of brightness steps, the last being the terminal's full red.
pub const STEPS: u8 = 10;

/// Red levels of the indexes 16, 52, 88, 124, 160, 196 in the 256-colour cube of xterm.
const CUBE: [(u8, u8); 6] = [(16, 0), (52, 95), (88, 135), (124, 175), (160, 215), (196, 255)];

/// The reds at one brightness.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Theme {
    depth: Depth,
    brightness: u8,
}

impl Theme {
    /// The reds of a terminal at a brightness from 1 to [`STEPS`].
    #[must_use]
    pub fn new(depth: Depth, brightness: u8) -> Theme {
        Theme { depth, brightness: brightness.clamp(1, STEPS) }
    }

    /// Black, as this terminal writes it.
    #[must_use]
    pub fn black(&self) -> Color {
        match self.depth {
            Depth::True => Color::Rgb(0, 0, 0),
            Depth::Indexed => Color::Indexed(16),
            Depth::Sixteen => Color::Black,
        }
    }

    /// A red that can be read: never so dark that it is gone.
    #[must_use]
    pub fn red(&self, level: Level) -> Color {
        self.shade(level.share(), 40)
    }

    /// A red for a picture, 0 black to 1 as bright as text may be.
    #[must_use]
    pub fn light(&self, value: f32) -> Color {
        if value <= 0.0 { self.black() } else { self.shade(value, 0) }
    }

    fn shade(&self, share: f32, least: u8) -> Color {
        let full = 255.0 * f32::from(self.brightness) / f32::from(STEPS);
        let red = ((full * share.clamp(0.0, 1.0)).round() as u8).max(least);
        match self.depth {
            Depth::True => Color::Rgb(red, 0, 0),
            Depth::Indexed => {
                let cube = if least > 0 { &CUBE[1..] } else { &CUBE[..] };
                let nearest = cube.iter().min_by_key(|(_, level)| level.abs_diff(red));
                Color::Indexed(nearest.map_or(16, |(index, _)| *index))
            }
            Depth::Sixteen if least == 0 && red < 64 => Color::Black,
            Depth::Sixteen => Color::Red,
        }
    }

    /// Text on black.
    #[must_use]
    pub fn text(&self, level: Level) -> Style {
        Style::new().fg(self.red(level)).bg(self.black())
    }

    /// What is chosen, and what must be seen: black on red.
    #[must_use]
    pub fn inverse(&self) -> Style {
        Style::new().fg(self.black()).bg(self.red(Level::Normal))
    }

    /// Whether a picture has shades, or only dots.
    #[must_use]
    pub fn has_shades(&self) -> bool {
        self.depth != Depth::Sixteen
    }
}

/// Whether a colour has neither green nor blue in it.
#[must_use]
pub fn is_red(color: Color) -> bool {
    match color {
        Color::Rgb(_, green, blue) => green == 0 && blue == 0,
        Color::Indexed(index) => CUBE.iter().any(|(red, _)| *red == index),
        Color::Black | Color::Red => true,
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_shade_of_every_terminal_is_red() {
        for depth in [Depth::True, Depth::Indexed, Depth::Sixteen] {
            for brightness in 0..=STEPS + 1 {
                let theme = Theme::new(depth, brightness);
                for level in [Level::Faint, Level::Dim, Level::Normal, Level::Bright] {
                    assert!(is_red(theme.red(level)));
                    assert_ne!(theme.red(level), theme.black(), "text that cannot be seen");
                }
                for value in [-1.0, 0.0, 0.01, 0.5, 1.0, 7.0, f32::NAN] {
                    assert!(is_red(theme.light(value)));
                }
            }
        }
    }

    #[test]
    fn the_environment_tells_how_many_reds_there_are() {
        assert_eq!(Depth::of(Some("truecolor"), Some("xterm")), Depth::True);
        assert_eq!(Depth::of(None, Some("tmux-256color")), Depth::Indexed);
        assert_eq!(Depth::of(Some(""), Some("linux")), Depth::Sixteen);
        assert_eq!(Depth::of(None, None), Depth::Sixteen);
    }

    #[test]
    fn brighter_is_brighter() {
        let red = |brightness| match Theme::new(Depth::True, brightness).red(Level::Bright) {
            Color::Rgb(red, 0, 0) => red,
            other => panic!("{other:?} is not red"),
        };
        assert!((1..STEPS).all(|step| red(step) <= red(step + 1)));
        assert_eq!(red(STEPS), 255);
    }
}
