//! The picture, small: half-blocks where the terminal has shades of red, braille dots where it has one red.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::widgets::Widget;

use super::theme::{Level, Theme};
use crate::picture::Picture;

/// A dot is set where the picture is brighter than this share of what could be (after gamma).
const DOT: f32 = 0.3;

/// The picture, to be drawn into cells.
pub struct Preview<'a> {
    /// What the projector shows.
    pub picture: &'a Picture,
    /// With which reds.
    pub theme: &'a Theme,
}

impl Preview<'_> {
    /// The largest rectangle inside `area` that has the picture's shape; a cell is twice as high as wide.
    #[must_use]
    pub fn fitted(&self, area: Rect) -> Rect {
        let (width, height) = (self.picture.width().max(1), self.picture.height().max(1));
        let columns = usize::from(area.width).min(usize::from(area.height) * 2 * width / height);
        let rows = usize::from(area.height).min((columns * height).div_ceil(2 * width));
        let (columns, rows) = (u16::try_from(columns).unwrap_or(0), u16::try_from(rows).unwrap_or(0));
        Rect { x: area.x + (area.width - columns) / 2, y: area.y, width: columns, height: rows }
    }

    /// The light of a rectangle of the picture, cut in `across` by `down`, as the eye would see it in a small picture: a
    /// star keeps half of its peak, so that it does not drown.
    fn light(&self, x: usize, y: usize, across: usize, down: usize) -> f32 {
        let (width, height) = (self.picture.width(), self.picture.height());
        let columns = x * width / across..((x + 1) * width / across).max(x * width / across + 1).min(width);
        let (mut sum, mut peak, mut count) = (0.0f32, 0.0f32, 0u32);
        for row in y * height / down..((y + 1) * height / down).max(y * height / down + 1).min(height) {
            for pixel in self.picture.row(row).get(columns.clone()).unwrap_or_default() {
                let value = pixel[0].max(pixel[1]).max(pixel[2]);
                sum += value;
                peak = peak.max(value);
                count += 1;
            }
        }
        let mean = sum / count.max(1) as f32;
        (0.5 * (mean + peak)).clamp(0.0, 1.0).powf(1.0 / 2.2)
    }
}

impl Widget for Preview<'_> {
    fn render(self, area: Rect, buffer: &mut Buffer) {
        let area = self.fitted(area);
        let (columns, rows) = (usize::from(area.width), usize::from(area.height));
        for (row, y) in area.rows().enumerate() {
            for (column, cell) in y.columns().enumerate() {
                let Some(cell) = buffer.cell_mut(cell.as_position()) else { continue };
                if self.theme.has_shades() {
                    let top = self.light(column, 2 * row, columns, 2 * rows);
                    let bottom = self.light(column, 2 * row + 1, columns, 2 * rows);
                    let (top, bottom) = (self.theme.light(top), self.theme.light(bottom));
                    let dark = top == bottom && top == self.theme.black();
                    cell.set_symbol(if dark { " " } else { "▀" }).set_fg(top).set_bg(bottom);
                } else {
                    cell.set_char(self.dots(column, row, columns, rows)).set_style(self.theme.text(Level::Normal));
                }
            }
        }
    }
}

impl Preview<'_> {
    /// The braille character of a cell: two dots across, four down.
    fn dots(&self, column: usize, row: usize, columns: usize, rows: usize) -> char {
        /// The bit of each dot, from the top row to the bottom, left then right (Unicode, block 2800).
        const BITS: [[u32; 2]; 4] = [[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]];
        let mut dots = 0;
        for (dy, bits) in BITS.iter().enumerate() {
            for (dx, bit) in bits.iter().enumerate() {
                if self.light(2 * column + dx, 4 * row + dy, 2 * columns, 4 * rows) > DOT {
                    dots |= bit;
                }
            }
        }
        char::from_u32(0x2800 + dots).unwrap_or(' ')
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::theme::Depth;

    #[test]
    fn a_star_in_the_upper_half_of_a_cell_lights_that_half() {
        let mut picture = Picture::black(8, 8);
        picture.row_mut(1)[4] = [1.0; 3];
        let theme = Theme::new(Depth::True, 10);
        let mut buffer = Buffer::empty(Rect::new(0, 0, 4, 2));
        Preview { picture: &picture, theme: &theme }.render(buffer.area, &mut buffer);
        let lit: Vec<_> =
            buffer.content.iter().map(|cell| (cell.fg != theme.black(), cell.bg != theme.black())).collect();
        assert_eq!(lit.iter().filter(|cell| **cell == (true, false)).count(), 1);
        assert!(lit[2].0, "{lit:?}");
    }

    #[test]
    fn the_preview_keeps_the_shape_of_the_picture() {
        let picture = Picture::black(1024, 768);
        let preview = Preview { picture: &picture, theme: &Theme::new(Depth::True, 5) };
        let fitted = preview.fitted(Rect::new(30, 4, 50, 17));
        assert_eq!((fitted.width, fitted.height), (45, 17));
        assert_eq!(preview.fitted(Rect::new(0, 0, 0, 0)).area(), 0);
    }
}
