//! The renderer to fly with: full scattering of a nebula many times a second, from any place, and how far each picture is from the truth.
//!
//! ```text
//! once:          columns of dust from the stars, bricks, the light that has scattered more than once
//! each frame:    shade each voxel towards the eye -> cast rays through the shaded cells -> add what the grid cannot hold near stars
//! ```
//!
//! What is the same for many samples is done once for all of them: the phase function once a voxel and star, what is empty once for
//! 8 x 8 rays. The light of a voxel is a source for each unit of extinction, so that a step through dust of any depth is right.

use glam::DVec3;
use rayon::prelude::*;

use super::bricks::Bricks;
use super::camera::Camera;
use super::light::lattice::Lattice;
use super::multiple::Field;
use super::scene::{Scene, Star};
use super::volume::Volume;

/// Roots and exponentials.
mod approximate;
/// Rays through shaded cells.
mod cast;
/// Pictures.
mod frame;
/// Light that has scattered more than once.
mod glow;
/// The grid and its margin.
mod grid;
/// Numbers of 16 bits.
mod half;
/// The kernel.
mod march;
/// The light close to a star.
mod near;
/// Where dust is.
mod occupancy;
/// The same rays in finer steps with nothing from the grid, in a few pixels.
mod probe;
/// How much is done.
mod quality;
/// The light of each voxel towards the eye.
mod shade;
/// Pixels between rays.
mod spread;
/// How long steps can be.
mod steps;

pub use cast::Work;
pub use frame::{Believed, Frame};
pub use quality::{FastError, Quality};

use self::cast::Times;
use self::cast::points::{self, Points};
use self::frame::spread;
use self::glow::Seen;
use self::grid::Grid;
use self::march::{Cell, DENSITY};
use self::near::Surroundings;
use self::near::hood::Hood;
use self::near::tiles;
use self::occupancy::Occupancy;
use self::shade::{BANDS, Lamp, Shading, Towards};
use self::spread::Between;

/// Widest and highest frame, pixels.
pub const LARGEST_FRAME: usize = 8192;

/// A nebula, made ready to fly through.
pub struct Flyer {
    grid: Grid,
    occupancy: Occupancy,
    everywhere: Occupancy,
    density: Vec<f32>,
    lamps: Vec<Lamp>,
    scene: Scene,
    field: Option<Field>,
    /// Radiance of 1 in the flyer's numbers.
    scale: f64,
    cells: Vec<Cell>,
    times: Times,
    /// How the cells were shaded last: they serve again for the same eye.
    shaded: Option<(Towards, bool, f32)>,
    /// The glow as it was seen then.
    seen: Seen,
}

impl Flyer {
    /// Makes a nebula ready: columns of dust from its stars, its bricks. `field` is the light that has scattered more than once.
    ///
    /// # Errors
    /// More than three bands.
    pub fn new(volume: &Volume, scene: &Scene, field: Option<Field>) -> Result<Flyer, FastError> {
        let bands = scene.bands();
        if bands > BANDS {
            return Err(FastError::Bands(bands));
        }
        let grid = Grid::new(volume);
        let bricks = Bricks::of(volume);
        let brightest = scene.stars().iter().flat_map(|star| &star.intensity).fold(0.0f64, |a, b| a.max(*b));
        let brightest = if brightest > 0.0 { brightest } else { 1.0 };
        // Radiance is intensity over a length squared.
        let scale = brightest / (grid.unit * grid.unit);
        let negligible = negligible(scene, &grid);
        let density = grid.pad(volume.density());
        let most = density.iter().fold(0.0f32, |a, b| a.max(*b));
        let times = Times { light: 1.0, density: half::power_of_two(most) };
        let mut flyer = Flyer {
            occupancy: Occupancy::new(&grid, &bricks, negligible),
            everywhere: Occupancy::new(&grid, &bricks, -1.0),
            cells: density
                .iter()
                .map(|density| Cell::from(half::half(density * times.density)) << DENSITY.trailing_zeros())
                .collect(),
            times,
            density,
            lamps: Vec::new(),
            scene: scene.clone(),
            seen: field.as_ref().map(|field| Seen::of(field, &grid)).unwrap_or_default(),
            field,
            scale,
            grid,
            shaded: None,
        };
        flyer.light(volume, brightest);
        Ok(flyer)
    }

