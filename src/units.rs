//! Physical quantities as types. The only place where units are converted.
//!
//! Inside the program everything is in radians, metres, seconds, kelvin and pascals; a bare `f64` carries its unit
//! in its name's suffix (`_deg`, `_mm`, `_arcsec`, `_s`).

/// Plane angles, and the sexagesimal forms that astronomers and mounts write.
pub mod angle;
/// Astronomical magnitudes, surface brightness, and their luminances.
pub mod magnitude;

pub use angle::Angle;
pub use magnitude::{Magnitude, SurfaceBrightness};
