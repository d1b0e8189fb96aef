//! The frame round every screen: whether it is simulated, the line to the mount, the position and how surely it is known,
//! the message, and the keys at the bottom.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Paragraph, Wrap};

use super::panels;
use super::theme::{Depth, Level, Theme};
use crate::app::commands::{Action, COMMANDS, Command, Where};
use crate::app::log::Weight;
use crate::app::{Model, Screen, words};
use crate::units::angle::{DegreesMinutesSeconds, HoursMinutesSeconds};

/// Draws the session. Reads the model and changes nothing.
pub fn draw(model: &Model, depth: Depth, frame: &mut Frame<'_>) {
    let theme = Theme::new(depth, model.view.brightness);
    let area = frame.area();
    frame.render_widget(Block::new().style(theme.text(Level::Normal)), area);
    let message = u16::try_from(message_rows(model, area.width)).unwrap_or(1);
    let rows = [Constraint::Length(3), Constraint::Length(message), Constraint::Min(1), Constraint::Length(1)];
    let [head, banner, body, keys] = Layout::vertical(rows).areas(area);
    draw_head(model, &theme, frame, head);
    draw_message(model, &theme, frame, banner);
    draw_keys(model, &theme, frame, keys);
    panels::draw(model, &theme, frame, body);
    everywhere_on_black(&theme, frame);
}

/// Widgets that forget a colour leave the terminal's own: this puts red on black there.
fn everywhere_on_black(theme: &Theme, frame: &mut Frame<'_>) {
    use ratatui::style::{Color, Modifier};
    for cell in &mut frame.buffer_mut().content {
        if cell.fg == Color::Reset {
            cell.fg = theme.red(Level::Normal);
        }
        if cell.bg == Color::Reset {
            cell.bg = theme.black();
        }
        cell.modifier = Modifier::empty();
    }
}

fn draw_head(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    let [first, second, third] = Layout::vertical([Constraint::Length(1); 3]).areas(area);
    let mut title = vec![Span::styled(" scotopic ", theme.text(Level::Dim))];
    if model.opening.simulated {
        title.push(Span::styled(" SIMULATED ", theme.inverse()));
    }
    title.push(Span::styled(format!(" {} ", model.view.screen.title()), theme.text(Level::Bright)));
    let clock = model.utc().to_rfc3339().replace('T', "  ").replace('Z', " UTC ");
    both_ends(theme, frame, first, Line::from(title), Line::styled(clock, theme.text(Level::Normal)));

    let (link, well) = words::link(model);
    let level = if well { Level::Normal } else { Level::Bright };
    let disagreements = model.belief.decision.as_ref().map_or(0, |decision| decision.disagreements.len());
    let warn = match disagreements {
        0 => Line::default(),
        1 => Line::styled("1 disagreement (m) ", theme.text(Level::Bright)),
        many => Line::styled(format!("{many} disagreements (m) "), theme.text(Level::Bright)),
    };
    let left = Line::styled(format!(" {link}, {}", words::motion(model)), theme.text(level));
    both_ends(theme, frame, second, left, warn);

    let left = Line::styled(position(model), theme.text(Level::Normal));
    let sure = words::how(&model.belief.position, model.time.now);
    both_ends(theme, frame, third, left, Line::styled(format!("{sure} "), theme.text(Level::Dim)));
}

/// The sky position in one line.
fn position(model: &Model) -> String {
    let Some(here) = model.here else { return " the position is not known".to_owned() };
    let place = here.pointing.position;
    let mut text = format!(" RA {}  Dec {}", HoursMinutesSeconds(place.ra()), DegreesMinutesSeconds(place.dec()));
    if let Some(horizontal) = here.horizontal {
        let (altitude, azimuth) = (horizontal.altitude().to_degrees(), horizontal.azimuth().to_degrees());
        text.push_str(&format!("  alt {altitude:.1}° az {azimuth:.1}°"));
    }
    if here.pointing.stale {
        text.push_str("  STALE");
    }
    text
}

fn both_ends(theme: &Theme, frame: &mut Frame<'_>, area: Rect, left: Line<'_>, right: Line<'_>) {
    let width = u16::try_from(right.width()).unwrap_or(area.width).min(area.width);
    let [start, end] = Layout::horizontal([Constraint::Min(0), Constraint::Length(width)]).areas(area);
    frame.render_widget(Paragraph::new(left).style(theme.text(Level::Normal)), start);
    frame.render_widget(Paragraph::new(right).style(theme.text(Level::Normal)), end);
}

/// A line for every so many characters, and never none, so that the screen does not jump when a message comes.
fn message_rows(model: &Model, width: u16) -> usize {
    let room = usize::from(width.saturating_sub(2)).max(20);
    model.banner.as_ref().map_or(1, |banner| (banner.sentence().chars().count() + 8).div_ceil(room).clamp(1, 3))
}

fn draw_message(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    let Some(banner) = &model.banner else {
        let rule = "─".repeat(usize::from(area.width));
        frame.render_widget(Paragraph::new(rule).style(theme.text(Level::Faint)), area);
        return;
    };
    let style = match banner.weight {
        Weight::Note => theme.text(Level::Normal),
        Weight::Warning => theme.text(Level::Bright),
        Weight::Alarm => theme.inverse(),
    };
    let sign = if banner.weight == Weight::Note { ' ' } else { '!' };
    let text = format!(" {sign} {}", banner.sentence());
    frame.render_widget(Paragraph::new(text).style(style).wrap(Wrap { trim: false }), area);
}

/// The commands that are hinted at on the screen of the sky, the most wanted first: what does not fit is left out.
const SKY: &[Action] = &[
    Action::Stop,
    Action::Search,
    Action::Goto,
    Action::NextEyepiece,
    Action::OverlayMode,
    Action::NudgeBack,
    Action::Sync,
    Action::Show(Screen::Help),
    Action::Quit,
    Action::Show(Screen::Mount),
    Action::Show(Screen::Log),
    Action::Show(Screen::Eyepieces),
    Action::Show(Screen::Align),
];

/// The commands that are worth a hint on a screen, the stop always first.
fn hinted(model: &Model) -> Vec<&'static Command> {
    let screen = model.view.screen;
    let on_it = |command: &&Command| command.belongs_to(screen) && command.when.is_now(model);
    let wanted = |action: &Action| COMMANDS.iter().filter(on_it).find(|command| command.action == *action);
    if screen == Screen::Sky {
        return SKY.iter().filter_map(wanted).collect();
    }
    let its_own = |command: &&Command| match command.at {
        Where::On(screens) => screens == [screen] || command.action == Action::Show(Screen::Sky),
        _ => command.action == Action::Stop,
    };
    COMMANDS.iter().filter(on_it).filter(its_own).collect()
}

fn draw_keys(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    let mut spans = Vec::new();
    let mut hint = |key: String, name: &'static str| {
        spans.push(Span::styled(format!(" {key} "), theme.text(Level::Normal)));
        spans.push(Span::styled(name, theme.text(Level::Faint)));
        spans.push(Span::styled(" ", theme.text(Level::Faint)));
    };
    for command in hinted(model) {
        hint(command.keys.first().map(ToString::to_string).unwrap_or_default(), command.name);
    }
    if model.view.screen == Screen::Search {
        for (key, name) in [("Enter", "go there"), ("Tab", "complete"), ("↓", "choose")] {
            hint(key.to_owned(), name);
        }
    }
    frame.render_widget(Paragraph::new(Line::from(spans)).style(theme.text(Level::Faint)), area);
}
