//! The circles of the eyepieces' field stops on the canvas: figure 8.8.

use super::Board;
use crate::sky::optics::Instrument;

/// A circle for each eyepiece, named where there is room; in the middle, how much of each field the picture covers. A circle
/// that the canvas does not reach is only listed.
pub(super) fn eyepieces(board: &mut Board, instrument: &Instrument) {
    let (x, y) = board.middle();
    let (width, height) = board.size();
    let corner = x.hypot(y);
    board.line((0.5, 0.5), (width - 0.5, 0.5), 1.0);
    board.line((width - 0.5, 0.5), (width - 0.5, height - 0.5), 1.0);
    board.line((width - 0.5, height - 0.5), (0.5, height - 0.5), 1.0);
    board.line((0.5, height - 0.5), (0.5, 0.5), 1.0);
    board.lay(0.4);

    let mut listed = Vec::new();
    let mut named: Vec<(String, f64)> = Vec::new();
    for eyepiece in &instrument.eyepieces {
        let stop_mm = eyepiece.field_circle_mm(&instrument.telescope);
        let radius = stop_mm / 2.0 / instrument.projector.pixel_mm();
        let covered = instrument.projector.coverage(stop_mm).of_field * 100.0;
        let power = eyepiece.magnification(&instrument.telescope);
        let name = format!("{} mm", eyepiece.focal_length_mm);
        let beyond = if radius >= corner { ", beyond the picture" } else { "" };
        listed.push(format!("{name}, {power:.0}x: {covered:.0} % covered{beyond}"));
        if radius < corner {
            board.circle(x, y, radius, 2.0);
            named.push((name, radius));
        }
    }
    board.lay(1.0);
    for (name, radius) in named {
        // On the circle at the right, else on the diagonal where it crosses the picture's upper side.
        let (right, up) = if radius < x - 60.0 {
            (radius, 0.0)
        } else {
            let up = y - 40.0;
            ((radius * radius - up * up).max(0.0).sqrt(), up)
        };
        board.text(&name, 20.0, x + right, y - up, 1.0);
    }
    let top = y - listed.len() as f64 * 13.0;
    for (row, text) in listed.iter().enumerate() {
        board.text(text, 20.0, x, top + row as f64 * 26.0, 0.7);
    }
}
