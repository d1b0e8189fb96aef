//! What the optics do to the view: telescope, eyepieces and projector, read from one TOML file, and the numbers that follow.
//!
//! ```
//! use scotopic::sky::optics::Instrument;
//! let thesis = Instrument::default().with_eyepiece(24.0);
//! assert_eq!(thesis.magnification().round(), 104.0);
//! ```

/// One eyepiece: focal length, apparent field, field stop.
pub mod eyepiece;
/// Telescope, eyepieces and projector together, one eyepiece in use.
pub mod instrument;
/// The projector's rectangle in the focal plane.
pub mod projector;
/// How the sky lies on the canvas, as one transform, and what was measured of it.
pub mod registration;
/// The tube, its mirrors, and the mounting that carries it.
pub mod telescope;

pub use eyepiece::Eyepiece;
pub use instrument::{Instrument, InstrumentError};
pub use projector::{Coverage, ProjectorGeometry};
pub use registration::{Calibration, Registration};
pub use telescope::{Diagonal, Mounting, Telescope};
