//! How noisy gathered light is, from the differences between independent parts of its photons.

use crate::physics::dust::multiple::cells::{Cells, NONE};
use crate::physics::dust::multiple::harmonics::Harmonics;
use crate::physics::dust::multiple::walk::{LANES, Part};

/// Noise of columns of cells along an axis, as a share of their light, from the differences between the parts; the worst axis of all orders together.
pub(in crate::physics::dust::multiple) fn noise(
    cells: &Cells,
    parts: &[Part<'_>],
    harmonics: &Harmonics,
    orders: usize,
) -> f64 {
    let stride = harmonics.count() * LANES;
    let [nx, ny, _] = cells.size;
    let mut worst = 0.0_f64;
    for axis in 0..3 {
        let kept = |x: usize, y: usize, z: usize| match axis {
            0 => (y, z),
            1 => (x, z),
            _ => (x, y),
        };
        let wide = if axis == 0 { ny } else { nx };
        let high = if axis == 2 { ny } else { cells.size[2] };
        // Of each column and band: the sum over parts and the sum of squares.
        let mut sums = vec![[0.0_f64; 2 * LANES]; wide * high];
        for part in parts {
            let mut columns = vec![[0.0_f64; LANES]; wide * high];
            for (cell, slot) in cells.slots.iter().enumerate().filter(|(_, slot)| **slot != NONE) {
                let (x, rest) = (cell % nx, cell / nx);
                let (a, b) = kept(x, rest % ny, rest / ny);
                let dust = f64::from(cells.density(cell)) / part.done.photons.max(1) as f64;
                for order in 0..orders {
                    let at = (order * cells.used + *slot as usize) * stride;
                    for (sum, tally) in columns[b * wide + a].iter_mut().zip(&part.tally[at..at + LANES]) {
                        *sum += dust * f64::from(*tally);
                    }
                }
            }
            for (sums, column) in sums.iter_mut().zip(&columns) {
                for lane in 0..LANES {
                    sums[lane] += column[lane];
                    sums[LANES + lane] += column[lane] * column[lane];
                }
            }
        }
        let n = parts.len() as f64;
        let (mut light, mut noise) = ([0.0; LANES], [0.0; LANES]);
        for sums in &sums {
            for lane in 0..LANES {
                let mean = sums[lane] / n;
                light[lane] += mean;
                noise[lane] += ((sums[LANES + lane] / n - mean * mean).max(0.0) / (n - 1.0)).sqrt();
            }
        }
        for lane in 0..LANES {
            if light[lane] > 0.0 {
                worst = worst.max(noise[lane] / light[lane]);
            }
        }
    }
    worst
}
