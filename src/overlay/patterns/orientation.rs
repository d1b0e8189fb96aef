//! Which way up: one asymmetric picture, or all eight ways at once.

use super::Board;
use crate::overlay::canvas::lay_text;
use crate::picture::Picture;

/// Pixels of one of the eight signs.
const SIGN_PX: usize = 168;

/// From the middle to the signs' middles.
const RING_PX: f64 = 280.0;

/// A large F, an arrow to the top, the sides by name, and one to four dots in the corners, clockwise from the upper left.
pub(super) fn one(board: &mut Board) {
    let (x, y) = board.middle();
    let (width, height) = board.size();
    for (count, (right, down)) in
        [(40.0, 40.0), (width - 40.0, 40.0), (width - 40.0, height - 40.0), (40.0, height - 40.0)]
            .into_iter()
            .enumerate()
    {
        for dot in 0..=count {
            let along = (dot as f64 - count as f64 / 2.0) * 18.0;
            board.dot(right + along, down, 6.0);
        }
    }
    board.line((x, 70.0), (x, 160.0), 4.0);
    board.line((x, 68.0), (x - 22.0, 100.0), 4.0);
    board.line((x, 68.0), (x + 22.0, 100.0), 4.0);
    board.lay(1.0);
    board.text("F", 320.0, x, y, 1.0);
    for (name, right, down) in
        [("top", x, 40.0), ("bottom", x, height - 40.0), ("left", 80.0, y), ("right", width - 80.0, y)]
    {
        board.text(name, 40.0, right, down, 1.0);
    }
}

/// Eight signs on a ring, each an F and its number, laid in one of the eight ways. Sent to the module as it is, neither flipped
/// nor turned, the sign that reads rightly in the eyepiece is laid as every picture must be: 1 to 4 turned clockwise by 0, 90,
/// 180 and 270 degrees, 5 to 8 flipped left to right and then turned so. `mirror` is the flip that the session adds for a unit
/// that does not mirror its picture itself.
pub(super) fn all(board: &mut Board, mirror: bool) {
    let (x, y) = board.middle();
    // 1 at the top, then clockwise as drawn.
    for number in 1..=8u8 {
        let sign = laid(&sign(board, number), number, mirror);
        let angle = f64::from(number - 1) * std::f64::consts::FRAC_PI_4;
        let left = (x + RING_PX * angle.sin()) as usize - SIGN_PX / 2;
        let top = (y - RING_PX * angle.cos()) as usize - SIGN_PX / 2;
        for row in 0..SIGN_PX {
            let end = (left + SIGN_PX).min(board.picture.width());
            if top + row < board.picture.height() && left < end {
                board.picture.row_mut(top + row)[left..end].copy_from_slice(&sign.row(row)[..end - left]);
            }
        }
    }
}

/// An F with its number.
pub(super) fn sign(board: &mut Board, number: u8) -> Picture {
    let mut sign = Picture::black(SIGN_PX, SIGN_PX);
    let light = board.light(1.0);
    for (text, em_px, left, top) in [("F".to_owned(), 130.0, 14, -2), (number.to_string(), 66.0, 104, 64)] {
        let written = board.written(&text, em_px);
        lay_text(&mut sign, &written, left, top, light);
    }
    sign
}

/// A sign laid in the way of its number.
fn laid(sign: &Picture, number: u8, mirror: bool) -> Picture {
    sign.clone().flipped((number > 4) != mirror, false).turned((number - 1) % 4)
}
