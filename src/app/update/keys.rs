//! Keys: looked up in the table of commands, and done.

use std::time::Duration;

use super::{goto, handbox};
use crate::app::commands::{Action, meaning};
use crate::app::effect::Effect;
use crate::app::key::{Arrow, Key};
use crate::app::log::{KEPT, Weight};
use crate::app::menu::Page;
use crate::app::model::{Model, Screen};
use crate::app::search::Search;
use crate::hw::mount::order::Order;
use crate::overlay::tone::MOST_MAG;
use crate::safety::Acknowledgement;
use crate::sky::alignment;
use crate::sky::catalogue::{Catalogue, Object};
use crate::sky::ephemeris::{Body, Ephemeris, InView};
use crate::sky::field::FieldOfView;
use crate::sky::site::Site;
use crate::sky::time::Moment;

/// An arrow pushes the picture by so many pixels: half a field takes thirty.
const PUSH_PX: f64 = 8.0;

/// A picture is not pushed farther than this: whoever needs more should sync.
const FARTHEST_DEG: f64 = 5.0;

/// A step of the picture's or the words' own brightness, magnitudes.
const STEP_MAG: f64 = 0.5;

/// So many pairs of stars are proposed.
const PAIRS: usize = 3;

/// So many lines are a page.
const PAGE: usize = 10;

/// A key was pressed.
pub(super) fn pressed(model: &mut Model, key: Key) -> Vec<Effect> {
    match meaning(model, key) {
        Some(action) => {
            let effects = done(model, action);
            if key == Key::Esc {
                model.show(Screen::Sky);
            }
            effects
        }
        None if model.view.screen == Screen::Search => typed(model, key),
        None => Vec::new(),
    }
}

/// A key that belongs to the search box.
fn typed(model: &mut Model, key: Key) -> Vec<Effect> {
    if key == Key::Enter
        && let Ok(words) = Acknowledgement::typed(&model.search.text)
    {
        acknowledged(model, words);
        return Vec::new();
    }
    match key {
        Key::Char(c) => model.search.typed(c),
        Key::Backspace if model.search.text.is_empty() => model.show(Screen::Sky),
        Key::Backspace => model.search.rubbed_out(),
        Key::Tab => model.search.completed(),
        Key::Arrow(Arrow::Down) => model.search.bar_moved(1),
        Key::Arrow(Arrow::Up) => model.search.bar_moved(-1),
        Key::Enter => match model.search.meant.clone() {
            Some(object) => {
                model.target = Some(object);
                model.show(Screen::Sky);
                return goto::go(model);
            }
            None => {
                let text = format!("nothing is called '{}'", model.search.text);
                model.say(Weight::Note, &text, "choose one of the offered names with ↓");
            }
        },
        _ => {}
    }
    Vec::new()
}

/// The words that let the settings weaken the Sun rule for this session.
fn acknowledged(model: &mut Model, words: Acknowledgement) {
    model.acknowledged = Some(words);
    model.show(Screen::Sky);
    let rules = model.opening.rules;
    if rules.weakened() {
        let text = format!("until the session ends the Sun rule is your own: {}° from the Sun", rules.sun_cone_deg);
        model.say(Weight::Warning, &text, "cover the finder, and look at the filter once more");
    } else {
        model.note("noted; the settings ask for no weaker Sun rule than the default, so nothing changes");
    }
}

/// A part of the overlay with a brightness of its own.
#[derive(Clone, Copy, PartialEq)]
enum Part {
    Picture,
    Words,
}

/// Makes a part brighter or dimmer by some magnitudes, from what it has now; as far as the projector goes, and no words brighter
/// than the picture.
fn relative(model: &mut Model, part: Part, step: f64) {
    let lights = model.lights();
    let tone = &mut model.overlay.tone;
    let (wanted, now) = match part {
        Part::Picture => (&mut tone.picture_over_object_mag, lights.over_own_mag(lights.picture_cd_m2())),
        Part::Words => (&mut tone.captions_over_object_mag, lights.over_own_mag(lights.captions_cd_m2())),
    };
    let before = *wanted;
    // From what is seen to the nearest step beyond it.
    let next = ((before.unwrap_or(now) + step) / STEP_MAG).round() * STEP_MAG;
    *wanted = Some(next.clamp(-MOST_MAG, MOST_MAG));
    let after = model.lights();
    let (was, is) = match part {
        Part::Picture => (lights.picture, after.picture),
        Part::Words => (lights.text, after.text),
    };
    if step > 0.0 && is <= was {
        // It is already at its limit: asking for more would only have to be taken back.
        match part {
            Part::Picture => model.overlay.tone.picture_over_object_mag = before,
            Part::Words => model.overlay.tone.captions_over_object_mag = before,
        }
        let (why, advice) = match part {
            Part::Picture => ("the projector gives no more at this brightness", "make the overlay brighter first"),
            Part::Words => ("words are never brighter than the picture", "make the picture brighter first"),
        };
        model.say(Weight::Note, why, advice);
    }
}

