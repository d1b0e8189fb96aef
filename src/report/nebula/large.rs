//! A generated cloud of 128^3 voxels in three colours with one star: what more photons buy.

use std::time::Duration;

use glam::DVec3;

use super::known::{StudyError, refused, scene};
use super::{WISH, draw};
use crate::physics::dust::multiple::{Settings, gather};
use crate::physics::dust::render::Wish;
use crate::physics::dust::scene::RED_GREEN_BLUE;
use crate::physics::dust::volume::generate::Recipe;

/// Side of the pictures, pixels.
const SIDE: usize = 64;

/// Edge of a block, pixels.
const BLOCK: usize = 8;

/// What so many photons gave.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Run {
    /// Flights asked for.
    pub flights: u64,
    /// Time of gathering, seconds.
    pub ready_s: f64,
    /// Noise of a column of cells, believed.
    pub noise: f64,
    /// Mean difference of a pixel of multiply scattered light from the last run with other photons, as a share of the mean.
    pub pixels: f64,
    /// The same of blocks of 8 x 8 pixels.
    pub blocks: f64,
}

/// Gathers with more and more flights, and with four times the most for a reference.
///
/// # Errors
/// Never.
pub fn runs(clock: &dyn Fn() -> Duration, told: &dyn Fn(&str)) -> Result<Vec<Run>, StudyError> {
    let volume = Recipe::default().generate([128; 3], DVec3::splat(2.0), &|_| {}).map_err(refused)?;
    let scene = scene(RED_GREEN_BLUE.map(|colour| 4.0 * colour).to_vec(), DVec3::ZERO)?;
    let usual = Settings::fitting(&volume);
    let picture = |settings: &Settings| {
        told(&format!("128^3 voxels, three bands: {} flights", settings.flights));
        let begin = clock();
        let field = gather(&volume, &scene, settings).map_err(refused)?;
        let ready_s = (clock() - begin).as_secs_f64();
        let seen = field.along(DVec3::Z);
        let drawn = draw(&volume, &scene, &seen, SIDE, &Wish { tolerance: 1e-2, ..WISH })?;
        Ok((ready_s, field.told().noise, drawn.radiance))
    };
    let mut all = Vec::new();
    for flights in [10_000, 30_000, 100_000, 300_000, 1_000_000] {
        all.push((flights, picture(&Settings { flights, ..usual })?));
    }
    let (_, _, reference) = picture(&Settings { flights: 4_000_000, seed: 2, ..usual })?;
    let run = |(flights, (ready_s, noise, planes)): (u64, (f64, f64, Vec<Vec<f32>>))| Run {
        flights,
        ready_s,
        noise,
        pixels: difference(&planes, &reference, 1),
        blocks: difference(&planes, &reference, BLOCK),
    };
    Ok(all.into_iter().map(run).collect())
}

/// Mean difference of blocks as a share of their mean, of the worst band.
fn difference(planes: &[Vec<f32>], reference: &[Vec<f32>], block: usize) -> f64 {
    let sum = |plane: &[f32], corner: (usize, usize)| {
        let pixels = (0..block * block).map(|i| (corner.0 + i / block) * SIDE + corner.1 + i % block);
        pixels.filter_map(|i| plane.get(i)).map(|value| f64::from(*value)).sum::<f64>()
    };
    let blocks = SIDE / block;
    let band = |(plane, reference): (&Vec<f32>, &Vec<f32>)| {
        let (mut differences, mut light) = (0.0, 0.0);
        for i in 0..blocks * blocks {
            let corner = (i / blocks * block, i % blocks * block);
            let (ours, theirs) = (sum(plane, corner), sum(reference, corner));
            differences += (ours - theirs).abs();
            light += theirs;
        }
        differences / light
    };
    planes.iter().zip(reference).map(band).fold(0.0, f64::max)
}

/// The runs as a table for people.
#[must_use]
pub fn text(runs: &[Run]) -> String {
    let mut text = format!(
        "A generated cloud of 128^3 voxels, three bands, one star: multiply scattered light against four million other flights\n  \
         {:>9} {:>8} {:>10} {:>10} {:>10}\n",
        "flights", "ready s", "believed %", "pixels %", "blocks %"
    );
    for run in runs {
        text += &format!(
            "  {:>9} {:>8.2} {:>10.2} {:>10.2} {:>10.2}\n",
            run.flights,
            run.ready_s,
            100.0 * run.noise,
            100.0 * run.pixels,
            100.0 * run.blocks
        );
    }
    text
}
