//! The session as a value: model, events, effects, one table of commands. Pure: no clock, no port, no terminal.
//!
//! ```text
//! event (key, clocks, mount, projector) -> update(model) -> effects (order, draw, dark, keep, quit)
//! ```

/// What the overlay does to the eye.
pub mod adapting;
/// The message at the top.
pub mod banner;
/// What the hand controller's keys mean.
pub mod bindings;
/// The one table of commands.
pub mod commands;
/// What the session asks of the world.
pub mod effect;
/// What happens to the session.
pub mod event;
/// What is in the field, in words.
pub mod facts;
/// A key, whatever device it was pressed on.
pub mod key;
/// What has happened.
pub mod log;
/// The menu in the eyepiece.
pub mod menu;
/// All that the session knows.
pub mod model;
/// What is to be drawn, and whether it differs from what was drawn.
pub mod scene;
/// The search box.
pub mod search;
/// The session's step: event in, effects out.
pub mod update;
/// What is believed of the mount, in words.
pub mod words;

pub use effect::Effect;
pub use event::Event;
pub use model::{Model, Screen};
pub use update::update;
