//! Where one disc lies on another, and where a disc lies in its photograph.

use super::limb::Limb;

/// A similarity of the disc's coordinates: `u' = (a u - b v + x, b u + a v + y)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Map {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) x: f64,
    pub(super) y: f64,
}

impl Map {
    /// A turn from x to y.
    pub(super) fn turned(angle: f64) -> Map {
        Map { a: angle.cos(), b: angle.sin(), x: 0.0, y: 0.0 }
    }

    /// The identity changed by stretch, turn and shift.
    pub(super) fn changed(by: [f64; 4]) -> Map {
        Map { a: 1.0 + by[0], b: by[1], x: by[2], y: by[3] }
    }

    /// How much larger: 0 is not at all.
    pub(super) fn stretch(&self) -> f64 {
        self.a.hypot(self.b) - 1.0
    }

    fn apply(&self, u: f64, v: f64) -> (f64, f64) {
        (self.a * u - self.b * v + self.x, self.b * u + self.a * v + self.y)
    }

    /// First another map, then this.
    pub(super) fn after(&self, first: &Map) -> Map {
        let (x, y) = self.apply(first.x, first.y);
        Map { a: self.a * first.a - self.b * first.b, b: self.b * first.a + self.a * first.b, x, y }
    }

    /// Where a placing puts what this map leads to.
    pub(super) fn over(&self, placing: &Placing) -> Placing {
        let middle = placing.at(self.x, self.y);
        let from = |(x, y): (f64, f64)| (x - middle.0, y - middle.1);
        let (right, down) = (self.apply(1.0, 0.0), self.apply(0.0, 1.0));
        Placing { middle, across: from(placing.at(right.0, right.1)), down: from(placing.at(down.0, down.1)) }
    }
}

/// Where the disc's own coordinates (half widths, x right and y down) are in a photograph: `(x, y) + across u + down v`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placing {
    middle: (f64, f64),
    across: (f64, f64),
    down: (f64, f64),
}

impl Placing {
    /// The disc of a limb, its left and right exchanged if `mirrored`.
    pub(super) fn of(limb: &Limb, mirrored: bool) -> Placing {
        let from = |u, v| {
            let (x, y) = limb.place(u, v);
            (x - limb.x, y - limb.y)
        };
        Placing { middle: (limb.x, limb.y), across: from(if mirrored { -1.0 } else { 1.0 }, 0.0), down: from(0.0, 1.0) }
    }

    pub(super) fn at(&self, u: f64, v: f64) -> (f64, f64) {
        (self.middle.0 + self.across.0 * u + self.down.0 * v, self.middle.1 + self.across.1 * u + self.down.1 * v)
    }
}
