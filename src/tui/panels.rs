//! One file a screen.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};

use super::theme::{Level, Theme};
use crate::app::{Model, Screen};

mod align;
mod eyepieces;
mod help;
mod log;
mod mount;
mod search;
mod sky;

/// Draws the screen that is shown.
pub(super) fn draw(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    match model.view.screen {
        Screen::Sky => sky::draw(model, theme, frame, area),
        Screen::Search => search::draw(model, theme, frame, area),
        Screen::Eyepieces => eyepieces::draw(model, theme, frame, area),
        Screen::Mount => mount::draw(model, theme, frame, area),
        Screen::Align => align::draw(model, theme, frame, area),
        Screen::Log => log::draw(model, theme, frame, area),
        Screen::Help => help::draw(model, theme, frame, area),
    }
}

/// A heading.
fn heading(theme: &Theme, text: impl Into<String>) -> Line<'static> {
    Line::styled(format!(" {}", text.into()), theme.text(Level::Bright))
}

/// A label and its value.
fn fact(theme: &Theme, label: &str, value: &str) -> Line<'static> {
    Line::from(vec![
        Span::styled(format!("  {label:<11}"), theme.text(Level::Dim)),
        Span::styled(value.to_owned(), theme.text(Level::Normal)),
    ])
}

/// A text cut to so many columns, with a sign that it was cut.
fn cut(text: &str, columns: usize) -> String {
    if text.chars().count() <= columns {
        return text.to_owned();
    }
    let kept: String = text.chars().take(columns.saturating_sub(1)).collect();
    format!("{kept}…")
}
