//! Light that has been scattered more than once: for every cell of the dust, the light that arrives there after one scattering or more and
//! is scattered again, in every direction and for no viewpoint in particular.
//!
//! ```text
//! photons from the stars -> flights between scatterings -> sums of light x length x Y_lm in each cell -> source J_lm of the next scattering
//! ```
//!
//! A picture adds it to exact single scattering, which holds what these functions of low order cannot: needles of light near a star.

use glam::DVec3;
use rayon::prelude::*;

use self::cells::{Cells, Sides};
use self::harmonics::Harmonics;
use self::walk::{From, Grains, LANES, Part, Source};
use super::scene::{Dust, Scene, Star};
use super::volume::Volume;

mod cells;
/// The gathered light, looked up.
pub mod field;
/// Functions on the sphere.
pub mod harmonics;
mod walk;

pub use field::Field;

/// How the light is gathered.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Highest order of the spherical harmonics, 0 to [`harmonics::HIGHEST`].
    pub order: usize,
    /// Cells along the longest edge of the box, 1 to [`MOST_CELLS`].
    pub cells: usize,
    /// Most flights of photons between two places, for each four bands: the cost, whatever the scene.
    pub flights: u64,
    /// End before, when the noise of a column of cells is no more than this share of its light.
    pub noise: f64,
    /// A walk is cut after this many scatterings; what it still carries is told.
    pub longest_walk: u32,
    /// Where the random numbers begin.
    pub seed: u64,
}

/// Most cells along an edge.
pub const MOST_CELLS: usize = 256;

/// Most flights that may be asked for.
pub const MOST_FLIGHTS: u64 = 1 << 40;

impl Settings {
    /// What serves most volumes: order 4, a million flights, and cells as large as two voxels, 16 at least and 32 at most along an edge.
    #[must_use]
    pub fn fitting(volume: &Volume) -> Settings {
        let longest = volume.size().into_iter().max().unwrap_or(1);
        let cells = (longest / 2).clamp(16, 32);
        Settings { order: 4, cells, flights: 1_000_000, noise: 0.0, longest_walk: 10_000, seed: 1 }
    }
}

/// Why no light was gathered.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MultipleError {
    /// An order that is not there.
    #[error("spherical harmonics of order {0}: 0 to 8 are there")]
    Order(usize),
    /// No cells, or too many.
    #[error("{0} cells along the longest edge: 1 to 256 are possible")]
    Cells(usize),
    /// No flights, or too many.
    #[error("{0} flights of photons: at least 1, and fewer than 2^40")]
    Flights(u64),
    /// A noise that is none.
    #[error("a noise of {0}: it is a share of the light, 0 (all flights are done) or more")]
    Noise(f64),
    /// No scatterings.
    #[error("walks cut after 0 scatterings: at least 1, or nothing is scattered twice")]
    Walk,
    /// Tallies beyond any memory.
    #[error("{0} MiB for one tally: ask for fewer cells, a lower order or fewer orders of scattering")]
    Memory(u64),
}

/// Most memory of one tally.
const MOST_BYTES: usize = 1 << 30;

/// Memory that all tallies together may take where there are more than [`FEWEST_PARTS`].
const ENOUGH_BYTES: usize = 1 << 28;

/// Parts of the photons: enough to see from their differences how noisy they are.
const FEWEST_PARTS: usize = 4;

/// More parts than this gain nothing.
const MOST_PARTS: usize = 16;

/// Rounds after which the noise is looked at double from this share of all flights.
const FIRST_ROUND: u64 = 16;

/// Gathers what the stars' light becomes after one scattering and more.
///
/// # Errors
/// Settings that cannot be, with what may be.
pub fn gather(volume: &Volume, scene: &Scene, settings: &Settings) -> Result<Field, MultipleError> {
    let mut fields = gather_by_order(volume, scene, settings, 1)?;
    fields.pop().ok_or(MultipleError::Walk)
}

/// The same for each order of scattering by itself: second, third and so on, `orders` of them, the last with all that follow.
///
/// # Errors
/// Settings that cannot be, with what may be.
pub fn gather_by_order(
    volume: &Volume,
    scene: &Scene,
    settings: &Settings,
    orders: usize,
) -> Result<Vec<Field>, MultipleError> {
    let cells = Cells::of(volume, checked(settings)?.cells, Sides::Open);
    let groups = scene.dust().extinction.len().div_ceil(LANES);
    let sources: Vec<Vec<Source>> =
        (0..groups).map(|group| scene.stars().iter().map(|star| point(star, volume, group)).collect()).collect();
    gather_from(&cells, scene.dust(), &sources, settings, orders)
}

/// The same for a slab: the volume repeated without end along x and y, lit from above (down the z axis) with an irradiance of 1.
///
/// # Errors
/// Settings that cannot be, with what may be.
pub fn gather_slab(volume: &Volume, dust: &Dust, settings: &Settings) -> Result<Field, MultipleError> {
    let cells = Cells::of(volume, checked(settings)?.cells, Sides::Periodic);
    let face = volume.edges().x * volume.edges().y;
    let bands = dust.extinction.len();
    let sources: Vec<Vec<Source>> = (0..bands.div_ceil(LANES))
        .map(|group| {
            let power = lanes(group, |band| if band < bands { face } else { 0.0 });
            vec![Source { from: From::Above, power }]
        })
        .collect();
    let mut fields = gather_from(&cells, dust, &sources, settings, 1)?;
    fields.pop().ok_or(MultipleError::Walk)
}

