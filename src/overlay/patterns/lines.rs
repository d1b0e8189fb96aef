//! Grid, cross, ghosts: lines and dots at known places.

use super::Board;

/// Pixels between the grid's lines: 16 x 12 squares on 1024 x 768.
const GRID_PX: usize = 64;

/// Lines every 64 pixels, the middle ones fat, every second one numbered; and a frame of the outermost pixels, one pixel wide:
/// where it is missing the module is cut or its picture scaled away.
pub(super) fn grid(board: &mut Board) {
    let (width, height) = board.size();
    let (columns, rows) = (board.picture.width(), board.picture.height());
    for x in (GRID_PX..columns).step_by(GRID_PX) {
        board.line((x as f64 + 0.5, 0.0), (x as f64 + 0.5, height), 1.0);
    }
    for y in (GRID_PX..rows).step_by(GRID_PX) {
        board.line((0.0, y as f64 + 0.5), (width, y as f64 + 0.5), 1.0);
    }
    board.lay(0.4);
    let (x, y) = board.middle();
    board.line((x, 0.0), (x, height), 4.0);
    board.line((0.0, y), (width, y), 4.0);
    board.lay(0.7);
    // The frame is set pixel by pixel: it must not be smoothed.
    let light = board.light(1.0);
    for y in 0..rows {
        let row = board.picture.row_mut(y);
        if y == 0 || y == rows - 1 {
            row.fill(light);
        } else {
            (row[0], row[columns - 1]) = (light, light);
        }
    }
    for x in (2 * GRID_PX..columns).step_by(2 * GRID_PX) {
        board.text(&x.to_string(), 18.0, x as f64, 16.0, 1.0);
    }
    for y in (2 * GRID_PX..rows).step_by(2 * GRID_PX) {
        board.text(&y.to_string(), 18.0, 24.0, y as f64, 1.0);
    }
}

/// A cross through the middle, open where the star is to stand, with marks every 16 and 64 pixels and three circles.
pub(super) fn cross(board: &mut Board) {
    let (width, height) = board.size();
    let (x, y) = board.middle();
    let free = 8.0;
    for (from, to) in [((0.0, y), (x - free, y)), ((x + free, y), (width, y))] {
        board.line(from, to, 2.0);
    }
    for (from, to) in [((x, 0.0), (x, y - free)), ((x, y + free), (x, height))] {
        board.line(from, to, 2.0);
    }
    for step in 1..=(width as usize / 32) {
        let (away, half) = (step as f64 * 16.0, if step % 4 == 0 { 12.0 } else { 5.0 });
        for side in [-away, away] {
            board.line((x + side, y - half), (x + side, y + half), 1.0);
            board.line((x - half, y + side), (x + half, y + side), 1.0);
        }
    }
    for radius in [16.0, 64.0, 192.0] {
        board.circle(x, y, radius, 1.5);
    }
    board.lay(1.0);
    for (radius, name) in [(64.0, "64"), (192.0, "192")] {
        let away = radius * std::f64::consts::FRAC_1_SQRT_2 + 16.0;
        board.text(name, 18.0, x + away, y - away, 0.7);
    }
}

/// Five bright dots far apart on black. Beside each a dim scale in four directions, a mark every 20 pixels: a ghost is a fainter
/// dot that all five have at the same place.
pub(super) fn ghost(board: &mut Board) {
    let (x, y) = board.middle();
    let (right, down) = (x * 0.55, y * 0.55);
    let places = [(x, y), (x - right, y - down), (x + right, y - down), (x - right, y + down), (x + right, y + down)];
    for (x, y) in places {
        for mark in 1..=5 {
            let away = f64::from(mark) * 20.0;
            let half = if mark == 5 { 5.0 } else { 2.0 };
            for side in [-away, away] {
                board.line((x + side, y - half), (x + side, y + half), 1.0);
                board.line((x - half, y + side), (x + half, y + side), 1.0);
            }
        }
    }
    board.lay(0.04);
    for (x, y) in places {
        board.dot(x, y, 5.0);
    }
    board.lay(1.0);
}
