//! The light that each voxel sends to the eye, once a frame: eight voxels of a row at a time.
//!
//! The phase function depends on the voxel and the eye only, so that a frame needs it once a voxel and star, not once a sample.

use glam::DVec3;
use rayon::prelude::*;

use super::approximate::{fused, inverse_root, larger, power_of_2};
use super::glow::Seen;
use super::grid::{Grid, LANES};
use super::half;
use super::march::{Cell, DENSITY};
use super::near::REACH;
use super::near::hood::Hood;
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
    pub(super) fn directions<const FUSED: bool>(self, xs: &Eight, y: f32, z: f32) -> [Eight; 3] {
        match self {
            Towards::Far(direction) => direction.map(|d| [d; LANES]),
            Towards::Eye(eye) => {
                let mut inverse = [0.0; LANES];
                let mut to = [[0.0; LANES]; 3];
                let (y, z) = (eye[1] - y, eye[2] - z);
                let rest = y * y + z * z;
                for n in 0..LANES {
                    to[0][n] = eye[0] - xs[n];
                    inverse[n] = inverse_root::<FUSED>(larger(fused::<FUSED>(to[0][n], to[0][n], rest), 1e-12));
                }
                for n in 0..LANES {
                    to[0][n] *= inverse[n];
                    to[1][n] = y * inverse[n];
                    to[2][n] = z * inverse[n];
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
    /// The dust about it.
    pub(super) hood: Hood,
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
    let xs: Vec<f32> = (0..grid.padded[0]).map(|x| grid.centre(0, x) as f32).collect();
    cells
        .par_chunks_mut(grid.padded[0] * grid.padded[1])
        .enumerate()
        .map_init(Vec::new, |glow, (z, plane)| dispatched(shading, &xs, z, plane, glow))
        .reduce(|| 0.0, f32::max)
}

/// One plane, with the widest vectors that the processor has.
fn dispatched(shading: &Shading<'_>, xs: &[f32], z: usize, plane: &mut [Cell], glow: &mut Vec<f32>) -> f32 {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
        #[expect(unsafe_code, reason = "the processor was asked whether it has these instructions")]
        return unsafe { with_avx2(shading, xs, z, plane, glow) };
    }
    shade_plane::<false>(shading, xs, z, plane, glow)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn with_avx2(shading: &Shading<'_>, xs: &[f32], z: usize, plane: &mut [Cell], glow: &mut Vec<f32>) -> f32 {
    shade_plane::<true>(shading, xs, z, plane, glow)
}

#[inline(always)]
fn shade_plane<const FUSED: bool>(
    shading: &Shading<'_>,
    xs: &[f32],
    z: usize,
    plane: &mut [Cell],
    glow: &mut Vec<f32>,
) -> f32 {
    let grid = shading.grid;
    let (row, start) = (grid.padded[0], z * grid.padded[1] * grid.padded[0]);
    let wanted = |from: usize, count: usize| (from / LANES..(from + count) / LANES).any(|n| shading.occupancy.wants(n));
    if !wanted(start, plane.len()) {
        return 0.0;
    }
    if let Some(seen) = shading.seen {
        seen.plane(z, glow);
    }
    let mut most = [0.0; LANES];
    for (y, line) in plane.chunks_mut(row).enumerate() {
        let start = start + y * row;
        if !wanted(start, row) {
            continue;
        }
        let glow = shading.seen.map(|seen| seen.line(glow, y));
        let place = (grid.centre(1, y) as f32, grid.centre(2, z) as f32);
        for (piece, (cells, xs)) in
            line.as_chunks_mut::<LANES>().0.iter_mut().zip(xs.as_chunks::<LANES>().0).enumerate()
        {
            let at = start + piece * LANES;
            if !shading.occupancy.wants(at / LANES) {
                continue;
            }
            let mut light = [[0.0; LANES]; BANDS];
            if let Some(glow) = &glow {
                glow.eight::<FUSED>(piece * LANES, &mut light);
            }
            let to_eye = shading.towards.directions::<FUSED>(xs, place.0, place.1);
            for lamp in shading.lamps {
                if let Some(columns) = lamp.columns.get(at..).and_then(|rest| rest.first_chunk::<LANES>()) {
                    lit::<FUSED>(shading, lamp, columns, (xs, place), &to_eye, &mut light);
                }
            }
            for n in 0..LANES {
                most[n] = larger(larger(larger(light[0][n], light[1][n]), light[2][n]), most[n]);
            }
            keep(cells, &light, shading.times);
        }
    }
    most.into_iter().fold(0.0, f32::max)
}

/// Puts the light of eight cells into them, `times` as much.
#[inline(always)]
fn keep(cells: &mut [Cell; LANES], light: &[Eight; BANDS], times: f32) {
    let (mut low, mut high) = ([0u32; LANES], [0u32; LANES]);
    for n in 0..LANES {
        let number = |band: usize| u32::from(half::half(light[band][n] * times));
        low[n] = number(0) | number(1) << 16;
        high[n] = number(2);
    }
    for n in 0..LANES {
        cells[n] = cells[n] & DENSITY | u64::from(high[n]) << 32 | u64::from(low[n]);
    }
}

/// Adds what one star's light sends to the eye after one scattering (thesis, equation 5.3 for a thin voxel).
#[inline(always)]
fn lit<const FUSED: bool>(
    shading: &Shading<'_>,
    lamp: &Lamp,
    columns: &Eight,
    (xs, (y, z)): (&Eight, (f32, f32)),
    to: &[Eight; 3],
    light: &mut [Eight; BANDS],
) {
    let g = shading.asymmetry;
    let (least, height) = ((1.0 - g) * (1.0 - g), (1.0 - g * g) / (4.0 * std::f32::consts::PI));
    let star = lamp.position.as_vec3();
    let (y, z) = (y - star.y, z - star.z);
    let rest = y * y + z * z;
    let mut amount = [0.0; LANES];
    let mut inverses = [0.0; LANES];
    for n in 0..LANES {
        let x = xs[n] - star.x;
        let inverse = inverse_root::<FUSED>(larger(fused::<FUSED>(x, x, rest), 1e-12));
        // 1 - cos from the difference of the two directions keeps its digits where they nearly agree.
        let part = |way: f32, to: f32| fused::<FUSED>(way, inverse, -to);
        let (u, v, w) = (part(x, to[0][n]), part(y, to[1][n]), part(z, to[2][n]));
        let turned = fused::<FUSED>(u, u, fused::<FUSED>(v, v, w * w));
        let root = inverse_root::<FUSED>(fused::<FUSED>(g, turned, least));
        inverses[n] = inverse;
        amount[n] = (height * root) * (root * inverse) * (root * inverse);
    }
    if rest < REACH * REACH {
        for n in 0..LANES {
            amount[n] *= share_of_grid(1.0 / (inverses[n] * REACH));
        }
    }
    for ((light, power), extinction) in light.iter_mut().zip(lamp.power).zip(shading.extinction) {
        let extinction = -extinction * std::f32::consts::LOG2_E;
        for n in 0..LANES {
            let way = power_of_2::<FUSED>(extinction * columns[n]);
            light[n] = fused::<FUSED>(power * amount[n], way, light[n]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::dust::bricks::Bricks;
    use crate::physics::dust::phase::HenyeyGreenstein;
    use crate::physics::dust::volume::Volume;

    /// The light of eight voxels in a row, fused or not, against f64.
    #[test]
    fn a_voxel_sends_on_what_the_law_says() {
        let law = |g: f64| HenyeyGreenstein::new(g).unwrap();
        let volume = Volume::new([8; 3], DVec3::splat(8.0), vec![1.0; 512]).unwrap();
        let grid = Grid::new(&volume);
        let occupancy = Occupancy::new(&grid, &Bricks::of(&volume), -1.0);
        let xs: Eight = std::array::from_fn(|n| n as f32 - 3.5);
        let columns: Eight = std::array::from_fn(|n| 0.3 * n as f32);
        let eye = [2.0f32, 3.0, 40.0];
        for (g, star) in
            [(0.0, [0.2, 9.0, 0.1]), (0.6, [0.2, 0.3, -0.4]), (-0.9, [30.0, 7.0, 1.0]), (0.99, [1.0, -7.0, -9.0])]
        {
            let position = DVec3::from_array(star);
            let hood = Hood::new(&grid, &vec![1.0; grid.len()], position);
            let lamp = Lamp { position, power: [0.7, 1.0, 1.3], columns: Vec::new(), hood };
            let shading = Shading {
                grid: &grid,
                occupancy: &occupancy,
                lamps: &[],
                asymmetry: g as f32,
                extinction: [0.5, 1.0, 2.0],
                towards: Towards::Eye(eye),
                seen: None,
                times: 1.0,
            };
            let (y, z) = (0.5f32, -1.5f32);
            let light = |fused: bool| {
                let mut light = [[0.0; LANES]; BANDS];
                if fused {
                    let to = shading.towards.directions::<true>(&xs, y, z);
                    lit::<true>(&shading, &lamp, &columns, (&xs, (y, z)), &to, &mut light);
                } else {
                    let to = shading.towards.directions::<false>(&xs, y, z);
                    lit::<false>(&shading, &lamp, &columns, (&xs, (y, z)), &to, &mut light);
                }
                light
            };
            for light in [light(true), light(false)] {
                for n in 0..LANES {
                    let place = DVec3::new(xs[n].into(), y.into(), z.into());
                    let (way, to) = (place - lamp.position, DVec3::from_array(eye.map(f64::from)) - place);
                    let share = f64::from(share_of_grid(way.length() as f32 / REACH));
                    let cosine = way.normalize().dot(to.normalize());
                    let amount = share * law(g).per_steradian(cosine) / way.length_squared();
                    for (band, light) in light.iter().enumerate() {
                        let k = f64::from(shading.extinction[band]) * f64::from(columns[n]);
                        let exact = f64::from(lamp.power[band]) * amount * (-k).exp();
                        let there = f64::from(light[n]);
                        assert!((there / exact - 1.0).abs() < 3e-5, "g {g}, voxel {n}, band {band}: {there} {exact}");
                    }
                }
            }
        }
    }
}
