//! The menu in the eyepiece: opened, gone through, chosen from.

use super::keys;
use crate::app::commands::Action;
use crate::app::effect::Effect;
use crate::app::log::Weight;
use crate::app::menu::{KEYS_A_PAGE, LINES, Page};
use crate::app::model::Model;
use crate::hw::handbox::Pressed;

/// A key of the hand controller was pressed. What the terminal would say of it is said in the eyepiece too: there may be no
/// terminal.
pub(super) fn pressed(model: &mut Model, pressed: &Pressed) -> Vec<Effect> {
    model.counts.presses += 1;
    let Some(action) = model.opening.bindings.meaning(&pressed.key, pressed.long) else { return Vec::new() };
    // With one key only, the same press that steps through the eyepieces steps through the lines.
    let action = match (model.menu.as_ref().map(|menu| &menu.page), action) {
        (None | Some(Page::Eyepieces), action) => action,
        (Some(_), Action::NextEyepiece) => Action::MenuDown,
        (Some(_), Action::PreviousEyepiece) => Action::MenuUp,
        (Some(_), action) => action,
    };
    let before = model.banner.take();
    let effects = keys::done(model, action);
    match (&model.banner, before) {
        (_, Some(alarm)) if alarm.weight == Weight::Alarm => model.banner = Some(alarm),
        (None, before) => model.banner = before,
        (Some(said), _) => {
            let text = said.sentence();
            model.open_menu(Page::Says(text));
        }
    }
    effects
}

/// A command of the menu itself.
pub(super) fn in_menu(model: &mut Model, action: Action) -> Vec<Effect> {
    let now = model.time.now;
    match action {
        Action::Menu => match model.menu.as_ref().map(|menu| &menu.page) {
            Some(Page::Commands) => return in_menu(model, Action::MenuChoose),
            _ => model.open_menu(Page::Commands),
        },
        Action::EyepieceHelp => model.open_menu(Page::Help),
        Action::MenuClose => model.menu = None,
        Action::MenuDown | Action::MenuUp | Action::MenuChoose => {
            let Some(menu) = model.menu.as_mut() else { return Vec::new() };
            menu.touched(now);
            let (page, bar) = (menu.page.clone(), menu.bar);
            let down = action == Action::MenuDown;
            match page {
                Page::Commands if action == Action::MenuChoose => return chosen(model, LINES[bar % LINES.len()]),
                Page::Commands => menu.bar = (bar + if down { 1 } else { LINES.len() - 1 }) % LINES.len(),
                Page::Eyepieces if action == Action::MenuChoose => model.menu = None,
                Page::Eyepieces => {
                    return keys::done(model, if down { Action::NextEyepiece } else { Action::PreviousEyepiece });
                }
                Page::Help if down && bar + KEYS_A_PAGE < model.opening.bindings.all().count() => {
                    menu.bar += KEYS_A_PAGE;
                }
                Page::Help | Page::Says(_) => model.open_menu(Page::Commands),
            }
        }
        _ => {}
    }
    Vec::new()
}

/// A line of the page of commands was chosen. The page stays, so that what changed is seen and can be changed again.
fn chosen(model: &mut Model, action: Action) -> Vec<Effect> {
    if action == Action::NextEyepiece {
        // Which one is chosen on a page of its own.
        model.open_menu(Page::Eyepieces);
        return Vec::new();
    }
    keys::done(model, action)
}
