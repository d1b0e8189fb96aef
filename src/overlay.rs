//! What is in the field, drawn as the picture that the projector shows.
//!
//! All drawing is in linear light. Text and marks use the red primary alone, which costs the dark-adapted eye least; stars
//! and photographs keep their colours unless the style's palette is red.

/// Moving pictures of an object.
pub mod animation;
/// Shapes and text laid over the picture.
pub mod canvas;
/// Colours of stars, and the red palette.
pub mod colour;
/// What is in the field, as one picture.
pub mod compose;
/// How much light a picture sends into the eye.
pub mod exposure;
/// What is told of an object, fact by fact.
pub mod facts;
/// Sun, Moon and planets as discs.
pub mod globe;
/// The words: information block and eyepiece's line.
pub mod information;
/// Names without overlap.
pub mod labels;
/// Where things go on the canvas.
pub mod layout;
/// Outlines, reticle, north and east.
pub mod marks;
/// The menu in the eyepiece.
pub mod menu;
/// Test patterns for building and aligning the projector.
pub mod patterns;
/// The observer's photographs.
pub mod photograph;
/// Stars as soft points.
pub mod stars;
/// How the overlay looks: mode, palette, brightness, sizes.
pub mod style;
/// Text as coverage.
pub mod text;
/// How bright pictures and captions are, toned for the eye.
pub mod tone;

pub use compose::{Composer, Scene, compose, reach};
pub use photograph::Photograph;
pub use style::{Eye, Mode, Palette, Style};
