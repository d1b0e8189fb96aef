//! The air: its refractive index, and what it is like at each height.

/// The refractive index of moist air.
pub mod ciddor;
/// Atmospheres known by name.
pub mod presets;
/// The air by height.
pub mod profile;
/// Profiles from TOML and CSV.
pub mod read;
/// Rounding the kinks of a profile.
pub mod rounding;
/// The air over warm ground.
pub mod surface_layer;
/// The US Standard Atmosphere 1976.
pub mod us76;
