//! What has happened, newest first.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Paragraph, Wrap};

use crate::app::Model;
use crate::app::log::Weight;
use crate::tui::theme::{Level, Theme};

pub(super) fn draw(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    let newest_first = model.log.lines().rev().skip(model.view.bar).take(usize::from(area.height));
    let lines: Vec<Line<'_>> = newest_first
        .map(|line| {
            let utc = line.utc.to_rfc3339();
            let time = utc.get(11..19).unwrap_or(&utc).to_owned();
            let (sign, level) = match line.weight {
                Weight::Note => (' ', Level::Normal),
                Weight::Warning => ('!', Level::Bright),
                Weight::Alarm => ('‼', Level::Bright),
            };
            let times = if line.times > 1 { format!(" ({} times)", line.times) } else { String::new() };
            Line::from(vec![
                Span::styled(format!(" {time} {sign} "), theme.text(Level::Dim)),
                Span::styled(format!("{}{times}", line.text), theme.text(level)),
            ])
        })
        .collect();
    frame.render_widget(Paragraph::new(lines).style(theme.text(Level::Normal)).wrap(Wrap { trim: false }), area);
}