pub(super) fn done(model: &mut Model, action: Action) -> Vec<Effect> {
    match action {
        Action::Stop => return goto::stop(model),
        Action::Search => {
            let seen = model.moment().map(|moment| bodies(&moment, model.site().as_ref()));
            model.search = Search::among(seen.unwrap_or_default());
            model.show(Screen::Search);
        }
        Action::Goto => return goto::go(model),
        Action::NextObject => next_object(model),
        Action::NextEyepiece => step_eyepiece(model, 1),
        Action::PreviousEyepiece => {
            let count = model.instrument.eyepieces.len();
            step_eyepiece(model, count.saturating_sub(1));
        }
        Action::ChooseEyepiece => use_eyepiece(model, model.view.bar),
        Action::OverlayMode => model.overlay.mode = model.overlay.mode.next(),
        Action::Overlay(mode) => model.overlay.mode = mode,
        Action::Photographs => {
            model.overlay.photographs = !model.overlay.photographs;
            model.note(if model.overlay.photographs { "photographs are drawn" } else { "no photographs are drawn" });
        }
        Action::Facts => {
            model.overlay.facts = !model.overlay.facts;
            model.note(if model.overlay.facts { "words are drawn" } else { "no words are drawn" });
        }
        Action::Animation => animate(model),
        Action::Menu
        | Action::EyepieceHelp
        | Action::MenuDown
        | Action::MenuUp
        | Action::MenuChoose
        | Action::MenuClose => return handbox::in_menu(model, action),
        Action::OverlayBrighter => model.overlay.brightness = (model.overlay.brightness + 1).min(10),
        Action::OverlayDimmer => model.overlay.brightness = model.overlay.brightness.saturating_sub(1).max(1),
        Action::PictureBrighter => relative(model, Part::Picture, STEP_MAG),
        Action::PictureDimmer => relative(model, Part::Picture, -STEP_MAG),
        Action::WordsBrighter => relative(model, Part::Words, STEP_MAG),
        Action::WordsDimmer => relative(model, Part::Words, -STEP_MAG),
        Action::LightByItself => {
            model.overlay.tone.picture_over_object_mag = None;
            model.overlay.tone.captions_over_object_mag = None;
            model.note("picture and words are as bright as the overlay's brightness makes them");
        }
        Action::ToneMethod => {
            model.overlay.tone.method = model.overlay.tone.method.next();
            let lights = model.lights();
            model.note(lights.words());
        }
        Action::ScreenBrighter => model.view.brightness = (model.view.brightness + 1).min(10),
        Action::ScreenDimmer => model.view.brightness = model.view.brightness.saturating_sub(1).max(1),
        Action::Nudge(arrow) => return nudge(model, arrow, PUSH_PX),
        Action::NudgeFinely(arrow) => return nudge(model, arrow, 1.0),
        Action::NudgeBack => {
            model.nudge = Default::default();
            model.note("the picture stands where the mount says");
            return vec![Effect::Keep(model.turns, model.nudge)];
        }
        Action::Sync => return goto::sync(model),
        Action::GiveClock => return give_clock(model),
        Action::GiveSite => return give_site(model),
        Action::Compare => return vec![Effect::Order(Order::Compare)],
        Action::ReadDisplay => return vec![Effect::Order(Order::ReadDisplay)],
        Action::MarkUnwound => {
            model.turns.mark_unwound();
            model.note("the cable hangs free: the turns are counted from here");
            return vec![Effect::Keep(model.turns, model.nudge)];
        }
        Action::Show(screen) => {
            if screen == Screen::Align {
                propose(model);
            }
            model.show(screen);
        }
        Action::Up => model.view.bar = model.view.bar.saturating_sub(1),
        Action::Down => scroll(model, 1),
        Action::PageUp => model.view.bar = model.view.bar.saturating_sub(PAGE),
        Action::PageDown => scroll(model, PAGE),
        Action::Dismiss => model.banner = None,
        Action::Quit => return goto::quit(model),
    }
    Vec::new()
}

/// Proposes stars to align on, for where and when we are.
fn propose(model: &mut Model) {
    let (Some(moment), Some(site)) = (model.moment(), model.site()) else { return };
    model.pairs = alignment::propose(&alignment::bright_stars(Catalogue::embedded()), &moment, &site, PAIRS);
}

fn scroll(model: &mut Model, by: usize) {
    let last = match model.view.screen {
        Screen::Eyepieces => model.instrument.eyepieces.len().saturating_sub(1),
        Screen::Log => model.log.lines().len().saturating_sub(1),
        _ => KEPT,
    };
    model.view.bar = (model.view.bar + by).min(last);
}

/// Uses an eyepiece further on in the list, and shows the list in the eyepiece, as figure 8.10 of the thesis does.
fn step_eyepiece(model: &mut Model, by: usize) {
    use_eyepiece(model, model.instrument.eyepiece_index() + by);
    model.open_menu(Page::Eyepieces);
}

