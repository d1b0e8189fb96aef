//! The cells of a grid along a ray. A cell lies between neighbouring voxel centres (at the box's faces, between a centre and the face);
//! in it the density is trilinear, so that along a line it is a cubic.

use crate::physics::dust::camera::Ray;
use crate::physics::dust::volume::Volume;

/// A piece of a ray in one cell.
#[derive(Debug, Clone, Copy)]
pub struct Cell {
    /// Where it begins, distance from the ray's origin.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Density, powers 0 to 3 of the distance from `from`.
    pub cubic: [f64; 4],
}

impl Cell {
    /// How long it is.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.to - self.from
    }

    /// The density at a distance from its beginning. Not below zero, which rounding could make it.
    #[must_use]
    #[inline]
    pub fn density(&self, s: f64) -> f64 {
        let [a, b, c, d] = self.cubic;
        (a + s * (b + s * (c + s * d))).max(0.0)
    }

    /// The column from its beginning to a distance from it.
    #[must_use]
    #[inline]
    pub fn column(&self, s: f64) -> f64 {
        let [a, b, c, d] = self.cubic;
        (s * (a + s * (b / 2.0 + s * (c / 3.0 + s * (d / 4.0))))).max(0.0)
    }

    /// Whether there is no dust in it.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.cubic == [0.0; 4]
    }
}

/// The part of a ray between two distances that is in the box, if any.
#[must_use]
pub fn inside(volume: &Volume, ray: &Ray, from: f64, to: f64) -> Option<(f64, f64)> {
    let half = volume.edges() * 0.5;
    let (mut near, mut far) = (from, to);
    for axis in 0..3 {
        let (at, along) = (ray.origin[axis], ray.direction[axis]);
        if along == 0.0 {
            if at.abs() > half[axis] {
                return None;
            }
            continue;
        }
        let (a, b) = ((-half[axis] - at) / along, (half[axis] - at) / along);
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    (near < far).then_some((near, far))
}

/// One axis of a walk, in voxels: voxel centres are whole numbers.
#[derive(Clone, Copy, Default)]
struct Axis {
    /// The cell: it lies between centre `cell` and the next; -1 and last are the outer halves.
    cell: i64,
    last: i64,
    stride: usize,
    origin: f64,
    slope: f64,
    /// Distance along the ray where the cell ends.
    next: f64,
}

impl Axis {
    fn new(volume: &Volume, ray: &Ray, axis: usize, start: f64, stride: usize) -> Axis {
        let size = volume.size()[axis] as f64;
        let scale = size / volume.edges()[axis];
        let origin = ray.origin[axis] * scale + size / 2.0 - 0.5;
        let slope = ray.direction[axis] * scale;
        let last = volume.size()[axis] as i64 - 1;
        let place = origin + slope * start;
        // On a border the cell ahead is taken.
        let cell = if slope < 0.0 { place.ceil() as i64 - 1 } else { place.floor() as i64 };
        let mut new = Axis { cell: cell.clamp(-1, last), last, stride, origin, slope, next: 0.0 };
        new.aim();
        new
    }

    /// Sets where the cell ends.
    fn aim(&mut self) {
        let border = if self.slope > 0.0 { self.cell + 1 } else { self.cell };
        let ends = self.slope == 0.0 || border < 0 || border > self.last;
        self.next = if ends { f64::INFINITY } else { (border as f64 - self.origin) / self.slope };
    }

    fn step(&mut self) {
        self.cell += if self.slope > 0.0 { 1 } else { -1 };
        self.aim();
    }

    /// Offsets of the two centres, and the place between them and its slope; level in the outer halves.
    #[inline]
    fn between(&self, at: f64) -> (usize, usize, f64, f64) {
        let low = self.cell.clamp(0, self.last) as usize;
        let high = (self.cell + 1).clamp(0, self.last) as usize;
        if low == high {
            (low * self.stride, high * self.stride, 0.0, 0.0)
        } else {
            (low * self.stride, high * self.stride, self.origin + self.slope * at - self.cell as f64, self.slope)
        }
    }
}

/// Visits the cells of a ray between two distances, in order, until the visitor says that it has seen enough (false).
pub fn walk(volume: &Volume, ray: &Ray, from: f64, to: f64, mut visit: impl FnMut(&Cell) -> bool) {
    let Some((start, end)) = inside(volume, ray, from, to) else { return };
    let [nx, ny, _] = volume.size();
    let strides = [1, nx, nx * ny];
    let mut axes: [Axis; 3] = std::array::from_fn(|axis| Axis::new(volume, ray, axis, start, strides[axis]));
    let density = volume.density();
    let mut at = start;
    loop {
        let nearest = if axes[0].next <= axes[1].next { 0 } else { 1 };
        let nearest = if axes[nearest].next <= axes[2].next { nearest } else { 2 };
        let next = axes[nearest].next.min(end);
        if next > at {
            let cell = Cell { from: at, to: next, cubic: cubic(density, &axes, at) };
            if !visit(&cell) {
                return;
            }
            at = next;
        }
        if axes[nearest].next >= end {
            return;
        }
        axes[nearest].step();
    }
}

/// The density along a ray in a cell, powers of the distance from `at`.
#[inline]
fn cubic(density: &[f32], axes: &[Axis; 3], at: f64) -> [f64; 4] {
    let (x0, x1, u, du) = axes[0].between(at);
    let (y0, y1, v, dv) = axes[1].between(at);
    let (z0, z1, w, dw) = axes[2].between(at);
    let value = |x: usize, y: usize, z: usize| f64::from(density[x + y + z]);
    let corners = [
        value(x0, y0, z0),
        value(x1, y0, z0),
        value(x0, y1, z0),
        value(x1, y1, z0),
        value(x0, y0, z1),
        value(x1, y0, z1),
        value(x0, y1, z1),
        value(x1, y1, z1),
    ];
    if corners == [0.0; 8] {
        return [0.0; 4];
    }
    // Along x: four linear functions of the distance; then along y, then along z.
    let lines: [[f64; 2]; 4] = std::array::from_fn(|i| {
        let (low, rise) = (corners[2 * i], corners[2 * i + 1] - corners[2 * i]);
        [low + rise * u, rise * du]
    });
    let planes: [[f64; 3]; 2] = std::array::from_fn(|i| {
        let (low, high) = (lines[2 * i], lines[2 * i + 1]);
        let rise = [high[0] - low[0], high[1] - low[1]];
        [low[0] + rise[0] * v, low[1] + rise[1] * v + rise[0] * dv, rise[1] * dv]
    });
    let rise = [planes[1][0] - planes[0][0], planes[1][1] - planes[0][1], planes[1][2] - planes[0][2]];
    [
        planes[0][0] + rise[0] * w,
        planes[0][1] + rise[1] * w + rise[0] * dw,
        planes[0][2] + rise[2] * w + rise[1] * dw,
        rise[2] * dw,
    ]
}
