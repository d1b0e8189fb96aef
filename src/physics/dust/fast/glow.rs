//! Light that has scattered more than once, as one eye sees it: once a frame, eight cells of its coarse grid at a time.
//!
//! It is spread over the voxels one axis after another: along x for the whole frame, along z for a plane, along y for a row.

use rayon::prelude::*;

use super::approximate::fused;
use super::grid::{Grid, LANES};
use super::march::CELL;
use super::shade::{BANDS, Towards};
use crate::physics::dust::multiple::Field;

/// The source towards one eye.
#[derive(Debug, Clone, Default)]
pub(super) struct Seen {
    /// Cells.
    size: [usize; 3],
    /// By cell along z, cell along y, band and padded voxel along x.
    values: Vec<f32>,
    /// By axis and padded voxel: the cell below its centre, and the place between it and the next.
    places: [Vec<(u32, f32)>; 3],
}

impl Seen {
    /// Room for a field over a grid.
    pub(super) fn of(field: &Field, grid: &Grid) -> Seen {
        let size = field.size();
        let places = [0, 1, 2].map(|axis| {
            let ratio = size[axis] as f64 / grid.size[axis] as f64;
            let between = |voxel: usize| {
                let voxel = voxel.clamp(1, grid.size[axis]) - 1;
                let place = ((voxel as f64 + 0.5) * ratio - 0.5).clamp(0.0, (size[axis] - 1) as f64);
                let low = (place as usize).min(size[axis].saturating_sub(2));
                (low as u32, (place - low as f64) as f32)
            };
            (0..grid.padded[axis]).map(between).collect()
        });
        Seen { size, values: vec![0.0; BANDS * grid.padded[0] * size[1] * size[2]], places }
    }

    /// Looks at the field from an eye. `scale` takes its radiance into the flyer's numbers.
    pub(super) fn look(&mut self, field: &Field, grid: &Grid, towards: Towards, scale: f32) {
        let (size, padded) = (self.size, grid.padded[0]);
        let far = match towards {
            Towards::Far(direction) => Some(field.harmonics().eight(direction.map(|d| [d; LANES]))),
            Towards::Eye(_) => None,
        };
        let centre =
            |axis: usize, cell: usize| (grid.edges()[axis] * ((cell as f64 + 0.5) / size[axis] as f64 - 0.5)) as f32;
        let xs: Vec<f32> = (0..size[0].next_multiple_of(LANES)).map(|x| centre(0, x)).collect();
        let places = &self.places[0];
        self.values.par_chunks_mut(BANDS * padded).enumerate().for_each(|(row, values)| {
            let (y, z) = (row % size[1], row / size[1]);
            if (0..size[0]).all(|x| field.slot(x, y, z).is_none()) {
                return;
            }
            let (py, pz) = (centre(1, y), centre(2, z));
            // One more than there are, for a grid of one cell.
            let mut cells = vec![[0.0f32; CELL]; size[0] + 1];
            for (piece, (cells, xs)) in cells.chunks_mut(LANES).zip(xs.as_chunks::<LANES>().0).enumerate() {
                let functions = match far {
                    Some(functions) => functions,
                    None => field.harmonics().eight(towards.directions::<false>(xs, py, pz)),
                };
                for (n, cell) in cells.iter_mut().enumerate() {
                    let x = piece * LANES + n;
                    let Some(slot) = (x < size[0]).then(|| field.slot(x, y, z)).flatten() else { continue };
                    let mut sum = [0.0f32; CELL];
                    for (coefficients, all) in field.coefficients(0, slot).as_chunks::<CELL>().0.iter().zip(&functions)
                    {
                        for band in 0..CELL {
                            sum[band] += coefficients[band] * all[n];
                        }
                    }
                    // A series cut off can fall below zero, light cannot.
                    *cell = sum.map(|light| light.max(0.0) * scale);
                }
            }
            for (x, (low, u)) in places.iter().enumerate() {
                let (a, b) = (cells[*low as usize], cells[*low as usize + 1]);
                for band in 0..BANDS {
                    values[band * padded + x] = a[band] + (b[band] - a[band]) * u;
                }
            }
        });
    }

    /// The glow in a plane of padded voxels: by cell along y, band and padded voxel along x.
    #[inline(always)]
    pub(super) fn plane(&self, z: usize, plane: &mut Vec<f32>) {
        let (k, w) = self.places[2][z];
        let (k, size) = (k as usize, self.places[0].len() * BANDS * self.size[1]);
        let behind = (k + 1).min(self.size[2] - 1);
        let (near, far) = (&self.values[k * size..][..size], &self.values[behind * size..][..size]);
        plane.clear();
        plane.extend(near.iter().zip(far).map(|(a, b)| a + (b - a) * w));
    }

    /// The glow along a row of a plane.
    pub(super) fn line<'a>(&self, plane: &'a [f32], y: usize) -> Line<'a> {
        let (j, share) = self.places[1][y];
        let (j, padded) = (j as usize, self.places[0].len());
        let row = |j: usize| &plane[j * BANDS * padded..][..BANDS * padded];
        Line { below: row(j), above: row((j + 1).min(self.size[1] - 1)), share, padded }
    }
}

/// A row of a glow: between two rows of cells.
pub(super) struct Line<'a> {
    below: &'a [f32],
    above: &'a [f32],
    share: f32,
    padded: usize,
}

impl Line<'_> {
    /// The glow of eight padded voxels from `x` on.
    #[inline(always)]
    pub(super) fn eight<const FUSED: bool>(&self, x: usize, light: &mut [[f32; LANES]; BANDS]) {
        for (band, light) in light.iter_mut().enumerate() {
            let at = band * self.padded + x;
            let eight = |row: &[f32]| row.get(at..).and_then(|rest| rest.first_chunk::<LANES>()).copied();
            let (Some(a), Some(b)) = (eight(self.below), eight(self.above)) else { continue };
            for n in 0..LANES {
                light[n] = fused::<FUSED>(b[n] - a[n], self.share, a[n]);
            }
        }
    }
}
