//! The search box: what was typed, what it means, what else could be meant.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Paragraph, Wrap};

use super::{fact, heading};
use crate::app::log::printable;
use crate::app::{Model, facts};
use crate::tui::theme::{Level, Theme};

pub(super) fn draw(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    let [_, typed, _, body] =
        Layout::vertical([Constraint::Length(1), Constraint::Length(1), Constraint::Length(1), Constraint::Min(0)])
            .areas(area);
    let search = &model.search;
    let text = Line::from(vec![
        Span::styled("  go to: ", theme.text(Level::Dim)),
        Span::styled(printable(&search.text), theme.text(Level::Bright)),
        Span::styled(" ", theme.inverse()),
    ]);
    frame.render_widget(Paragraph::new(text).style(theme.text(Level::Normal)), typed);

    let [offered, meant] = Layout::horizontal([Constraint::Percentage(45), Constraint::Min(0)]).areas(body);
    let mut lines = vec![heading(
        theme,
        match (search.text.is_empty(), search.missed, search.offered.is_empty()) {
            (true, ..) => "names, numbers, abbreviations:",
            (_, true, false) => "nothing is called so; did you mean",
            (_, _, true) if search.meant.is_none() => "nothing is called so",
            _ => "names",
        },
    )];
    if search.text.is_empty() {
        for example in ["M31", "ngc 224", "andromeda galaxy", "C 14", "alpha centauri", "61 Cyg", "HIP 11767"] {
            lines.push(Line::styled(format!("  {example}"), theme.text(Level::Dim)));
        }
    }
    for (place, name) in search.offered.iter().enumerate() {
        let style = if search.bar == Some(place) { theme.inverse() } else { theme.text(Level::Normal) };
        lines.push(Line::from(vec![
            Span::styled("  ", theme.text(Level::Normal)),
            Span::styled(printable(name), style),
        ]));
    }
    frame.render_widget(Paragraph::new(lines).style(theme.text(Level::Normal)), offered);

    let mut lines = Vec::new();
    if let Some(object) = &search.meant {
        lines.push(heading(theme, printable(&object.name)));
        let known = facts::of(object, &model.instrument, &model.opening.observer);
        lines.extend(known.iter().map(|(label, value)| fact(theme, label, value)));
    }
    frame.render_widget(Paragraph::new(lines).style(theme.text(Level::Normal)).wrap(Wrap { trim: false }), meant);
}
