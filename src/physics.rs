//! What nature does: the bending of light by air.

/// Mean refraction by the air, and its inverse.
pub mod refraction;
