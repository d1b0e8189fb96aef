//! What the grid cannot hold: the light close to a star, which grows as 1/d^2 between two voxels.
//!
//! Within [`REACH`] of a star the grid holds a smooth share of its light only (`share_of_grid`). The rest is added here, along the few
//! rays that pass there, in steps of equal angle seen from the star:
//!
//! ```text
//! t = t0 + b tan(phi),   dt / d^2 = dphi / b         b the ray's distance from the star, averaged as 1/b over the pixel
//! ```

use glam::DVec3;

use self::hood::Hood;
use super::approximate::{fused, inverse_root, power_of_2};
use super::grid::{Grid, LANES};
use super::shade::{BANDS, Lamp, share_of_grid};
use crate::physics::dust::camera::Ray;
use crate::physics::dust::phase::HenyeyGreenstein;

/// The dust about a star.
pub(super) mod hood;
/// The light close to the stars in a picture.
pub(super) mod tiles;

/// How far from a star the grid does not hold all of its light, longest edges of a voxel.
pub(super) const REACH: f32 = 6.0;

/// Directions from the star along a ray that passes it closely; others have their share of the half turn.
const ANGLES: f64 = 24.0;

/// Fewest directions.
const FEWEST: f64 = 4.0;

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
    #[inline(always)]
    pub(super) fn missing<const FUSED: bool>(
        &self,
        lamp: &Lamp,
        ray: &Ray,
        (enter, leave): (f64, f64),
        pixel: f64,
    ) -> [f32; BANDS] {
        let mut light = [0.0; BANDS];
        let to = lamp.position - ray.origin;
        let middle = to.dot(ray.direction);
        let closest = ray.direction * middle - to;
        let passing = closest.length();
        let reach = f64::from(REACH);
        let half = (reach * reach - passing * passing).max(0.0).sqrt();
        let (from, until) = ((middle - half).max(enter) - middle, (middle + half).min(leave) - middle);
        if passing >= reach || from >= until {
            return light;
        }
        let column = self.grid.column(self.density, ray, (enter, from + middle));
        let way = Way { closest, direction: ray.direction, passing: (1.0 / mean_inverse(passing, pixel)).max(NEAREST) };
        let (first, last) = ((from / way.passing).atan(), (until / way.passing).atan());
        let angles = (ANGLES * (last - first) / std::f64::consts::PI).ceil().max(FEWEST);
        let step = (last - first) / angles;
        let mut walk = Walk {
            turn: (0.5 * step + first).sin_cos(),
            step: step.sin_cos(),
            column,
            before: (from, lamp.hood.at(way.at(from))[0]),
        };
        for done in (0..angles as usize).step_by(LANES) {
            let now = (angles as usize - done).min(LANES);
            let points = walk.on(&way, &lamp.hood, (from, until), now);
            self.add::<FUSED>(lamp, &points, (step / way.passing) as f32, &mut light);
        }
        light
    }

    /// Adds the light of eight points, each of which stands for so much of the integral over dt / d^2.
    #[inline(always)]
    fn add<const FUSED: bool>(&self, lamp: &Lamp, points: &Points, part: f32, light: &mut [f32; BANDS]) {
        let g = self.phase.asymmetry() as f32;
        let (least, height) = ((1.0 - g) * (1.0 - g), part * (1.0 - g * g) / (4.0 * std::f32::consts::PI));
        let mut amount = [0.0; LANES];
        for (n, amount) in amount.iter_mut().enumerate() {
            // Rounding may leave a hair less than nothing.
            let share = (1.0 - share_of_grid(points.distance[n] * (1.0 / REACH))).max(0.0);
            let root = inverse_root::<FUSED>(fused::<FUSED>(2.0 * g, points.lack[n], least));
            *amount = share * points.density[n] * height * root * root * root;
        }
        for ((light, k), power) in light.iter_mut().zip(self.extinction).zip(lamp.power) {
            let mut sum = 0.0;
            for (amount, column) in amount.iter().zip(points.column) {
                sum += amount * power_of_2::<FUSED>(-k * std::f32::consts::LOG2_E * column);
            }
            *light += power * k * sum;
        }
    }
}

/// A ray past a star.
struct Way {
    /// From the star to the point of the ray closest to it.
    closest: DVec3,
    direction: DVec3,
    /// How far the ray passes, averaged over the pixel.
    passing: f64,
}

impl Way {
    /// A point of the ray, so far behind the closest one; counted from the star.
    fn at(&self, t: f64) -> DVec3 {
        self.closest + self.direction * t
    }
}

/// Eight points of a ray.
#[derive(Default)]
struct Points {
    /// Density; 0 where there is no point.
    density: [f32; LANES],
    /// Distance from the star, averaged over the pixel.
    distance: [f32; LANES],
    /// 1 less the cosine of the angle that light from the star turns through.
    lack: [f32; LANES],
    /// Column from the star, and on to the eye.
    column: [f32; LANES],
}

/// A walk along a ray in steps of equal angle.
struct Walk {
    /// Sine and cosine of the angle at the next point, and of the steps.
    turn: (f64, f64),
    step: (f64, f64),
    /// Column between the eye and the point before.
    column: f32,
    /// Where the point before was, and its density.
    before: (f64, f32),
}

impl Walk {
    #[inline(always)]
    fn on(&mut self, way: &Way, hood: &Hood, (from, until): (f64, f64), now: usize) -> Points {
        let mut points = Points::default();
        for n in 0..now {
            let (sine, cosine) = self.turn;
            let t = (way.passing * sine / cosine).clamp(from, until);
            let place = way.at(t);
            let [density, mean] = hood.at(place);
            self.column += 0.5 * (density + self.before.1) * (t - self.before.0) as f32;
            self.before = (t, density);
            let distance = place.length().max(1e-12);
            points.density[n] = density;
            points.distance[n] = (way.passing / cosine) as f32;
            // Light comes from the star and goes against the ray.
            points.lack[n] = (1.0 + t / distance) as f32;
            points.column[n] = self.column + mean * distance as f32;
            self.turn = (sine * self.step.1 + cosine * self.step.0, cosine * self.step.1 - sine * self.step.0);
        }
        points
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
