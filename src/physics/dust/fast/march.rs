//! The kernel: one ray through one stretch of shaded cells, eight samples at a time.
//!
//! A cell holds the light that leaves it towards the eye (three bands) and its density, 8 bytes. Two neighbours along x are one load
//! of 16 bytes, so that a sample is four loads, not 32.

use super::approximate::fused;
use super::grid::LANES;
use super::half;

/// The kernel for processors with AVX2.
#[cfg(target_arch = "x86_64")]
pub(super) mod wide;

/// Numbers in a cell.
pub(super) const CELL: usize = 4;

/// Light of three bands towards the eye and density, from the lowest bits on: numbers of 16 bits, brought to their range.
pub(super) type Cell = u64;

/// The bits of a cell that hold its density.
pub(super) const DENSITY: Cell = 0xffff << (16 * (CELL - 1));

/// Above this optical depth of a step the exponential is taken whole.
const THIN: f32 = 0.25;

/// Shaded cells and how far apart their rows and planes are, in cells.
#[derive(Clone, Copy)]
pub(super) struct Cells<'a> {
    pub(super) values: &'a [Cell],
    pub(super) row: u32,
    pub(super) plane: u32,
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

impl Stretch {
    /// Optical depths of a step at density 1, and whether that of each step is small.
    #[inline(always)]
    fn depth(&self, extinction: [f32; CELL]) -> ([f32; CELL], bool) {
        let depth = extinction.map(|k| k * self.step);
        (depth, depth.iter().fold(0.0f32, |a, b| a.max(*b)) * self.densest <= THIN)
    }
}

/// Eight samples in a row.
struct Places {
    /// The first cell of each.
    base: [u32; LANES],
    /// How far in it along x.
    across: [f32; LANES],
    /// Shares of the four rows about it: this one, the next along y, along z, along both.
    shares: [[f32; LANES]; 4],
}

impl Places {
    #[inline(always)]
    fn of<const FUSED: bool>(cells: Cells<'_>, traveller: &Traveller, stretch: Stretch, done: usize) -> Places {
        /// Adding 2^23 leaves the nearest integer in the last bits of an f32.
        const MAGIC: f32 = 8_388_608.0;
        let mut places = Places { base: [0; LANES], across: [0.0; LANES], shares: [[0.0; LANES]; 4] };
        for k in 0..LANES {
            let t = fused::<FUSED>((done + k) as f32 + 0.5, stretch.step, stretch.from);
            let place = |axis: usize| fused::<FUSED>(t, traveller.step[axis], traveller.origin[axis]);
            let floor = |x: f32| x - 0.5 + MAGIC;
            let (x, y, z) = (place(0), place(1), place(2));
            let (i, j, l) = (floor(x), floor(y), floor(z));
            let index = |f: f32| f.to_bits().wrapping_sub(MAGIC.to_bits());
            places.base[k] = index(i)
                .wrapping_add(index(j).wrapping_mul(cells.row))
                .wrapping_add(index(l).wrapping_mul(cells.plane));
            places.across[k] = x - (i - MAGIC);
            let (v, w) = (y - (j - MAGIC), z - (l - MAGIC));
            places.shares[3][k] = v * w;
            places.shares[2][k] = w - v * w;
            places.shares[1][k] = v - v * w;
            places.shares[0][k] = 1.0 - v - w + v * w;
        }
        places
    }
}

/// 1 - e^-x without loss of digits: three doublings of a = 1 - e^(-x/8) by a (2 - a).
#[inline(always)]
fn lost(x: f32) -> f32 {
    // From y = 2 on all is lost but 2e-11; the series would run away beyond 2.6.
    let y = (x * 0.125).min(2.0);
    let series = 1.0 + y * (-0.5 + y * (1.0 / 6.0 + y * (-1.0 / 24.0 + y * (1.0 / 120.0))));
    let mut a = y * series;
    for _ in 0..3 {
        a = a * (2.0 - a);
    }
    a
}

/// The same for x of at most [`THIN`].
#[inline(always)]
fn lost_thin(x: f32) -> f32 {
    x + x * x * (-0.5 + x * (1.0 / 6.0 - x * (1.0 / 24.0)))
}

/// Takes a ray through a stretch. `extinction` is per unit of length and density, one number a band, the last 0.
#[inline(always)]
pub(super) fn through(cells: Cells<'_>, traveller: &mut Traveller, stretch: Stretch, extinction: [f32; CELL]) {
    let (depth, thin) = stretch.depth(extinction);
    if thin {
        samples(cells, traveller, stretch, depth, lost_thin);
    } else {
        samples(cells, traveller, stretch, depth, lost);
    }
}

