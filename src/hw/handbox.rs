//! The mount's own hand controller as an input device: its cable is tapped, and what its keys send is heard. Nothing is ever
//! sent on that line.
//!
//! ```text
//! bytes of the tapped line (tap) -> frames and patterns (decoder, keymap) -> presses (presses) -> Heard
//! ```
//!
//! Where no cable is tapped, a presenter or a gamepad (`presenter`) or the display (`watch`) give the same `Pressed`.

use std::time::Duration;

use serde::Serialize;

/// The speed of an unknown line, found by key presses.
pub mod baud;
/// What was heard, as JSON lines.
pub mod capture;
/// Bytes of the line -> keys.
pub mod decoder;
/// Key maps: which bytes a key sends, over which line.
pub mod keymap;
/// What the keys of an unknown cable send, found by pressing them.
pub mod learn;
/// Patterns of bytes with wildcards.
pub mod pattern;
/// Presenters and gamepads instead of a tapped cable.
pub mod presenter;
/// Debouncing, long presses, stuck keys.
pub mod presses;
/// A hand controller that is not there.
pub mod sim;
/// Where keys come from.
pub mod source;
/// The tapped line, read and never written.
pub mod tap;
/// The hand controller's display instead of a tapped cable.
pub mod watch;

pub use decoder::Decoder;
pub use keymap::{KeyMap, KeyMapError};

/// A key was pressed: what the session acts on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Pressed {
    /// The key's name in its key map, like `?` or `MODE`.
    pub key: String,
    /// Whether it was held down (0.8 s), or sent its pattern for a long press.
    pub long: bool,
    /// When that was known, since the program started.
    pub at: Duration,
}

/// What a line said.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Heard {
    /// A key was pressed.
    Pressed(Pressed),
    /// A key was let go.
    Released {
        /// The key's name.
        key: String,
        /// When.
        at: Duration,
    },
    /// A key sends more than ten presses a second. It is not heard any more until it has been silent for a second.
    Stuck {
        /// The key's name.
        key: String,
        /// When.
        at: Duration,
    },
    /// Bytes that belong to no key.
    Unknown {
        /// The bytes, two digits each, at most 32 bytes.
        hex: String,
        /// When.
        at: Duration,
    },
    /// More bytes that belong to no key than are worth showing.
    Noise {
        /// How many.
        bytes: usize,
        /// When.
        at: Duration,
    },
}

/// Bytes as people write them: two digits each, a space between.
#[must_use]
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().join(" ")
}
