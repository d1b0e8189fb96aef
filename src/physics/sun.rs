//! The low Sun: its light, its limb, and its picture through layered air.
//!
//! The sky is layered, so that a picture is a curve for each wavelength, from the altitude at which something appears to the
//! altitude at which it is, and a disc behind it. Rays are traced for the curve, not for the pixels.
//!
//! ```text
//! scene -> plan (wavelengths) -> transfer curves -> rows -> XYZ -> codes
//! ```

/// What the matter in the air takes from light, kind by kind.
mod air;
/// The average of a darkened disc over a stretch of a line.
mod chord;
/// Sunlight above the air.
pub mod irradiance;
/// How the disc darkens towards its limb.
pub mod limb;
/// The picture, by curves and pixel by pixel.
pub mod render;
/// What is to be seen.
pub mod scene;
/// The light of the sky before and around the disc.
pub mod sky;
/// Where the things that appear are, by wavelength.
mod transfer;
/// The wavelengths of a picture.
pub mod wavelengths;

pub use render::{Explained, Rendered, everything, render};
pub use scene::{Scene, SceneError, View};
