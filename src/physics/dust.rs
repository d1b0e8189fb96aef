//! Dust lit by stars: volumes of dust, what one grain does to light, and the light that reaches an eye.
//!
//! ```text
//! volume + stars -> star light in the dust -> light scattered towards the eye -> picture (+ error, + time)
//! ```

/// What is behind a nebula.
pub mod backdrop;
/// The least and the most dust in each small cube of a volume.
pub mod bricks;
/// Where an eye stands, and the ray of each of its pixels.
pub mod camera;
/// From linear light to the 8 bits of a display.
pub mod develop;
/// A nebula made ready to be drawn, with its model of scattering.
pub mod drawing;
/// The renderer to fly with.
pub mod fast;
/// Columns of dust between two points, and from the stars.
pub mod light;
/// The light that a ray gathers.
pub mod march;
/// What a model of scattering tells the renderer.
pub mod model;
/// Light that has been scattered more than once.
pub mod multiple;
/// The way of an eye through a scene.
pub mod path;
/// The law by which a grain turns light aside.
pub mod phase;
/// Pictures, with the error they are believed to have.
pub mod render;
/// Dust, bands and stars: what is lit and by what.
pub mod scene;
/// Exact single scattering.
pub mod single;
/// A sphere of even dust, and photons followed through it.
pub mod sphere;
/// Stars' colours by their temperatures.
pub mod starlight;
/// The scattering table of the thesis.
pub mod table;
/// Dust on a grid of voxels.
pub mod volume;
/// Scattering as the thesis has it: each voxel by the table.
pub mod voxelwise;