fn checked(settings: &Settings) -> Result<&Settings, MultipleError> {
    if settings.order > harmonics::HIGHEST {
        return Err(MultipleError::Order(settings.order));
    }
    if !(1..=MOST_CELLS).contains(&settings.cells) {
        return Err(MultipleError::Cells(settings.cells));
    }
    if !(1..MOST_FLIGHTS).contains(&settings.flights) {
        return Err(MultipleError::Flights(settings.flights));
    }
    if !(settings.noise.is_finite() && settings.noise >= 0.0) {
        return Err(MultipleError::Noise(settings.noise));
    }
    if settings.longest_walk == 0 {
        return Err(MultipleError::Walk);
    }
    Ok(settings)
}

/// A number for each band of a group.
fn lanes(group: usize, of: impl Fn(usize) -> f64) -> [f64; LANES] {
    std::array::from_fn(|lane| of(group * LANES + lane))
}

/// A star as a source: from outside the box, only the cone that holds it is lit.
fn point(star: &Star, volume: &Volume, group: usize) -> Source {
    let radius = 0.5 * volume.edges().length();
    let distance = star.position.length();
    let inside = (star.position.abs().cmple(volume.edges() * 0.5)).all();
    let (axis, cosine) = match (-star.position).try_normalize() {
        Some(axis) if !inside && distance > radius => (axis, (1.0 - (radius / distance).powi(2)).sqrt()),
        _ => (DVec3::Z, -1.0),
    };
    // Written so that it keeps its digits for a star far away.
    let cap = if cosine < 0.0 { 2.0 } else { (radius / distance).powi(2) / (1.0 + cosine) };
    let solid_angle = std::f64::consts::TAU * cap;
    let power = lanes(group, |band| star.intensity.get(band).map_or(0.0, |intensity| intensity * solid_angle));
    Source { from: From::Point { position: star.position, axis, cap }, power }
}

fn gather_from(
    cells: &Cells,
    dust: &Dust,
    sources: &[Vec<Source>],
    settings: &Settings,
    orders: usize,
) -> Result<Vec<Field>, MultipleError> {
    let orders = orders.max(1);
    let harmonics = Harmonics::new(settings.order);
    let bytes = cells.used.saturating_mul(orders * harmonics.count() * LANES * size_of::<f32>());
    if bytes > MOST_BYTES {
        return Err(MultipleError::Memory((bytes >> 20) as u64));
    }
    let count = (ENOUGH_BYTES / bytes.max(1)).clamp(FEWEST_PARTS, MOST_PARTS);
    let bands = dust.extinction.len();
    let mut fields: Vec<Field> = (0..orders).map(|_| Field::empty(cells, harmonics.clone(), bands)).collect();
    for (group, sources) in sources.iter().enumerate() {
        // Within a walk the bands count alike, however bright the stars are in each.
        let light = lanes(0, |lane| sources.iter().map(|source| source.power[lane]).sum());
        let shares: Vec<Source> = sources
            .iter()
            .map(|source| {
                let power = lanes(0, |lane| if light[lane] > 0.0 { source.power[lane] / light[lane] } else { 0.0 });
                Source { power, ..*source }
            })
            .filter(|source| source.power.iter().any(|power| *power > 0.0))
            .collect();
        if shares.is_empty() || cells.used == 0 || dust.albedo <= 0.0 {
            continue;
        }
        let grains = Grains {
            extinction: lanes(group, |band| dust.extinction.get(band).copied().unwrap_or(0.0)),
            albedo: dust.albedo,
            phase: dust.phase,
        };
        let mut parts: Vec<Part<'_>> = (0..count as u64)
            .map(|part| {
                let seed = settings.seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ ((group as u64) << 32 | part);
                Part::new(cells, &harmonics, (grains, &shares), (orders, settings.longest_walk), seed)
            })
            .collect();
        let (mut done, mut goal) = (0, settings.flights);
        if settings.noise > 0.0 {
            goal = settings.flights.div_ceil(FIRST_ROUND);
        }
        loop {
            let each = (goal - done).div_ceil(count as u64);
            parts.par_iter_mut().for_each(|part| part.run(each));
            done = goal;
            let noise = if settings.noise > 0.0 { field::noise(cells, &parts, &harmonics, orders) } else { 0.0 };
            if done >= settings.flights || noise <= settings.noise {
                break;
            }
            goal = (2 * goal).min(settings.flights);
        }
        let noise = field::noise(cells, &parts, &harmonics, orders);
        for (order, field) in fields.iter_mut().enumerate() {
            field.add(group, order, &parts, light, dust, noise);
        }
    }
    for field in &mut fields {
        field.finish(cells);
    }
    Ok(fields)
}
