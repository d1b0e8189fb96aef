//! What the grid cannot hold: the light close to a star, which grows as 1/d^2 between two voxels.
//!
//! Within [`REACH`] of a star the grid holds a smooth share of its light only (`share_of_grid`). The rest is added here, along the few
//! rays that pass there, in steps of equal angle seen from the star:
//!
//! ```text
//! t = t0 + b tan(phi),   dt / d^2 = dphi / b         b the ray's distance from the star, averaged as 1/b over the pixel
//! ```

use glam::DVec3;

use super::grid::Grid;
use super::shade::{BANDS, Lamp, share_of_grid};
use crate::physics::dust::camera::Ray;
use crate::physics::dust::phase::HenyeyGreenstein;

/// How far from a star the grid does not hold all of its light, longest edges of a voxel.
pub(super) const REACH: f32 = 6.0;

/// Directions from the star along a ray that passes it closely; others have their share of the half turn.
const ANGLES: f64 = 24.0;

/// Fewest directions.
const FEWEST: f64 = 4.0;

/// Samples between the star and a point.
const WAY: usize = 3;

/// Nearer than this no ray is taken to pass: the radiance of an eye on the star has no bound.
const NEAREST: f64 = 1e-3;

/// The dust around a star.
pub(super) struct Surroundings<'a> {
    pub(super) grid: &'a Grid,
    pub(super) density: &'a [f32],
    pub(super) phase: HenyeyGreenstein,
    pub(super) extinction: [f32; BANDS],
}

impl Surroundings<'_> {
    /// The light that the grid does not hold of one star along a ray, which enters the box and leaves it at these lengths. `pixel` is
    /// half the width of a pixel where the star is.
    pub(super) fn missing(&self, lamp: &Lamp, ray: &Ray, (enter, leave): (f64, f64), pixel: f64) -> [f32; BANDS] {
        let mut light = [0.0; BANDS];
        let to = lamp.position - ray.origin;
        let middle = to.dot(ray.direction);
        let passing = (to - ray.direction * middle).length();
        let reach = f64::from(REACH);
        let half = (reach * reach - passing * passing).max(0.0).sqrt();
        let (from, until) = ((middle - half).max(enter), (middle + half).min(leave));
        if passing >= reach || from >= until {
            return light;
        }
        let passing = (1.0 / mean_inverse(passing, pixel)).max(NEAREST);
        let angle = |t: f64| ((t - middle) / passing).atan();
        let (first, last) = (angle(from), angle(until));
        let angles = (ANGLES * (last - first) / std::f64::consts::PI).ceil().max(FEWEST);
        let step = (last - first) / angles;
        let mut column = self.column(ray, enter, from);
        let mut before = (from, self.dust(ray, from));
        for n in 0..angles as usize {
            let phi = first + (n as f64 + 0.5) * step;
            let t = (middle + passing * phi.tan()).clamp(from, until);
            let place = ray.origin + ray.direction * t;
            let density = self.dust(ray, t);
            column += 0.5 * (density + before.1) * (t - before.0) as f32;
            before = (t, density);
            let distance = (passing / phi.cos()).min(reach);
            // Rounding may leave a hair less than nothing.
            let share = (1.0 - share_of_grid(distance as f32 / REACH)).max(0.0);
            // Light comes from the star and goes against the ray.
            let cosine = -(place - lamp.position).normalize_or_zero().dot(ray.direction);
            let amount = f64::from(share) * self.phase.per_steradian(cosine) * step / passing;
            let way = self.way(lamp.position, place);
            for ((light, k), power) in light.iter_mut().zip(self.extinction).zip(lamp.power) {
                *light += power * (-k * (way + column)).exp() * k * density * amount as f32;
            }
        }
        light
    }

    fn dust(&self, ray: &Ray, t: f64) -> f32 {
        self.grid.at(self.density, ray.origin + ray.direction * t)
    }

    /// Column along a ray, steps of a voxel at most.
    fn column(&self, ray: &Ray, from: f64, until: f64) -> f32 {
        let steps = (until - from).ceil().max(1.0);
        let step = (until - from) / steps;
        (0..steps as usize).map(|n| self.dust(ray, from + (n as f64 + 0.5) * step)).sum::<f32>() * step as f32
    }

    /// Column between the star and a place near it; outside the box there is none.
    fn way(&self, star: DVec3, place: DVec3) -> f32 {
        let half = self.grid.edges() * 0.5;
        let dust = |share: f64| {
            let point = star + (place - star) * share;
            if point.abs().cmple(half).all() { self.grid.at(self.density, point) } else { 0.0 }
        };
        let sum: f32 = (0..WAY).map(|n| dust((n as f64 + 0.5) / WAY as f64)).sum();
        sum * star.distance(place) as f32 / WAY as f32
    }
}

/// The mean of 1/b over a square pixel of half width a whose centre passes at a distance: from the antiderivative
/// x asinh(y/|x|) + y asinh(x/|y|) of 1/sqrt(x^2 + y^2).
fn mean_inverse(distance: f64, a: f64) -> f64 {
    if a <= 0.0 || distance > 8.0 * a {
        return 1.0 / distance.max(NEAREST);
    }
    let corner = |x: f64, y: f64| {
        let part = |x: f64, y: f64| if x == 0.0 { 0.0 } else { x * (y / x.abs()).asinh() };
        part(x, y) + part(y, x)
    };
    let (left, right) = (distance - a, distance + a);
    (corner(right, a) - corner(left, a) - corner(right, -a) + corner(left, -a)) / (4.0 * a * a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_1_over_b_in_a_pixel_is_that_of_many_points() {
        for distance in [0.0, 0.3, 0.5, 1.7, 9.0] {
            let steps = 1000;
            let mut sum = 0.0;
            for i in 0..steps {
                for j in 0..steps {
                    let at = |i: i32| (f64::from(i) + 0.5) / f64::from(steps) - 0.5;
                    sum += 1.0 / (distance + at(i)).hypot(at(j));
                }
            }
            let many = sum / f64::from(steps * steps);
            let mean = mean_inverse(distance, 0.5);
            assert!((mean / many - 1.0).abs() < 2e-3, "{distance}: {mean} {many}");
        }
    }
}
