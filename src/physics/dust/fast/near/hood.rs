//! The dust about a star: what the light close to it passes, voxel by voxel.

use glam::DVec3;

use super::REACH;
use crate::physics::dust::bricks::crossing;
use crate::physics::dust::camera::Ray;
use crate::physics::dust::fast::grid::Grid;

/// Voxels within reach of a star, each with its density and the mean density on the way from the star to it. Both are as smooth as the dust,
/// which the column itself is not at the star, and are interpolated.
#[derive(Debug, Clone)]
pub(in super::super) struct Hood {
    /// Voxels along the axes.
    size: [usize; 3],
    /// Indices per unit of length.
    per_length: DVec3,
    /// The star's index, counted from the first voxel.
    star: DVec3,
    /// Highest and lowest indices of a place in the box, counted likewise.
    within: [DVec3; 2],
    values: Vec<[f32; 2]>,
}

impl Hood {
    /// The dust about a place. `density` is padded.
    pub(in super::super) fn new(grid: &Grid, density: &[f32], star: DVec3) -> Hood {
        let (index, per_length) = (grid.index(star), grid.per_length());
        let reach = per_length * f64::from(REACH);
        let within = [DVec3::splat(0.5), grid.counts() + 0.5];
        let low = (index - reach).clamp(within[0], within[1]).floor();
        let high = (index + reach).clamp(within[0], within[1]).floor() + 1.0;
        let size = [0, 1, 2].map(|axis| (high[axis] - low[axis]) as usize + 1);
        let mut values = Vec::with_capacity(size.iter().product());
        for z in 0..size[2] {
            for y in 0..size[1] {
                for x in 0..size[0] {
                    let place = grid.place(low + DVec3::new(x as f64, y as f64, z as f64));
                    values.push([grid.at(density, place), mean(grid, density, star, place)]);
                }
            }
        }
        Hood { size, per_length, star: index - low, within: within.map(|end| end - low), values }
    }

    /// Density, and mean density on the way from the star, at a place in the box and within reach, counted from the star.
    #[inline(always)]
    pub(super) fn at(&self, from_star: DVec3) -> [f32; 2] {
        let index = (self.star + from_star * self.per_length).clamp(self.within[0], self.within[1]);
        let low = [0, 1, 2].map(|axis| (index[axis] as usize).min(self.size[axis] - 2));
        let [u, v, w] = [0, 1, 2].map(|axis| (index[axis] - low[axis] as f64) as f32);
        let start = (low[2] * self.size[1] + low[1]) * self.size[0] + low[0];
        let row = |at: usize| match self.values.get(at..at + 2) {
            Some([a, b]) => [0, 1].map(|n| a[n] + (b[n] - a[n]) * u),
            _ => [0.0; 2],
        };
        let plane = |at: usize| {
            let (a, b) = (row(at), row(at + self.size[0]));
            [0, 1].map(|n| a[n] + (b[n] - a[n]) * v)
        };
        let (a, b) = (plane(start), plane(start + self.size[0] * self.size[1]));
        [0, 1].map(|n| a[n] + (b[n] - a[n]) * w)
    }
}

/// Mean density between a star and a place in the box; outside the box there is none.
fn mean(grid: &Grid, density: &[f32], star: DVec3, place: DVec3) -> f32 {
    let distance = star.distance(place);
    if distance < 1e-6 {
        return grid.at(density, place);
    }
    let ray = Ray { origin: place, direction: (star - place) / distance };
    let Some((_, leave)) = crossing(grid.edges(), &ray) else { return 0.0 };
    let inside = leave.clamp(0.0, distance);
    let samples = (2.0 * inside).ceil() + 1.0;
    let step = inside / samples;
    let sum: f32 =
        (0..samples as usize).map(|n| grid.at(density, place + ray.direction * (step * (n as f64 + 0.5)))).sum();
    sum / samples as f32 * (inside / distance) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::dust::volume::Volume;

    /// Dust that grows evenly along all axes: the mean on a way is the density in its middle, and no interpolation is off.
    #[test]
    fn the_way_from_a_star_is_known_in_dust_that_grows_evenly() {
        let size = [20, 24, 18];
        let mut dust = Vec::new();
        for n in 0..size.iter().product::<usize>() {
            dust.push((n % 20) as f32 + 0.5 * (n / 20 % 24) as f32 + 2.0 * (n / 480) as f32);
        }
        let grid = Grid::new(&Volume::new(size, DVec3::new(20.0, 24.0, 18.0), dust.clone()).unwrap());
        let density = grid.pad(&dust);
        let star = DVec3::new(0.3, -1.2, 0.7);
        let hood = Hood::new(&grid, &density, star);
        for way in [DVec3::ZERO, DVec3::new(3.3, -4.1, 1.0), DVec3::new(-2.0, 0.1, 5.0), DVec3::new(0.01, 0.0, 0.0)] {
            let [there, mean] = hood.at(way);
            let exact = grid.at(&density, star + way);
            let middle = grid.at(&density, star + way * 0.5);
            assert!(
                (there - exact).abs() < 1e-4 * exact && (mean - middle).abs() < 1e-4 * middle,
                "{way}: {there} {exact} {mean} {middle}"
            );
        }
    }

    #[test]
    fn on_the_way_from_a_star_beside_the_box_only_what_is_inside_counts() {
        let grid = Grid::new(&Volume::new([9; 3], DVec3::splat(9.0), vec![2.0; 729]).unwrap());
        let star = DVec3::new(-6.0, 0.0, 0.0);
        let hood = Hood::new(&grid, &grid.pad(&[2.0; 729]), star);
        // 1.5 of the way is empty, 2.5 holds dust of density 2.
        let [density, mean] = hood.at(DVec3::new(4.0, 0.0, 0.0));
        assert!((density - 2.0).abs() < 1e-6 && (mean - 2.0 * 2.5 / 4.0).abs() < 0.02, "{density} {mean}");
    }
}
