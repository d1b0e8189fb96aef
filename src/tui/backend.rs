//! What reaches the terminal: red on black, no control characters, no reset to the terminal's own colours.
//!
//! ratatui's own crossterm backend resets colours after each frame and obeys `NO_COLOR`; on a white terminal both would let
//! white through. This one can only write red, so a mistake further up is dark, not bright.

use std::io::{self, Write};

use ratatui::backend::{Backend, ClearType, WindowSize};
use ratatui::buffer::Cell;
use ratatui::layout::{Position, Size};
use ratatui::style::Color;

/// A terminal behind a writer.
pub struct RedBackend<W: Write> {
    writer: W,
    size: Box<dyn Fn() -> io::Result<(u16, u16)> + Send>,
    /// The colours that the terminal has been told last.
    colours: Option<(Color, Color)>,
}

impl<W: Write> RedBackend<W> {
    /// Writes to `writer`, a terminal whose columns and rows `size` asks for.
    pub fn new(writer: W, size: impl Fn() -> io::Result<(u16, u16)> + Send + 'static) -> RedBackend<W> {
        RedBackend { writer, size: Box::new(size), colours: None }
    }

    fn colour(&mut self, foreground: Color, background: Color) -> io::Result<()> {
        if self.colours != Some((foreground, background)) {
            self.colours = Some((foreground, background));
            write!(self.writer, "\x1b[{};{}m", code(foreground, 30), code(background, 40))?;
        }
        Ok(())
    }
}

/// The parameters that choose a colour; 30 chooses the foreground, 40 the background. Green and blue are not written, and
/// what is no red is black.
#[must_use]
pub fn code(color: Color, base: u8) -> String {
    match color {
        Color::Rgb(red, ..) => format!("{};2;{red};0;0", base + 8),
        Color::Indexed(index @ (16 | 52 | 88 | 124 | 160 | 196)) => format!("{};5;{index}", base + 8),
        Color::Red => format!("{}", base + 1),
        _ => format!("{base}"),
    }
}

impl<W: Write> Backend for RedBackend<W> {
    type Error = io::Error;

    fn draw<'a, I: Iterator<Item = (u16, u16, &'a Cell)>>(&mut self, content: I) -> io::Result<()> {
        let mut next = None;
        for (x, y, cell) in content {
            if next != Some((x, y)) {
                write!(self.writer, "\x1b[{};{}H", y + 1, x + 1)?;
            }
            next = Some((x + 1, y));
            self.colour(cell.fg, cell.bg)?;
            let symbol = cell.symbol();
            let safe = if symbol.is_empty() || symbol.chars().any(char::is_control) { " " } else { symbol };
            self.writer.write_all(safe.as_bytes())?;
        }
        Ok(())
    }

    fn hide_cursor(&mut self) -> io::Result<()> {
        Ok(())
    }

    /// The cursor is hidden from beginning to end: terminals draw it white.
    fn show_cursor(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn get_cursor_position(&mut self) -> io::Result<Position> {
        Ok(Position::ORIGIN)
    }

    fn set_cursor_position<P: Into<Position>>(&mut self, _position: P) -> io::Result<()> {
        Ok(())
    }

    fn clear(&mut self) -> io::Result<()> {
        let background = self.colours.map_or(Color::Black, |(_, background)| background);
        self.colour(background, background)?;
        self.writer.write_all(b"\x1b[2J")
    }

    fn clear_region(&mut self, _region: ClearType) -> io::Result<()> {
        self.clear()
    }

    fn size(&self) -> io::Result<Size> {
        (self.size)().map(|(width, height)| Size { width, height })
    }

    fn window_size(&mut self) -> io::Result<WindowSize> {
        Ok(WindowSize { columns_rows: self.size()?, pixels: Size::ZERO })
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(cells: &[Cell]) -> String {
        let mut bytes = Vec::new();
        let mut backend = RedBackend::new(&mut bytes, || Ok((80, 24)));
        backend.draw(cells.iter().enumerate().map(|(x, cell)| (x as u16, 0, cell))).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn a_white_cell_and_a_reset_come_out_dark() {
        let mut white = Cell::new("w");
        white.set_fg(Color::White).set_bg(Color::Rgb(9, 255, 255));
        assert_eq!(written(&[white, Cell::new("r")]), "\x1b[1;1H\x1b[30;48;2;9;0;0mw\x1b[30;40mr");
    }

    #[test]
    fn an_escape_in_a_cell_is_written_as_a_space() {
        assert_eq!(written(&[Cell::new("\x1b[41m"), Cell::new("\u{9b}2J")]), "\x1b[1;1H\x1b[30;40m  ");
    }
}
