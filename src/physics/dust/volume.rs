//! Dust on a grid of voxels: densities at the voxels' centres, trilinear between them, nothing outside the box.

use glam::DVec3;

use crate::numerics::hash::mixed;

/// Gas that glows in the dust.
pub mod gas;
/// Nebulae made by a recipe.
pub mod generate;
/// Perlin's noise.
pub mod noise;
/// Planes: cut at an index, or summed along an axis.
pub mod slice;
/// What a volume holds, in numbers.
pub mod statistics;

/// Longest side of a grid, voxels.
pub const LONGEST_SIDE: usize = 1024;

/// Why a grid was refused.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum VolumeError {
    /// No voxels, or more than a side may have.
    #[error("a volume of {0} x {1} x {2} voxels: each side has 1 to 1024")]
    Size(usize, usize, usize),
    /// Sides that are no lengths.
    #[error("a box of {0} x {1} x {2}: each edge is a length above 0")]
    Edges(f64, f64, f64),
    /// Fewer or more numbers than voxels.
    #[error("{there} densities for {needed} voxels")]
    Count {
        /// Voxels.
        needed: usize,
        /// Numbers.
        there: usize,
    },
    /// A density that no dust has.
    #[error("the density at x {x}, y {y}, z {z} is {value}: dust is a number of 0 or more; mend the file or clip it")]
    Density {
        /// Index along x.
        x: usize,
        /// Index along y.
        y: usize,
        /// Index along z.
        z: usize,
        /// What stands there.
        value: f32,
    },
}

/// A box of dust with its centre in the origin. Densities are f32: the eye sees steps of 1 %, and 512^3 of them are 512 MiB.
///
/// Index 0 is at -x, -y, -z; x runs fastest. A voxel's centre is at -edge/2 + edge (i + 1/2)/N. Between the centres the density is
/// trilinear, in the outer half voxel that of the nearest centre, outside the box zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Volume {
    size: [usize; 3],
    edges: DVec3,
    density: Vec<f32>,
}

impl Volume {
    /// A volume of x, y, z voxels in a box of these edges, any unit of length; densities relative, x fastest, then y, then z.
    ///
    /// # Errors
    /// Sizes, edges or densities that no dust has, with index and value.
    pub fn new(size: [usize; 3], edges: DVec3, density: Vec<f32>) -> Result<Volume, VolumeError> {
        let needed = Volume::voxels(size, edges)?;
        if density.len() != needed {
            return Err(VolumeError::Count { needed, there: density.len() });
        }
        if let Some(index) = density.iter().position(|d| !(d.is_finite() && *d >= 0.0)) {
            let (x, rest) = (index % size[0], index / size[0]);
            return Err(VolumeError::Density { x, y: rest % size[1], z: rest / size[1], value: density[index] });
        }
        Ok(Volume { size, edges, density })
    }

    /// How many voxels a volume of this size has, judged before memory is asked for.
    ///
    /// # Errors
    /// Sizes or edges that no volume has.
    pub fn voxels(size: [usize; 3], edges: DVec3) -> Result<usize, VolumeError> {
        if size.iter().any(|n| !(1..=LONGEST_SIDE).contains(n)) {
            return Err(VolumeError::Size(size[0], size[1], size[2]));
        }
        if !(edges.is_finite() && edges.min_element() > 0.0) {
            return Err(VolumeError::Edges(edges.x, edges.y, edges.z));
        }
        Ok(size[0] * size[1] * size[2])
    }

    /// Voxels along x, y, z.
    #[must_use]
    pub fn size(&self) -> [usize; 3] {
        self.size
    }

    /// Edges of the box, its centre in the origin.
    #[must_use]
    pub fn edges(&self) -> DVec3 {
        self.edges
    }

    /// Edges of one voxel.
    #[must_use]
    pub fn voxel(&self) -> DVec3 {
        self.edges / DVec3::new(self.size[0] as f64, self.size[1] as f64, self.size[2] as f64)
    }

    /// All densities, x fastest, then y, then z.
    #[must_use]
    pub fn density(&self) -> &[f32] {
        &self.density
    }

