//! Rays through the shaded cells, 8 x 8 pixels at a time: what they pass over is decided once for all of them.

use glam::DVec3;
use rayon::prelude::*;

use super::grid::{Grid, LANES};
use super::march::{self, CELL, Cells, Stretch, Traveller};
use super::near::{REACH, Surroundings};
use super::occupancy::Occupancy;
use super::shade::{BANDS, Lamp};
use crate::physics::dust::bricks::crossing;
use crate::physics::dust::camera::{Camera, Ray};

/// Pixels along the edge of a tile.
const TILE: usize = 8;
/// Pixels of a tile.
const PIXELS: usize = TILE * TILE;

/// What rays go through, and how.
pub(super) struct Casting<'a> {
    pub(super) grid: &'a Grid,
    pub(super) occupancy: &'a Occupancy,
    pub(super) cells: &'a [[f32; CELL]],
    pub(super) lamps: &'a [Lamp],
    pub(super) surroundings: &'a Surroundings<'a>,
    /// Steps, in voxels.
    pub(super) step: f64,
    /// A ray of which no more comes through ends.
    pub(super) opaque: f32,
}

/// What the rays of a frame did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Work {
    /// Samples taken.
    pub samples: u64,
    /// Samples that the same rays would take with no dust passed over and no ray ended early.
    pub everything: u64,
    /// Rays through the box.
    pub rays: u64,
    /// Rays ended early.
    pub ended: u64,
    /// The largest share that still came through where a ray was ended.
    pub hidden: f32,
}

impl Work {
    fn with(self, other: Work) -> Work {
        Work {
            samples: self.samples + other.samples,
            everything: self.everything + other.everything,
            rays: self.rays + other.rays,
            ended: self.ended + other.ended,
            hidden: self.hidden.max(other.hidden),
        }
    }
}

/// One pixel's ray in units of the grid.
struct Lane {
    ray: Ray,
    enter: f64,
    leave: f64,
    traveller: Traveller,
    done: bool,
}

/// Casts all rays of a picture into `pixels`, and into `through` what of the light behind comes through.
pub(super) fn cast(
    casting: &Casting<'_>,
    camera: &Camera,
    (width, height): (usize, usize),
    pixels: &mut [[f32; BANDS]],
    through: &mut [[f32; BANDS]],
) -> Work {
    pixels
        .par_chunks_mut(TILE * width)
        .zip(through.par_chunks_mut(TILE * width))
        .enumerate()
        .map(|(band, (pixels, through))| {
            let mut work = Work::default();
            for x in (0..width).step_by(TILE) {
                let tile = Tile { x, y: band * TILE, width, height };
                work = work.with(dispatched(casting, camera, tile, pixels, through));
            }
            work
        })
        .reduce(Work::default, Work::with)
}

/// Where a tile is.
#[derive(Clone, Copy)]
struct Tile {
    x: usize,
    y: usize,
    width: usize,
    height: usize,
}

type Pixels<'a> = &'a mut [[f32; BANDS]];

/// One tile, with the widest vectors that the processor has.
fn dispatched(casting: &Casting<'_>, camera: &Camera, tile: Tile, pixels: Pixels<'_>, through: Pixels<'_>) -> Work {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
        #[expect(unsafe_code, reason = "the processor was asked whether it has these instructions")]
        return unsafe { with_avx2(casting, camera, tile, pixels, through) };
    }
    cast_tile::<false>(casting, camera, tile, pixels, through)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn with_avx2(casting: &Casting<'_>, camera: &Camera, tile: Tile, pixels: Pixels<'_>, through: Pixels<'_>) -> Work {
    cast_tile::<true>(casting, camera, tile, pixels, through)
}

#[inline(always)]
fn cast_tile<const FUSED: bool>(
    casting: &Casting<'_>,
    camera: &Camera,
    tile: Tile,
    pixels: Pixels<'_>,
    through: Pixels<'_>,
) -> Work {
    let grid = casting.grid;
    let mut work = Work::default();
    let mut lanes: [Option<Lane>; PIXELS] = std::array::from_fn(|n| {
        let (x, y) = (tile.x + n % TILE, tile.y + n / TILE);
        if x >= tile.width || y >= tile.height {
            return None;
        }
        let ray = grid.ray(&camera.ray(x as f64 + 0.5, y as f64 + 0.5, tile.width, tile.height)?);
        let (enter, leave) = crossing(grid.edges(), &ray)?;
        let enter = enter.max(0.0);
        (enter < leave).then(|| Lane { ray, enter, leave, traveller: Traveller::default(), done: false })
    });
    let Some(bundle) = Bundle::of(grid, &lanes) else { return work };
    let cells = Cells { values: casting.cells, row: grid.padded[0], plane: grid.padded[0] * grid.padded[1] };
    let k = casting.surroundings.extinction;
    let extinction = [k[0], k[1], k[2], 0.0];
    for lane in lanes.iter_mut().flatten() {
        // Places are counted from where the bundle enters: an eye far away costs no digits.
        let origin = grid.index(lane.ray.origin + lane.ray.direction * bundle.enter);
        let step = lane.ray.direction * grid.per_length();
        lane.traveller =
            Traveller { origin: single(origin), step: single(step), light: [0.0; CELL], through: [1.0; CELL] };
        work.rays += 1;
        work.everything += ((lane.leave - lane.enter) * bundle.pace / casting.step) as u64;
    }
    let step = casting.step / bundle.pace;
    let length = step * LANES as f64;
    let mut from = bundle.enter;
    let mut alive = work.rays;
    while from < bundle.leave && alive > 0 {
        let free = bundle.free(casting.occupancy, from);
        if free > 0.0 {
            from += free;
            continue;
        }
        let until = from + length;
        let densest = bundle.densest(casting.occupancy, from, until);
        if densest > 0.0 {
            for lane in lanes.iter_mut().flatten().filter(|lane| !lane.done) {
                let (a, b) = (from.max(lane.enter), until.min(lane.leave));
                if a >= b {
                    continue;
                }
                let whole = b - a >= length * (1.0 - 1e-9);
                let steps = if whole { LANES } else { ((b - a) / step).ceil().max(1.0) as usize };
                let stretch =
                    Stretch { from: (a - bundle.enter) as f32, step: ((b - a) / steps as f64) as f32, steps, densest };
                march::through::<FUSED>(cells, &mut lane.traveller, stretch, extinction);
                work.samples += steps as u64;
                let left = lane.traveller.through;
                let most = left[0].max(left[1]).max(left[2]);
                if most < casting.opaque {
                    lane.done = true;
                    alive -= 1;
                    work.ended += 1;
                    work.hidden = work.hidden.max(most);
                }
            }
        }
        from = until;
    }
    let close = bundle.close(casting.lamps);
    for (n, lane) in lanes.iter().enumerate() {
        let Some(lane) = lane else { continue };
        let [mut red, mut green, mut blue, _] = lane.traveller.light;
        for lamp in close.iter().filter_map(|index| casting.lamps.get(*index)) {
            let pixel = 0.5 * bundle.pixel(lamp.position);
            let more = casting.surroundings.missing(lamp, &lane.ray, (lane.enter, lane.leave), pixel);
            (red, green, blue) = (red + more[0], green + more[1], blue + more[2]);
        }
        let at = n / TILE * tile.width + tile.x + n % TILE;
        if let (Some(pixel), Some(through)) = (pixels.get_mut(at), through.get_mut(at)) {
            *pixel = [red, green, blue];
            *through = [0, 1, 2].map(|band| lane.traveller.through[band]);
        }
    }
    work
}

