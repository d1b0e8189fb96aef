//! Maria and craters of one photograph laid on the other: turn and parity by correlation round the disc, then all four numbers
//! by least squares (Lucas and Kanade 1981), and their errors from how well small tiles agree with each other.

use super::frame::Frame;
use super::limb::Limb;
use super::linear::{Normal, median};
use super::texture::{Placing, SIDE, Texture, alone, disc, sampled, together};

/// How the second face lies on the first: `u' = (1 + stretch) Rot(turn) u + shift`, in half widths of the disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Laid {
    /// How much larger.
    pub(super) stretch: f64,
    /// Turned from x to y, radians.
    pub(super) turn: f64,
    pub(super) shift: (f64, f64),
    /// Standard deviations of stretch (and turn) and of the shift.
    pub(super) error: f64,
    pub(super) shift_error: f64,
    /// Whether left and right were exchanged.
    pub(super) mirrored: bool,
    /// Correlation of the two faces once laid on each other, 0 to 1.
    pub(super) alike: f64,
}

/// Angles tried in the search.
const ANGLES: usize = 360;
/// Rings of the search.
const RINGS: usize = 14;
/// Two faces are the same if they correlate so well, and the better parity must lead by as much as [`LEAD`].
const ALIKE: f64 = 0.25;
const LEAD: f64 = 0.06;
/// Cells of a tile's side.
const TILE: usize = 24;
/// Least tiles that speak of an error.
const LEAST_TILES: usize = 8;

/// Lays the second photograph's face on the first's; `None` where they share too little.
pub(super) fn laid(first: (&Frame, &Limb), second: (&Frame, &Limb)) -> Option<Laid> {
    let seen = sampled(first.0, &Placing::of(first.1, false));
    let mut tried: Vec<Laid> = Vec::new();
    for mirrored in [false, true] {
        tried.extend(one_parity(&seen, second.0, &Placing::of(second.1, mirrored), mirrored));
    }
    tried.sort_by(|a, b| b.alike.total_cmp(&a.alike));
    let best = *tried.first()?;
    let lead = best.alike - tried.get(1).map_or(0.0, |next| next.alike);
    (best.alike > ALIKE && lead > LEAD).then_some(best)
}

/// Times that the second face is taken anew through the map found so far. Only where both are cut out alike do their borders
/// not pull.
const ANEW: usize = 3;

fn one_parity(seen: &[Option<f32>], frame: &Frame, placing: &Placing, mirrored: bool) -> Option<Laid> {
    let (one, other) = (alone(seen), alone(&sampled(frame, placing)));
    let turn = searched(&one.softened(3), &other.softened(3))?;
    let mut map = Map { a: turn.cos(), b: turn.sin(), x: 0.0, y: 0.0 };
    map = refined(&one, &other, map, &[(8, 12), (4, 10), (2, 6)])?;
    for _ in 0..ANEW {
        let (one, other) = together(seen, &sampled(frame, &map.over(placing)));
        let more = refined(&one, &other, Map::SAME, &[(2, 5), (1, 4)])?;
        map = map.after(&more);
    }
    let (one, other) = together(seen, &sampled(frame, &map.over(placing)));
    tiled(&one.softened(1), &other.softened(1), &map, mirrored)
}

/// The turn at which the rings of two faces correlate best.
fn searched(first: &Texture, second: &Texture) -> Option<f64> {
    let rings = |texture: &Texture| -> Vec<Option<f64>> {
        let mut values = Vec::with_capacity(RINGS * ANGLES);
        for ring in 0..RINGS {
            let radius = 0.2 + 0.7 * ring as f64 / (RINGS - 1) as f64;
            for k in 0..ANGLES {
                let (sin, cos) = (k as f64 / ANGLES as f64 * std::f64::consts::TAU).sin_cos();
                values.push(texture.at(radius * cos, radius * sin).map(|(value, _, _)| value));
            }
        }
        values
    };
    let (one, other) = (rings(first), rings(second));
    let mut best = (0.0, None);
    for turn in 0..ANGLES {
        let (mut both, mut a2, mut b2, mut count) = (0.0, 0.0, 0.0, 0usize);
        for ring in 0..RINGS {
            // Further out a ring is longer.
            let weight = 0.2 + 0.7 * ring as f64 / (RINGS - 1) as f64;
            for k in 0..ANGLES {
                if let (Some(a), Some(b)) = (one[ring * ANGLES + k], other[ring * ANGLES + (k + turn) % ANGLES]) {
                    both += weight * a * b;
                    a2 += weight * a * a;
                    b2 += weight * b * b;
                    count += 1;
                }
            }
        }
        // A few shared cells correlate by chance.
        let share = (count as f64 / 600.0).min(1.0);
        let alike = share * both / (a2 * b2).sqrt().max(1e-12);
        if alike > best.0 {
            best = (alike, Some(turn as f64 / ANGLES as f64 * std::f64::consts::TAU));
        }
    }
    best.1
}

