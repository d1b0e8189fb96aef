//! How the projected sky lies on the seen one, from two photographs of the Moon through the eyepiece: section 8.7.1 of the
//! thesis, with errors.
//!
//! ```text
//! limb:     bright edge -> circle of each photograph                  scale = R projected / R seen
//! surface:  maria and craters of one photograph laid on the other     scale, rotation, parity, offset
//! ```
//!
//! Both know the scale, from different light; they are joined by their errors, and a disagreement is told.

/// The limb's circle with correlated errors.
mod arc;
/// Places of strong change, where a limb may be.
mod edges;
/// A photograph as numbers.
pub mod frame;
/// The limb to a part of a pixel.
pub mod limb;
/// Small systems of linear equations.
mod linear;
/// Where discs lie.
mod map;
/// Both photographs together.
pub mod pair;
/// The drive's periodic error from the observer's nudges.
pub mod periodic;
/// The shape of a blurred edge.
mod profile;
/// The first guess of the circle.
mod search;
/// A step towards laying one face on the other.
mod step;
/// Maria and craters of one photograph on the other.
mod surface;
/// The Moon's face as a square of relative brightness.
mod texture;

pub use frame::{Frame, MoonError};
pub use limb::{Limb, Shape};
pub use pair::{Measured, Pair, PairError, Which};