    /// A number that stands for all that is in it: volumes with different sides, edges or dust have different ones but for a chance of 1 in 2^64.
    #[must_use]
    pub fn digest(&self) -> u64 {
        let sides = self.size.iter().map(|side| *side as u64);
        let edges = self.edges.to_array().map(f64::to_bits);
        let head = sides.chain(edges).fold(0, mixed);
        // +0 and -0 are the same dust.
        self.density.iter().fold(head, |hash, density| mixed(hash, u64::from((density + 0.0).to_bits())))
    }

    /// Where the centre of a voxel is.
    #[must_use]
    pub fn centre(&self, x: usize, y: usize, z: usize) -> DVec3 {
        let index = DVec3::new(x as f64, y as f64, z as f64);
        let size = DVec3::new(self.size[0] as f64, self.size[1] as f64, self.size[2] as f64);
        self.edges * ((index + 0.5) / size - 0.5)
    }

    /// The density at a point.
    #[must_use]
    pub fn at(&self, point: DVec3) -> f64 {
        if !(point.abs().cmple(self.edges * 0.5)).all() {
            return 0.0;
        }
        let along = |axis: usize| {
            let last = self.size[axis] - 1;
            let place = ((point[axis] / self.edges[axis] + 0.5) * self.size[axis] as f64 - 0.5).clamp(0.0, last as f64);
            let low = (place as usize).min(last);
            (low, (low + 1).min(last), place - low as f64)
        };
        let ((x0, x1, u), (y0, y1, v), (z0, z1, w)) = (along(0), along(1), along(2));
        let value = |x: usize, y: usize, z: usize| f64::from(self.density[(z * self.size[1] + y) * self.size[0] + x]);
        let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
        let row = |y: usize, z: usize| mix(value(x0, y, z), value(x1, y, z), u);
        mix(mix(row(y0, z0), row(y1, z0), v), mix(row(y0, z1), row(y1, z1), v), w)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_density_that_no_dust_has_is_refused_by_index() {
        let grid = |value| Volume::new([2, 2, 2], DVec3::splat(2.0), vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, value, 0.0]);
        for value in [f32::NAN, -1.0, f32::INFINITY] {
            let told = grid(value).unwrap_err().to_string();
            assert!(told.contains("x 0, y 1, z 1"), "{told}");
        }
        assert_eq!(grid(3.0).unwrap().at(DVec3::new(-0.5, 0.5, 0.5)), 3.0);
    }

    #[test]
    fn a_digest_tells_volumes_apart_by_dust_sides_and_edges() {
        let of =
            |size, edge, density: [f32; 4]| Volume::new(size, DVec3::splat(edge), density.to_vec()).unwrap().digest();
        let one = of([2, 2, 1], 2.0, [0.0, 1.0, 2.0, 3.0]);
        assert_eq!(one, of([2, 2, 1], 2.0, [-0.0, 1.0, 2.0, 3.0]));
        let others = [
            of([2, 2, 1], 2.0, [0.0, 1.0, 3.0, 2.0]),
            of([2, 2, 1], 2.0, [0.0, 1.0, 2.0, 3.000_000_2]),
            of([4, 1, 1], 2.0, [0.0, 1.0, 2.0, 3.0]),
            of([2, 2, 1], 2.5, [0.0, 1.0, 2.0, 3.0]),
        ];
        assert!(others.iter().all(|other| *other != one), "{one} {others:?}");
    }

    #[test]
    fn density_is_linear_between_centres_level_in_the_outer_half_voxel_and_zero_outside() {
        let volume = Volume::new([2, 1, 1], DVec3::splat(2.0), vec![1.0, 3.0]).unwrap();
        let at = |x| volume.at(DVec3::new(x, 0.3, -0.9));
        assert_eq!((at(-1.0), at(-0.5), at(0.0), at(0.25), at(0.9)), (1.0, 1.0, 2.0, 2.5, 3.0));
        assert_eq!((at(1.001), volume.at(DVec3::new(0.0, 1.1, 0.0))), (0.0, 0.0));
        assert_eq!(volume.centre(1, 0, 0), DVec3::new(0.5, 0.0, 0.0));
    }
}
