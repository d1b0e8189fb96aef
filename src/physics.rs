//! What nature does: air, what its molecules and particles do to light, the bending of light by it, the low Sun behind it;
//! dust between the stars.

/// Particles in the air: size distributions, Mie's series, the climates of OPAC.
pub mod aerosol;
/// The air: its refractive index, and what it is like at each height.
pub mod air;
/// From spectra to colours.
pub mod colour;
/// Dust between the stars, lit by them.
pub mod dust;
/// Absorption by ozone.
pub mod ozone;
/// Scattering by the molecules of the air.
pub mod rayleigh;
/// How air bends light: mean refraction, and rays traced through layers.
pub mod refraction;
/// The light of the sky around a low Sun.
pub mod skylight;
/// The low Sun: its light, its limb, and its picture through the air.
pub mod sun;
