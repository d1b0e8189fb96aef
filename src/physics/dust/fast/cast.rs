//! Rays through the shaded cells, 8 x 8 pixels at a time: what they pass over is decided once for all of them.

use glam::DVec3;
use rayon::prelude::*;

use super::grid::{Grid, LANES};
use super::march::{self, CELL, Cell, Cells, Stretch, Traveller};
use super::near::{REACH, Surroundings};
use super::occupancy::Occupancy;
use super::shade::{BANDS, Lamp};
use crate::physics::dust::bricks::crossing;
use crate::physics::dust::camera::{Camera, Ray};

/// Pixels along the edge of a tile.
const TILE: usize = 8;
/// Pixels of a tile.
const PIXELS: usize = TILE * TILE;

/// Longest steps so near a star, both in voxels: what the grid holds of its light is a hill three voxels wide, and steep beyond.
const NEAR_STEP: f64 = 0.75;
const NEAR: f64 = 12.0;

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
    fn pixel(&self, place: DVec3) -> f64 {
        let (ray, origin, slope) = self.middle;
        origin + slope * (place - ray.origin).length()
    }
}

/// The ray through the middle of a picture, in units of the grid, and how far from it the next pixel's is.
pub(super) fn middle(grid: &Grid, camera: &Camera, (width, height): (usize, usize)) -> (Ray, f64, f64) {
    let ray = |x: f64| camera.ray(x, height as f64 / 2.0, width, height).map(|ray| grid.ray(&ray));
    let half = width as f64 / 2.0;
    match (ray(half), ray(half + 0.5)) {
        (Some(a), Some(b)) => (a, 2.0 * (b.origin - a.origin).length(), 2.0 * (b.direction - a.direction).length()),
        _ => (Ray { origin: DVec3::ZERO, direction: DVec3::Z }, 0.0, 0.0),
    }
}

/// Which points of a picture rays are cast through.
#[derive(Clone, Copy)]
pub(super) struct Points<'a> {
    /// Of the whole picture, pixels.
    pub(super) picture: (usize, usize),
    /// Points across and down.
    pub(super) count: (usize, usize),
    /// From one point to the next, pixels.
    pub(super) apart: usize,
    /// Where the first is, pixels from the left and the top.
    pub(super) first: f64,
    /// By point, whether it is wanted; all where this is nothing.
    pub(super) wanted: Option<&'a [bool]>,
}

