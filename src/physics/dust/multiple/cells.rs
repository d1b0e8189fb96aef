//! The grids on which photons are followed and counted: the volume's dust averaged over cells, and the way of a straight flight through them.
//!
//! Light that has been scattered is smoother than dust: it is counted in cells that may hold several of those in which it is followed.

use glam::DVec3;

use crate::physics::dust::volume::Volume;

/// No tally is kept in this cell.
pub(super) const NONE: u32 = u32::MAX;

/// What lies on the sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sides {
    /// Empty space.
    Open,
    /// The same volume again, along x and y: a slab without end.
    Periodic,
}

/// Most cells in which photons are followed, along the longest edge, unless they are counted in more.
const FINEST: usize = 128;

/// Cells of dust; their density is the mean of the volume's trilinear one.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    /// Where photons are counted.
    pub(super) size: [usize; 3],
    pub(super) edges: DVec3,
    density: Vec<f32>,
    /// By cell: where its tally stands, or [`NONE`] far from all dust.
    pub(super) slots: Vec<u32>,
    pub(super) used: usize,
    /// Where photons are followed.
    fine_size: [usize; 3],
    fine_step: DVec3,
    fine_density: Vec<f32>,
    /// By axis and fine index: the share of the index into `slots`.
    holders: [Vec<u32>; 3],
    sides: Sides,
}

/// A part of a flight inside one cell.
#[derive(Debug, Clone, Copy)]
pub(super) struct Segment {
    pub(super) slot: u32,
    pub(super) length: f32,
    /// Density times length.
    pub(super) depth: f32,
}

impl Cells {
    /// Cells as near to cubes as the box allows, `longest` of them along its longest edge.
    pub(super) fn of(volume: &Volume, longest: usize, sides: Sides) -> Cells {
        let edges = volume.edges();
        let cell = edges.max_element() / longest as f64;
        let size = [0, 1, 2].map(|axis| ((edges[axis] / cell).round() as usize).clamp(1, longest));
        // As fine as the dust, where that is not finer than photons need.
        let finer = |axis: usize| volume.size()[axis].min(FINEST).div_ceil(size[axis]);
        let fine_size = [0, 1, 2].map(|axis| size[axis] * finer(axis));
        let strides = [1, size[0], size[0] * size[1]];
        let holders = [0, 1, 2].map(|axis| {
            (0..fine_size[axis]).map(|index| (index / finer(axis) * strides[axis]) as u32).collect::<Vec<_>>()
        });
        let fine_density = averaged(volume, fine_size);
        let density = if fine_size == size { fine_density.clone() } else { averaged(volume, size) };
        let slots = vec![NONE; density.len()];
        let fine_step = edges / DVec3::new(fine_size[0] as f64, fine_size[1] as f64, fine_size[2] as f64);
        let mut cells =
            Cells { size, edges, density, slots, used: 0, fine_size, fine_step, fine_density, holders, sides };
        cells.number();
        cells
    }

    /// Gives a slot to each cell that has dust or touches one that has: those that a look-up between centres can ask for.
    fn number(&mut self) {
        let [nx, ny, nz] = self.size;
        let near = |i: usize, n: usize| i.saturating_sub(1)..(i + 2).min(n);
        let mut wanted = vec![false; self.density.len()];
        for z in 0..nz {
            for y in 0..ny {
                for x in 0..nx {
                    if self.density[(z * ny + y) * nx + x] > 0.0 {
                        for z in near(z, nz) {
                            for y in near(y, ny) {
                                let row = (z * ny + y) * nx;
                                let along = near(x, nx);
                                wanted[row + along.start..row + along.end].fill(true);
                            }
                        }
                    }
                }
            }
        }
        for (slot, _) in self.slots.iter_mut().zip(wanted).filter(|(_, wanted)| *wanted) {
            *slot = self.used as u32;
            self.used += 1;
        }
    }

