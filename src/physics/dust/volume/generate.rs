//! Nebulae out of nothing: noise held in a shape, swept clean around the stars (thesis, section 5.6).

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::DVec3;
use rayon::prelude::*;

use super::noise::Noise;
use super::{Volume, VolumeError};
use crate::numerics::streams::Stream;

/// Most octaves of noise.
pub const MOST_OCTAVES: usize = 16;
/// Most clumps, and most places swept clean.
pub const MOST_CLUMPS: usize = 1000;
/// Voxels of a block that is judged before it is filled.
const BLOCK: usize = 8;

/// One layer of noise: so many features across the box, so strong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Octave {
    /// Features across the box.
    pub frequency: f64,
    /// How much density it adds and takes.
    pub amplitude: f64,
}

/// What a nebula is made by. Lengths are in half edges of the box: 1 is the middle of a face.
///
/// ```text
/// density(p) = sweep(p) * (edge(r) * max(0, level + sum_i a_i noise_i(f_i p) - decline (r/R)^2) + clumps(p))
/// ```
///
/// `r` is the distance from the centre, R the outer radius, `edge` falls smoothly to 0 over the outer tenth before R, `sweep` rises
/// smoothly from 0 to 1 between a star's cavity and its wall. The recipe knows nothing of voxels: a finer grid samples the same
/// nebula, and only shows octaves that a coarser one cannot hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// Seed of everything that is random.
    pub seed: u64,
    /// The noise.
    pub octaves: Vec<Octave>,
    /// Density of the smooth part.
    pub level: f64,
    /// How much less of it there is at the outer radius: above 0 the outline is ragged, as the noise has it.
    pub decline: f64,
    /// Nothing beyond this.
    pub outer_radius: f64,
    /// Places of the stars that have swept a cavity.
    pub swept: Vec<DVec3>,
    /// Radius of the cavity around each.
    pub cavity_radius: f64,
    /// Thickness of the cavity's wall, in which the density rises.
    pub cavity_wall: f64,
    /// Number of round dense clumps, strewn evenly over the ball.
    pub clumps: usize,
    /// Radius of a clump.
    pub clump_radius: f64,
    /// Density in a clump's middle.
    pub clump_density: f64,
}

impl Default for Recipe {
    fn default() -> Recipe {
        Recipe {
            seed: 1,
            octaves: octaves(6, 3.0, 2.0, 1.0, 0.55),
            level: 0.35,
            decline: 0.5,
            outer_radius: 0.95,
            swept: vec![DVec3::ZERO],
            cavity_radius: 0.12,
            cavity_wall: 0.25,
            clumps: 0,
            clump_radius: 0.1,
            clump_density: 4.0,
        }
    }
}

/// Octaves in geometric steps: frequency, times `lacunarity` each; amplitude, times `persistence` each.
#[must_use]
pub fn octaves(count: usize, frequency: f64, lacunarity: f64, amplitude: f64, persistence: f64) -> Vec<Octave> {
    let step = |i: usize| i as i32;
    (0..count.min(MOST_OCTAVES))
        .map(|i| Octave {
            frequency: frequency * lacunarity.powi(step(i)),
            amplitude: amplitude * persistence.powi(step(i)),
        })
        .collect()
}

/// A recipe that makes no nebula.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RecipeError {
    /// A number out of its range.
    #[error("{what} is {value}: {wanted}")]
    Number {
        /// Which.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        wanted: &'static str,
    },
    /// The grid cannot be.
    #[error(transparent)]
    Volume(#[from] VolumeError),
}

