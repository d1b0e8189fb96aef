//! Dust lit by stars: volumes of dust, what one grain does to light, and the light that reaches an eye.
//!
//! ```text
//! volume + stars -> star light in the dust -> light scattered towards the eye -> picture (+ error, + time)
//! ```

/// The least and the most dust in each small cube of a volume.
pub mod bricks;
/// Where an eye stands, and the ray of each of its pixels.
pub mod camera;
/// From linear light to the 8 bits of a display.
pub mod develop;
/// The renderer to fly with.
pub mod fast;
/// Columns of dust between two points, and from the stars.
pub mod light;
/// What a model of scattering tells the renderer.
pub mod model;
/// Light that has been scattered more than once.
pub mod multiple;
/// The way of an eye through a scene.
pub mod path;
/// The law by which a grain turns light aside.
pub mod phase;
/// Dust, bands and stars: what is lit and by what.
pub mod scene;
/// A sphere of even dust, and photons followed through it.
pub mod sphere;
/// The scattering table of the thesis.
pub mod table;
/// Dust on a grid of voxels.
pub mod volume;
