//! The light close to the stars in a picture: only tiles that come near one are looked at.

use glam::DVec3;
use rayon::prelude::*;

use super::REACH;
use crate::physics::dust::camera::{Camera, Ray};
use crate::physics::dust::fast::cast::Casting;
use crate::physics::dust::fast::cast::points::{Points, TILE, Tile, aims};
use crate::physics::dust::fast::shade::{BANDS, Lamp};

type Pixels<'a> = &'a mut [[f32; BANDS]];

/// Adds what the grid cannot hold of the light close to the stars, at all points.
pub(in super::super) fn add_near(
    casting: &Casting<'_>,
    camera: &Camera,
    points: Points<'_>,
    pixels: &mut [[f32; BANDS]],
) {
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
