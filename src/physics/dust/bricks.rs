//! What is in each small cube of a volume: the least and the most dust, so that what is empty can be passed over by a bound.

use glam::DVec3;
use rayon::prelude::*;

use super::camera::Ray;
use super::volume::Volume;

/// Voxels along the side of a brick: 8^3 of f32 are 2 KiB, and a ray through 128^3 meets 16 to 48 bricks.
pub const SIDE: usize = 8;

/// The least and the most density that the trilinear dust has anywhere in a brick.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// No less anywhere in it.
    pub least: f32,
    /// No more anywhere in it.
    pub most: f32,
}

/// The bricks of a volume: brick (i, j, k) is the part of the box from voxel edge 8 i to 8 i + 8 along x, and so on; the last ones
/// along an axis may be shorter.
///
/// A trilinear density between two centres lies between theirs, so that the range over a brick's voxels and those one beyond its
/// faces is a bound for every point in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Bricks {
    count: [usize; 3],
    voxels: [usize; 3],
    edges: DVec3,
    ranges: Vec<Range>,
}

impl Bricks {
    /// The bricks of a volume. In parallel, the same for any number of threads.
    #[must_use]
    pub fn of(volume: &Volume) -> Bricks {
        let voxels = volume.size();
        let count = voxels.map(|side| side.div_ceil(SIDE));
        let density = volume.density();
        // One voxel beyond each face.
        let reach = |brick: usize, side: usize| (brick * SIDE).saturating_sub(1)..(brick * SIDE + SIDE + 1).min(side);
        let ranges = (0..count[1] * count[2])
            .into_par_iter()
            .flat_map_iter(|row| {
                let (j, k) = (row % count[1], row / count[1]);
                let mut along = vec![Range { least: f32::INFINITY, most: 0.0 }; count[0]];
                for z in reach(k, voxels[2]) {
                    for y in reach(j, voxels[1]) {
                        let line = &density[(z * voxels[1] + y) * voxels[0]..][..voxels[0]];
                        for (i, range) in along.iter_mut().enumerate() {
                            for value in &line[reach(i, voxels[0])] {
                                range.least = range.least.min(*value);
                                range.most = range.most.max(*value);
                            }
                        }
                    }
                }
                along
            })
            .collect();
        Bricks { count, voxels, edges: volume.edges(), ranges }
    }

    /// Bricks along x, y, z.
    #[must_use]
    pub fn count(&self) -> [usize; 3] {
        self.count
    }

    /// The range of a brick.
    #[must_use]
    pub fn range(&self, i: usize, j: usize, k: usize) -> Range {
        self.ranges[(k * self.count[1] + j) * self.count[0] + i]
    }

    /// Ranges of all bricks, x fastest, then y, then z.
    #[must_use]
    pub fn ranges(&self) -> &[Range] {
        &self.ranges
    }

    /// Share of the bricks that hold no dust at all.
    #[must_use]
    pub fn empty_share(&self) -> f64 {
        self.ranges.iter().filter(|range| range.most == 0.0).count() as f64 / self.ranges.len() as f64
    }

    /// The bricks that a ray passes between two distances from its origin, in their order. Neighbouring empty ones are one stretch.
    #[must_use]
    pub fn along(&self, ray: &Ray, near: f64, far: f64) -> Walk<'_> {
        let start = crossing(self.edges, ray).map(|(from, to)| (from.max(near), to.min(far))).filter(|(f, t)| f < t);
        let (from, end) = start.unwrap_or((0.0, 0.0));
        let mut walk =
            Walk { bricks: self, from, end, brick: [0; 3], next: [f64::INFINITY; 3], step: [0.0; 3], up: [true; 3] };
        if start.is_none() {
            return walk;
        }
        let inside = ray.origin + ray.direction * from;
        for axis in 0..3 {
            let side = SIDE as f64 * self.edges[axis] / self.voxels[axis] as f64;
            let along = ray.direction[axis];
            // The cast saturates; a point on the upper face belongs to the last brick.
            let place = ((inside[axis] + 0.5 * self.edges[axis]) / side) as usize;
            walk.brick[axis] = place.min(self.count[axis] - 1);
            walk.up[axis] = along > 0.0;
            if along != 0.0 {
                let face = (walk.brick[axis] + usize::from(walk.up[axis])) as f64 * side - 0.5 * self.edges[axis];
                walk.next[axis] = (face - ray.origin[axis]) / along;
                walk.step[axis] = side / along.abs();
            }
        }
        walk
    }
}

/// Where a ray enters and leaves a box of these edges with its centre in the origin; negative before the ray's own origin.
/// Nothing for a ray that misses it.
#[must_use]
pub fn crossing(edges: DVec3, ray: &Ray) -> Option<(f64, f64)> {
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    for axis in 0..3 {
        let (place, along, half) = (ray.origin[axis], ray.direction[axis], 0.5 * edges[axis]);
        if along == 0.0 {
            // Along a face is inside, as for the density.
            if place.abs() <= half { continue } else { return None }
        }
        let (one, other) = ((-half - place) / along, (half - place) / along);
        enter = enter.max(one.min(other));
        leave = leave.min(one.max(other));
    }
    (enter < leave && enter.is_finite() && leave.is_finite()).then_some((enter, leave))
}

/// A part of a ray, and what dust can be on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// Distance from the ray's origin at which it begins.
    pub from: f64,
    /// Distance at which it ends.
    pub to: f64,
    /// What dust can be on it.
    pub range: Range,
}