impl Points<'_> {
    fn ray(&self, camera: &Camera, x: usize, y: usize) -> Option<Ray> {
        let at = |n: usize| (n * self.apart) as f64 + self.first;
        camera.ray(at(x), at(y), self.picture.0, self.picture.1)
    }
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
    pub(super) fn with(self, other: Work) -> Work {
        Work {
            samples: self.samples + other.samples,
            everything: self.everything + other.everything,
            rays: self.rays + other.rays,
            ended: self.ended + other.ended,
            hidden: self.hidden.max(other.hidden),
        }
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

/// One pixel's ray in units of the grid.
#[derive(Clone, Copy)]
struct Aim {
    ray: Ray,
    enter: f64,
    leave: f64,
    /// Its pixel in the tile.
    pixel: usize,
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

/// Adds what the grid cannot hold of the light close to the stars, at all points.
pub(super) fn add_near(casting: &Casting<'_>, camera: &Camera, points: Points<'_>, pixels: &mut [[f32; BANDS]]) {
    let width = points.count.0;
    let points = Points { wanted: None, ..points };
    pixels.par_chunks_mut(TILE * width).enumerate().for_each(|(band, pixels)| {
        for x in (0..width).step_by(TILE) {
            near_dispatched(casting, camera, Tile { x, y: band * TILE, points }, pixels);
        }
    });
}

/// The same in one tile, with the widest vectors that the processor has.
fn near_dispatched(casting: &Casting<'_>, camera: &Camera, tile: Tile<'_>, pixels: Pixels<'_>) {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma") {
        #[expect(unsafe_code, reason = "the processor was asked whether it has these instructions")]
        return unsafe { near_with_avx2(casting, camera, tile, pixels) };
    }
    near_tile::<false>(casting, camera, tile, pixels);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn near_with_avx2(casting: &Casting<'_>, camera: &Camera, tile: Tile<'_>, pixels: Pixels<'_>) {
    near_tile::<true>(casting, camera, tile, pixels);
}

#[inline(always)]
fn near_tile<const FUSED: bool>(casting: &Casting<'_>, camera: &Camera, tile: Tile<'_>, pixels: Pixels<'_>) {
    let Tile { x, y, points } = tile;
    let (width, height) = points.count;
    let (right, bottom) = ((x + TILE - 1).min(width - 1), (y + TILE - 1).min(height - 1));
    let corners = [(x, y), (right, y), (x, bottom), (right, bottom)];
    let rays = corners.map(|(x, y)| points.ray(camera, x, y).map(|ray| casting.grid.ray(&ray)));
    // A tile on the rim of a domemaster has corners without rays: it is looked at in full.
    let whole = rays.iter().all(Option::is_some);
    let close = if whole { close(rays.iter().flatten(), casting.lamps) } else { (0..casting.lamps.len()).collect() };
    if close.is_empty() {
        return;
    }
    let (aims, count) = aims(casting.grid, camera, tile);
    for aim in &aims[..count] {
        let Some(pixel) = pixels.get_mut(aim.pixel / TILE * width + x + aim.pixel % TILE) else { continue };
        for lamp in close.iter().filter_map(|index| casting.lamps.get(*index)) {
            let half = 0.5 * points.apart as f64 * casting.pixel(lamp.position);
            let more = casting.surroundings.missing::<FUSED>(lamp, &aim.ray, (aim.enter, aim.leave), half);
            pixel.iter_mut().zip(more).for_each(|(pixel, more)| *pixel += more);
        }
    }
}

/// Stars that a ray between some may come close to.
fn close<'a>(rays: impl Iterator<Item = &'a Ray> + Clone, lamps: &[Lamp]) -> Vec<usize> {
    let count = rays.clone().count().max(1) as f64;
    let mean = |of: fn(&Ray) -> DVec3| rays.clone().map(of).sum::<DVec3>() / count;
    let (origin, direction) = (mean(|ray| ray.origin), mean(|ray| ray.direction));
    let width = rays.fold((0.0f64, 0.0f64), |width, ray| {
        (width.0.max((ray.origin - origin).length()), width.1.max((ray.direction - direction).length()))
    });
    let near = |lamp: &Lamp| {
        let to = lamp.position - origin;
        let t = to.dot(direction) / direction.length_squared().max(1e-12);
        let passing = (to - direction * t.max(0.0)).length();
        let reach = f64::from(REACH);
        t > -reach && passing < reach + width.0 + width.1 * (t.max(0.0) + reach)
    };
    (0..lamps.len()).filter(|index| near(&lamps[*index])).collect()
}

/// Where a tile is.
#[derive(Clone, Copy)]
struct Tile<'a> {
    x: usize,
    y: usize,
    points: Points<'a>,
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

/// The rays of a tile that meet the box.
fn aims(grid: &Grid, camera: &Camera, tile: Tile<'_>) -> ([Aim; PIXELS], usize) {
    let nowhere = Aim { ray: Ray { origin: DVec3::ZERO, direction: DVec3::Z }, enter: 0.0, leave: 0.0, pixel: 0 };
    let points = tile.points;
    let (mut aims, mut count) = ([nowhere; PIXELS], 0);
    for pixel in 0..PIXELS {
        let (x, y) = (tile.x + pixel % TILE, tile.y + pixel / TILE);
        let (columns, rows) = points.count;
        let unwanted = || points.wanted.is_some_and(|wanted| !wanted.get(y * columns + x).copied().unwrap_or(false));
        if x >= columns || y >= rows || unwanted() {
            continue;
        }
        let Some(ray) = points.ray(camera, x, y) else { continue };
        let ray = grid.ray(&ray);
        let Some((enter, leave)) = crossing(grid.edges(), &ray) else { continue };
        let enter = enter.max(0.0);
        if enter < leave {
            aims[count] = Aim { ray, enter, leave, pixel };
            count += 1;
        }
    }
    (aims, count)
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

/// The rays of a tile together: a middle ray, and how far from it the others are.
struct Bundle {
    /// Index of the middle's origin, and indices per length.
    origin: DVec3,
    direction: DVec3,
    /// How far the others are from the middle: at their origins, and more per length; in indices.
    apart: (f64, f64),
    enter: f64,
    leave: f64,
    /// Indices passed per length.
    pace: f64,
}

impl Bundle {
    fn of(grid: &Grid, aims: &[Aim]) -> Option<Bundle> {
        if aims.is_empty() {
            return None;
        }
        let sum = |of: fn(&Ray) -> DVec3| aims.iter().map(|aim| of(&aim.ray)).sum::<DVec3>() / aims.len() as f64;
        let middle = Ray { origin: sum(|ray| ray.origin), direction: sum(|ray| ray.direction) };
        let scale = grid.per_length();
        let mut apart = (0.0f64, 0.0f64);
        for aim in aims {
            let (o, d) = (aim.ray.origin - middle.origin, aim.ray.direction - middle.direction);
            apart = (apart.0.max((o * scale).abs().max_element()), apart.1.max((d * scale).abs().max_element()));
        }
        Some(Bundle {
            origin: grid.index(middle.origin),
            direction: middle.direction * scale,
            apart,
            enter: aims.iter().map(|aim| aim.enter).fold(f64::INFINITY, f64::min),
            leave: aims.iter().map(|aim| aim.leave).fold(0.0, f64::max),
            pace: aims.iter().map(|aim| (aim.ray.direction * scale).length()).fold(1e-9, f64::max),
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

    /// Corners of a box around all between two lengths.
    fn around(&self, from: f64, until: f64) -> (DVec3, DVec3) {
        let (a, b) = (self.origin + self.direction * from, self.origin + self.direction * until);
        let apart = DVec3::splat(self.apart(until));
        (a.min(b) - apart, a.max(b) + apart)
    }

    /// The most dust that any can meet between two lengths.
    fn densest(&self, occupancy: &Occupancy, from: f64, until: f64) -> f32 {
        let (low, high) = self.around(from, until);
        occupancy.densest(low, high)
    }

    /// Whether any can come near a star between two lengths.
    fn near_a_star(&self, casting: &Casting<'_>, from: f64, until: f64) -> bool {
        let (low, high) = self.around(from, until);
        let reach = casting.grid.per_length() * NEAR;
        casting.lamps.iter().any(|lamp| {
            let star = casting.grid.index(lamp.position);
            star.cmpge(low - reach).all() && star.cmple(high + reach).all()
        })
    }
}
