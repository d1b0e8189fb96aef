//! The observer's eye through the night: what the overlay costs while it is on, how long until the eye is back, and how bright
//! the overlay may be so that it is back within a minute.

use std::time::Duration;

use crate::eye::adaptation::{brightest_for, veil_dex};
use crate::eye::rods::rod_elevation_dex;
use crate::eye::{Adaptation, Lamp};
use crate::overlay::exposure::{Exposure, exposure};
use crate::overlay::facts::Choices;
use crate::overlay::style::{Eye, Style};
use crate::overlay::tone::{Display, RED_SHARE, Toning};
use crate::picture::Picture;

/// Steps of the overlay's brightness.
const STEPS: u8 = 10;

/// The brightness that is used if the eye bears it.
const WANTED: u8 = 7;

/// So long one looks at the overlay in one go, seconds.
const LOOKED_S: f64 = 600.0;

/// Within so many minutes the eye shall be back.
const BACK_MIN: f64 = 1.0;

/// A magnitude is so many powers of ten, inverted.
const MAGNITUDES: f64 = 2.5;

/// The observer, as the session knows them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Observer {
    /// The eye, and the sky above it.
    pub eye: Eye,
    /// Which facts are wanted.
    pub facts: Choices,
    /// What the projector gives at the eye: white as the settings' `light.luminance_cd_m2`, black as measured or assumed.
    pub display: Display,
    /// How the light is toned to begin with.
    pub tone: Toning,
    /// Whether the projector's LEDs are dimmed, rather than the picture.
    pub lamps_dim: bool,
    /// Whether anything may be drawn that is not red.
    pub white: bool,
}

impl Observer {
    /// The overlay's brightness to begin with, 1 to 10: the greatest up to 7 at which ten minutes before the brightest part of
    /// what is drawn, text or photograph, leave the eye back within a minute; at least 1.
    #[must_use]
    pub fn brightness(&self) -> u8 {
        let style = Style::default();
        let (lamp, share) = if self.white {
            (Lamp::White, f64::from(style.photograph))
        } else {
            (Lamp::LcdRed, RED_SHARE * f64::from(style.text))
        };
        let borne = brightest_for(lamp, LOOKED_S, BACK_MIN, None) / (share * self.display.full_cd_m2).max(1e-12);
        ((borne * f64::from(STEPS)).floor().min(f64::from(WANTED)) as u8).max(1)
    }
}

/// The eye at work.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Adapting {
    /// Its pigment.
    pub pigment: Adaptation,
    /// What it looks at, while the projector shows something.
    pub light: Option<Exposure>,
}

impl Adapting {
    /// A picture is shown at a brightness of 1 to 10.
    pub fn lit(&mut self, picture: &Picture, observer: &Observer, brightness: u8) {
        let dimmed = if observer.lamps_dim { f64::from(brightness) / f64::from(STEPS) } else { 1.0 };
        self.light = Some(exposure(picture, observer.display.full_cd_m2 * dimmed)).filter(|light| light.lit > 0.0);
        // What a black pixel lets through lies over the object too.
        if let Some(light) = &mut self.light {
            light.middle_cd_m2 += observer.display.black_cd_m2 * dimmed;
        }
    }

    /// Time passes.
    pub fn pass(&mut self, time: Duration) {
        let light = self.light.unwrap_or_default();
        self.pigment = self.pigment.after_scotopic(light.scotopic_cd_m2, light.photopic_cd_m2, time.as_secs_f64());
    }

    /// By how many magnitudes the light raises the threshold while it is on.
    #[must_use]
    pub fn while_lit_magnitudes(&self) -> f64 {
        MAGNITUDES * self.light.map_or(0.0, |light| rod_elevation_dex(light.scotopic_cd_m2))
    }

    /// By how many magnitudes the light over the object lowers its contrast, before a sky of a luminance at the eye.
    #[must_use]
    pub fn on_object_magnitudes(&self, background_cd_m2: f64) -> f64 {
        MAGNITUDES * self.light.map_or(0.0, |light| veil_dex(background_cd_m2, light.middle_cd_m2))
    }

    /// The state as a bar of so many cells, each a tenth of a power of ten.
    #[must_use]
    pub fn bar(&self, cells: usize) -> String {
        let filled = ((self.pigment.elevation_dex() * 10.0).round() as usize).min(cells);
        "▮".repeat(filled) + &"▯".repeat(cells - filled)
    }

