//! Where things are: time, site, coordinates, catalogues, optics, and the field of view.

/// Positions on the sky, each with its frame in its type.
pub mod coords;
/// The field of view: what part of the sky is in the eyepiece, and which way up.
pub mod field;
/// Telescope, eyepieces, projector: what the optics do to the view.
pub mod optics;
/// Where the telescope points, and how sure that is.
pub mod pointing;
/// Where on Earth the observer stands.
pub mod site;
/// UTC, delta T, and the time scales made of them.
pub mod time;
