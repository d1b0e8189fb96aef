//! What is in the field, drawn as the picture that the projector shows.
//!
//! All drawing is in linear light. Text and marks use the red primary alone, which costs the dark-adapted eye least; stars
//! and photographs keep their colours unless the style's palette is red.

/// Shapes and text laid over the picture.
pub mod canvas;
/// How the overlay looks: mode, palette, brightness, sizes.
pub mod style;
/// Text as coverage.
pub mod text;

pub use style::{Eye, Mode, Palette, Style};