    /// The state in two lines of plain words. What rests on our own calibration has an asterisk.
    #[must_use]
    pub fn words(&self, background_cd_m2: f64) -> [String; 2] {
        let loss = self.pigment.loss_magnitudes();
        let state = if loss < 0.05 {
            "dark adapted*".to_owned()
        } else {
            match self.pigment.minutes_until_back() {
                soon if soon < 0.1 => format!("−{loss:.1} mag*, back at once*"),
                minutes => format!("−{loss:.1} mag*, back in {minutes:.1} min*"),
            }
        };
        let taken = 1.0 - 10f64.powf(-self.on_object_magnitudes(background_cd_m2) / MAGNITUDES);
        let cost = format!("lit −{:.1} mag, contrast −{:.0} % (*our own)", self.while_lit_magnitudes(), 100.0 * taken);
        [format!("eye {} {state}", self.bar(8)), cost]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn red_words_may_be_as_bright_as_wanted_and_white_pictures_may_not() {
        assert_eq!(Observer::default().brightness(), WANTED);
        let white = Observer { white: true, display: Display::assumed(0.1), ..Observer::default() };
        assert!(white.brightness() < WANTED);
        let glaring = Observer { display: Display::assumed(1e4), ..white.clone() };
        assert_eq!(glaring.brightness(), 1);
        // What is chosen keeps the promise: ten minutes, then a minute of dark.
        let luminance = 0.6 * white.display.full_cd_m2 * f64::from(white.brightness()) / 10.0;
        let eye = Adaptation::default().after(Lamp::White, luminance, None, LOOKED_S);
        assert!(eye.minutes_until_back() <= BACK_MIN, "{luminance}: {}", eye.minutes_until_back());
    }

    #[test]
    fn a_white_screen_costs_and_the_dark_gives_back() {
        let mut picture = Picture::black(16, 16);
        picture.pixels_mut().fill([1.0; 3]);
        let observer = Observer { display: Display::assumed(1.8), ..Observer::default() };
        let mut eye = Adapting::default();
        eye.lit(&picture, &observer, 10);
        for _ in 0..60 {
            eye.pass(Duration::from_secs(1));
        }
        // The table: white 1.8 cd/m2 for 60 s costs 2.9 mag and 7.2 minutes.
        let (lost, minutes) = (eye.pigment.loss_magnitudes(), eye.pigment.minutes_until_back());
        assert!((lost - 2.9).abs() < 0.06 && (minutes - 7.2).abs() < 0.06, "{lost} {minutes}");
        assert!(eye.while_lit_magnitudes() > 5.0 && eye.on_object_magnitudes(4e-5) > 5.0);
        eye.light = None;
        eye.pass(Duration::from_secs_f64(minutes * 60.0 + 1.0));
        assert_eq!(eye.pigment.minutes_until_back(), 0.0);
        assert_eq!((eye.while_lit_magnitudes(), eye.on_object_magnitudes(4e-5)), (0.0, 0.0));
    }

    /// A veil of a quarter of the sky takes a fifth of the contrast; here all of it is the projector's black.
    #[test]
    fn a_black_that_is_not_black_takes_contrast_from_the_object_and_is_told() {
        let mut picture = Picture::black(100, 100);
        picture.row_mut(0).fill([0.5, 0.0, 0.0]);
        let display = Display { black_cd_m2: 1e-5, ..Display::assumed(0.3) };
        let mut eye = Adapting::default();
        eye.lit(&picture, &Observer { display, ..Observer::default() }, 10);
        assert!((10f64.powf(-0.4 * eye.on_object_magnitudes(4e-5)) - 0.8).abs() < 1e-9);
        assert!(eye.words(4e-5)[1].contains("contrast −20 %"), "{:?}", eye.words(4e-5));
    }

    #[test]
    fn the_words_say_how_long_and_the_bar_how_much() {
        let mut eye = Adapting::default();
        assert!(eye.words(4e-5)[0].contains("▯▯▯▯▯▯▯▯ dark adapted"));
        eye.pigment = Adaptation::default().after(Lamp::White, 0.03, None, 60.0);
        assert_eq!(eye.words(4e-5)[0], "eye ▮▮▯▯▯▯▯▯ −0.4 mag*, back in 0.9 min*");
        eye.pigment = Adaptation::default().after(Lamp::White, 1e4, None, 600.0);
        assert_eq!(eye.bar(8), "▮▮▮▮▮▮▮▮");
    }
}
