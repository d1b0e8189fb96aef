//! Columns from the stars to the points of a lattice, computed once: between its points a column is interpolated.
//!
//! What is kept is the mean density of the way, column over distance: it is level where the column is a cone, near the star. Within four
//! spacings of a star the column itself is computed, the way being short.

use glam::DVec3;
use rayon::prelude::*;

use super::column;
use crate::physics::dust::scene::Star;
use crate::physics::dust::volume::Volume;

/// Nearer to a star than so many spacings no column is interpolated.
const NEAR: f64 = 4.0;

/// Mean densities of the ways from the stars to the points of a lattice that holds the box's faces.
pub struct Lattice {
    /// Spacings along x, y, z; points are one more.
    size: [usize; 3],
    edges: DVec3,
    near: f64,
    stars: Vec<DVec3>,
    /// One list a star, x fastest. f32: its rounding is 6e-8 of an optical depth.
    means: Vec<Vec<f32>>,
}

impl Lattice {
    /// The lattice of so many spacings along the box's longest side; the shorter ones in proportion, at least one.
    ///
    /// `told` hears the share that is done. Stars in one place are computed once each.
    #[must_use]
    pub fn new(volume: &Volume, stars: &[Star], spacings: usize, told: &mut dyn FnMut(f64)) -> Lattice {
        let edges = volume.edges();
        let along = |edge: f64| ((spacings.max(1) as f64 * edge / edges.max_element()).round() as usize).max(1);
        let size = [along(edges.x), along(edges.y), along(edges.z)];
        let spacing = edges / DVec3::new(size[0] as f64, size[1] as f64, size[2] as f64);
        let points = [size[0] + 1, size[1] + 1, size[2] + 1];
        let mut means = Vec::with_capacity(stars.len());
        for (star, number) in stars.iter().zip(0..) {
            let mut mean = vec![0f32; points[0] * points[1] * points[2]];
            let slab = points[0] * points[1];
            // Slabs in a few batches, so that progress can be told.
            let batch = points[2].div_ceil(16);
            for (part, slabs) in mean.chunks_mut(batch * slab).enumerate() {
                slabs.par_chunks_mut(slab).enumerate().for_each(|(z, out)| {
                    let z = (part * batch + z) as f64;
                    for (y, row) in out.chunks_mut(points[0]).enumerate() {
                        for (x, value) in row.iter_mut().enumerate() {
                            let point = DVec3::new(x as f64, y as f64, z) * spacing - edges * 0.5;
                            *value = mean_density(volume, star.position, point) as f32;
                        }
                    }
                });
                told((number as f64 + ((part + 1) * batch) as f64 / points[2] as f64) / stars.len() as f64);
            }
            means.push(mean);
        }
        let near = NEAR * spacing.max_element();
        Lattice { size, edges, near, stars: stars.iter().map(|star| star.position).collect(), means }
    }

    /// Spacings along the longest side.
    #[must_use]
    pub fn spacings(&self) -> usize {
        self.size.into_iter().max().unwrap_or(1)
    }

    /// Bytes of memory.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.means.iter().map(|mean| mean.len() * 4).sum()
    }

    /// The column from a star (by its index) to a point in the box.
    #[must_use]
    pub fn column(&self, volume: &Volume, star: usize, point: DVec3) -> f64 {
        let position = self.stars[star];
        let distance = position.distance(point);
        if distance < self.near {
            return column(volume, position, point);
        }
        distance * self.mean(star, point)
    }

    /// The mean density on the way, trilinear.
    fn mean(&self, star: usize, point: DVec3) -> f64 {
        let along = |axis: usize| {
            let last = self.size[axis];
            let place = ((point[axis] / self.edges[axis] + 0.5) * last as f64).clamp(0.0, last as f64);
            let low = (place as usize).min(last - 1);
            (low, place - low as f64)
        };
        let ((x, u), (y, v), (z, w)) = (along(0), along(1), along(2));
        let (nx, ny) = (self.size[0] + 1, self.size[1] + 1);
        let means = &self.means[star];
        let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let row = |y: usize, z: usize| {
            let at = (z * ny + y) * nx + x;
            mix(f64::from(means[at]), f64::from(means[at + 1]), u)
        };
        mix(mix(row(y, z), row(y + 1, z), v), mix(row(y, z + 1), row(y + 1, z + 1), v), w)
    }
}

fn mean_density(volume: &Volume, star: DVec3, point: DVec3) -> f64 {
    let distance = star.distance(point);
    if distance > 0.0 { column(volume, star, point) / distance } else { volume.at(point) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_a_lattice_are_those_of_the_way() {
        let density = (0..512).map(|i| 1.0 + (f64::from(i) * 0.01).sin() as f32).collect();
        let volume = Volume::new([8, 8, 8], DVec3::splat(2.0), density).unwrap();
        let stars = [
            Star { position: DVec3::new(0.1, 0.2, -0.3), intensity: vec![1.0] },
            Star { position: DVec3::new(3.0, 0.5, 0.0), intensity: vec![1.0] },
        ];
        let mut shares = Vec::new();
        let lattice = Lattice::new(&volume, &stars, 32, &mut |share| shares.push(share));
        assert!(shares.is_sorted() && *shares.last().unwrap() >= 1.0);
        for (i, star) in stars.iter().enumerate() {
            for point in [DVec3::new(-0.9, 0.7, 0.4), DVec3::new(0.99, -0.99, 0.0), DVec3::new(0.12, 0.21, -0.3)] {
                let (quick, exact) = (lattice.column(&volume, i, point), column(&volume, star.position, point));
                // A thousandth of an optical depth is a thousandth of the light.
                assert!((quick - exact).abs() < 1e-3, "star {i}, {point}: {quick} {exact}");
            }
        }
    }
}
