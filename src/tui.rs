//! Model to cells, keys to events; red only. The only module that knows ratatui and crossterm.
//!
//! Night vision is what this program exists for, so red is not a theme here but a property: `theme` has no other colour to
//! give, and `backend` has no other colour to write.

/// What reaches the terminal: red on black, no control characters, no reset to the terminal's own colours.
pub mod backend;
/// Keys pressed, in the session's words.
pub mod keys;
/// A flight through a nebula.
pub mod nebula;
/// Raw mode and the alternate screen, given back on every way out.
pub mod terminal;
/// The reds, and how many of them a terminal has.
pub mod theme;

/// The picture, small, in red half-blocks or dots.
pub mod preview;

/// One file a screen.
mod panels;
/// The frame round every screen: who, when, where, what is wrong, which keys.
mod view;

pub use view::draw;
