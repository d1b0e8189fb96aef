//! Every key, from the table of commands.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::Paragraph;

use super::cut;
use crate::app::Model;
use crate::app::commands::{COMMANDS, When, Where};
use crate::tui::theme::{Level, Theme};

pub(super) fn draw(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    let room = usize::from(area.width).saturating_sub(31);
    let lines: Vec<Line<'_>> = COMMANDS
        .iter()
        .filter(|command| !command.keys.is_empty())
        .map(|command| {
            let place = match command.at {
                _ if command.when == When::MenuOpen => "menu",
                Where::Always | Where::Everywhere => "",
                Where::On(screens) => {
                    screens.first().filter(|_| screens.len() == 1).map_or("", |screen| screen.title())
                }
            };
            Line::from(vec![
                Span::styled(format!("  {:<18} ", command.keys_in_words()), theme.text(Level::Bright)),
                Span::styled(format!("{place:<10}"), theme.text(Level::Dim)),
                Span::styled(cut(command.help, room), theme.text(Level::Normal)),
            ])
        })
        .skip(model.view.bar.min(COMMANDS.len().saturating_sub(1)))
        .collect();
    frame.render_widget(Paragraph::new(lines).style(theme.text(Level::Normal)), area);
}