impl Recipe {
    fn check(&self) -> Result<(), RecipeError> {
        let number = |what, value: f64, good: bool, wanted| {
            if good { Ok(()) } else { Err(RecipeError::Number { what, value, wanted }) }
        };
        let upwards =
            |what, value: f64| number(what, value, value.is_finite() && value >= 0.0, "give a number of 0 or more");
        let count = self.octaves.len();
        number("the number of octaves", count as f64, count <= MOST_OCTAVES, "give 0 to 16")?;
        for octave in &self.octaves {
            let frequency = octave.frequency;
            number(
                "a frequency",
                frequency,
                (0.0..=256.0).contains(&frequency),
                "give 0 to 256 features across the box",
            )?;
            number("an amplitude", octave.amplitude, octave.amplitude.abs() <= 1e6, "give -1e6 to 1e6")?;
        }
        number("the level", self.level, self.level.abs() <= 1e6, "give -1e6 to 1e6")?;
        upwards("the decline", self.decline)?;
        upwards("the cavity's radius", self.cavity_radius)?;
        upwards("the cavity's wall", self.cavity_wall)?;
        upwards("a clump's radius", self.clump_radius)?;
        upwards("a clump's density", self.clump_density)?;
        let outer = self.outer_radius;
        number("the outer radius", outer, outer > 0.0 && outer <= 4.0, "give more than 0 and at most 4 half edges")?;
        number("the number of clumps", self.clumps as f64, self.clumps <= MOST_CLUMPS, "give 0 to 1000")?;
        number("the number of stars", self.swept.len() as f64, self.swept.len() <= MOST_CLUMPS, "give 0 to 1000")?;
        match self.swept.iter().find(|place| !place.is_finite()) {
            Some(place) => number("a star's place", place.x + place.y + place.z, false, "give three numbers"),
            None => Ok(()),
        }
    }

    /// Makes the nebula on a grid. Blocks that can hold nothing are never filled; `tell` hears the share that is done.
    /// In parallel, the same for any number of threads.
    ///
    /// # Errors
    /// Numbers that make no nebula, or no grid.
    pub fn generate(&self, size: [usize; 3], edges: DVec3, tell: &(dyn Fn(f64) + Sync)) -> Result<Volume, RecipeError> {
        self.check()?;
        let voxels = Volume::voxels(size, edges)?;
        let nebula = Nebula::new(self, size, edges);
        // Fresh zeros cost no memory until they are written to.
        let mut density = vec![0.0f32; voxels];
        let done = AtomicUsize::new(0);
        let slabs = size[2].div_ceil(BLOCK);
        density.par_chunks_mut(size[0] * size[1] * BLOCK).enumerate().for_each(|(slab, values)| {
            nebula.fill(slab * BLOCK, values);
            tell((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / slabs as f64);
        });
        Ok(Volume::new(size, edges, density)?)
    }
}

/// A recipe on its grid, everything drawn that is random.
struct Nebula<'a> {
    recipe: &'a Recipe,
    size: [usize; 3],
    /// Edges of the box, in halves of the longest.
    edges: DVec3,
    noise: Noise,
    /// Each octave that the grid can hold, with its place in the noise.
    octaves: Vec<(Octave, DVec3)>,
    clumps: Vec<DVec3>,
    /// The most that noise can add.
    most: f64,
}

