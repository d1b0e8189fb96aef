//! What nature does: air, its scattering, and the bending of light by it.

/// The air: its refractive index, and what it is like at each height.
pub mod air;
/// Scattering by the molecules of the air.
pub mod rayleigh;
/// How air bends light: mean refraction, and rays traced through layers.
pub mod refraction;
