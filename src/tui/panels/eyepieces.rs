//! The eyepieces and what each gives in this telescope.

use ratatui::Frame;
use ratatui::layout::Rect;
use ratatui::text::Line;
use ratatui::widgets::Paragraph;

use super::heading;
use crate::app::Model;
use crate::tui::theme::{Level, Theme};

pub(super) fn draw(model: &Model, theme: &Theme, frame: &mut Frame<'_>, area: Rect) {
    let telescope = &model.instrument.telescope;
    let mut lines = vec![
        heading(
            theme,
            format!(
                "{}: {:.0} mm, focal length {:.0} mm, resolves {:.2}″",
                crate::app::log::printable(&telescope.name),
                telescope.aperture_mm,
                telescope.focal_length_mm,
                telescope.dawes_limit().to_arcseconds()
            ),
        ),
        Line::default(),
        Line::styled("    eyepiece   magnifies   true field   exit pupil   apparent field", theme.text(Level::Dim)),
    ];
    for (index, eyepiece) in model.instrument.eyepieces.iter().enumerate() {
        let used = if index == model.instrument.eyepiece_index() { '●' } else { ' ' };
        let row = format!(
            "  {used} {:5.1} mm   {:6.0}×   {:8.1}′   {:7.1} mm   {:10.0}°      ",
            eyepiece.focal_length_mm,
            eyepiece.magnification(telescope),
            eyepiece.true_field(telescope).to_arcminutes(),
            eyepiece.exit_pupil_mm(telescope),
            eyepiece.apparent_field_deg,
        );
        let style = if index == model.view.bar { theme.inverse() } else { theme.text(Level::Normal) };
        lines.push(Line::styled(row, style));
    }
    frame.render_widget(Paragraph::new(lines).style(theme.text(Level::Normal)), area);
}
