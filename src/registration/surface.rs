//! Maria and craters of one photograph laid on the other: turn and parity by correlation round the disc, then all four numbers
//! by least squares (Lucas and Kanade 1981), and their errors from how well small tiles agree with each other.

use super::frame::Frame;
use super::limb::Limb;
use super::linear::Normal;
use super::texture::{Placing, SIDE, Texture, alone, disc, sampled, together};

/// How the second face lies on the first: `u' = (1 + stretch) Rot(turn) u + shift`, in half widths of the disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Laid {
    /// How much larger.
    pub(super) stretch: f64,
    /// Turned from x to y, radians.
    pub(super) turn: f64,
    pub(super) shift: (f64, f64),
    /// Standard deviations of stretch, turn and shift.
    pub(super) error: f64,
    pub(super) turn_error: f64,
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
        let more = refined(&one, &other, Map::SAME, &[(2, 3), (1, 4)])?;
        map = map.after(&more);
    }
    let (one, other) = together(seen, &sampled(frame, &map.over(placing)));
    settled(&one.softened(1), &other.softened(1), &map, mirrored)
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

/// One step towards the map that lays the second face on the first.
///
/// Least squares would be drawn off by noise: it lowers the fitted contrast, and a wrong contrast looks like a wrong size. So the
/// two faces take turns, and what noise does to the one is taken back by the other:
///
/// ```text
/// step = sum(w . grad B  A - w . grad A  B) / (2 sum (w . grad A) (w . grad B))          w what the number moves
/// ```
fn aligned(first: &Texture, second: &Texture, map: &Map) -> Option<Map> {
    let mut normal = Normal::<4>::new();
    let mut count = 0usize;
    each(first, second, map, |u, v, here, there| {
        let (own, other) = (moved(u, v, here), moved(u, v, there));
        normal.cross(&own, &other, |k| other[k] * here.0 - own[k] * there.0);
        count += 1;
    });
    if count < 600 {
        return None;
    }
    let (by, _) = normal.solve()?;
    Some(map.after(&Map { a: 1.0 + by[0], b: by[1], x: by[2], y: by[3] }))
}

/// What stretch, turn and shift change in the value at a place.
fn moved(u: f64, v: f64, (_, gx, gy): Point) -> [f64; 4] {
    [gx * u + gy * v, gy * u - gx * v, gx, gy]
}

/// Value and slopes.
type Point = (f64, f64, f64);

/// Walks over the cells that both know: disc coordinates, and both faces' values and slopes along those coordinates.
fn each(first: &Texture, second: &Texture, map: &Map, mut with: impl FnMut(f64, f64, Point, Point)) {
    for row in 0..SIDE {
        for column in 0..SIDE {
            if first.known[row * SIDE + column] == 0.0 {
                continue;
            }
            let (u, v) = (disc(column as f64), disc(row as f64));
            let (x, y) = map.apply(u, v);
            if let (Some(here), Some((there, gx, gy))) = (first.at(u, v), second.at(x, y)) {
                with(u, v, here, (there, map.a * gx + map.b * gy, map.a * gy - map.b * gx));
            }
        }
    }
}

/// The last step, and its error from how far tiles contradict each other: the jackknife (Quenouille 1956, Tukey 1958), each tile
/// left out in its turn.
fn settled(first: &Texture, second: &Texture, before: &Map, mirrored: bool) -> Option<Laid> {
    let across = SIDE.div_ceil(TILE);
    let mut tiles: Vec<Option<Normal<4>>> = vec![None; across * across];
    let mut normal = Normal::<4>::new();
    let (mut both, mut one2, mut other2) = (0.0, 1e-12, 1e-12);
    let tile_of = |w: f64| (((w / super::texture::REACH + 1.0) / 2.0 * SIDE as f64) as usize / TILE).min(across - 1);
    each(first, second, &Map::SAME, |u, v, here, there| {
        let (own, other) = (moved(u, v, here), moved(u, v, there));
        let right = |k: usize| other[k] * here.0 - own[k] * there.0;
        normal.cross(&own, &other, right);
        tiles[tile_of(v) * across + tile_of(u)].get_or_insert_with(Normal::new).cross(&own, &other, right);
        both += here.0 * there.0;
        one2 += here.0 * here.0;
        other2 += there.0 * there.0;
    });
    let (by, _) = normal.solve()?;
    let tiles: Vec<Normal<4>> = tiles.into_iter().flatten().collect();
    if tiles.len() < LEAST_TILES {
        return None;
    }
    let without: Vec<[f64; 4]> =
        tiles.iter().map(|tile| normal.without(tile).solve().map(|(by, _)| by)).collect::<Option<_>>()?;
    let n = tiles.len() as f64;
    let variance = |k: usize| (n - 1.0) / n * without.iter().map(|other| (other[k] - by[k]).powi(2)).sum::<f64>();
    let map = before.after(&Map { a: 1.0 + by[0], b: by[1], x: by[2], y: by[3] });
    Some(Laid {
        stretch: map.a.hypot(map.b) - 1.0,
        turn: map.b.atan2(map.a),
        shift: (map.x, map.y),
        error: variance(0).sqrt(),
        turn_error: variance(1).sqrt(),
        shift_error: variance(2).max(variance(3)).sqrt(),
        mirrored,
        alike: both / (one2 * other2).sqrt(),
    })
}
