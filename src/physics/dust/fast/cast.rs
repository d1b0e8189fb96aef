//! Rays through the shaded cells, 8 x 8 pixels at a time: what they pass over is decided once for all of them.

use glam::DVec3;
use rayon::prelude::*;

use super::grid::{Grid, LANES};
use super::march::{self, CELL, Cell, Cells, Stretch, Traveller};
use super::near::Surroundings;
use super::occupancy::Occupancy;
use super::shade::{BANDS, Lamp};
use crate::physics::dust::camera::{Camera, Ray};

/// The rays of a tile together.
mod bundle;
/// Which rays a picture needs.
pub(super) mod points;
/// What was done.
mod work;

pub use work::Work;

use self::bundle::Bundle;
use self::points::{PIXELS, Points, TILE, Tile, aims};

/// Longest steps near a star, voxels: what the grid holds of its light is a hill three voxels wide, and steep beyond.
const NEAR_STEP: f64 = 0.75;

/// What the numbers in the cells are multiplied by: powers of two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Times {
    pub(super) light: f32,
    pub(super) density: f32,
}

/// What rays go through, and how.
pub(super) struct Casting<'a> {
    pub(super) grid: &'a Grid,
    pub(super) occupancy: &'a Occupancy,
    pub(super) cells: &'a [Cell],
    /// What light and density in the cells are multiplied by.
    pub(super) times: Times,
    pub(super) lamps: &'a [Lamp],
    pub(super) surroundings: &'a Surroundings<'a>,
    /// Steps, in voxels.
    pub(super) step: f64,
    /// A ray of which no more comes through ends.
    pub(super) opaque: f32,
    /// The middle of the picture: its ray, and how far from it the ray of the next pixel is, at its origin and per length.
    pub(super) middle: (Ray, f64, f64),
}

impl Casting<'_> {
    /// The width of a pixel at a place.
    pub(super) fn pixel(&self, place: DVec3) -> f64 {
        let (ray, origin, slope) = self.middle;
        origin + slope * (place - ray.origin).length()
    }
}

/// One pixel's ray as the kernel needs it; lengths are counted from near where the bundle enters the box.
#[derive(Clone, Copy, Default)]
struct Lane {
    traveller: Traveller,
    enter: f32,
    leave: f32,
    done: bool,
}

impl Lane {
    /// What of a stretch is in the box, in as many steps as that takes.
    #[inline(always)]
    fn part(&self, whole: Stretch) -> Option<Stretch> {
        let end = whole.from + whole.step * whole.steps as f32;
        let (a, b) = (whole.from.max(self.enter), end.min(self.leave));
        if a >= b {
            return None;
        }
        if a == whole.from && b == end {
            return Some(whole);
        }
        let steps = ((b - a) / whole.step).ceil().clamp(1.0, LANES as f32);
        Some(Stretch { from: a, step: (b - a) / steps, steps: steps as usize, ..whole })
    }
}

/// Casts rays through points of a picture into `pixels`, and into `through` what of the light behind comes through.
pub(super) fn cast(
    casting: &Casting<'_>,
    camera: &Camera,
    points: Points<'_>,
    pixels: &mut [[f32; BANDS]],
    through: &mut [[f32; BANDS]],
) -> Work {
    let width = points.count.0;
    pixels
        .par_chunks_mut(TILE * width)
        .zip(through.par_chunks_mut(TILE * width))
        .enumerate()
        .map(|(band, (pixels, through))| {
            let mut work = Work::default();
            for x in (0..width).step_by(TILE) {
                let tile = Tile { x, y: band * TILE, points };
                work = work.with(dispatched(casting, camera, tile, pixels, through));
            }
            work
        })
        .reduce(Work::default, Work::with)
}

type Pixels<'a> = &'a mut [[f32; BANDS]];

/// One tile, with the widest vectors that the processor has.
fn dispatched(casting: &Casting<'_>, camera: &Camera, tile: Tile<'_>, pixels: Pixels<'_>, through: Pixels<'_>) -> Work {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2")
        && std::arch::is_x86_feature_detected!("fma")
        && std::arch::is_x86_feature_detected!("f16c")
    {
        #[expect(unsafe_code, reason = "the processor was asked whether it has these instructions")]
        return unsafe { with_avx2(casting, camera, tile, pixels, through) };
    }
    cast_tile(casting, camera, tile, (pixels, through), march::through)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,f16c")]
fn with_avx2(casting: &Casting<'_>, camera: &Camera, tile: Tile<'_>, pixels: Pixels<'_>, through: Pixels<'_>) -> Work {
    // A closure made here may use what the processor has.
    let kernel = |cells: Cells<'_>, traveller: &mut Traveller, stretch: Stretch, extinction| {
        march::wide::through(cells, traveller, stretch, extinction);
    };
    cast_tile(casting, camera, tile, (pixels, through), kernel)
}

