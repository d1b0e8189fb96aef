//! Where things are: time, site, coordinates, catalogues, optics, and the field of view.

/// Two stars to align on tonight, and how to align.
pub mod alignment;
/// From the catalogue's place to the apparent place of date, and back.
pub mod astrometry;
/// On which chart of two printed atlases a place is.
pub mod atlas;
/// Stars and deep-sky objects: search, and what is in a field.
pub mod catalogue;
/// Positions on the sky, each with its frame in its type.
pub mod coords;
/// TT - UT1: measured, then foretold.
pub mod delta_t;
/// Sun, Moon, planets and their moons: where they are.
pub mod ephemeris;
/// The field of view: what part of the sky is in the eyepiece, and which way up.
pub mod field;
/// Altitude, azimuth, hour angle and parallactic angle, and the way back.
pub mod horizon;
/// Telescope, eyepieces, projector: what the optics do to the view.
pub mod optics;
/// How the bodies of the solar system present themselves: phase, axis, magnitude.
pub mod physical;
/// Where the telescope points, and how sure that is.
pub mod pointing;
/// From a direction on the sky to a pixel of the canvas, and back.
pub mod project;
/// Where on Earth the observer stands.
pub mod site;
/// The Sun's place, and the middle of the coming night.
pub mod sun;
/// UTC, delta T, and the time scales made of them.
pub mod time;
/// What is worth showing now.
pub mod tonight;
