//! Maria and craters of one photograph laid on the other: turn and parity by correlation round the disc, then all four numbers
//! by matching the faces, coarse before fine.

use super::frame::Frame;
use super::limb::Limb;
use super::map::{Map, Placing};
use super::step::Step;
use super::texture::{Source, Texture};

/// How the second face lies on the first: `u' = (1 + stretch) Rot(turn) u + shift`, in half widths of the disc.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Laid {
    /// How much larger.
    pub(super) stretch: f64,
    /// Turned from x to y, radians.
    pub(super) turn: f64,
    pub(super) shift: (f64, f64),
    /// Covariance of stretch, turn and shift.
    pub(super) covariance: [[f64; 4]; 4],
    /// Whether left and right were exchanged.
    pub(super) mirrored: bool,
}

/// Cells a side of the disc's square, from coarse to fine.
const SIDES: [usize; 3] = [96, 192, 384];
/// Angles tried in the search.
const ANGLES: usize = 360;
/// Rings of the search.
const RINGS: usize = 14;
/// Two faces are the same if they correlate so well, and the better parity must lead by as much as [`LEAD`].
const ALIKE: f64 = 0.25;
const LEAD: f64 = 0.06;

/// Lays the second photograph's face on the first's; `None` where they share too little.
pub(super) fn laid(first: (&Frame, &Limb), second: (&Frame, &Limb)) -> Option<Laid> {
    let faces = |side| (Source::of(first.0, first.1, side), Source::of(second.0, second.1, side));
    let seen = Placing::of(first.1, false);
    let [coarse, middle, fine] = SIDES;
    let (coarse, middle) = (faces(coarse), faces(middle));
    let mut tried: Vec<(f64, bool, Map)> = Vec::new();
    for mirrored in [false, true] {
        let placings = (seen, Placing::of(second.1, mirrored));
        tried.extend(placed(&coarse, &middle, &placings).map(|(alike, map)| (alike, mirrored, map)));
    }
    tried.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (alike, mirrored, map) = *tried.first()?;
    if alike < ALIKE || alike - tried.get(1).map_or(0.0, |next| next.0) < LEAD {
        return None;
    }
    let placings = (seen, Placing::of(second.1, mirrored));
    let (before, step) = matched(&faces(fine), &placings, map, 1, 6)?;
    let (map, covariance) = step.settled(&before)?;
    Some(Laid { stretch: map.stretch(), turn: map.b.atan2(map.a), shift: (map.x, map.y), covariance, mirrored })
}

/// Both photographs at one fineness.
type Faces<'a> = (Source<'a>, Source<'a>);

/// How one parity lies, to a part of a coarse cell, and how alike the faces are then.
fn placed(coarse: &Faces, middle: &Faces, placings: &(Placing, Placing)) -> Option<(f64, Map)> {
    let alone = |source: &Source, placing| Texture::alone(&source.cut(placing)).softened(1);
    let turn = searched(&alone(&coarse.0, &placings.0), &alone(&coarse.1, &placings.1))?;
    let (map, _) = matched(coarse, placings, Map::turned(turn), 2, 12)?;
    let (map, _) = matched(coarse, placings, map, 1, 8)?;
    let (map, step) = matched(middle, placings, map, 1, 6)?;
    Some((step.alike(), map))
}

/// The turn at which the rings of two faces correlate best.
fn searched(first: &Texture, second: &Texture) -> Option<f64> {
    let rings = |texture: &Texture| -> Vec<Option<f64>> {
        let mut values = Vec::with_capacity(RINGS * ANGLES);
        for ring in 0..RINGS {
            let radius = 0.2 + 0.7 * ring as f64 / (RINGS - 1) as f64;
            for k in 0..ANGLES {
                let (sin, cos) = (k as f64 / ANGLES as f64 * std::f64::consts::TAU).sin_cos();
                values.push(texture.at(radius * cos, radius * sin));
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

/// Steps until nothing moves, `most` at most, on faces blurred over so many cells; the second face is taken anew through the
/// map found so far each time. Gives the map before the last step, and that step.
fn matched(
    faces: &Faces,
    placings: &(Placing, Placing),
    mut map: Map,
    blur: usize,
    most: usize,
) -> Option<(Map, Step)> {
    let seen = faces.0.cut(&placings.0);
    let mut last = None;
    for _ in 0..most {
        if let Some(step) = last {
            map = Step::taken(&step, &map)?;
        }
        if map.stretch().abs() > 0.25 || map.x.hypot(map.y) > 0.25 {
            return None;
        }
        let (one, other) = Texture::together(&seen, &faces.1.cut(&map.over(&placings.1)));
        let step = Step::between(&one.softened(blur), &other.softened(blur));
        let small = step.size()? < 1e-5;
        last = Some(step);
        if small {
            break;
        }
    }
    last.map(|step| (map, step))
}
