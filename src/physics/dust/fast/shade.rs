//! The light that each voxel sends to the eye, once a frame: eight voxels of a row at a time.
//!
//! The phase function depends on the voxel and the eye only, so that a frame needs it once a voxel and star, not once a sample.

use glam::DVec3;
use rayon::prelude::*;

use super::glow::Seen;
use super::grid::{Grid, LANES};
use super::half;
use super::march::{CELL, Cell, DENSITY};
use super::near::REACH;
use super::occupancy::Occupancy;

/// Bands that are seen together.
pub(super) const BANDS: usize = 3;

/// Where the light of a frame goes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Towards {
    /// An eye at a place, in units of the grid.
    Eye([f32; 3]),
    /// An eye far away, in this direction.
    Far([f32; 3]),
}

impl Towards {
    /// Directions to the eye from eight places in a row.
    #[inline(always)]
    pub(super) fn directions(self, xs: &Eight, y: f32, z: f32) -> [Eight; 3] {
        match self {
            Towards::Far(direction) => direction.map(|d| [d; LANES]),
            Towards::Eye(eye) => {
                let mut to = [[0.0; LANES]; 3];
                for n in 0..LANES {
                    let (x, y, z) = (eye[0] - xs[n], eye[1] - y, eye[2] - z);
                    let inverse = 1.0 / (x * x + y * y + z * z).max(1e-12).sqrt();
                    (to[0][n], to[1][n], to[2][n]) = (x * inverse, y * inverse, z * inverse);
                }
                to
            }
        }
    }
}

/// A star, in units of the grid.
#[derive(Debug, Clone)]
pub(super) struct Lamp {
    pub(super) position: DVec3,
    /// Albedo times intensity, in units of the flyer's scale.
    pub(super) power: [f32; BANDS],
    /// The column of dust from the star to each padded voxel.
    pub(super) columns: Vec<f32>,
}

/// What is shaded.
pub(super) struct Shading<'a> {
    pub(super) grid: &'a Grid,
    pub(super) occupancy: &'a Occupancy,
    pub(super) lamps: &'a [Lamp],
    pub(super) asymmetry: f32,
    /// Extinction per unit of the grid's length and density.
    pub(super) extinction: [f32; BANDS],
    pub(super) towards: Towards,
    pub(super) seen: Option<&'a Seen>,
    /// What light is multiplied by in the cells.
    pub(super) times: f32,
}

type Eight = [f32; LANES];

/// e^x for x of 0 or less, to 3e-7 of itself; 0 below e^-87.
#[inline(always)]
fn exponential(x: f32) -> f32 {
    /// Adding 1.5 x 2^23 leaves the nearest integer, of either sign, in the last bits of an f32.
    const MAGIC: f32 = 12_582_912.0;
    let power = (x * std::f32::consts::LOG2_E).max(-126.0);
    let whole = power + MAGIC;
    let part = (power - (whole - MAGIC)) * std::f32::consts::LN_2;
    let series = 1.0 + part * (1.0 + part * (0.5 + part * (1.0 / 6.0 + part * (1.0 / 24.0 + part * (1.0 / 120.0)))));
    f32::from_bits(series.to_bits().wrapping_add(whole.to_bits().wrapping_sub(MAGIC.to_bits()) << 23))
}

/// How much of a star's light at a distance, in shares of [`REACH`], is left to the grid: none at the star, all beyond the reach, with
/// two derivatives that vanish at both ends. The rest is added along the rays, see `near`.
#[inline(always)]
pub(super) fn share_of_grid(x: f32) -> f32 {
    let x = x.min(1.0);
    x * x * x * (10.0 + x * (6.0 * x - 15.0))
}

/// Shades all cells that a ray can ask for. Gives the most light of any.
pub(super) fn shade(shading: &Shading<'_>, cells: &mut [Cell]) -> f32 {
    let grid = shading.grid;
    let row = grid.padded[0];
    let xs: Vec<f32> = (0..row).map(|x| grid.centre(0, x) as f32).collect();
    cells
        .par_chunks_mut(row * grid.padded[1])
        .enumerate()
        .map(|(z, plane)| {
            let mut most = 0.0f32;
            for (y, line) in plane.chunks_mut(row).enumerate() {
                most = most.max(dispatched(shading, &xs, y, z, line));
            }
            most
        })
        .reduce(|| 0.0, f32::max)
}