    /// Mean of extinction at density 1 along the way of a ray through the box, the cells one after another into `way`.
    ///
    /// Ends behind the density-length `enough`. Gives the distance from the origin to the box, and the density-length of all.
    pub(super) fn follow(&self, origin: DVec3, direction: DVec3, enough: f64, way: &mut Vec<Segment>) -> (f64, f64) {
        way.clear();
        let half = self.edges * 0.5;
        let along = |axis: usize| direction[axis].abs() > 1e-12;
        let inverse = direction.recip();
        // Where the ray is between both faces of each axis.
        let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            if self.sides == Sides::Periodic && axis < 2 {
                continue;
            }
            if !along(axis) {
                if origin[axis].abs() > half[axis] {
                    return (0.0, 0.0);
                }
                continue;
            }
            let (a, b) = ((-half[axis] - origin[axis]) * inverse[axis], (half[axis] - origin[axis]) * inverse[axis]);
            (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
        }
        if leave <= enter {
            return (0.0, 0.0);
        }
        let start = origin + direction * enter;
        let mut index = [0_i64; 3];
        let (mut next, mut stride, mut turn) = ([f64::INFINITY; 3], [f64::INFINITY; 3], [0_i64; 3]);
        for axis in 0..3 {
            let last = self.fine_size[axis] as i64 - 1;
            index[axis] = (((start[axis] + half[axis]) / self.fine_step[axis]).floor() as i64).clamp(0, last);
            if along(axis) {
                turn[axis] = if direction[axis] > 0.0 { 1 } else { -1 };
                stride[axis] = self.fine_step[axis] * inverse[axis].abs();
                let face = (index[axis] + i64::from(turn[axis] > 0)) as f64 * self.fine_step[axis] - half[axis];
                next[axis] = ((face - origin[axis]) * inverse[axis]).max(enter);
            }
        }
        // A slab without end has no last cell: a flight along it ends after a fixed number.
        let most = 4 * self.fine_size.iter().sum::<usize>() + 8;
        let (mut at, mut depth) = (enter, 0.0);
        for _ in 0..most {
            let axis = if next[0] < next[1] {
                if next[0] < next[2] { 0 } else { 2 }
            } else if next[1] < next[2] {
                1
            } else {
                2
            };
            let to = next[axis].min(leave);
            let length = (to - at).max(0.0);
            let [x, y, z] = index.map(|i| i as usize);
            let density_length =
                f64::from(self.fine_density[(z * self.fine_size[1] + y) * self.fine_size[0] + x]) * length;
            let slot = self.slots[(self.holders[0][x] + self.holders[1][y] + self.holders[2][z]) as usize];
            way.push(Segment { slot, length: length as f32, depth: density_length as f32 });
            depth += density_length;
            at = to;
            if to >= leave || depth > enough {
                break;
            }
            next[axis] += stride[axis];
            index[axis] += turn[axis];
            let size = self.fine_size[axis] as i64;
            if !(0..size).contains(&index[axis]) {
                if self.sides == Sides::Open || axis == 2 {
                    break;
                }
                index[axis] = index[axis].rem_euclid(size);
            }
        }
        (enter, depth)
    }

    /// Mean density of a cell, x fastest.
    pub(super) fn density(&self, cell: usize) -> f32 {
        self.density[cell]
    }

    /// A place inside the box again, where the sides are periodic.
    pub(super) fn inside(&self, mut place: DVec3) -> DVec3 {
        if self.sides == Sides::Periodic {
            for axis in 0..2 {
                let edge = self.edges[axis];
                place[axis] = (place[axis] + 0.5 * edge).rem_euclid(edge) - 0.5 * edge;
            }
        }
        place
    }
}

/// Means of the trilinear density over cells. The law between voxel centres is a product of three, so the axes are averaged one by one.
fn averaged(volume: &Volume, size: [usize; 3]) -> Vec<f32> {
    let [nx, ny, nz] = volume.size();
    let weights = [0, 1, 2].map(|axis| shares(volume.size()[axis], size[axis]));
    let along_x = reduce(volume.density(), 1, nx, ny * nz, &weights[0]);
    let along_y = reduce(&along_x, size[0], ny, nz, &weights[1]);
    reduce(&along_y, size[0] * size[1], nz, 1, &weights[2])
}