/// Least squares from blurred faces to sharper ones: (cells of blur, steps) one after the other.
fn refined(first: &Texture, second: &Texture, mut map: Map, rounds: &[(usize, usize)]) -> Option<Map> {
    for (cells, steps) in rounds {
        let (one, other) = (first.softened(*cells), second.softened(*cells));
        for _ in 0..*steps {
            map = aligned(&one, &other, &map)?;
        }
        if !(0.8..1.25).contains(&map.a.hypot(map.b)) || map.x.hypot(map.y) > 0.25 {
            return None;
        }
    }
    Some(map)
}

/// `u' = (a u - b v + x, b u + a v + y)`.
#[derive(Debug, Clone, Copy)]
struct Map {
    a: f64,
    b: f64,
    x: f64,
    y: f64,
}

impl Map {
    const SAME: Map = Map { a: 1.0, b: 0.0, x: 0.0, y: 0.0 };

    fn apply(&self, u: f64, v: f64) -> (f64, f64) {
        (self.a * u - self.b * v + self.x, self.b * u + self.a * v + self.y)
    }

    /// First another map, then this.
    fn after(&self, first: &Map) -> Map {
        let (x, y) = self.apply(first.x, first.y);
        Map { a: self.a * first.a - self.b * first.b, b: self.b * first.a + self.a * first.b, x, y }
    }

    /// Where a placing puts what this map leads to.
    fn over(&self, placing: &Placing) -> Placing {
        let middle = placing.at(self.x, self.y);
        let from = |(x, y): (f64, f64)| (x - middle.0, y - middle.1);
        let (right, down) = (self.apply(1.0, 0.0), self.apply(0.0, 1.0));
        Placing { middle, across: from(placing.at(right.0, right.1)), down: from(placing.at(down.0, down.1)) }
    }
}

/// One step of Gauss-Newton for map and contrast.
fn aligned(first: &Texture, second: &Texture, map: &Map) -> Option<Map> {
    let (mut both, mut other2) = (0.0, 1e-12);
    let mut cells = Vec::new();
    each(first, second, map, |u, v, here, (there, across, down)| {
        both += here * there;
        other2 += there * there;
        cells.push([u, v, here, there, across, down]);
    });
    if cells.len() < 600 {
        return None;
    }
    let gain = (both / other2).clamp(0.2, 5.0);
    let mut normal = Normal::<4>::new();
    for [u, v, here, there, across, down] in cells {
        let (gx, gy) = (gain * across, gain * down);
        let rest: f64 = here - gain * there;
        // A crater's shadow that one of them lacks is no shift.
        let weight = 1.0 / (1.0 + (rest / 0.15).powi(2));
        normal.add(&[gx * u + gy * v, gy * u - gx * v, gx, gy], rest, weight);
    }
    let (by, _) = normal.solve()?;
    Some(Map { a: map.a + by[0], b: map.b + by[1], x: map.x + by[2], y: map.y + by[3] })
}

/// Walks over the cells that both know: disc coordinates, the first's value, the second's value and slopes.
fn each(first: &Texture, second: &Texture, map: &Map, mut with: impl FnMut(f64, f64, f64, (f64, f64, f64))) {
    for row in 0..SIDE {
        for column in 0..SIDE {
            let k = row * SIDE + column;
            if first.known[k] == 0.0 {
                continue;
            }
            let (u, v) = (disc(column as f64), disc(row as f64));
            let (x, y) = map.apply(u, v);
            if let Some(there) = second.at(x, y) {
                with(u, v, f64::from(first.values[k]), there);
            }
        }
    }
}

/// What a tile's own shift needs.
#[derive(Clone)]
struct Tile {
    normal: Normal<2>,
    sums: [f64; 4],
}

