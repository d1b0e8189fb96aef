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
    /// One list a star, x fastest; none before the lattice is filled. f32: its rounding is 6e-8 of an optical depth.
    means: Vec<Vec<f32>>,
}

/// Spacings along x, y, z of a lattice with so many along the longest side; the shorter ones in proportion, at least one.
fn size(volume: &Volume, spacings: usize) -> [usize; 3] {
    let edges = volume.edges();
    [edges.x, edges.y, edges.z]
        .map(|edge| ((spacings.max(1) as f64 * edge / edges.max_element()).round() as usize).max(1))
}

/// How many columns fill a lattice, for each star.
#[must_use]
pub fn points(volume: &Volume, spacings: usize) -> usize {
    size(volume, spacings).iter().map(|n| n + 1).product()
}

impl Lattice {
    /// A lattice of so many spacings along the longest side that is not filled: what it would interpolate is computed for each look. To try
    /// out on a few rays whether filling it would be good enough.
    #[must_use]
    pub fn untried(volume: &Volume, stars: &[Star], spacings: usize) -> Lattice {
        let size = size(volume, spacings);
        let spacing = volume.edges() / DVec3::new(size[0] as f64, size[1] as f64, size[2] as f64);
        Lattice {
            size,
            edges: volume.edges(),
            near: NEAR * spacing.max_element(),
            stars: stars.iter().map(|star| star.position).collect(),
            means: Vec::new(),
        }
    }

    /// A filled lattice. `told` hears the share that is done.
    #[must_use]
    pub fn new(volume: &Volume, stars: &[Star], spacings: usize, told: &mut dyn FnMut(f64)) -> Lattice {
        let mut lattice = Lattice::untried(volume, stars, spacings);
        let size = lattice.size;
        let points = [size[0] + 1, size[1] + 1, size[2] + 1];
        let mut means = Vec::with_capacity(stars.len());
        for (star, number) in stars.iter().zip(0..) {
            let mut mean = vec![0f32; points[0] * points[1] * points[2]];
            let slab = points[0] * points[1];
            // Slabs in a few batches, so that progress can be told.
            let batch = points[2].div_ceil(16);
            for (part, slabs) in mean.chunks_mut(batch * slab).enumerate() {
                slabs.par_chunks_mut(slab).enumerate().for_each(|(z, out)| {
                    let z = part * batch + z;
                    for (y, row) in out.chunks_mut(points[0]).enumerate() {
                        for (x, value) in row.iter_mut().enumerate() {
                            *value = mean_density(volume, star.position, lattice.point(x, y, z)) as f32;
                        }
                    }
                });
                told((number as f64 + ((part + 1) * batch) as f64 / points[2] as f64) / stars.len() as f64);
            }
            means.push(mean);
        }
        lattice.means = means;
        lattice
    }

    fn point(&self, x: usize, y: usize, z: usize) -> DVec3 {
        let [nx, ny, nz] = self.size.map(|n| n as f64);
        self.edges * (DVec3::new(x as f64 / nx, y as f64 / ny, z as f64 / nz) - 0.5)
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
        distance * self.mean(volume, star, point)
    }

    /// The mean density on the way, trilinear.
    fn mean(&self, volume: &Volume, star: usize, point: DVec3) -> f64 {
        let along = |axis: usize| {
            let last = self.size[axis];
            let place = ((point[axis] / self.edges[axis] + 0.5) * last as f64).clamp(0.0, last as f64);
            let low = (place as usize).min(last - 1);
            (low, place - low as f64)
        };
        let ((x, u), (y, v), (z, w)) = (along(0), along(1), along(2));
        let (nx, ny) = (self.size[0] + 1, self.size[1] + 1);
        let filled = self.means.get(star);
        let at = |x: usize, y: usize, z: usize| match filled {
            Some(means) => f64::from(means[(z * ny + y) * nx + x]),
            None => mean_density(volume, self.stars[star], self.point(x, y, z)),
        };
        let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let row = |y: usize, z: usize| mix(at(x, y, z), at(x + 1, y, z), u);
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
    use crate::numerics::streams::Stream;

    #[test]
    fn columns_of_a_lattice_tend_to_those_of_the_way_as_it_is_refined() {
        let density = (0..512).map(|i| 1.0 + (f64::from(i) * 0.01).sin() as f32).collect();
        let volume = Volume::new([8, 8, 8], DVec3::splat(2.0), density).unwrap();
        let stars = [DVec3::new(0.1, 0.2, -0.3), DVec3::new(3.0, 0.5, 0.0)]
            .map(|position| Star { position, intensity: vec![1.0] });
        let mut stream = Stream::seeded(3);
        let points: Vec<DVec3> =
            (0..500).map(|_| DVec3::new(stream.uniform(), stream.uniform(), stream.uniform()) * 2.0 - 1.0).collect();
        let mut shares = Vec::new();
        let mut worst = |spacings| {
            let lattice = Lattice::new(&volume, &stars, spacings, &mut |share| shares.push(share));
            let error = |star: usize, point: &DVec3| {
                (lattice.column(&volume, star, *point) - column(&volume, stars[star].position, *point)).abs()
            };
            points.iter().flat_map(|point| [error(0, point), error(1, point)]).fold(0.0, f64::max)
        };
        let (coarse, fine) = (worst(16), worst(64));
        assert!(fine < 5e-3 && fine < 0.25 * coarse, "{coarse} {fine}");
        assert!(shares[..16].is_sorted() && shares.last().is_some_and(|share| *share >= 1.0));
    }
}
