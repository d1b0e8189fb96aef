//! The session's step: event in, effects out. Pure, so that each rule is a test of the form given-event-then-state.

use super::effect::Effect;
use super::event::Event;
use super::model::{Model, Projector};

/// Go-to and sync, through the judgement of safety.
mod goto;
/// Keys of the hand controller, and the menu in the eyepiece.
mod handbox;
/// Keys.
mod keys;
/// What the mount tells.
mod mount;
/// Where the telescope points, and whether the picture is drawn anew.
mod refresh;
/// Time, and the lack of it: a suspended machine.
mod time;

/// Takes in what happened and says what is to be done. The order of the effects is the order in which to do them.
pub fn update(model: &mut Model, event: Event) -> Vec<Effect> {
    match event {
        Event::Key(key) => {
            let mut effects = keys::pressed(model, key);
            effects.extend(refresh::refreshed(model));
            effects
        }
        Event::Handbox(pressed) => {
            let mut effects = handbox::pressed(model, &pressed);
            effects.extend(refresh::refreshed(model));
            effects
        }
        Event::Clocks(clocks) => {
            let mut effects = time::passed(model, clocks);
            effects.extend(refresh::refreshed(model));
            effects
        }
        Event::Mount(belief, reports) => {
            let mut effects = mount::told(model, *belief, reports);
            effects.extend(refresh::refreshed(model));
            effects
        }
        Event::Shown(picture) => {
            model.eye.lit(&picture, &model.opening.observer, model.overlay.brightness);
            model.picture = Some(picture);
            model.projector = Projector::Showing;
            Vec::new()
        }
        Event::Photographs(credits) => {
            model.credits = credits.iter().map(|credit| super::log::printable(credit)).collect();
            Vec::new()
        }
        Event::ProjectorFailed(why) => {
            model.projector = Projector::Failed(super::log::printable(&why));
            model.say(super::log::Weight::Warning, &why, "");
            Vec::new()
        }
        Event::Notice(text) => {
            model.say(super::log::Weight::Warning, &text, "");
            Vec::new()
        }
        Event::AskedToEnd => goto::quit(model),
    }
}

#[cfg(test)]
mod tests;
