//! Text for the LX200 Classic's display, on the same wire as its keys: `1B` and what follows it.
//!
//! Source: MAPUG message 17012: `1B 31` and `1B 32` begin the two lines of 16 characters, `1B 42` clears, `1B 44` and `1B 4C` set
//! lamps and have one more byte, `1B 43` (prompt) and `1B 4D` (characters of one's own) have more. All end with a silence too.

/// Longer than anything that is sent to the display.
const LONGEST: usize = 80;

/// Where in a sequence for the display we are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Escape {
    /// In none.
    #[default]
    Closed,
    /// After `1B`.
    Command,
    /// So many bytes are still to come, at most.
    Text(usize),
}

impl Escape {
    /// Whether a byte belongs to the display.
    pub(super) fn swallows(&mut self, byte: u8) -> bool {
        let after = match (*self, byte) {
            (_, 0x1B) => Escape::Command,
            (Escape::Closed, _) => return false,
            (Escape::Command, b'1' | b'2') => Escape::Text(16),
            (Escape::Command, b'B') | (Escape::Text(..=1), _) => Escape::Closed,
            (Escape::Command, b'D' | b'L') => Escape::Text(1),
            (Escape::Command, _) => Escape::Text(LONGEST),
            (Escape::Text(left), _) => Escape::Text(left - 1),
        };
        *self = after;
        true
    }

    /// Whether a silence would end something.
    pub(super) fn is_open(self) -> bool {
        self != Escape::Closed
    }
}
