//! Light gathered in cells, as the source of the next scattering: looked up at a point, in a direction, in a band.

use glam::DVec3;

use super::cells::{Cells, NONE};
use super::harmonics::{Harmonics, MOST};
use super::walk::{LANES, Part};
use crate::physics::dust::camera::Ray;
use crate::physics::dust::model::Scattering;
use crate::physics::dust::scene::Dust;

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

    /// The field as one direction sees it: cheap to look up along parallel rays.
    #[must_use]
    pub fn along(&self, towards: DVec3) -> Seen<'_> {
        let functions = self.harmonics.at(towards);
        self.seen(None, |_| functions)
    }

    /// The field as an eye sees it, every cell in the direction from its centre to the eye; near the eye, each point in its own.
    #[must_use]
    pub fn from(&self, eye: DVec3) -> Seen<'_> {
        self.seen(Some(eye), |centre| self.harmonics.at((eye - centre).normalize_or(DVec3::Z)))
    }

    fn seen(&self, eye: Option<DVec3>, functions: impl Fn(DVec3) -> [f64; MOST]) -> Seen<'_> {
        let (count, groups) = (self.harmonics.count(), self.bands.div_ceil(LANES));
        let mut sources = vec![[0.0_f32; LANES]; self.used * groups];
        for (cell, slot) in self.slots.iter().enumerate().filter(|(_, slot)| **slot != NONE) {
            let (x, rest) = (cell % self.size[0], cell / self.size[0]);
            let index = DVec3::new(x as f64, (rest % self.size[1]) as f64, (rest / self.size[1]) as f64);
            let functions = functions(self.edges * ((index + 0.5) / self.counts() - 0.5)).map(|y| y as f32);
            for group in 0..groups {
                let sum = &mut sources[group * self.used + *slot as usize];
                let all = self.coefficients(group, *slot as usize);
                for (four, function) in all.chunks_exact(LANES).zip(&functions[..count]) {
                    for (sum, coefficient) in sum.iter_mut().zip(four) {
                        *sum += coefficient * function;
                    }
                }
            }
        }
        let mut highest = vec![[0.0_f32; LANES]; groups];
        for (index, source) in sources.iter().enumerate() {
            for (high, source) in highest[index / self.used].iter_mut().zip(source) {
                *high = high.max(*source);
            }
        }
        if eye.is_some() {
            // Near the eye all directions occur: |sum of J_lm Y_lm| over m is at most sqrt((2 l + 1)/(4 pi) sum of J_lm^2).
            highest.clone_from(&self.bounds);
        }
        Seen { field: self, eye, sources, highest }
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

/// A field seen from somewhere: one number for each cell and band. The direction asked for is only looked at near the eye.
#[derive(Debug, Clone)]
pub struct Seen<'a> {
    field: &'a Field,
    eye: Option<DVec3>,
    /// By group of four bands and slot.
    sources: Vec<[f32; LANES]>,
    /// By group of four bands.
    highest: Vec<[f32; LANES]>,
}

/// Cells from the eye within which each point is seen in its own direction.
const NEAR: f64 = 4.0;

impl Scattering for Seen<'_> {
    fn name(&self) -> &'static str {
        self.field.name()
    }

    fn source(&self, point: DVec3, towards: DVec3, out: &mut [f64]) {
        let near = self
            .eye
            .is_some_and(|eye| ((point - eye) / self.field.edges * self.field.counts()).length_squared() < NEAR * NEAR);
        if near {
            return self.field.source(point, towards, out);
        }
        out.fill(0.0);
        for (slot, share) in self.field.about(point) {
            if slot == NONE {
                continue;
            }
            for (group, out) in out.chunks_mut(LANES).enumerate() {
                if let Some(here) = self.sources.get(group * self.field.used + slot as usize) {
                    for (out, here) in out.iter_mut().zip(here) {
                        *out += share * f64::from(*here);
                    }
                }
            }
        }
        out.iter_mut().for_each(|source| *source = source.max(0.0));
    }

    fn ceiling(&self, _: &Ray, _: f64, _: f64, out: &mut [f64]) {
        spread(&self.highest, out);
    }

    fn error(&self) -> f64 {
        self.field.error()
    }
}

/// A number for each band from groups of four; a little more than it, as sums are rounded.
fn spread(groups: &[[f32; LANES]], out: &mut [f64]) {
    for (out, bound) in out.iter_mut().zip(groups.iter().flatten()) {
        *out = f64::from(*bound) * (1.0 + 1e-6);
    }
}

/// Noise of columns of cells along an axis, as a share of their light, from the differences between the parts; the worst axis of all orders together.
pub(super) fn noise(cells: &Cells, parts: &[Part<'_>], harmonics: &Harmonics, orders: usize) -> f64 {
    let stride = harmonics.count() * LANES;
    let [nx, ny, _] = cells.size;
    let mut worst = 0.0_f64;
    for axis in 0..3 {
        let kept = |x: usize, y: usize, z: usize| match axis {
            0 => (y, z),
            1 => (x, z),
            _ => (x, y),
        };
        let wide = if axis == 0 { ny } else { nx };
        let high = if axis == 2 { ny } else { cells.size[2] };
        // Of each column and band: the sum over parts and the sum of squares.
        let mut sums = vec![[0.0_f64; 2 * LANES]; wide * high];
        for part in parts {
            let mut columns = vec![[0.0_f64; LANES]; wide * high];
            for (cell, slot) in cells.slots.iter().enumerate().filter(|(_, slot)| **slot != NONE) {
                let (x, rest) = (cell % nx, cell / nx);
                let (a, b) = kept(x, rest % ny, rest / ny);
                let dust = f64::from(cells.density(cell)) / part.done.photons.max(1) as f64;
                for order in 0..orders {
                    let at = (order * cells.used + *slot as usize) * stride;
                    for (sum, tally) in columns[b * wide + a].iter_mut().zip(&part.tally[at..at + LANES]) {
                        *sum += dust * f64::from(*tally);
                    }
                }
            }
            for (sums, column) in sums.iter_mut().zip(&columns) {
                for lane in 0..LANES {
                    sums[lane] += column[lane];
                    sums[LANES + lane] += column[lane] * column[lane];
                }
            }
        }
        let n = parts.len() as f64;
        let (mut light, mut noise) = ([0.0; LANES], [0.0; LANES]);
        for sums in &sums {
            for lane in 0..LANES {
                let mean = sums[lane] / n;
                light[lane] += mean;
                noise[lane] += ((sums[LANES + lane] / n - mean * mean).max(0.0) / (n - 1.0)).sqrt();
            }
        }
        for lane in 0..LANES {
            if light[lane] > 0.0 {
                worst = worst.max(noise[lane] / light[lane]);
            }
        }
    }
    worst
}
