//! Keys pressed, in the session's words.

use std::io;
use std::time::Duration;

use ratatui::crossterm::event::{Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers, poll, read};

use crate::app::key::{Arrow, Key};

/// What the terminal told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Input {
    /// A key was pressed (or repeats).
    Key(Key),
    /// The terminal has another size: draw again.
    Resized,
}

/// Waits for the next input that means something here.
///
/// # Errors
/// The terminal is gone.
pub fn next() -> io::Result<Input> {
    loop {
        match read()? {
            Event::Key(event) => {
                if let Some(key) = key(&event) {
                    return Ok(Input::Key(key));
                }
            }
            Event::Resize(..) => return Ok(Input::Resized),
            _ => {}
        }
    }
}

/// The next input that means something here, if one comes in time.
///
/// # Errors
/// The terminal is gone.
pub fn within(time: Duration) -> io::Result<Option<Input>> {
    while poll(time)? {
        match read()? {
            Event::Key(event) => {
                if let Some(key) = key(&event) {
                    return Ok(Some(Input::Key(key)));
                }
            }
            Event::Resize(..) => return Ok(Some(Input::Resized)),
            _ => {}
        }
    }
    Ok(None)
}

/// A key event as a key, if it is one that could mean something.
fn key(event: &KeyEvent) -> Option<Key> {
    if event.kind == KeyEventKind::Release {
        return None;
    }
    let shift = event.modifiers.contains(KeyModifiers::SHIFT);
    let arrow = |arrow| Some(if shift { Key::Shifted(arrow) } else { Key::Arrow(arrow) });
    match event.code {
        KeyCode::Char(c) if event.modifiers.contains(KeyModifiers::CONTROL) => Some(Key::Ctrl(c.to_ascii_lowercase())),
        KeyCode::Char(c) if !event.modifiers.contains(KeyModifiers::ALT) => Some(Key::Char(c)),
        KeyCode::Enter => Some(Key::Enter),
        KeyCode::Esc => Some(Key::Esc),
        KeyCode::Backspace => Some(Key::Backspace),
        KeyCode::Tab => Some(Key::Tab),
        KeyCode::PageUp => Some(Key::PageUp),
        KeyCode::PageDown => Some(Key::PageDown),
        KeyCode::Up => arrow(Arrow::Up),
        KeyCode::Down => arrow(Arrow::Down),
        KeyCode::Left => arrow(Arrow::Left),
        KeyCode::Right => arrow(Arrow::Right),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shift_makes_a_letter_large_and_an_arrow_fine() {
        let press = |code, modifiers| key(&KeyEvent::new(code, modifiers));
        assert_eq!(press(KeyCode::Char('S'), KeyModifiers::SHIFT), Some(Key::Char('S')));
        assert_eq!(press(KeyCode::Left, KeyModifiers::SHIFT), Some(Key::Shifted(Arrow::Left)));
        assert_eq!(press(KeyCode::Char('x'), KeyModifiers::CONTROL), Some(Key::Ctrl('x')));
        assert_eq!(press(KeyCode::F(5), KeyModifiers::NONE), None);
    }
}