/// Averages blocks of `count` rows of `row` numbers, `blocks` times, into `weights.len()` rows.
fn reduce(numbers: &[f32], row: usize, count: usize, blocks: usize, weights: &[Vec<(usize, f32)>]) -> Vec<f32> {
    let mut out = vec![0.0; row * weights.len() * blocks];
    for (block, out) in out.chunks_exact_mut(row * weights.len()).enumerate() {
        for (out, weights) in out.chunks_exact_mut(row).zip(weights) {
            for &(index, weight) in weights {
                let from = (block * count + index) * row;
                for (out, number) in out.iter_mut().zip(&numbers[from..from + row]) {
                    *out += weight * number;
                }
            }
        }
    }
    out
}

/// For each of `cells` along an axis, the voxels of `voxels` that its mean takes and their shares.
///
/// Between two voxel centres the density is linear, so that the mean over each piece between them is the value in its middle.
fn shares(voxels: usize, cells: usize) -> Vec<Vec<(usize, f32)>> {
    let last = voxels - 1;
    let (length, mut all) = (voxels as f64 / cells as f64, Vec::with_capacity(cells));
    for cell in 0..cells {
        let (mut from, end) = (cell as f64 * length, (cell + 1) as f64 * length);
        let mut sums: Vec<(usize, f64)> = Vec::new();
        while from < end {
            let to = ((from + 0.5).floor() + 0.5).min(end);
            let place = (0.5 * (from + to) - 0.5).clamp(0.0, last as f64);
            let low = (place as usize).min(last);
            let (above, part) = (place - low as f64, (to - from) / length);
            for (index, share) in [(low, (1.0 - above) * part), ((low + 1).min(last), above * part)] {
                match sums.iter_mut().find(|(there, _)| *there == index) {
                    Some((_, sum)) => *sum += share,
                    None => sums.push((index, share)),
                }
            }
            from = to;
        }
        all.push(
            sums.into_iter().map(|(index, share)| (index, share as f32)).filter(|(_, share)| *share > 0.0).collect(),
        );
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume(size: [usize; 3], density: impl Fn(usize) -> f32) -> Volume {
        Volume::new(size, DVec3::splat(2.0), (0..size[0] * size[1] * size[2]).map(density).collect()).unwrap()
    }

    #[test]
    fn cells_hold_as_much_dust_as_the_volume() {
        // 3/4 of a voxel and 1/8 of each neighbour is the mean of a trilinear density over the voxel itself.
        let one = volume([5, 5, 5], |i| f32::from(i == 62));
        let cells = Cells::of(&one, 5, Sides::Open);
        assert!((cells.density[62] - 0.421_875).abs() < 1e-6 && (cells.density[61] - 0.070_312_5).abs() < 1e-6);
        for longest in [2, 5, 10, 13] {
            let cells = Cells::of(&one, longest, Sides::Open);
            let mass: f64 = cells.density.iter().map(|d| f64::from(*d)).sum::<f64>() / cells.density.len() as f64;
            assert!((mass - 1.0 / 125.0).abs() < 1e-8, "{longest}: {mass}");
        }
    }

    #[test]
    fn a_way_is_as_long_as_its_chord_and_gathers_what_lies_on_it() {
        let cells = Cells::of(&volume([7, 7, 7], |_| 3.0), 7, Sides::Open);
        let mut way = Vec::new();
        for (origin, direction, chord) in [
            (DVec3::new(0.0, 0.0, 5.0), -DVec3::Z, 2.0),
            (DVec3::new(-1.0, -1.0, -1.0), DVec3::ONE.normalize(), 12.0_f64.sqrt()),
            (DVec3::new(0.3, -0.2, 0.9), DVec3::new(0.6, 0.0, 0.8), 0.125),
            (DVec3::new(0.0, 3.0, 0.0), DVec3::X, 0.0),
            (DVec3::new(0.0, 3.0, 0.0), DVec3::Y, 0.0),
        ] {
            let (_, depth) = cells.follow(origin, direction, f64::INFINITY, &mut way);
            let length: f64 = way.iter().map(|s| f64::from(s.length)).sum();
            assert!((length - chord).abs() < 1e-6 && (depth - 3.0 * chord).abs() < 1e-6, "{origin} {direction}");
        }
    }

    #[test]
    fn cells_far_from_all_dust_have_no_tally() {
        let cells = Cells::of(&volume([16, 16, 16], |i| f32::from(i == 0)), 16, Sides::Open);
        assert_eq!(cells.used, 27, "the corner's cell and the one beside it hold dust, and all that touch these");
    }
}
