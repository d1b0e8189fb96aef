//! Which rays a picture needs, in tiles of 8 x 8.

use glam::DVec3;

use crate::physics::dust::bricks::crossing;
use crate::physics::dust::camera::{Camera, Ray};
use crate::physics::dust::fast::grid::Grid;

/// Pixels along the edge of a tile.
pub(in super::super) const TILE: usize = 8;
/// Pixels of a tile.
pub(in super::super) const PIXELS: usize = TILE * TILE;

/// The ray through the middle of a picture, in units of the grid, and how far from it the next pixel's is.
pub(in super::super) fn middle(grid: &Grid, camera: &Camera, (width, height): (usize, usize)) -> (Ray, f64, f64) {
    let ray = |x: f64| camera.ray(x, height as f64 / 2.0, width, height).map(|ray| grid.ray(&ray));
    let half = width as f64 / 2.0;
    match (ray(half), ray(half + 0.5)) {
        (Some(a), Some(b)) => (a, 2.0 * (b.origin - a.origin).length(), 2.0 * (b.direction - a.direction).length()),
        _ => (Ray { origin: DVec3::ZERO, direction: DVec3::Z }, 0.0, 0.0),
    }
}

/// Which points of a picture rays are cast through.
#[derive(Clone, Copy)]
pub(in super::super) struct Points<'a> {
    /// Of the whole picture, pixels.
    pub(in super::super) picture: (usize, usize),
    /// Points across and down.
    pub(in super::super) count: (usize, usize),
    /// From one point to the next, pixels.
    pub(in super::super) apart: usize,
    /// Where the first is, pixels from the left and the top.
    pub(in super::super) first: f64,
    /// By point, whether it is wanted; all where this is nothing.
    pub(in super::super) wanted: Option<&'a [bool]>,
}

impl Points<'_> {
    pub(in super::super) fn ray(&self, camera: &Camera, x: usize, y: usize) -> Option<Ray> {
        let at = |n: usize| (n * self.apart) as f64 + self.first;
        camera.ray(at(x), at(y), self.picture.0, self.picture.1)
    }
}

/// Where a tile is.
#[derive(Clone, Copy)]
pub(in super::super) struct Tile<'a> {
    pub(in super::super) x: usize,
    pub(in super::super) y: usize,
    pub(in super::super) points: Points<'a>,
}

/// One pixel's ray in units of the grid.
#[derive(Clone, Copy)]
pub(in super::super) struct Aim {
    pub(in super::super) ray: Ray,
    pub(in super::super) enter: f64,
    pub(in super::super) leave: f64,
    /// Its pixel in the tile.
    pub(in super::super) pixel: usize,
}

/// The rays of a tile that meet the box.
pub(in super::super) fn aims(grid: &Grid, camera: &Camera, tile: Tile<'_>) -> ([Aim; PIXELS], usize) {
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
