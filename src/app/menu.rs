//! The menu in the eyepiece, as the session has it: which page, which line, and until when. Operable with one key (a short
//! press goes on, a long one chooses) and with several. It goes away by itself.

use std::time::Duration;

use super::commands::Action;
use super::model::Model;
use crate::overlay::menu::{Entry, Menu as Drawn};

/// A list of eyepieces is seen for so long after the last key.
const EYEPIECES_STAY: Duration = Duration::from_secs(5);
/// The commands.
const COMMANDS_STAY: Duration = Duration::from_secs(10);
/// Text that has to be read.
const TEXT_STAYS: Duration = Duration::from_secs(15);
/// Longest line of text, in characters.
const WIDEST: usize = 30;
/// So many keys are shown at once.
pub const KEYS_A_PAGE: usize = 8;
/// Most lines of text.
const MOST_LINES: usize = 14;

/// What the menu shows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Page {
    /// The eyepieces; the one under the bar is in use.
    Eyepieces,
    /// What can be done.
    Commands,
    /// What the keys of the hand controller do.
    Help,
    /// A sentence that would else be seen on the screen only.
    Says(String),
}

/// The open menu.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Menu {
    /// What it shows.
    pub page: Page,
    /// The line under the bar.
    pub bar: usize,
    /// When it goes away, on the session's clock.
    pub until: Duration,
}

/// The lines of the page of commands, and what choosing each does.
pub const LINES: [Action; 14] = [
    Action::NextEyepiece,
    Action::OverlayMode,
    Action::Photographs,
    Action::Facts,
    Action::Animation,
    Action::OverlayBrighter,
    Action::OverlayDimmer,
    Action::PictureBrighter,
    Action::PictureDimmer,
    Action::WordsBrighter,
    Action::WordsDimmer,
    Action::NextObject,
    Action::EyepieceHelp,
    Action::MenuClose,
];

impl Menu {
    /// A page from its top, opened now.
    #[must_use]
    pub fn open(page: Page, now: Duration) -> Menu {
        let mut menu = Menu { page, bar: 0, until: now };
        menu.touched(now);
        menu
    }

    /// A key was pressed: it stays from now on.
    pub fn touched(&mut self, now: Duration) {
        self.until = now
            + match self.page {
                Page::Eyepieces => EYEPIECES_STAY,
                Page::Commands => COMMANDS_STAY,
                Page::Help | Page::Says(_) => TEXT_STAYS,
            };
    }

    /// What is drawn of it.
    #[must_use]
    pub fn drawn(&self, model: &Model) -> Drawn {
        match &self.page {
            Page::Eyepieces => eyepieces(model),
            Page::Commands => Drawn {
                title: "menu".into(),
                lines: LINES.iter().map(|action| line(model, *action)).collect(),
                bar: Some(self.bar),
                hint: hint(model, &[Action::Menu, Action::MenuChoose], "choose"),
            },
            Page::Help => help(model, self.bar),
            Page::Says(text) => Drawn { title: "note".into(), lines: wrapped(text), ..Drawn::default() },
        }
    }
}

fn eyepieces(model: &Model) -> Drawn {
    let instrument = &model.instrument;
    let lines = instrument.eyepieces.iter().enumerate().map(|(index, eyepiece)| Entry {
        label: format!("{:.1} mm", eyepiece.focal_length_mm).replace(".0 mm", " mm"),
        value: format!("{:.0}×", eyepiece.magnification(&instrument.telescope)),
        chosen: index == instrument.eyepiece_index(),
    });
    Drawn {
        title: "eyepiece".into(),
        lines: lines.collect(),
        bar: Some(instrument.eyepiece_index()),
        hint: hint(model, &[Action::Menu], "menu"),
    }
}

/// A line of the page of commands with the state that it would change.
fn line(model: &Model, action: Action) -> Entry {
    let on = |on: bool| if on { "on" } else { "off" }.to_owned();
    let overlay = &model.overlay;
    let (label, value) = match action {
        Action::NextEyepiece => {
            let mm = model.instrument.eyepiece().focal_length_mm;
            ("eyepiece", format!("{mm:.1} mm").replace(".0 mm", " mm"))
        }
        Action::OverlayMode => ("overlay", overlay.mode.to_string()),
        Action::Photographs => ("picture", on(overlay.photographs)),
        Action::Facts => ("facts", on(overlay.facts)),
        Action::Animation => {
            ("animation", if model.animation().is_none() { "none".to_owned() } else { on(overlay.animation) })
        }
        Action::OverlayBrighter => ("brighter", format!("{} of 10", overlay.brightness)),
        Action::OverlayDimmer => ("dimmer", String::new()),
        Action::PictureBrighter => {
            let lights = model.lights();
            ("picture up", format!("{:+.1} mag", lights.over_own_mag(lights.picture_cd_m2())))
        }
        Action::PictureDimmer => ("picture down", String::new()),
        Action::WordsBrighter => {
            let lights = model.lights();
            ("words up", format!("{:+.1} mag", lights.over_own_mag(lights.captions_cd_m2())))
        }
        Action::WordsDimmer => ("words down", String::new()),
        Action::NextObject => ("next object", model.next_in_field().map_or_else(String::new, |name| cut(name, 10))),
        Action::EyepieceHelp => ("help", String::new()),
        _ => ("close", String::new()),
    };
    Entry { label: label.to_owned(), value, chosen: false }
}

fn cut(text: &str, most: usize) -> String {
    if text.chars().count() <= most { text.to_owned() } else { text.chars().take(most - 1).chain(['.']).collect() }
}

/// `hold ?: choose`, for the first of the commands that a key means.
fn hint(model: &Model, actions: &[Action], does: &str) -> String {
    let press = actions.iter().find_map(|action| model.opening.bindings.words(*action));
    press.map_or_else(String::new, |press| format!("{press}: {does}"))
}

/// A page of the hand controller's keys, from the given one on.
fn help(model: &Model, first: usize) -> Drawn {
    let keys = model.opening.bindings.all().map(|(press, name)| Entry {
        label: press.words(),
        value: name.to_owned(),
        chosen: false,
    });
    let mut lines: Vec<Entry> = keys.skip(first).take(KEYS_A_PAGE).collect();
    if lines.is_empty() {
        lines = wrapped("no key of a hand controller means anything: start with --handbox PORT");
    }
    Drawn { title: "keys".into(), lines, bar: None, hint: String::new() }
}

/// Text in lines that fit beside the object.
fn wrapped(text: &str) -> Vec<Entry> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(last) if last.chars().count() + 1 + word.chars().count() <= WIDEST => {
                last.push(' ');
                last.push_str(word);
            }
            _ => lines.push(word.chars().take(WIDEST).collect()),
        }
    }
    lines.truncate(MOST_LINES);
    lines.into_iter().map(|label| Entry { label, ..Entry::default() }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_sentence_is_broken_between_words() {
        let lines = wrapped("there is no animation of M31: put one beside your photographs");
        assert!(lines.len() >= 2 && lines.iter().all(|line| line.label.chars().count() <= WIDEST), "{lines:?}");
        let words: Vec<&str> = lines.iter().map(|line| line.label.as_str()).collect();
        assert_eq!(words.join(" "), "there is no animation of M31: put one beside your photographs");
        assert_eq!(wrapped(&"x".repeat(500))[0].label.len(), WIDEST);
    }
}
