//! Light gathered in cells, as the source of the next scattering: looked up at a point, in a direction, in a band.

use glam::DVec3;

use super::cells::{Cells, NONE};
use super::harmonics::Harmonics;
use super::walk::{LANES, Part};
use crate::physics::dust::camera::Ray;
use crate::physics::dust::model::Scattering;
use crate::physics::dust::scene::Dust;

/// Fields as bytes, to be kept.
pub mod file;
mod noise;
mod seen;

pub(super) use noise::noise;
pub use seen::Seen;

/// What gathering has cost and what it believes to have missed.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub struct Told {
    /// Photons that left the stars.
    pub photons: u64,
    /// Flights between two places: the cost.
    pub flights: u64,
    /// Most scatterings of one photon.
    pub most_scatterings: u32,
    /// Cells with a tally.
    pub cells: usize,
    /// Noise of a column of cells along an axis, as a share of its light (believed, from the differences of independent parts): nearly that of a pixel.
    pub noise: f64,
    /// What orders beyond the highest would add to the source, rms over directions, as a share of its mean (believed, from the last two orders).
    pub beyond: f64,
    /// Light still on its way when walks were cut, as a share of the light scattered once.
    pub cut: f64,
}

impl Told {
    /// All believed errors of a picture's multiply scattered light together, as a share of it.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.noise.hypot(self.beyond) + self.cut
    }
}

/// The source of light that has been scattered twice or more, per unit of extinction and steradian: `J_lm` in each cell near dust.
///
/// ```text
/// J(direction) = sum over l, m of J_lm Y_lm(direction),    J_lm = albedo g^l L_lm,    L = radiance of light scattered once or more
/// ```
///
/// A picture is the integral of extinction x e^-depth x J along its rays. Between the cells' centres J is trilinear.
#[derive(Debug, Clone)]
pub struct Field {
    size: [usize; 3],
    edges: DVec3,
    slots: Vec<u32>,
    used: usize,
    harmonics: Harmonics,
    bands: usize,
    /// By group of four bands, slot, function and band.
    coefficients: Vec<f32>,
    /// By group of four bands: no source is larger anywhere, in any direction.
    bounds: Vec<[f32; LANES]>,
    told: Told,
}

impl Field {
    pub(super) fn empty(cells: &Cells, harmonics: Harmonics, bands: usize) -> Field {
        let length = bands.div_ceil(LANES) * cells.used * harmonics.count() * LANES;
        Field {
            size: cells.size,
            edges: cells.edges,
            slots: cells.slots.clone(),
            used: cells.used,
            harmonics,
            bands,
            coefficients: vec![0.0; length],
            bounds: vec![[0.0; LANES]; bands.div_ceil(LANES)],
            told: Told { cells: cells.used, ..Told::default() },
        }
    }