    /// Changes the dust's grains or the stars while flying. Stars that stay where they are keep their columns; another depth, albedo, law or
    /// brightness costs no more than a frame. The light that has scattered more than once stays as it was until [`Flyer::glow`].
    ///
    /// # Errors
    /// More than three bands.
    pub fn change(&mut self, volume: &Volume, scene: &Scene) -> Result<(), FastError> {
        let places = |scene: &Scene| scene.stars().iter().map(|star| star.position).collect::<Vec<_>>();
        if places(scene) != places(&self.scene) {
            let field = self.field.take();
            *self = Flyer::new(volume, scene, field)?;
            return Ok(());
        }
        if scene.bands() > BANDS {
            return Err(FastError::Bands(scene.bands()));
        }
        let brightest = self.scale * self.grid.unit * self.grid.unit;
        for (lamp, star) in self.lamps.iter_mut().zip(scene.stars()) {
            lamp.power = power(scene, star, brightest);
        }
        if scene.dust().extinction != self.scene.dust().extinction {
            let negligible = negligible(scene, &self.grid);
            self.occupancy = Occupancy::new(&self.grid, &Bricks::of(volume), negligible);
        }
        self.scene = scene.clone();
        self.shaded = None;
        Ok(())
    }

    /// Takes the light that has scattered more than once.
    pub fn glow(&mut self, field: Field) {
        self.seen = Seen::of(&field, &self.grid);
        self.field = Some(field);
        self.shaded = None;
    }

    /// The scene that is seen.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Columns from the stars to each voxel.
    fn light(&mut self, volume: &Volume, brightest: f64) {
        let (nx, ny) = (volume.size()[0], volume.size()[1]);
        let spacings = volume.size().into_iter().max().unwrap_or(1).min(FINEST_LATTICE);
        let lattice = Lattice::new(volume, self.scene.stars(), spacings, &mut |_| {});
        for (index, star) in self.scene.stars().iter().enumerate() {
            let mut columns = vec![0.0f32; volume.density().len()];
            columns.par_chunks_mut(nx).enumerate().for_each(|(row, out)| {
                for (x, column) in out.iter_mut().enumerate() {
                    let place = volume.centre(x, row % ny, row / ny);
                    *column = (lattice.column(volume, index, place) / self.grid.unit) as f32;
                }
            });
            let power = power(&self.scene, star, brightest);
            let position = star.position / self.grid.unit;
            let hood = Hood::new(&self.grid, &self.density, position);
            self.lamps.push(Lamp { position, power, columns: self.grid.pad(&columns), hood });
        }
    }

    /// Sees the nebula.
    ///
    /// # Errors
    /// A size or a quality that cannot be.
    pub fn frame(
        &mut self,
        camera: &Camera,
        width: usize,
        height: usize,
        quality: &Quality,
    ) -> Result<Frame, FastError> {
        quality.check()?;
        if !(1..=LARGEST_FRAME).contains(&width) || !(1..=LARGEST_FRAME).contains(&height) {
            return Err(FastError::Size(width, height));
        }
        let towards = match camera.parallel() {
            Some(direction) => Towards::Far(single(-direction)),
            None => Towards::Eye(single(camera.eye() / self.grid.unit)),
        };
        let brightest = self.shade(towards, quality.skip);
        let coarse = quality.coarse.clamp(1, 8);
        let refine = coarse == 2 && quality.refine > 0.0;
        let count = (width.div_ceil(coarse), height.div_ceil(coarse));
        let first = if refine { 0.5 } else { coarse as f64 / 2.0 };
        let mut pixels = vec![[0.0; BANDS]; count.0 * count.1];
        let mut through = vec![[1.0; BANDS]; count.0 * count.1];
        let surroundings = self.surroundings();
        let mut casting = cast::Casting {
            grid: &self.grid,
            occupancy: if quality.skip { &self.occupancy } else { &self.everywhere },
            cells: &self.cells,
            times: self.times,
            lamps: &self.lamps,
            surroundings: &surroundings,
            step: quality.step,
            opaque: quality.opaque as f32,
            middle: points::middle(&self.grid, camera, (width, height)),
        };
        let points = Points { picture: (width, height), count, apart: coarse, first, wanted: None };
        let mut work = cast::cast(&casting, camera, points, &mut pixels, &mut through);
        // Behind dense dust everything is dark: what was ended early may outshine what is seen. Then rays go on, to a bound.
        let seen = pixels.iter().flatten().fold(0.0f32, |a, b| a.max(*b));
        if quality.opaque <= FINE_OPAQUE && work.hidden * brightest > UNSEEN * seen {
            casting.opaque = (UNSEEN * seen / brightest).min(casting.opaque);
            pixels.fill([0.0; BANDS]);
            through.fill([1.0; BANDS]);
            work = cast::cast(&casting, camera, points, &mut pixels, &mut through);
        }
        let mut all = points;
        let wanted;
        if refine {
            let typical = pixels.iter().flatten().sum::<f32>() / (3 * pixels.len()) as f32;
            let share = quality.refine as f32;
            let between = |points| Between { points, count };
            let mut picture;
            (picture, wanted) = between(&pixels).picture(width, height, share, typical);
            let (mut clear, _) = between(&through).picture(width, height, share, 1.0);
            all = Points { count: (width, height), apart: 1, wanted: Some(&wanted), ..points };
            work = work.with(cast::cast(&casting, camera, all, &mut picture, &mut clear));
            (pixels, through) = (picture, clear);
        }
        tiles::add_near(&casting, camera, all, &mut pixels);
        let cast_size = if refine { (width, height) } else { count };
        let scale = self.scale as f32;
        pixels.iter_mut().for_each(|pixel| *pixel = pixel.map(|value| value * scale));
        let passed_over = if quality.skip {
            self.occupancy.passed_over() * self.strongest() * self.grid.diagonal() as f32
        } else {
            0.0
        };
        let left_out = (work.hidden + passed_over) * brightest * scale;
        let mut frame =
            Frame { width: cast_size.0, height: cast_size.1, pixels, through, left_out, believed: None, work };
        if coarse > 1 && !refine {
            frame = spread(&frame, width, height, coarse);
        }
        if quality.probes > 0 {
            let probing = probe::Probing {
                grid: &self.grid,
                lamps: &self.lamps,
                surroundings: &surroundings,
                field: self.field.as_ref(),
                step: FINE * quality.step.min(1.0) / self.grid.per_length().max_element(),
                scale,
            };
            frame.believed = Some(probe::believed(&probing, camera, &frame, quality.probes));
        }
        Ok(frame)
    }

