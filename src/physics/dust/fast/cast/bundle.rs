//! The rays of a tile together: what all of them can pass over.

use glam::DVec3;

use super::Casting;
use super::points::Aim;
use crate::physics::dust::camera::Ray;
use crate::physics::dust::fast::grid::Grid;
use crate::physics::dust::fast::occupancy::Occupancy;

/// So near a star, in voxels, its light in the grid is steep.
const NEAR: f64 = 12.0;

/// The rays of a tile together: a middle ray, and how far from it the others are.
pub(super) struct Bundle {
    /// Index of the middle's origin, and indices per length.
    pub(super) origin: DVec3,
    pub(super) direction: DVec3,
    /// How far the others are from the middle: at their origins, and more per length; in indices.
    apart: (f64, f64),
    pub(super) enter: f64,
    pub(super) leave: f64,
    /// Indices passed per length.
    pub(super) pace: f64,
}

impl Bundle {
    pub(super) fn of(grid: &Grid, aims: &[Aim]) -> Option<Bundle> {
        if aims.is_empty() {
            return None;
        }
        let sum = |of: fn(&Ray) -> DVec3| aims.iter().map(|aim| of(&aim.ray)).sum::<DVec3>() / aims.len() as f64;
        let middle = Ray { origin: sum(|ray| ray.origin), direction: sum(|ray| ray.direction) };
        let scale = grid.per_length();
        let mut apart = (0.0f64, 0.0f64);
        for aim in aims {
            let (o, d) = (aim.ray.origin - middle.origin, aim.ray.direction - middle.direction);
            apart = (apart.0.max((o * scale).abs().max_element()), apart.1.max((d * scale).abs().max_element()));
        }
        Some(Bundle {
            origin: grid.index(middle.origin),
            direction: middle.direction * scale,
            apart,
            enter: aims.iter().map(|aim| aim.enter).fold(f64::INFINITY, f64::min),
            leave: aims.iter().map(|aim| aim.leave).fold(0.0, f64::max),
            pace: aims.iter().map(|aim| (aim.ray.direction * scale).length()).fold(1e-9, f64::max),
        })
    }

    fn apart(&self, t: f64) -> f64 {
        // A hair more, for rounding.
        self.apart.0 + self.apart.1 * t + 1e-3
    }

    /// How far all can go on from a length without meeting dust; 0 for less than a few voxels.
    pub(super) fn free(&self, occupancy: &Occupancy, t: f64) -> f64 {
        let room = occupancy.free(self.origin + self.direction * t) - self.apart(t);
        let far = room / (self.direction.abs().max_element() + self.apart.1).max(1e-12);
        if room > 2.0 { far } else { 0.0 }
    }

    /// Corners of a box around all between two lengths.
    fn around(&self, from: f64, until: f64) -> (DVec3, DVec3) {
        let (a, b) = (self.origin + self.direction * from, self.origin + self.direction * until);
        let apart = DVec3::splat(self.apart(until));
        (a.min(b) - apart, a.max(b) + apart)
    }

    /// The most dust that any can meet between two lengths.
    pub(super) fn densest(&self, occupancy: &Occupancy, from: f64, until: f64) -> f32 {
        let (low, high) = self.around(from, until);
        occupancy.densest(low, high)
    }

    /// Whether any can come near a star between two lengths.
    pub(super) fn near_a_star(&self, casting: &Casting<'_>, from: f64, until: f64) -> bool {
        let (low, high) = self.around(from, until);
        let reach = casting.grid.per_length() * NEAR;
        casting.lamps.iter().any(|lamp| {
            let star = casting.grid.index(lamp.position);
            star.cmpge(low - reach).all() && star.cmple(high + reach).all()
        })
    }
}