impl Nebula<'_> {
    fn new(recipe: &Recipe, size: [usize; 3], edges: DVec3) -> Nebula<'_> {
        let mut stream = Stream::seeded(recipe.seed);
        let noise = Noise::seeded(&mut stream);
        let mut vector = |scale: f64| DVec3::new(stream.uniform(), stream.uniform(), stream.uniform()) * scale;
        let longest = edges.max_element();
        // Voxels along the longest edge, if all were as long as the longest is.
        let sides = DVec3::new(size[0] as f64, size[1] as f64, size[2] as f64);
        let across = (sides / edges).min_element() * longest;
        let octaves: Vec<_> = (recipe.octaves.iter())
            .map(|octave| {
                // Whole up to 4 voxels a feature, gone at 2: a grid cannot hold finer ones.
                let held = (2.0 - 4.0 * octave.frequency / across).clamp(0.0, 1.0);
                (Octave { amplitude: octave.amplitude * held, ..*octave }, vector(256.0))
            })
            .filter(|(octave, _)| octave.amplitude != 0.0)
            .collect();
        // Even in the ball: what falls outside is drawn again.
        let radius = recipe.outer_radius;
        let clump = |_| loop {
            let place = vector(2.0) - 1.0;
            if place.length() <= 1.0 {
                return place * radius;
            }
        };
        let clumps = (0..recipe.clumps).map(clump).collect();
        let most = octaves.iter().map(|(octave, _)| octave.amplitude.abs()).sum();
        Nebula { recipe, size, edges: edges * (2.0 / longest), noise, octaves, clumps, most }
    }

    fn place(&self, x: usize, y: usize, z: usize) -> DVec3 {
        let sides = DVec3::new(self.size[0] as f64, self.size[1] as f64, self.size[2] as f64);
        self.edges * ((DVec3::new(x as f64, y as f64, z as f64) + 0.5) / sides - 0.5)
    }

    /// Fills a slab of planes that begins at a z.
    fn fill(&self, begin: usize, values: &mut [f32]) {
        let [width, height, _] = self.size;
        let planes = values.len() / (width * height);
        for y in (0..height).step_by(BLOCK) {
            for x in (0..width).step_by(BLOCK) {
                let (right, below) = ((x + BLOCK).min(width), (y + BLOCK).min(height));
                let low = self.place(x, y, begin);
                let high = self.place(right - 1, below - 1, begin + planes - 1);
                let clumps: Vec<DVec3> = self
                    .clumps
                    .iter()
                    .copied()
                    .filter(|c| c.distance(c.clamp(low, high)) < self.recipe.clump_radius)
                    .collect();
                let nearest = DVec3::ZERO.clamp(low, high).length();
                if clumps.is_empty() && self.smooth(nearest) + self.most <= 0.0 {
                    continue;
                }
                for plane in 0..planes {
                    for row in y..below {
                        for column in x..right {
                            let density = self.density(self.place(column, row, begin + plane), &clumps);
                            // Written only where there is something, so that empty pages stay free.
                            if density > 0.0 {
                                values[(plane * height + row) * width + column] = density as f32;
                            }
                        }
                    }
                }
            }
        }
    }

    /// The density without noise at a distance from the centre; as low as can be outside.
    fn smooth(&self, r: f64) -> f64 {
        let share = r / self.recipe.outer_radius;
        if share >= 1.0 { f64::NEG_INFINITY } else { self.recipe.level - self.recipe.decline * share * share }
    }

    fn density(&self, place: DVec3, clumps: &[DVec3]) -> f64 {
        let recipe = self.recipe;
        let sweep: f64 = recipe
            .swept
            .iter()
            .map(|star| rise(recipe.cavity_radius, recipe.cavity_radius + recipe.cavity_wall, star.distance(place)))
            .product();
        if sweep == 0.0 {
            return 0.0;
        }
        let clumped: f64 = clumps
            .iter()
            .map(|centre| (1.0 - centre.distance_squared(place) / recipe.clump_radius.powi(2)).max(0.0).powi(2))
            .sum();
        let r = place.length();
        let mut cloud = self.smooth(r);
        if cloud + self.most > 0.0 {
            for (octave, offset) in &self.octaves {
                cloud += octave.amplitude * self.noise.at(place * (0.5 * octave.frequency) + *offset);
            }
        }
        let edge = 1.0 - rise(0.9 * recipe.outer_radius, recipe.outer_radius, r);
        sweep * (edge * cloud.max(0.0) + recipe.clump_density * clumped)
    }
}

