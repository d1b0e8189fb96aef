//! One step towards the map that lays one face on another, and its error from how far small tiles contradict each other.

use super::linear::Normal;
use super::map::Map;
use super::texture::{Texture, disc};

/// The equations of a step, tile by tile.
///
/// Least squares would be drawn off by noise: it lowers the fitted contrast, and a wrong contrast looks like a wrong size. So the
/// two faces take turns, and what noise does to the one is taken back by the other:
///
/// ```text
/// step = sum v (w . grad B  A - w . grad A  B) / (2 sum v (w . grad A) (w . grad B))    w what the number moves
/// ```
///
/// `v` is one over the variance of the difference of the two, so that what is dim near the terminator counts less.
pub(super) struct Step {
    all: Normal<4>,
    tiles: Vec<Normal<4>>,
    cells: usize,
    alike: f64,
}

/// Tiles a side of the disc's square.
const TILES: usize = 32;
/// Least tiles that speak of an error.
const LEAST_TILES: usize = 12;
/// Least cells that are compared.
const LEAST_CELLS: usize = 300;

impl Step {
    /// Compares two faces cell by cell.
    pub(super) fn between(first: &Texture, second: &Texture) -> Step {
        let side = first.side;
        let per_radius = first.cells_per_radius() / 2.0;
        let slopes = |texture: &Texture, k: usize| {
            let by =
                |ahead: usize, behind: usize| f64::from(texture.values[ahead] - texture.values[behind]) * per_radius;
            (by(k + 1, k - 1), by(k + side, k - side))
        };
        let mut tiles = vec![Normal::<4>::new(); TILES * TILES];
        let mut counts = vec![0usize; TILES * TILES];
        let (mut both, mut one2, mut other2) = (0.0, 1e-12, 1e-12);
        for row in 1..side - 1 {
            for column in 1..side - 1 {
                let k = row * side + column;
                let known = [k, k + 1, k - 1, k + side, k - side].iter().all(|k| first.known[*k] > 0.0);
                if !known || second.known[k] == 0.0 {
                    continue;
                }
                let (u, v) = (disc(column, side), disc(row, side));
                let (here, there) = (f64::from(first.values[k]), f64::from(second.values[k]));
                let (own, other) = (moved(u, v, slopes(first, k)), moved(u, v, slopes(second, k)));
                let weight = 1.0 / f64::from(1.0 / first.weights[k] + 1.0 / second.weights[k]);
                let tile = row * TILES / side * TILES + column * TILES / side;
                tiles[tile].cross(&own, &other, |k| other[k] * here - own[k] * there, weight);
                counts[tile] += 1;
                both += weight * here * there;
                one2 += weight * here * here;
                other2 += weight * there * there;
            }
        }
        let mut all = Normal::<4>::new();
        tiles.iter().for_each(|tile| all.join(tile));
        let tiles = tiles.into_iter().zip(&counts).filter(|(_, count)| **count > 0).map(|(tile, _)| tile).collect();
        Step { all, tiles, cells: counts.iter().sum(), alike: both / f64::sqrt(one2 * other2) }
    }

    /// Correlation of the two faces, 0 to 1.
    pub(super) fn alike(&self) -> f64 {
        self.alike
    }

    /// How far the step goes: half widths of the disc at its limb; `None` where too little is known for one.
    pub(super) fn size(&self) -> Option<f64> {
        let by = self.by()?;
        Some(by.iter().map(|by| by.abs()).sum())
    }

    fn by(&self) -> Option<[f64; 4]> {
        (self.cells >= LEAST_CELLS).then(|| self.all.solve().map(|(by, _)| by))?
    }

    /// The map after the step.
    pub(super) fn taken(&self, before: &Map) -> Option<Map> {
        self.by().map(|by| before.after(&Map::changed(by)))
    }

    /// The map after the step, and the covariance of stretch, turn and shift: the jackknife (Quenouille 1956, Tukey 1958), each
    /// tile left out in its turn.
    pub(super) fn settled(&self, before: &Map) -> Option<(Map, [[f64; 4]; 4])> {
        if self.tiles.len() < LEAST_TILES {
            return None;
        }
        let numbers = |by| {
            let map = before.after(&Map::changed(by));
            [map.stretch(), map.b.atan2(map.a), map.x, map.y]
        };
        let by = self.by()?;
        let all = numbers(by);
        let mut covariance = [[0.0; 4]; 4];
        let n = self.tiles.len() as f64;
        for tile in &self.tiles {
            let without = numbers(self.all.without(tile).solve()?.0);
            let mut off: [f64; 4] = std::array::from_fn(|k| without[k] - all[k]);
            // A turn of nearly half a circle may jump.
            off[1] = off[1].sin().atan2(off[1].cos());
            for i in 0..4 {
                for j in 0..4 {
                    covariance[i][j] += (n - 1.0) / n * off[i] * off[j];
                }
            }
        }
        Some((before.after(&Map::changed(by)), covariance))
    }
}

/// What stretch, turn and shift change in the value at a place.
fn moved(u: f64, v: f64, (gx, gy): (f64, f64)) -> [f64; 4] {
    [gx * u + gy * v, gy * u - gx * v, gx, gy]
}