/// The last step, tile by tile: each says how far it is off by itself, and by how much they contradict each other is the error.
fn tiled(first: &Texture, second: &Texture, before: &Map, mirrored: bool) -> Option<Laid> {
    let across = SIDE.div_ceil(TILE);
    let mut tiles = vec![Tile { normal: Normal::new(), sums: [0.0; 4] }; across * across];
    let (mut both, mut one2, mut other2) = (0.0, 1e-12, 1e-12);
    each(first, second, &Map::SAME, |_, _, here, (there, _, _)| {
        both += here * there;
        one2 += here * here;
        other2 += there * there;
    });
    let gain = (both / other2).clamp(0.2, 5.0);
    each(first, second, &Map::SAME, |u, v, here, (there, gx, gy)| {
        let at = |w: f64| (((w / super::texture::REACH + 1.0) / 2.0 * SIDE as f64) as usize / TILE).min(across - 1);
        let tile = &mut tiles[at(v) * across + at(u)];
        tile.normal.add(&[gain * gx, gain * gy], here - gain * there, 1.0);
        (0..4).for_each(|k| tile.sums[k] += [1.0, u, v, 0.0][k]);
    });
    let shifts: Vec<[f64; 5]> = tiles
        .iter()
        .filter(|tile| tile.sums[0] > (TILE * TILE / 3) as f64)
        .filter_map(|tile| {
            let (by, inverse) = tile.normal.solve()?;
            let (u, v) = (tile.sums[1] / tile.sums[0], tile.sums[2] / tile.sums[0]);
            Some([u, v, by[0], by[1], inverse[0][0] + inverse[1][1]])
        })
        .filter(|[.., variance]| variance.is_finite())
        .collect();
    if shifts.len() < LEAST_TILES {
        return None;
    }
    let (by, inverse, variance) = joined(&shifts)?;
    let map = before.after(&Map { a: 1.0 + by[0], b: by[1], x: by[2], y: by[3] });
    let size = map.a.hypot(map.b);
    Some(Laid {
        stretch: size - 1.0,
        turn: map.b.atan2(map.a),
        shift: (map.x, map.y),
        error: (inverse[0][0] * variance).sqrt(),
        shift_error: (inverse[2][2].max(inverse[3][3]) * variance).sqrt(),
        mirrored,
        alike: both / (one2 * other2).sqrt(),
    })
}

/// Four corrections, the inverse of their equations, and the variance of unit weight.
type Joined = ([f64; 4], [[f64; 4]; 4], f64);

/// One similarity through the tiles' shifts, robustly.
fn joined(shifts: &[[f64; 5]]) -> Option<Joined> {
    let mut variances: Vec<f64> = shifts.iter().map(|s| s[4]).collect();
    // A tile's shift is never better known than a typical one: what craters' shadows add is common to all.
    let floor = median(&mut variances);
    let mut weights = vec![1.0; shifts.len()];
    let mut last = None;
    for _ in 0..8 {
        let mut normal = Normal::<4>::new();
        for ([u, v, x, y, variance], weight) in shifts.iter().zip(&weights) {
            let weight = weight / (variance + floor);
            normal.add(&[*u, -v, 1.0, 0.0], *x, weight);
            normal.add(&[*v, *u, 0.0, 1.0], *y, weight);
        }
        let (by, inverse) = normal.solve()?;
        let rest: Vec<f64> = shifts
            .iter()
            .map(|[u, v, x, y, variance]| {
                let off = (x - by[0] * u + by[1] * v - by[2]).powi(2) + (y - by[0] * v - by[1] * u - by[3]).powi(2);
                (off / (variance + floor)).sqrt()
            })
            .collect();
        // Median of a Rayleigh distribution: 1.177 standard deviations.
        let scale = median(&mut rest.clone()) / 1.177;
        let (mut misfit, mut free) = (0.0, 0.0);
        for (weight, rest) in weights.iter_mut().zip(&rest) {
            let t = rest / (5.0 * scale).max(1e-12);
            *weight = if t < 1.0 { (1.0 - t * t).powi(2) } else { 0.0 };
            misfit += *weight * rest * rest;
            free += 2.0 * *weight;
        }
        // The biweight takes from the tails of good tiles as well: on Gaussian scatter it leaves 0.9 of the variance.
        last = Some((by, inverse, misfit / (free - 4.0).max(1.0) / 0.9));
    }
    last
}