/// Smoothly from 0 at one place to 1 at another: 3 t^2 - 2 t^3; a step where they are one.
pub(super) fn rise(from: f64, to: f64, at: f64) -> f64 {
    if at <= from {
        return 0.0;
    }
    let t = ((at - from) / (to - from)).min(1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(recipe: &Recipe, side: usize) -> Volume {
        recipe.generate([side; 3], DVec3::splat(2.0), &|_| ()).unwrap()
    }

    #[test]
    fn one_seed_gives_one_nebula_on_any_number_of_threads() {
        let recipe = Recipe { clumps: 5, ..Recipe::default() };
        let on = |threads| {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| made(&recipe, 24))
        };
        assert_eq!(on(1), on(3));
        assert_ne!(on(1), made(&Recipe { seed: 2, ..recipe.clone() }, 24));
    }

    #[test]
    fn without_noise_the_density_is_the_formula() {
        let recipe = Recipe {
            octaves: Vec::new(),
            level: 2.0,
            decline: 1.0,
            cavity_radius: 0.25,
            cavity_wall: 0.25,
            outer_radius: 1.0,
            ..Recipe::default()
        };
        let volume = made(&recipe, 16);
        // Centres along x in the middle rows: r^2 = x^2 + 2/256.
        for x in 8..16 {
            let r = volume.centre(x, 8, 8).length();
            let t = ((r - 0.25) / 0.25).clamp(0.0, 1.0);
            let u = ((r - 0.9) / 0.1).clamp(0.0, 1.0);
            let expected = t * t * (3.0 - 2.0 * t) * (1.0 - u * u * (3.0 - 2.0 * u)) * (2.0 - r * r);
            assert!((f64::from(volume.density()[(8 * 16 + 8) * 16 + x]) - expected).abs() < 1e-6, "{x}");
        }
    }

    #[test]
    fn the_cavity_of_every_star_is_empty_and_so_is_all_beyond_the_outer_radius() {
        let stars = vec![DVec3::new(0.4, 0.0, 0.0), DVec3::new(-0.4, 0.2, 0.1)];
        let recipe = Recipe {
            swept: stars.clone(),
            level: 3.0,
            clumps: 20,
            outer_radius: 0.7,
            clump_radius: 0.05,
            ..Recipe::default()
        };
        let volume = made(&recipe, 32);
        let mut filled = 0;
        for (index, density) in volume.density().iter().enumerate() {
            let place = volume.centre(index % 32, index / 32 % 32, index / 1024);
            let swept = stars.iter().any(|star| star.distance(place) <= 0.12);
            assert!(*density == 0.0 || !(swept || place.length() > 0.76), "{place}");
            filled += usize::from(*density > 0.0);
        }
        // The ball of 0.7 fills 18 % of the box.
        assert!((5000..6500).contains(&filled), "{filled}");
    }

    #[test]
    fn blocks_passed_over_are_those_that_are_empty() {
        // A ragged outline and clumps beyond it, against every voxel asked alone.
        let recipe = Recipe { level: -0.2, decline: 1.0, clumps: 6, ..Recipe::default() };
        let volume = made(&recipe, 40);
        let nebula = Nebula::new(&recipe, [40; 3], DVec3::splat(2.0));
        for (index, density) in volume.density().iter().enumerate() {
            let place = volume.centre(index % 40, index / 40 % 40, index / 1600);
            assert_eq!(nebula.density(place, &nebula.clumps).max(0.0) as f32, *density, "{place}");
        }
    }

    #[test]
    fn a_finer_grid_samples_the_same_nebula() {
        let recipe = Recipe { octaves: octaves(2, 2.0, 2.0, 1.0, 0.5), ..Recipe::default() };
        let (coarse, fine) = (made(&recipe, 20), made(&recipe, 60));
        for (index, density) in coarse.density().iter().enumerate() {
            let [x, y, z] = [index % 20, index / 20 % 20, index / 400].map(|i| 3 * i + 1);
            assert!((density - fine.density()[(z * 60 + y) * 60 + x]).abs() < 1e-6);
        }
    }

    #[test]
    fn numbers_that_make_no_nebula_are_named() {
        let told = |recipe: Recipe| recipe.generate([4; 3], DVec3::ONE, &|_| ()).unwrap_err().to_string();
        let usual = Recipe::default;
        assert!(told(Recipe { cavity_radius: f64::NAN, ..usual() }).contains("cavity"));
        assert!(told(Recipe { outer_radius: 0.0, ..usual() }).contains("outer radius is 0"));
        assert!(told(Recipe { octaves: octaves(3, 300.0, 1.0, 1.0, 1.0), ..usual() }).contains("frequency is 300"));
        assert!(told(Recipe { swept: vec![DVec3::NAN], ..usual() }).contains("star"));
        let wide = usual().generate([2000, 1, 1], DVec3::ONE, &|_| ()).unwrap_err();
        assert!(wide.to_string().contains("2000"), "{wide}");
    }
}
