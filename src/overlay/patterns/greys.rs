//! Steps of light, each half of the one before, and a ramp below the first code.

use super::Board;
use crate::picture::srgb;

/// Side of one step.
const STEP_PX: usize = 116;

/// Sixteen squares, 1 down to 2^-15 of the look's light, named by the exponent; and under them a ramp from black to the light of
/// the second of 255 codes, which only dithering can show.
pub(super) fn steps(board: &mut Board) {
    let (x, y) = board.middle();
    let (left, top) = (x as usize - 2 * STEP_PX, y as usize - 2 * STEP_PX - 40);
    for step in 0..16 {
        let light = board.light(0.5f32.powi(step as i32));
        let (column, row) = (left + step % 4 * STEP_PX, top + step / 4 * STEP_PX);
        for y in row..row + STEP_PX - 8 {
            board.picture.row_mut(y)[column..column + STEP_PX - 8].fill(light);
        }
    }
    for step in 0..16 {
        let (column, row) = (left + step % 4 * STEP_PX, top + step / 4 * STEP_PX);
        // In the squares that are bright enough the name is dark.
        let share = if step < 4 { 0.0 } else { 0.3 };
        board.text(&format!("-{step}"), 20.0, (column + 20) as f64, (row + STEP_PX - 26) as f64, share);
    }
    let (bottom, width) = (top + 4 * STEP_PX + 12, 4 * STEP_PX);
    let highest = srgb::from_byte(2);
    let colour = board.look.colour;
    for row in bottom..bottom + 48 {
        for (place, pixel) in board.picture.row_mut(row)[left..left + width].iter_mut().enumerate() {
            *pixel = colour.map(|channel| channel * highest * place as f32 / width as f32);
        }
    }
}