    fn strongest(&self) -> f32 {
        self.extinction().into_iter().fold(0.0, f32::max)
    }

    /// Extinction per unit of the grid's length and density.
    fn extinction(&self) -> [f32; BANDS] {
        let mut all = [0.0; BANDS];
        for (k, extinction) in all.iter_mut().zip(&self.scene.dust().extinction) {
            *k = (extinction * self.grid.unit) as f32;
        }
        all
    }

    fn surroundings(&self) -> Surroundings<'_> {
        Surroundings {
            grid: &self.grid,
            density: &self.density,
            phase: self.scene.dust().phase,
            extinction: self.extinction(),
        }
    }

    /// Shades the cells unless they serve still. Gives the most light of any.
    fn shade(&mut self, towards: Towards, skip: bool) -> f32 {
        if let Some((before, skipped, brightest)) = self.shaded
            && before == towards
            && skipped == skip
        {
            return brightest;
        }
        if let Some(field) = &self.field {
            self.seen.look(field, &self.grid, towards, (1.0 / self.scale) as f32);
        }
        let mut brightest = self.shaded_at(self.times.light, towards, skip);
        // The light was brought into the range of the cells' numbers as in the frame before, which is nearly always right.
        if brightest > 0.0 && !DIGITS.contains(&(brightest * self.times.light)) {
            self.times.light = half::power_of_two(brightest);
            brightest = self.shaded_at(self.times.light, towards, skip);
        }
        self.shaded = Some((towards, skip, brightest));
        brightest
    }

    fn shaded_at(&mut self, times: f32, towards: Towards, skip: bool) -> f32 {
        let shading = Shading {
            grid: &self.grid,
            occupancy: if skip { &self.occupancy } else { &self.everywhere },
            lamps: &self.lamps,
            asymmetry: self.scene.dust().phase.asymmetry() as f32,
            extinction: self.extinction(),
            towards,
            seen: self.field.as_ref().map(|_| &self.seen),
            times,
        };
        shade::shade(&shading, &mut self.cells)
    }
}

/// What a star's light is multiplied by, in the flyer's numbers.
fn power(scene: &Scene, star: &Star, brightest: f64) -> [f32; BANDS] {
    let mut power = [0.0; BANDS];
    for (power, intensity) in power.iter_mut().zip(&star.intensity) {
        *power = (scene.dust().albedo * intensity / brightest) as f32;
    }
    power
}

/// The density below which a brick is passed over.
fn negligible(scene: &Scene, grid: &Grid) -> f32 {
    let strongest = scene.dust().extinction.iter().fold(0.0f64, |a, b| a.max(*b)) * grid.unit;
    (NEGLIGIBLE / (strongest * grid.diagonal()).max(1e-30)) as f32
}

/// Dust of less optical depth than this along the longest way through the box is passed over.
const NEGLIGIBLE: f64 = 1e-4;

/// The brightest cell in numbers of 16 bits: above, it does not fit; below, the dimmer ones lose digits.
const DIGITS: std::ops::RangeInclusive<f32> = 64.0..=half::MOST;

/// Rays that end where less than this comes through are held to [`UNSEEN`].
const FINE_OPAQUE: f64 = 1.0 / 1024.0;

/// The share of the brightest pixel that a ray ended early may lack.
const UNSEEN: f32 = 1.0 / 600.0;

/// Steps of a probe, as shares of the frame's.
const FINE: f64 = 0.25;

/// Most spacings of the lattice of columns.
const FINEST_LATTICE: usize = 64;

fn single(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}