/// One row, with the widest vectors that the processor has.
fn dispatched(shading: &Shading<'_>, xs: &[f32], y: usize, z: usize, line: &mut [Cell]) -> f32 {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2")
        && std::arch::is_x86_feature_detected!("fma")
        && std::arch::is_x86_feature_detected!("f16c")
    {
        #[expect(unsafe_code, reason = "the processor was asked whether it has these instructions")]
        return unsafe { with_avx2(shading, xs, y, z, line) };
    }
    shade_line(shading, xs, y, z, line)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,f16c")]
fn with_avx2(shading: &Shading<'_>, xs: &[f32], y: usize, z: usize, line: &mut [Cell]) -> f32 {
    shade_line(shading, xs, y, z, line)
}

#[inline(always)]
fn shade_line(shading: &Shading<'_>, xs: &[f32], y: usize, z: usize, line: &mut [Cell]) -> f32 {
    let grid = shading.grid;
    let start = (z * grid.padded[1] + y) * grid.padded[0];
    let (py, pz) = (grid.centre(1, y) as f32, grid.centre(2, z) as f32);
    let glow = shading.seen.map(|seen| seen.line(y, z));
    let mut most = 0.0f32;
    for (piece, (cells, xs)) in line.as_chunks_mut::<LANES>().0.iter_mut().zip(xs.as_chunks::<LANES>().0).enumerate() {
        let at = start + piece * LANES;
        if !shading.occupancy.wants(at / LANES) {
            continue;
        }
        let mut light = [[0.0; LANES]; BANDS];
        let mut before = [[0.0; CELL]; LANES];
        if let Some(glow) = &glow {
            glow.eight(piece * LANES, &mut before);
        }
        let to_eye = shading.towards.directions(xs, py, pz);
        for lamp in shading.lamps {
            if let Some(columns) = lamp.columns.get(at..).and_then(|rest| rest.first_chunk::<LANES>()) {
                lit(shading, lamp, columns, [xs, &[py; LANES], &[pz; LANES]], &to_eye, &mut light);
            }
        }
        for n in 0..LANES {
            let mut cell = cells[n] & DENSITY;
            for band in 0..BANDS {
                let light = light[band][n] + before[n][band];
                most = most.max(light);
                cell |= u64::from(half::half(light * shading.times)) << (16 * band);
            }
            cells[n] = cell;
        }
    }
    most
}

/// Adds what one star's light sends to the eye after one scattering (thesis, equation 5.3 for a thin voxel).
#[inline(always)]
fn lit(
    shading: &Shading<'_>,
    lamp: &Lamp,
    columns: &Eight,
    at: [&Eight; 3],
    to: &[Eight; 3],
    light: &mut [Eight; BANDS],
) {
    let g = shading.asymmetry;
    let (least, steep) = ((1.0 - g) * (1.0 - g), 2.0 * g);
    let height = (1.0 - g * g) / (4.0 * std::f32::consts::PI);
    let star = lamp.position.as_vec3();
    let mut amount = [0.0; LANES];
    for n in 0..LANES {
        let (x, y, z) = (at[0][n] - star.x, at[1][n] - star.y, at[2][n] - star.z);
        let square = (x * x + y * y + z * z).max(1e-12);
        let inverse = 1.0 / square.sqrt();
        // 1 - cos from the difference of the two directions keeps its digits where they nearly agree.
        let (u, v, w) = (x * inverse - to[0][n], y * inverse - to[1][n], z * inverse - to[2][n]);
        let base = least + steep * 0.5 * (u * u + v * v + w * w);
        let share = share_of_grid(square * inverse * (1.0 / REACH));
        amount[n] = share * inverse * inverse * height / (base * base.sqrt());
    }
    for ((light, power), extinction) in light.iter_mut().zip(lamp.power).zip(shading.extinction) {
        for n in 0..LANES {
            light[n] += power * amount[n] * exponential(-extinction * columns[n]);
        }
    }
}