fn single(v: DVec3) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}

/// The rays of a tile together: a middle ray, and how far from it the others are.
struct Bundle {
    /// Index of the middle's origin, and indices per length.
    origin: DVec3,
    direction: DVec3,
    /// The middle in units of the grid.
    middle: Ray,
    /// How far the others are from the middle: at their origins, and more per length; in indices.
    apart: (f64, f64),
    /// The same in units of the grid.
    width: (f64, f64),
    enter: f64,
    leave: f64,
    /// Indices passed per length.
    pace: f64,
}

impl Bundle {
    fn of(grid: &Grid, lanes: &[Option<Lane>]) -> Option<Bundle> {
        let there = || lanes.iter().flatten();
        let count = there().count();
        if count == 0 {
            return None;
        }
        let sum = |of: fn(&Ray) -> DVec3| there().map(|lane| of(&lane.ray)).sum::<DVec3>() / count as f64;
        let middle = Ray { origin: sum(|ray| ray.origin), direction: sum(|ray| ray.direction) };
        let scale = grid.per_length();
        let (mut apart, mut width) = ((0.0f64, 0.0f64), (0.0f64, 0.0f64));
        for lane in there() {
            let (o, d) = (lane.ray.origin - middle.origin, lane.ray.direction - middle.direction);
            apart = (apart.0.max((o * scale).abs().max_element()), apart.1.max((d * scale).abs().max_element()));
            width = (width.0.max(o.length()), width.1.max(d.length()));
        }
        Some(Bundle {
            origin: grid.index(middle.origin),
            direction: middle.direction * scale,
            middle,
            apart,
            width,
            enter: there().map(|lane| lane.enter).fold(f64::INFINITY, f64::min),
            leave: there().map(|lane| lane.leave).fold(0.0, f64::max),
            pace: there().map(|lane| (lane.ray.direction * scale).length()).fold(1e-9, f64::max),
        })
    }

    fn apart(&self, t: f64) -> f64 {
        // A hair more, for rounding.
        self.apart.0 + self.apart.1 * t + 1e-3
    }

    /// How far all can go on from a length without meeting dust; 0 for less than a few voxels.
    fn free(&self, occupancy: &Occupancy, t: f64) -> f64 {
        let room = occupancy.free(self.origin + self.direction * t) - self.apart(t);
        let far = room / (self.direction.abs().max_element() + self.apart.1).max(1e-12);
        if room > 2.0 { far } else { 0.0 }
    }

    /// The most dust that any can meet between two lengths.
    fn densest(&self, occupancy: &Occupancy, from: f64, until: f64) -> f32 {
        let (a, b) = (self.origin + self.direction * from, self.origin + self.direction * until);
        let apart = DVec3::splat(self.apart(until));
        occupancy.densest(a.min(b) - apart, a.max(b) + apart)
    }

    /// Stars that a ray of it may come close to.
    fn close(&self, lamps: &[Lamp]) -> Vec<usize> {
        let near = |lamp: &Lamp| {
            let to = lamp.position - self.middle.origin;
            let t = to.dot(self.middle.direction) / self.middle.direction.length_squared().max(1e-12);
            let passing = (to - self.middle.direction * t.max(0.0)).length();
            let reach = f64::from(REACH);
            t > -reach && passing < reach + self.width.0 + self.width.1 * (t.max(0.0) + reach)
        };
        (0..lamps.len()).filter(|index| near(&lamps[*index])).collect()
    }

    /// The width of a pixel at a place: the corners of a tile are 3.5 sqrt(2) pixels from its middle.
    fn pixel(&self, place: DVec3) -> f64 {
        let t = (place - self.middle.origin).dot(self.middle.direction).max(0.0);
        (self.width.0 + self.width.1 * t) / (3.5 * std::f64::consts::SQRT_2)
    }
}