/// The bricks that a ray passes.
#[derive(Debug, Clone)]
pub struct Walk<'a> {
    bricks: &'a Bricks,
    from: f64,
    end: f64,
    brick: [usize; 3],
    /// Distances at which the next face across each axis is met.
    next: [f64; 3],
    /// From one face across an axis to the next.
    step: [f64; 3],
    up: [bool; 3],
}

impl Walk<'_> {
    /// Goes through one face; false at the end of the volume.
    fn advance(&mut self, axis: usize) -> bool {
        self.next[axis] += self.step[axis];
        let beyond = if self.up[axis] { self.brick[axis].checked_add(1) } else { self.brick[axis].checked_sub(1) };
        match beyond.filter(|brick| *brick < self.bricks.count[axis]) {
            Some(brick) => {
                self.brick[axis] = brick;
                true
            }
            None => false,
        }
    }
}

impl Iterator for Walk<'_> {
    type Item = Stretch;

    fn next(&mut self) -> Option<Stretch> {
        let mut empty = None;
        while self.from < self.end {
            let [i, j, k] = self.brick;
            let range = self.bricks.range(i, j, k);
            if empty.is_some() && range.most > 0.0 {
                return empty;
            }
            let [x, y, z] = self.next;
            let axis = if x <= y && x <= z {
                0
            } else if y <= z {
                1
            } else {
                2
            };
            let (from, to) = (self.from, self.next[axis].min(self.end));
            if !self.advance(axis) {
                // Rounding may leave the last brick a hair before the box ends.
                self.from = self.end;
            } else {
                self.from = to.max(from);
            }
            let to = if self.from == self.end { self.end } else { to };
            if to <= from {
                continue;
            }
            if range.most > 0.0 {
                return Some(Stretch { from, to, range });
            }
            empty = Some(Stretch { from: empty.map_or(from, |before: Stretch| before.from), to, range });
        }
        empty
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Half of it empty, the rest different everywhere.
    fn some(size: [usize; 3], edges: DVec3) -> Volume {
        let values = (0..size[0] * size[1] * size[2]).map(|i| ((i * 7919) % 64).saturating_sub(40) as f32);
        Volume::new(size, edges, values.collect()).unwrap()
    }

    #[test]
    fn a_voxel_shows_in_its_own_brick_and_in_the_next_one_that_it_reaches_into() {
        let mut density = vec![0.0; 24 * 8 * 8];
        density[8] = 2.0;
        let bricks = Bricks::of(&Volume::new([24, 8, 8], DVec3::new(3.0, 1.0, 1.0), density).unwrap());
        let most = |i| bricks.range(i, 0, 0).most;
        assert_eq!((bricks.count(), most(0), most(1), most(2)), ([3, 1, 1], 2.0, 2.0, 0.0));
        assert!((bricks.empty_share() - 1.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_ray_along_an_axis_passes_every_brick_of_its_row_once_and_empty_ones_are_joined() {
        let mut density = vec![0.0; 32];
        density[31] = 1.0;
        let bricks = Bricks::of(&Volume::new([32, 1, 1], DVec3::new(32.0, 1.0, 1.0), density).unwrap());
        let ray = Ray { origin: DVec3::new(-20.0, 0.0, 0.0), direction: DVec3::X };
        let passed: Vec<_> = bricks.along(&ray, 0.0, 1e9).map(|s| (s.from, s.to, s.range.most)).collect();
        assert_eq!(passed, [(4.0, 28.0, 0.0), (28.0, 36.0, 1.0)]);
        let back = Ray { origin: DVec3::new(20.0, 0.0, 0.0), direction: -DVec3::X };
        let passed: Vec<_> = bricks.along(&back, 6.0, 30.0).map(|s| (s.from, s.to)).collect();
        assert_eq!(passed, [(6.0, 12.0), (12.0, 30.0)]);
        let beside = Ray { origin: DVec3::new(-20.0, 0.6, 0.0), direction: DVec3::X };
        assert_eq!(bricks.along(&beside, 0.0, 1e9).count(), 0);
    }

    proptest! {
        #[test]
        fn stretches_fill_the_way_through_the_box_and_hold_all_its_dust(
            origin in prop::array::uniform3(-2.0f64..2.0), aim in prop::array::uniform3(-1.0f64..1.0), axis in 0usize..5,
        ) {
            let volume = some([19, 8, 30], DVec3::new(1.0, 0.7, 2.0));
            let bricks = Bricks::of(&volume);
            let mut direction = DVec3::from_array(aim);
            if axis < 3 {
                direction[axis] = 0.0;
            }
            prop_assume!(direction.length() > 1e-3);
            let ray = Ray { origin: DVec3::from_array(origin), direction: direction.normalize() };
            let passed: Vec<_> = bricks.along(&ray, 0.0, f64::INFINITY).collect();
            let whole = crossing(volume.edges(), &ray).map(|(from, to)| (from.max(0.0), to)).filter(|(from, to)| from < to);
            prop_assert_eq!(passed.first().map(|s| s.from), whole.map(|w| w.0));
            prop_assert_eq!(passed.last().map(|s| s.to), whole.map(|w| w.1));
            for pair in passed.windows(2) {
                prop_assert_eq!(pair[0].to, pair[1].from);
                prop_assert!(pair[0].range.most > 0.0 || pair[1].range.most > 0.0);
            }
            for stretch in &passed {
                for step in 0..8 {
                    let t = stretch.from + (stretch.to - stretch.from) * (f64::from(step) + 0.5) / 8.0;
                    let density = volume.at(ray.origin + ray.direction * t);
                    prop_assert!(density >= f64::from(stretch.range.least) - 1e-6, "{} at {}", density, t);
                    prop_assert!(density <= f64::from(stretch.range.most) + 1e-6, "{} at {}", density, t);
                }
            }
        }
    }
}
