//! What is believed of the mount, how surely, and where it disagrees with us.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Paragraph, Wrap};

use super::heading;
use crate::app::log::printable;
use crate::app::{Model, words};
use crate::tui::theme::{Level, Theme};

pub(super) fn draw(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    let mut lines = vec![heading(theme, format!("{}: {}", printable(&model.opening.mount), words::link(model).0))];
    for row in words::rows(model) {
        lines.push(Line::from(vec![
            Span::styled(format!("  {:<9}", row.label), theme.text(Level::Dim)),
            Span::styled(format!("{:<46}", row.value), theme.text(Level::Normal)),
            Span::styled(format!(" {}", row.how), theme.text(Level::Dim)),
        ]));
    }
    lines.push(Line::styled(format!("  {}", words::sources(model)), theme.text(Level::Normal)));
    let turned = model.turns.turned().to_degrees();
    let sure = if model.turns.is_certain() { "" } else { " (a guess: it moved while nobody was counting)" };
    lines.push(Line::styled(format!("  azimuth turned {turned:+.0}° since unwound{sure}"), theme.text(Level::Normal)));
    let counters = &model.belief.counters;
    lines.push(Line::styled(
        format!(
            "  {} positions, {} repeated, {} mended, {} reconnects, {} faults",
            counters.polls, counters.retries, counters.resyncs, counters.reconnects, counters.faults
        ),
        theme.text(Level::Dim),
    ));
    if let Some(display) = model.belief.display.value() {
        lines.push(Line::styled(
            format!("  hand controller: {} / {}", printable(&display.top), printable(&display.bottom)),
            theme.text(Level::Normal),
        ));
    }
    lines.push(Line::default());
    let disagreements =
        model.belief.decision.as_ref().map(|decision| decision.disagreements.as_slice()).unwrap_or_default();
    if !disagreements.is_empty() {
        lines.push(heading(theme, "where the mount and we disagree"));
    }
    for disagreement in disagreements {
        lines.push(Line::styled(format!("  ! {}", printable(&disagreement.to_string())), theme.text(Level::Bright)));
    }
    let scrolled = u16::try_from(model.view.bar).unwrap_or(0);
    let text = Paragraph::new(lines).style(theme.text(Level::Normal)).wrap(Wrap { trim: false });
    frame.render_widget(text.scroll((scrolled, 0)), area);
}
