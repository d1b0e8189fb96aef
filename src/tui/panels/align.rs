//! How to align: two stars for tonight, high precision, periodic error.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::{Paragraph, Wrap};

use super::heading;
use crate::app::{Model, words};
use crate::tui::theme::{Level, Theme};

pub(super) fn draw(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    let mut lines = vec![heading(theme, "stars to align on now")];
    if model.pairs.is_empty() {
        lines.push(Line::styled("  none can be proposed: site and time must be known", theme.text(Level::Dim)));
    }
    lines.extend(
        words::pairs(model).into_iter().map(|pair| Line::styled(format!("  {pair}"), theme.text(Level::Normal))),
    );
    for guide in words::guides() {
        lines.push(Line::default());
        lines.push(heading(theme, guide.title));
        lines.push(Line::styled(format!("  {}", guide.why), theme.text(Level::Dim)));
        for (number, step) in guide.steps.iter().enumerate() {
            lines.push(Line::styled(format!("  {}. {step}", number + 1), theme.text(Level::Normal)));
        }
    }
    let scrolled = u16::try_from(model.view.bar).unwrap_or(0);
    let text = Paragraph::new(lines).style(theme.text(Level::Normal)).wrap(Wrap { trim: false });
    frame.render_widget(text.scroll((scrolled, 0)), area);
}