/// Plays the object's animation from its beginning, or stops it.
fn animate(model: &mut Model) {
    if model.overlay.animation {
        model.overlay.animation = false;
        model.note("no animation is played");
        return;
    }
    let name = model.target.as_ref().map_or_else(|| "what is in the field".to_owned(), |target| target.name.clone());
    if model.animation().is_none() {
        let text = format!("there is no animation of {name}");
        model.say(Weight::Note, &text, "put one beside your photographs");
        return;
    }
    model.overlay.animation = true;
    model.played = Duration::ZERO;
    model.note(format!("playing the animation of {name}"));
}

fn use_eyepiece(model: &mut Model, index: usize) {
    let count = model.instrument.eyepieces.len().max(1);
    model.instrument.use_eyepiece(index % count);
    let eyepiece = model.instrument.eyepiece();
    let text = format!("{:.0} mm eyepiece, {:.0}×", eyepiece.focal_length_mm, model.instrument.magnification());
    model.note(text);
}

/// Sun, Moon and planets where they are now; none when the date is beyond the ephemeris.
fn bodies(moment: &Moment, site: Option<&Site>) -> Vec<Object> {
    let Ok(ephemeris) = Ephemeris::at(moment) else { return Vec::new() };
    Body::ALL.into_iter().map(|body| InView::of(&ephemeris, body, site).object()).collect()
}

/// Takes the next thing in the field that has a name as the target; the list is nearest first.
fn next_object(model: &mut Model) {
    let Some(name) = model.next_in_field() else {
        model.say(Weight::Note, "nothing in this field has a name", "press / and type one");
        return;
    };
    let seen = model.moment().map(|moment| bodies(&moment, model.site().as_ref()));
    let body = seen.into_iter().flatten().find(|body| body.name == name);
    match body.map_or_else(|| Catalogue::embedded().search(name), Ok) {
        Ok(object) => {
            model.note(format!("the target is {}", object.name));
            model.target = Some(object);
        }
        Err(error) => model.say(Weight::Note, &error.to_string(), ""),
    }
}

/// Pushes the picture along the canvas: the field's centre moves the other way, and stays on the sky from then on.
fn nudge(model: &mut Model, arrow: Arrow, by_px: f64) -> Vec<Effect> {
    let (Some(here), Some(moment)) = (model.here, model.moment()) else {
        model.say(Weight::Note, "there is no picture to push yet", "");
        return Vec::new();
    };
    let (right, down) = match arrow {
        Arrow::Left => (-by_px, 0.0),
        Arrow::Right => (by_px, 0.0),
        Arrow::Up => (0.0, -by_px),
        Arrow::Down => (0.0, by_px),
    };
    let field = FieldOfView::new(&here.pointing, &model.instrument, &moment, model.site().as_ref());
    let pushed = model.nudge.plus(field.nudge(right, down));
    if pushed.east.to_degrees().hypot(pushed.north.to_degrees()) > FARTHEST_DEG {
        model.say(Weight::Note, "the picture is pushed as far as it goes", "sync the mount on a star instead (S)");
        return Vec::new();
    }
    model.nudge = pushed;
    vec![Effect::Keep(model.turns, pushed)]
}

fn give_clock(model: &mut Model) -> Vec<Effect> {
    let Some(ours) = model.time.ours else { return Vec::new() };
    let offset = model.belief.clock.value().map_or(0.0, |clock| clock.offset_hours);
    model.note("giving the mount our date and time");
    vec![Effect::Order(Order::SetClock(ours, offset)), Effect::Order(Order::Compare)]
}

fn give_site(model: &mut Model) -> Vec<Effect> {
    let Some(site) = model.opening.site else {
        model.say(
            Weight::Note,
            "we have no site to give",
            "start with --site LAT,LON,ELEV, or write it in the settings",
        );
        return Vec::new();
    };
    model.note("giving the mount our site");
    vec![Effect::Order(Order::SetSite(site)), Effect::Order(Order::Compare)]
}

impl Model {
    /// Shows a screen from its top.
    pub(crate) fn show(&mut self, screen: Screen) {
        self.view.screen = screen;
        self.view.bar = if screen == Screen::Eyepieces { self.instrument.eyepiece_index() } else { 0 };
    }

    /// Something that is told in the log.
    pub(crate) fn note(&mut self, text: impl Into<String>) {
        let utc = self.utc();
        self.log.add(utc, Weight::Note, text);
    }

    /// Something that is told at the top and in the log. An alarm is not covered by anything lighter.
    pub(crate) fn say(&mut self, weight: Weight, text: &str, advice: &str) {
        use crate::app::banner::Banner;
        let banner = Banner::new(weight, text, advice);
        let utc = self.utc();
        self.log.add(utc, weight, banner.sentence());
        let covered = self.banner.as_ref().is_some_and(|old| old.weight == Weight::Alarm && weight != Weight::Alarm);
        if !covered {
            self.banner = Some(banner);
        }
    }
}