    /// Takes in a group of bands: sums of all parts in their order, per photon and volume of a cell, scattered once more.
    pub(super) fn add(
        &mut self,
        group: usize,
        order: usize,
        parts: &[Part<'_>],
        light: [f64; LANES],
        dust: &Dust,
        noise: f64,
    ) {
        let count = self.harmonics.count();
        let length = self.used * count * LANES;
        let photons: u64 = parts.iter().map(|part| part.done.photons).sum();
        let cell = (self.edges / self.counts()).element_product();
        let g = dust.phase.asymmetry();
        let scale: Vec<[f32; LANES]> = (0..count)
            .map(|index| {
                light.map(|light| (light * dust.albedo * g.powi(index.isqrt() as i32) / (photons as f64 * cell)) as f32)
            })
            .collect();
        let sums = &mut self.coefficients[group * length..][..length];
        for part in parts {
            for (sum, tally) in sums.iter_mut().zip(&part.tally[order * length..][..length]) {
                *sum += tally;
            }
        }
        for slot in sums.chunks_exact_mut(count * LANES) {
            for (sums, scale) in slot.chunks_exact_mut(LANES).zip(&scale) {
                for (sum, scale) in sums.iter_mut().zip(scale) {
                    *sum *= scale;
                }
            }
        }
        let once: f64 = parts.iter().map(|part| part.done.once).sum();
        let cut: f64 = parts.iter().map(|part| part.done.cut).sum();
        self.told.photons += photons;
        self.told.flights += parts.iter().map(|part| part.done.flights).sum::<u64>();
        let most = parts.iter().map(|part| part.done.most_scatterings).max().unwrap_or(0);
        self.told.most_scatterings = self.told.most_scatterings.max(most);
        self.told.noise = self.told.noise.max(noise);
        self.told.cut = self.told.cut.max(if once > 0.0 { cut / once } else { 0.0 });
    }

    /// Says what the orders that are not there would have held, as much less than the last as the last is less than the one before, and bounds
    /// the source: |sum over m of J_lm Y_lm| is at most sqrt((2 l + 1)/(4 pi) sum of J_lm^2).
    pub(super) fn finish(&mut self, cells: &Cells) {
        let order = self.harmonics.order();
        let mut lengths = vec![0.0; order + 1];
        let mut bounds = std::mem::take(&mut self.bounds);
        for (cell, slot) in cells.slots.iter().enumerate().filter(|(_, slot)| **slot != NONE) {
            let dust = f64::from(cells.density(cell));
            for (group, bounds) in bounds.iter_mut().enumerate() {
                let all = self.coefficients(group, *slot as usize);
                let mut here = [0.0_f32; LANES];
                for (l, sum) in lengths.iter_mut().enumerate() {
                    let mut squares = [0.0_f32; LANES];
                    for four in all[l * l * LANES..(l + 1) * (l + 1) * LANES].chunks_exact(LANES) {
                        for (square, coefficient) in squares.iter_mut().zip(four) {
                            *square += coefficient * coefficient;
                        }
                    }
                    let each = ((2 * l + 1) as f32 * 0.25 / std::f32::consts::PI).sqrt();
                    for (here, square) in here.iter_mut().zip(squares) {
                        *here += each * square.sqrt();
                        *sum += dust * f64::from(square.sqrt());
                    }
                }
                for (bound, here) in bounds.iter_mut().zip(here) {
                    *bound = bound.max(here);
                }
            }
        }
        self.bounds = bounds;
        let (mean, last) = (lengths[0], lengths[order]);
        if mean > 0.0 {
            let ratio = if order > 0 { (last / lengths[order - 1]).clamp(0.0, 0.9) } else { 0.5 };
            self.told.beyond = last / mean * ratio / (1.0 - ratio);
        }
    }

    /// What it has cost and missed.
    #[must_use]
    pub fn told(&self) -> Told {
        self.told
    }

    /// Cells along x, y, z.
    #[must_use]
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// Edges of the box.
    #[must_use]
    pub fn edges(&self) -> DVec3 {
        self.edges
    }

    /// Bands.
    #[must_use]
    pub fn bands(&self) -> usize {
        self.bands
    }

    /// The functions whose coefficients are held.
    #[must_use]
    pub fn harmonics(&self) -> &Harmonics {
        &self.harmonics
    }

    /// Where the coefficients of a cell stand, x fastest; nothing far from all dust. Cells with a place have all places from 0 to [`Told::cells`].
    #[must_use]
    pub fn slot(&self, x: usize, y: usize, z: usize) -> Option<usize> {
        let index = (z * self.size[1] + y) * self.size[0] + x;
        self.slots.get(index).filter(|slot| **slot != NONE).map(|slot| *slot as usize)
    }

    /// The coefficients of four bands (0 to 3, 4 to 7, ...) in a cell with a place: four for each function, zeros for bands that are not there.
    /// Empty where there is none.
    #[must_use]
    pub fn coefficients(&self, group: usize, slot: usize) -> &[f32] {
        let count = self.harmonics.count() * LANES;
        self.coefficients.get((group * self.used + slot) * count..).and_then(|rest| rest.get(..count)).unwrap_or(&[])
    }

    /// The eight cells about a point, with their shares.
    fn about(&self, point: DVec3) -> [(u32, f64); 8] {
        let along = |axis: usize| {
            let last = self.size[axis] - 1;
            let place = (point[axis] / self.edges[axis] + 0.5) * self.size[axis] as f64 - 0.5;
            let place = place.clamp(0.0, last as f64);
            let low = (place as usize).min(last);
            ([low, (low + 1).min(last)], [1.0 - (place - low as f64), place - low as f64])
        };
        let ((x, u), (y, v), (z, w)) = (along(0), along(1), along(2));
        std::array::from_fn(|corner| {
            let (i, j, k) = (corner & 1, corner >> 1 & 1, corner >> 2);
            (self.slots[(z[k] * self.size[1] + y[j]) * self.size[0] + x[i]], u[i] * v[j] * w[k])
        })
    }

    fn counts(&self) -> DVec3 {
        DVec3::new(self.size[0] as f64, self.size[1] as f64, self.size[2] as f64)
    }
}

/// Light scattered at a point towards any direction, per unit of extinction: all coefficients of eight cells at each look-up. For pictures, [`Seen`].
impl Scattering for Field {
    fn name(&self) -> &'static str {
        "scattered before"
    }

    fn source(&self, point: DVec3, towards: DVec3, out: &mut [f64]) {
        let (functions, count) = (self.harmonics.at(towards).map(|y| y as f32), self.harmonics.count());
        out.fill(0.0);
        for (slot, share) in self.about(point) {
            if slot == NONE || share <= 0.0 {
                continue;
            }
            for (group, out) in out.chunks_mut(LANES).enumerate() {
                let mut sum = [0.0_f32; LANES];
                let all = self.coefficients(group, slot as usize);
                for (four, function) in all.chunks_exact(LANES).zip(&functions[..count]) {
                    for (sum, coefficient) in sum.iter_mut().zip(four) {
                        *sum += coefficient * function;
                    }
                }
                for (out, sum) in out.iter_mut().zip(sum) {
                    *out += share * f64::from(sum);
                }
            }
        }
        out.iter_mut().for_each(|source| *source = source.max(0.0));
    }

    fn ceiling(&self, _: &Ray, _: f64, _: f64, out: &mut [f64]) {
        spread(&self.bounds, out);
    }

    fn error(&self) -> f64 {
        self.told.error()
    }
}

/// A number for each band from groups of four; a little more than it, as sums are rounded.
fn spread(groups: &[[f32; LANES]], out: &mut [f64]) {
    for (out, bound) in out.iter_mut().zip(groups.iter().flatten()) {
        *out = f64::from(*bound) * (1.0 + 1e-6);
    }
}
