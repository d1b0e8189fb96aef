//! The grid as the fast renderer sees it: one voxel of margin on each side, rows of whole vectors, lengths in voxels.

use glam::{DVec3, Vec3};

use crate::physics::dust::camera::Ray;
use crate::physics::dust::volume::Volume;

/// Voxels that are worked on together.
pub(super) const LANES: usize = 8;

/// Sizes, and how places become indices.
///
/// With the margin, the centre of voxel i stands at index i + 1, and the box reaches from 0.5 to N + 0.5: no corner of a trilinear cell
/// is ever missing, and the outer half voxel is level, as [`Volume`] has it. The unit of length is the longest edge of a voxel, so that
/// f32 holds a nebula in parsecs as well as one in metres.
#[derive(Debug, Clone)]
pub(super) struct Grid {
    /// Voxels of the volume.
    pub(super) size: [usize; 3],
    /// Voxels with margin; x a multiple of [`LANES`].
    pub(super) padded: [usize; 3],
    /// The unit, in the volume's unit.
    pub(super) unit: f64,
    /// Edges of the box.
    edges: DVec3,
}

impl Grid {
    pub(super) fn new(volume: &Volume) -> Grid {
        let size = volume.size();
        let counts = DVec3::new(size[0] as f64, size[1] as f64, size[2] as f64);
        let unit = (volume.edges() / counts).max_element();
        let padded = [(size[0] + 2).next_multiple_of(LANES), size[1] + 2, size[2] + 2];
        Grid { size, padded, unit, edges: volume.edges() / unit }
    }

    /// Voxels, as numbers.
    pub(super) fn counts(&self) -> DVec3 {
        DVec3::new(self.size[0] as f64, self.size[1] as f64, self.size[2] as f64)
    }

    /// Voxels with margin.
    pub(super) fn len(&self) -> usize {
        self.padded[0] * self.padded[1] * self.padded[2]
    }

    /// A ray in units of the grid.
    pub(super) fn ray(&self, ray: &Ray) -> Ray {
        Ray { origin: ray.origin / self.unit, direction: ray.direction }
    }

    /// The index of a place.
    pub(super) fn index(&self, place: DVec3) -> DVec3 {
        (place / self.edges + 0.5) * self.counts() + 0.5
    }

    /// Indices per unit of length.
    pub(super) fn per_length(&self) -> DVec3 {
        self.counts() / self.edges
    }

    /// Longest way through the box.
    pub(super) fn diagonal(&self) -> f64 {
        self.edges.length()
    }

    /// Edges of the box.
    pub(super) fn edges(&self) -> DVec3 {
        self.edges
    }

    /// Where the centre of a padded voxel stands along an axis; that of the nearest voxel in the margin.
    pub(super) fn centre(&self, axis: usize, padded: usize) -> f64 {
        let index = padded.clamp(1, self.size[axis]) - 1;
        self.edges[axis] * ((index as f64 + 0.5) / self.size[axis] as f64 - 0.5)
    }

    /// A value for each padded voxel from one for each voxel: the margin takes that of the nearest.
    pub(super) fn pad(&self, values: &[f32]) -> Vec<f32> {
        let mut padded = Vec::with_capacity(self.len());
        let nearest = |axis: usize, index: usize| index.clamp(1, self.size[axis]) - 1;
        for z in 0..self.padded[2] {
            for y in 0..self.padded[1] {
                let row = (nearest(2, z) * self.size[1] + nearest(1, y)) * self.size[0];
                padded.extend((0..self.padded[0]).map(|x| values.get(row + nearest(0, x)).copied().unwrap_or(0.0)));
            }
        }
        padded
    }

    /// The place of an index; that of the nearest in the box outside of it.
    pub(super) fn place(&self, index: DVec3) -> DVec3 {
        let counts = self.counts();
        ((index - 0.5).clamp(DVec3::ZERO, counts) / counts - 0.5) * self.edges
    }

    /// The padded values at a place inside the box, trilinear.
    pub(super) fn at(&self, values: &[f32], place: DVec3) -> f32 {
        self.fetch(values, self.index(place).as_vec3())
    }

    /// The same at an index.
    #[inline(always)]
    fn fetch(&self, values: &[f32], index: Vec3) -> f32 {
        let along = |axis: usize| {
            let at = index[axis].clamp(0.5, self.size[axis] as f32 + 0.5);
            let low = at as u32;
            (low as usize, at - low as f32)
        };
        let ((x, u), (y, v), (z, w)) = (along(0), along(1), along(2));
        let start = (z * self.padded[1] + y) * self.padded[0] + x;
        let row = |at: usize| match values.get(at..at + 2) {
            Some([a, b]) => a + (b - a) * u,
            _ => 0.0,
        };
        let plane = |at: usize| {
            let (a, b) = (row(at), row(at + self.padded[0]));
            a + (b - a) * v
        };
        let (a, b) = (plane(start), plane(start + self.padded[0] * self.padded[1]));
        a + (b - a) * w
    }

    /// The column of padded values between two points of a ray, steps of a voxel at most.
    #[inline(always)]
    pub(super) fn column(&self, values: &[f32], ray: &Ray, (from, until): (f64, f64)) -> f32 {
        let steps = (until - from).ceil().max(1.0);
        let step = (until - from) / steps;
        let first = self.index(ray.origin + ray.direction * (from + 0.5 * step)).as_vec3();
        let way = (ray.direction * self.per_length() * step).as_vec3();
        (0..steps as usize).map(|n| self.fetch(values, first + way * n as f32)).sum::<f32>() * step as f32
    }
}
