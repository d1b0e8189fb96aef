//! The kernel: one ray through one stretch of shaded cells, eight samples at a time.
//!
//! A cell holds the light that leaves it towards the eye (three bands) and its density, 16 bytes. Two neighbours along x are one load
//! of 32 bytes, so that a sample is four loads, not 32.

use super::grid::LANES;

/// Numbers in a cell.
pub(super) const CELL: usize = 4;

/// Above this optical depth of a step the exponential is taken whole.
const THIN: f32 = 0.25;

/// Shaded cells and how far apart their rows and planes are, in cells.
#[derive(Clone, Copy)]
pub(super) struct Cells<'a> {
    pub(super) values: &'a [[f32; CELL]],
    pub(super) row: usize,
    pub(super) plane: usize,
}

/// A ray in indices, and what it has gathered so far.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Traveller {
    /// Index where it begins.
    pub(super) origin: [f32; 3],
    /// Indices travelled per unit of length.
    pub(super) step: [f32; 3],
    /// Light gathered.
    pub(super) light: [f32; CELL],
    /// Share of the light behind that comes through.
    pub(super) through: [f32; CELL],
}

/// A stretch of a ray.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    /// Where it begins.
    pub(super) from: f32,
    /// Length of a step.
    pub(super) step: f32,
    /// Steps.
    pub(super) steps: usize,
    /// Largest density met.
    pub(super) densest: f32,
}

#[inline(always)]
fn fused<const FUSED: bool>(a: f32, b: f32, c: f32) -> f32 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

/// 1 - e^-x without loss of digits: three doublings of a = 1 - e^(-x/8) by a (2 - a).
#[inline(always)]
fn lost<const FUSED: bool>(x: f32) -> f32 {
    let y = (x * 0.125).min(8.0);
    let series = fused::<FUSED>(
        fused::<FUSED>(fused::<FUSED>(fused::<FUSED>(-1.0 / 120.0, y, 1.0 / 24.0), -y, 1.0 / 6.0), y, -0.5),
        y,
        1.0,
    );
    let mut a = y * series;
    for _ in 0..3 {
        a = a * (2.0 - a);
    }
    a
}

/// The same for x of at most [`THIN`]: five terms.
#[inline(always)]
fn lost_thin<const FUSED: bool>(x: f32) -> f32 {
    let inner = fused::<FUSED>(x, 1.0 / 24.0, -1.0 / 6.0);
    x * fused::<FUSED>(x, fused::<FUSED>(x, -inner, -0.5), 1.0)
}

/// Takes a ray through a stretch. `extinction` is per unit of length and density, one number a band, the last 0.
#[inline(always)]
pub(super) fn through<const FUSED: bool>(
    cells: Cells<'_>,
    traveller: &mut Traveller,
    stretch: Stretch,
    extinction: [f32; CELL],
) {
    let depth = extinction.map(|k| k * stretch.step);
    let thin = depth.iter().fold(0.0f32, |a, b| a.max(*b)) * stretch.densest <= THIN;
    if thin {
        samples::<FUSED, true>(cells, traveller, stretch, depth);
    } else {
        samples::<FUSED, false>(cells, traveller, stretch, depth);
    }
}

#[inline(always)]
fn samples<const FUSED: bool, const IS_THIN: bool>(
    cells: Cells<'_>,
    traveller: &mut Traveller,
    stretch: Stretch,
    depth: [f32; CELL],
) {
    /// Adding 2^23 leaves the nearest integer in the last bits of an f32.
    const MAGIC: f32 = 8_388_608.0;
    let (mut light, mut left) = (traveller.light, traveller.through);
    let mut done = 0;
    while done < stretch.steps {
        let mut base = [0u32; LANES];
        let mut across = [0.0f32; LANES];
        let mut weights = [[0.0f32; LANES]; 4];
        for k in 0..LANES {
            let t = fused::<FUSED>((done + k) as f32 + 0.5, stretch.step, stretch.from);
            let place = |axis: usize| fused::<FUSED>(t, traveller.step[axis], traveller.origin[axis]);
            let floor = |x: f32| x - 0.5 + MAGIC;
            let (x, y, z) = (place(0), place(1), place(2));
            let (i, j, l) = (floor(x), floor(y), floor(z));
            let index = |f: f32| f.to_bits().wrapping_sub(MAGIC.to_bits());
            base[k] = index(i)
                .wrapping_add(index(j).wrapping_mul(cells.row as u32))
                .wrapping_add(index(l).wrapping_mul(cells.plane as u32));
            across[k] = x - (i - MAGIC);
            let (v, w) = (y - (j - MAGIC), z - (l - MAGIC));
            weights[3][k] = v * w;
            weights[2][k] = w - v * w;
            weights[1][k] = v - v * w;
            weights[0][k] = 1.0 - v - w + v * w;
        }
        let now = (stretch.steps - done).min(LANES);
        let mut met = [[0.0f32; CELL]; LANES];
        let mut taken = [[0.0f32; CELL]; LANES];
        for k in 0..now {
            let at = base[k] as usize;
            let corners = [at, at + cells.row, at + cells.plane, at + cells.plane + cells.row];
            let mut both = [[0.0f32; CELL]; 2];
            for (corner, weight) in corners.into_iter().zip(weights) {
                let (Some(second), Some(first)) = (cells.values.get(corner + 1), cells.values.get(corner)) else {
                    continue;
                };
                for n in 0..CELL {
                    both[0][n] = fused::<FUSED>(first[n], weight[k], both[0][n]);
                    both[1][n] = fused::<FUSED>(second[n], weight[k], both[1][n]);
                }
            }
            for n in 0..CELL {
                met[k][n] = fused::<FUSED>(across[k], both[1][n] - both[0][n], both[0][n]);
            }
            for n in 0..CELL {
                let x = depth[n] * met[k][CELL - 1];
                taken[k][n] = if IS_THIN { lost_thin::<FUSED>(x) } else { lost::<FUSED>(x) };
            }
        }
        for k in 0..now {
            for n in 0..CELL {
                let taken = taken[k][n] * left[n];
                light[n] = fused::<FUSED>(taken, met[k][n], light[n]);
                left[n] -= taken;
            }
        }
        done += LANES;
    }
    traveller.light = light;
    traveller.through = left;
}
