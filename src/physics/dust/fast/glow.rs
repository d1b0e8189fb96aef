//! Light that has scattered more than once, as one eye sees it: once a frame, eight cells of its coarse grid at a time.

use rayon::prelude::*;

use super::grid::{Grid, LANES};
use super::march::CELL;
use super::shade::Towards;
use crate::physics::dust::multiple::Field;

/// The source of each cell towards one eye, three bands; the fourth number is not used.
#[derive(Debug, Clone, Default)]
pub(super) struct Seen {
    size: [usize; 3],
    values: Vec<[f32; CELL]>,
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
        Seen { size, values: vec![[0.0; CELL]; size[0] * size[1] * size[2]], places }
    }

    /// Looks at the field from an eye. `scale` takes its radiance into the flyer's numbers.
    pub(super) fn look(&mut self, field: &Field, grid: &Grid, towards: Towards, scale: f32) {
        let size = self.size;
        let far = match towards {
            Towards::Far(direction) => Some(field.harmonics().eight(direction.map(|d| [d; LANES]))),
            Towards::Eye(_) => None,
        };
        let centre =
            |axis: usize, cell: usize| (grid.edges()[axis] * ((cell as f64 + 0.5) / size[axis] as f64 - 0.5)) as f32;
        let xs: Vec<f32> = (0..size[0].next_multiple_of(LANES)).map(|x| centre(0, x)).collect();
        self.values.par_chunks_mut(size[0]).enumerate().for_each(|(row, values)| {
            let (y, z) = (row % size[1], row / size[1]);
            let (py, pz) = (centre(1, y), centre(2, z));
            for (piece, (values, xs)) in values.chunks_mut(LANES).zip(xs.as_chunks::<LANES>().0).enumerate() {
                let functions = match far {
                    Some(functions) => functions,
                    None => field.harmonics().eight(towards.directions(xs, py, pz)),
                };
                for (n, value) in values.iter_mut().enumerate() {
                    let Some(slot) = field.slot(piece * LANES + n, y, z) else { continue };
                    let mut sum = [0.0f32; CELL];
                    for (coefficients, all) in field.coefficients(0, slot).as_chunks::<CELL>().0.iter().zip(&functions)
                    {
                        for band in 0..CELL {
                            sum[band] += coefficients[band] * all[n];
                        }
                    }
                    // A series cut off can fall below zero, light cannot.
                    *value = sum.map(|light| light.max(0.0) * scale);
                }
            }
        });
    }

    /// The glow along a row of padded voxels, between the cells along y and z.
    pub(super) fn line(&self, y: usize, z: usize) -> Line<'_> {
        let ((j, v), (k, w)) = (self.places[1][y], self.places[2][z]);
        let (j, k) = (j as usize, k as usize);
        let (above, behind) = ((j + 1).min(self.size[1] - 1), (k + 1).min(self.size[2] - 1));
        let mut values = vec![[0.0f32; CELL]; self.size[0] + 1];
        let shares = [
            (j, k, (1.0 - v) * (1.0 - w)),
            (above, k, v * (1.0 - w)),
            (j, behind, (1.0 - v) * w),
            (above, behind, v * w),
        ];
        for (j, k, share) in shares {
            let row = &self.values[(k * self.size[1] + j) * self.size[0]..][..self.size[0]];
            for (out, value) in values.iter_mut().zip(row) {
                for band in 0..CELL {
                    out[band] += value[band] * share;
                }
            }
        }
        Line { places: &self.places[0], values }
    }
}

/// A row of a glow.
pub(super) struct Line<'a> {
    places: &'a [(u32, f32)],
    values: Vec<[f32; CELL]>,
}

impl Line<'_> {
    /// The glow of eight padded voxels from `x` on.
    #[inline(always)]
    pub(super) fn eight(&self, x: usize, light: &mut [[f32; CELL]; LANES]) {
        let Some(places) = self.places.get(x..).and_then(|rest| rest.first_chunk::<LANES>()) else { return };
        for (light, (low, u)) in light.iter_mut().zip(places) {
            let (Some(b), Some(a)) = (self.values.get(*low as usize + 1), self.values.get(*low as usize)) else {
                continue;
            };
            for band in 0..CELL {
                light[band] = a[band] + (b[band] - a[band]) * u;
            }
        }
    }
}
