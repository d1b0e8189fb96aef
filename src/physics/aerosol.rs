//! Particles in the air: what they scatter and absorb, from their sizes and refractive indices.

/// The air of a place, and how it thins out with height.
pub mod climate;
/// What the particles are, how they grow in humid air, and how they refract.
pub mod components;
/// One homogeneous sphere.
pub mod mie;
/// How particles lie over a place, whatever the wavelength.
pub mod shape;
/// Many spheres of one substance.
pub mod sizes;
/// Numbers as printed.
mod tables;
