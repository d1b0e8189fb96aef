//! A field as one eye sees it: a number for each cell and band, so that a look-up costs little.

use glam::DVec3;

use super::{Field, spread};
use crate::physics::dust::camera::Ray;
use crate::physics::dust::model::Scattering;
use crate::physics::dust::multiple::cells::NONE;
use crate::physics::dust::multiple::harmonics::MOST;
use crate::physics::dust::multiple::walk::LANES;

impl Field {
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