#[inline(always)]
fn cast_tile(
    casting: &Casting<'_>,
    camera: &Camera,
    tile: Tile<'_>,
    (pixels, through): (Pixels<'_>, Pixels<'_>),
    kernel: impl Fn(Cells<'_>, &mut Traveller, Stretch, [f32; CELL]),
) -> Work {
    let grid = casting.grid;
    let mut work = Work::default();
    let (aims, count) = aims(grid, camera, tile);
    let aims = &aims[..count];
    let Some(bundle) = Bundle::of(grid, aims) else { return work };
    let row = grid.padded[0] as u32;
    let cells = Cells { values: casting.cells, row, plane: row * grid.padded[1] as u32 };
    let [red, green, blue] = casting.surroundings.extinction;
    let extinction = [red, green, blue, 0.0].map(|k| k / casting.times.density);
    let step = casting.step / bundle.pace;
    let length = step * LANES as f64;
    let pieces = (casting.step / NEAR_STEP).ceil().max(1.0) as usize;
    // Stretches are counted from the eye, so that neighbouring tiles sample at the same lengths.
    let base = (bundle.enter / length).floor() * length;
    let mut lanes = [Lane::default(); PIXELS];
    let lanes = &mut lanes[..count];
    for (lane, aim) in lanes.iter_mut().zip(aims) {
        // An eye far away costs no digits.
        let origin = grid.index(aim.ray.origin + aim.ray.direction * base);
        let slope = aim.ray.direction * grid.per_length();
        let traveller =
            Traveller { origin: single(origin), step: single(slope), light: [0.0; CELL], through: [1.0; CELL] };
        let (enter, leave) = ((aim.enter - base) as f32, (aim.leave - base) as f32);
        *lane = Lane { traveller, enter, leave, done: false };
        work.rays += 1;
        work.everything += ((aim.leave - aim.enter) / step).ceil() as u64;
    }
    let mut from = base;
    let mut alive = work.rays;
    while from < bundle.leave && alive > 0 {
        let free = (bundle.free(casting.occupancy, from.max(bundle.enter)) / length).floor();
        if free > 0.0 {
            from += free * length;
            continue;
        }
        let until = from + length;
        let densest = bundle.densest(casting.occupancy, from, until) * casting.times.density;
        if densest > 0.0 {
            let pieces = if bundle.near_a_star(casting, from, until) { pieces } else { 1 };
            let length = length / pieces as f64;
            for piece in 0..pieces {
                let begin = from - base + piece as f64 * length;
                let stretch =
                    Stretch { from: begin as f32, step: (length / LANES as f64) as f32, steps: LANES, densest };
                for lane in lanes.iter_mut().filter(|lane| !lane.done) {
                    let Some(stretch) = lane.part(stretch) else { continue };
                    kernel(cells, &mut lane.traveller, stretch, extinction);
                    work.samples += stretch.steps as u64;
                    let [red, green, blue, _] = lane.traveller.through;
                    let most = red.max(green).max(blue);
                    if most < casting.opaque {
                        lane.done = true;
                        alive -= 1;
                        work.ended += 1;
                        work.hidden = work.hidden.max(most);
                    }
                }
            }
        }
        from = until;
    }
    for (lane, aim) in lanes.iter().zip(aims) {
        let at = aim.pixel / TILE * tile.points.count.0 + tile.x + aim.pixel % TILE;
        if let (Some(pixel), Some(through)) = (pixels.get_mut(at), through.get_mut(at)) {
            // Rounding may leave a hair less than nothing behind dust without end.
            let positive = |[red, green, blue, _]: [f32; CELL]| [red.max(0.0), green.max(0.0), blue.max(0.0)];
            *pixel = positive(lane.traveller.light).map(|light| light / casting.times.light);
            *through = positive(lane.traveller.through);
        }
    }
    work
}

fn single(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}
