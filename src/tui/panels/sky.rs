//! Where the telescope points, what is in the field, what the target is, and the picture.

use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Paragraph, Wrap};

use super::{cut, fact, heading};
use crate::app::model::Projector;
use crate::app::{Model, facts};
use crate::tui::preview::Preview;
use crate::tui::theme::{Level, Theme};

/// The texts are as wide as this, or a little less than half of the screen.
const TEXTS: u16 = 37;

pub(super) fn draw(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    let texts = if area.width >= 120 { area.width * 2 / 5 } else { TEXTS.min(area.width / 2) };
    let [left, right] = Layout::horizontal([Constraint::Length(texts), Constraint::Min(0)]).areas(area);
    draw_texts(model, theme, frame, left);
    let [picture, below] = Layout::vertical([Constraint::Min(0), Constraint::Length(6)]).areas(right);
    draw_picture(model, theme, frame, picture);
    draw_below(model, theme, frame, below);
}

fn draw_texts(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    let width = usize::from(area.width);
    let mut lines = Vec::new();
    match &model.target {
        None => {
            lines.push(heading(theme, "no target"));
            lines.push(Line::styled("  press / and type a name", theme.text(Level::Dim)));
        }
        Some(target) => {
            lines.push(heading(theme, cut(&crate::app::log::printable(&target.name), width.saturating_sub(2))));
            for (label, value) in facts::of(target, &model.instrument, &model.opening.observer) {
                lines.push(fact(theme, label, &cut(&value, width.saturating_sub(14))));
            }
        }
    }
    let shown = model.picture.as_ref().map_or(&[][..], |_| &model.credits);
    lines.extend(
        credits(shown, width.saturating_sub(14))
            .into_iter()
            .enumerate()
            .map(|(line, words)| fact(theme, if line == 0 { "photograph" } else { "" }, &words)),
    );
    lines.push(Line::default());
    lines.push(heading(theme, "in the field"));
    let room = usize::from(area.height).saturating_sub(lines.len());
    if model.field.is_empty() {
        lines.push(Line::styled(
            if model.picture.is_some() { "  nothing that is listed" } else { "  not known now" },
            theme.text(Level::Dim),
        ));
    }
    for listed in model.field.iter().take(room) {
        let magnitude = listed.magnitude.map_or_else(|| "    ".to_owned(), |magnitude| format!("{magnitude:4.1}"));
        let distance = format!("{:5.1}′", listed.separation.to_arcminutes());
        let named = cut(&format!("{} {}", listed.name, listed.what), width.saturating_sub(14));
        let chosen = model.target.as_ref().is_some_and(|target| target.name == listed.name);
        let level = if chosen { Level::Bright } else { Level::Normal };
        lines.push(Line::from(vec![
            Span::styled(format!("  {named:<0$}", width.saturating_sub(14)), theme.text(level)),
            Span::styled(format!("{magnitude}{distance}"), theme.text(Level::Dim)),
        ]));
    }
    frame.render_widget(Paragraph::new(lines).style(theme.text(Level::Normal)), area);
}

/// Whose the photographs are and on which terms they are shown: the finest's words in lines of so many columns, and how many
/// more there are.
fn credits(credits: &[String], columns: usize) -> Vec<String> {
    let Some((finest, others)) = credits.split_first() else { return Vec::new() };
    let mut lines = vec![String::new()];
    for word in finest.split_whitespace() {
        match lines.last_mut() {
            Some(last) if last.is_empty() || last.chars().count() + 1 + word.chars().count() <= columns => {
                last.push_str(if last.is_empty() { "" } else { " " });
                last.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    if !others.is_empty() {
        lines.push(format!("and {} more", others.len()));
    }
    lines.iter().map(|line| cut(line, columns)).collect()
}

fn draw_picture(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    if let Some(picture) = &model.picture {
        frame.render_widget(Preview { picture, theme }, area);
        return;
    }
    let why = match &model.projector {
        Projector::Dark(why) => format!("the projector is dark: {why}"),
        Projector::Drawing | Projector::Showing => "being drawn".to_owned(),
        Projector::Failed(why) => format!("the projector failed: {why}"),
    };
    let [_, middle] = Layout::vertical([Constraint::Length(area.height / 2), Constraint::Min(0)]).areas(area);
    let text = Paragraph::new(why).centered().wrap(Wrap { trim: true });
    frame.render_widget(text.style(theme.text(Level::Dim)), middle);
}

/// The eyepiece, what the projector does, and what that does to the eye.
fn draw_below(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    let instrument = &model.instrument;
    let eyepiece = format!(
        " {:.0} mm  {:.0}×  field {:.0}′  exit pupil {:.1} mm",
        instrument.eyepiece().focal_length_mm,
        instrument.magnification(),
        instrument.true_field().to_arcminutes(),
        instrument.exit_pupil_mm()
    );
    let shown = match &model.projector {
        Projector::Dark(_) => "dark",
        Projector::Drawing | Projector::Showing => "showing",
        Projector::Failed(_) => "FAILED",
    };
    let mut place = model.here.map_or_else(String::new, |here| {
        format!(" position good to ±{:.1}′", here.pointing.uncertainty.to_arcminutes())
    });
    if model.nudged() {
        let nudge = model.nudge.east.to_arcminutes().hypot(model.nudge.north.to_arcminutes());
        place = format!("{place}, nudged {nudge:.1}′");
    }
    let overlay = format!(" overlay {}, brightness {}/10, {shown}", model.overlay.mode, model.overlay.brightness);
    let observer = &model.opening.observer;
    let background = instrument.viewing(observer.eye.pupil_mm).background_cd_m2(observer.eye.sky);
    let mut lines = vec![
        Line::styled(eyepiece, theme.text(Level::Normal)),
        Line::styled(overlay, theme.text(Level::Dim)),
        Line::styled(format!(" {}", model.lights().words()), theme.text(Level::Dim)),
        Line::styled(place, theme.text(Level::Dim)),
    ];
    lines.extend(model.eye.words(background).map(|words| Line::styled(format!(" {words}"), theme.text(Level::Dim))));
    frame.render_widget(Paragraph::new(lines).style(theme.text(Level::Normal)), area);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_photographs_terms_are_told_whole_in_lines_that_fit() {
        let lines = credits(&["A. Observer and B. Observer (CC-BY-SA-4.0)".into(), "C".into()], 18);
        assert_eq!(lines, ["A. Observer and B.", "Observer", "(CC-BY-SA-4.0)", "and 1 more"]);
        assert!(credits(&[], 18).is_empty());
    }
}