#[inline(always)]
fn samples(
    cells: Cells<'_>,
    traveller: &mut Traveller,
    stretch: Stretch,
    depth: [f32; CELL],
    lost: impl Fn(f32) -> f32,
) {
    let (row, plane) = (cells.row as usize, cells.plane as usize);
    let (mut light, mut left) = (traveller.light, traveller.through);
    for done in (0..stretch.steps).step_by(LANES) {
        let places = Places::of::<false>(cells, traveller, stretch, done);
        let now = (stretch.steps - done).min(LANES);
        let mut met = [[0.0f32; CELL]; LANES];
        let mut taken = [[0.0f32; CELL]; LANES];
        for k in 0..now {
            let at = places.base[k] as usize;
            let mut both = [[0.0f32; CELL]; 2];
            for (corner, share) in [at, at + row, at + plane, at + plane + row].into_iter().zip(places.shares) {
                let (Some(second), Some(first)) = (cells.values.get(corner + 1), cells.values.get(corner)) else {
                    continue;
                };
                for (sum, cell) in both.iter_mut().zip([first, second]) {
                    for (n, sum) in sum.iter_mut().enumerate() {
                        *sum += half::whole((cell >> (16 * n)) as u16) * share[k];
                    }
                }
            }
            for n in 0..CELL {
                met[k][n] = both[0][n] + places.across[k] * (both[1][n] - both[0][n]);
            }
            for n in 0..CELL {
                taken[k][n] = lost(depth[n] * met[k][CELL - 1]);
            }
        }
        for k in 0..now {
            for n in 0..CELL {
                let taken = taken[k][n] * left[n];
                light[n] += taken * met[k][n];
                left[n] -= taken;
            }
        }
    }
    traveller.light = light;
    traveller.through = left;
}

#[cfg(all(test, target_arch = "x86_64"))]
mod tests {
    use super::*;

    #[test]
    fn what_a_step_takes_is_what_the_exponential_says_however_deep_it_is() {
        for n in -200..400 {
            let x = (n as f32 * 0.1).exp2();
            let exact = -(-f64::from(x)).exp_m1();
            assert!((f64::from(lost(x)) - exact).abs() < 2e-5 * exact, "{x}: {}", lost(x));
            if x <= THIN {
                assert!((f64::from(lost_thin(x)) / exact - 1.0).abs() < 4e-5, "{x}: {}", lost_thin(x));
            }
        }
    }

    #[test]
    fn wide_vectors_see_what_plain_numbers_see() {
        use std::arch::is_x86_feature_detected as has;
        if !(has!("avx2") && has!("fma") && has!("f16c")) {
            return;
        }
        let side = 16usize;
        let number = |n: usize, k: usize| half::half(((n * 7919 + k * 104_729) % 4001) as f32);
        let cell = |n: usize| (0..CELL).fold(0, |cell, k| cell | u64::from(number(n, k)) << (16 * k));
        let values: Vec<Cell> = (0..side.pow(3)).map(cell).collect();
        let cells = Cells { values: &values, row: side as u32, plane: (side * side) as u32 };
        let begin =
            Traveller { origin: [2.3, 1.7, 3.1], step: [0.8, 1.1, 0.9], light: [0.0; CELL], through: [1.0; CELL] };
        for steps in 1..=LANES {
            // Thin and deep steps go different ways.
            for depth in [1e-6f32, 1e-5, 1e-3, 1.0, 1e6] {
                let extinction = [depth, 0.7 * depth, 1.3 * depth, 0.0];
                let stretch = Stretch { from: 0.25, step: 0.9, steps, densest: 4001.0 };
                let (mut plain, mut wide) = (begin, begin);
                through(cells, &mut plain, stretch, extinction);
                #[expect(unsafe_code, reason = "the processor was asked whether it has these instructions")]
                unsafe {
                    wide::through(cells, &mut wide, stretch, extinction);
                }
                for band in 0..CELL - 1 {
                    let (a, b) = (plain.light[band], wide.light[band]);
                    assert!(a > 0.0 && (a - b).abs() <= 2e-5 * a, "{steps} steps, depth {depth}: {a} {b}");
                    assert!((plain.through[band] - wide.through[band]).abs() <= 2e-6);
                }
            }
        }
    }
}
