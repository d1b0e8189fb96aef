//! How far a frame is from finer steps: in a few of its pixels the light of the stars is worked out at each step, not once a voxel.
//!
//! What the grid itself says is shared, and not seen by this: the columns of dust from the stars, which are interpolated.

use glam::DVec3;
use rayon::prelude::*;

use super::grid::Grid;
use super::near::{REACH, Surroundings};
use super::shade::{BANDS, Lamp, share_of_grid};
use super::{Believed, Frame};
use crate::physics::dust::bricks::crossing;
use crate::physics::dust::camera::{Camera, Ray};
use crate::physics::dust::model::Scattering;
use crate::physics::dust::multiple::Field;

/// Behind this share nothing is looked at.
const OPAQUE: f32 = 1e-6;

/// What is probed, and how finely.
pub(super) struct Probing<'a> {
    pub(super) grid: &'a Grid,
    pub(super) lamps: &'a [Lamp],
    pub(super) surroundings: &'a Surroundings<'a>,
    pub(super) field: Option<&'a Field>,
    /// Voxels.
    pub(super) step: f64,
    /// Radiance of 1 in the flyer's numbers.
    pub(super) scale: f32,
}

/// The error of a frame's pixels, from so many of them spread evenly over it.
pub(super) fn believed(probing: &Probing<'_>, camera: &Camera, frame: &Frame, probes: usize) -> Believed {
    let (width, height) = (frame.width, frame.height);
    // Steps of the plastic number's sequence fill a rectangle evenly (Roberts 2018).
    let places = (0..probes).map(|n| {
        let along = |step: f64, size: usize| (((n as f64 + 0.5) * step).fract() * size as f64) as usize;
        (along(0.754_877_666_246_692_8, width), along(0.569_840_290_998_053_3, height))
    });
    let places: Vec<(usize, usize)> = places.collect();
    let found: Vec<(f32, f32)> = places
        .par_iter()
        .map(|(x, y)| {
            let ray = camera.ray(*x as f64 + 0.5, *y as f64 + 0.5, width, height);
            let fine = ray.map_or([0.0; BANDS], |ray| probing.radiance(&probing.grid.ray(&ray)));
            let there = frame.pixels[y * width + x];
            let mut error = 0.0f32;
            for band in 0..BANDS {
                error = error.max((fine[band] * probing.scale - there[band]).abs());
            }
            (error, fine.into_iter().fold(0.0, f32::max) * probing.scale)
        })
        .collect();
    let light = found.iter().map(|(_, light)| light).sum::<f32>();
    if light <= 0.0 {
        return Believed { mean: 0.0, worst: 0.0, probes };
    }
    let worst = found.iter().map(|(error, _)| *error).fold(0.0, f32::max);
    Believed {
        mean: found.iter().map(|(error, _)| error).sum::<f32>() / light,
        worst: worst * found.len() as f32 / light,
        probes,
    }
}

impl Probing<'_> {
    /// The radiance along a ray, without the part that the frame takes from `near` too.
    fn radiance(&self, ray: &Ray) -> [f32; BANDS] {
        let mut light = [0.0f32; BANDS];
        let Some((enter, leave)) = crossing(self.grid.edges(), ray) else { return light };
        let enter = enter.max(0.0);
        if enter >= leave {
            return light;
        }
        let extinction = self.surroundings.extinction;
        let mut through = [1.0f32; BANDS];
        let steps = ((leave - enter) / self.step).ceil().max(1.0);
        let step = (leave - enter) / steps;
        for n in 0..steps as usize {
            let place = ray.origin + ray.direction * (enter + (n as f64 + 0.5) * step);
            let depth = self.grid.at(self.surroundings.density, place) * step as f32;
            if depth <= 0.0 {
                continue;
            }
            let source = self.source(place, -ray.direction);
            for band in 0..BANDS {
                let lost = -(-extinction[band] * depth).exp_m1();
                light[band] += through[band] * lost * source[band];
                through[band] *= 1.0 - lost;
            }
            if through.iter().all(|left| *left < OPAQUE) {
                break;
            }
        }
        // A pixel's width matters within a pixel of a star only, and a probe falls there once in a thousand frames.
        for lamp in self.lamps {
            let near = self.surroundings.missing::<false>(lamp, ray, (enter, leave), 0.0);
            light.iter_mut().zip(near).for_each(|(light, near)| *light += near);
        }
        light
    }

    /// The source at a place towards the eye.
    fn source(&self, place: DVec3, towards: DVec3) -> [f32; BANDS] {
        let mut glow = [0.0f64; BANDS];
        if let Some(field) = self.field {
            field.source(place * self.grid.unit, towards, &mut glow);
        }
        let mut source = glow.map(|light| light as f32 / self.scale);
        for lamp in self.lamps {
            let way = place - lamp.position;
            let square = way.length_squared().max(1e-12);
            let distance = square.sqrt();
            let share = share_of_grid(distance as f32 / REACH);
            let phase = self.surroundings.phase.per_steradian(way.dot(towards) / distance);
            let amount = share * (phase / square) as f32;
            let column = self.grid.at(&lamp.columns, place);
            for ((source, k), power) in source.iter_mut().zip(self.surroundings.extinction).zip(lamp.power) {
                *source += power * amount * (-k * column).exp();
            }
        }
        source
    }
}
