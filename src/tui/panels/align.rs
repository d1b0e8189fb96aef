//! How to align: two stars for tonight, high precision, periodic error.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::{Paragraph, Wrap};

use super::heading;
use crate::app::Model;
use crate::tui::theme::{Level, Theme};

pub(super) fn draw(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    let lines = vec![heading(theme, "aligning the mount"), Line::default()];
    let scrolled = u16::try_from(model.view.bar).unwrap_or(0);
    let text = Paragraph::new(lines).style(theme.text(Level::Normal)).wrap(Wrap { trim: false });
    frame.render_widget(text.scroll((scrolled, 0)), area);
}
