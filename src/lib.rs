//! scotopic augments the view through a goto telescope.
//!
//! ```text
//! pointing (mount) -> field of view (optics, site, time) -> what is in it (catalogue, ephemeris)
//!                  -> picture (overlay, tone, adaptation) -> projector
//! ```
//!
//! The modules stand in the order of that flow; `docs/architecture.md` says who may use whom.

/// The session as a value: model, events, effects, one table of commands.
pub mod app;
/// The command line: parse, wire, run, print.
pub mod cli;
/// What the eye can see, what a light costs it, how a scene is toned for it.
pub mod eye;
/// Bytes and devices: the mount and the projector, each a pure protocol, a thin adapter and a simulator.
pub mod hw;
/// Integrals, roots, steps of differential equations, seeded random streams.
pub mod numerics;
/// What is in the field, drawn as the picture that the projector shows.
pub mod overlay;
/// What nature does: air, what its molecules and particles do to light, and the bending of light by it.
pub mod physics;
/// An image in memory, linear light.
pub mod picture;
/// One frame of data from the mount to the eyepiece: the page to read.
pub mod pipeline;
/// How the projected sky lies on the seen one, measured from photographs of the Moon; the drive's periodic error.
pub mod registration;
/// What methods cost and what errors they make, measured.
pub mod report;
/// May the telescope move there: the Sun, the limits, the turns of the cable.
pub mod safety;
/// Where things are: time, site, coordinates, catalogues, optics, the field of view.
pub mod sky;
/// Model to cells, keys to events; red only.
pub mod tui;
/// Angles and magnitudes as types; conversion only here.
pub mod units;
