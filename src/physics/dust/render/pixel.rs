//! The average of the radiance over a pixel's square.

use super::{View, Wish};
use crate::physics::dust::march::{Fineness, March, Tally};
use crate::physics::dust::scene::MOST_BANDS;

/// Most rays for one pixel.
const MOST_RAYS: u64 = 2000;
/// Most rays for a pixel with a star behind it.
const MOST_STAR_RAYS: u64 = 3000;
/// Of what rays of a part differ by, so much is believed to be error even where sums agree: kinks may hide between rays.
const UNSEEN: f64 = 3e-3;
/// A pixel whose curvature is more than so many tolerances has 16 rays at once.
const STRONGLY: f64 = 3.0;
/// Nearer to a star's image than this, pixels, the neighbours are not asked whether one ray is enough.
const NEAR_STAR: f64 = 3.0;
/// Gauss' two nodes in 0 to 1.
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// A pixel.
#[derive(Debug, Clone)]
pub(super) struct Pixel {
    pub(super) radiance: [f64; MOST_BANDS],
    pub(super) column: f64,
    /// Believed relative error of the average.
    pub(super) error: f64,
    pub(super) given_up: bool,
    pub(super) tally: Tally,
    /// Whether the box was met at all.
    met: bool,
}

impl Pixel {
    pub(super) fn is_lit(&self, bands: usize) -> bool {
        self.radiance[..bands].iter().any(|value| *value > 0.0)
    }
}

/// How a pixel was averaged.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Missed,
    OneRay,
    Many,
    Starred,
}

/// Takes rays of a picture.
pub(super) struct Sampler<'a> {
    march: March<'a>,
    /// Near the image of a star, where rays pass it closer than any that the fineness was tried on.
    near_star: March<'a>,
    view: &'a View,
    wish: &'a Wish,
    floor: &'a [f64],
    /// Images of the stars.
    stars: Vec<(f64, f64)>,
}

/// A part of a pixel: a map from the unit square, with the integral over it.
#[derive(Debug, Clone, Copy)]
struct Patch {
    shape: Shape,
    integral: [f64; MOST_BANDS],
    column: f64,
    error: [f64; MOST_BANDS],
    /// How much the four rays differ, as an integral: of that, [`UNSEEN`] is error at least, whatever agrees by chance.
    spread: [f64; MOST_BANDS],
}

#[derive(Debug, Clone, Copy)]
enum Shape {
    /// From x, y, so wide and so high.
    Square { x: f64, y: f64, width: f64, height: f64 },
    /// A part of the triangle of a star's image and two corners: u goes from the image (0) to the side (1), v along the side. The area is
    /// 2 A u du dv, so that what grows as 1/u at the image is level.
    Fan { tip: (f64, f64), a: (f64, f64), b: (f64, f64), u: (f64, f64), v: (f64, f64) },
}

impl Shape {
    /// Where a point of the unit square is, and how much area stands for a unit of it.
    fn place(&self, p: f64, q: f64) -> (f64, f64, f64) {
        match *self {
            Shape::Square { x, y, width, height } => (x + p * width, y + q * height, width * height),
            Shape::Fan { tip, a, b, u, v } => {
                let (s, t) = (u.0 + p * (u.1 - u.0), v.0 + q * (v.1 - v.0));
                let side = (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1));
                let twice = ((a.0 - tip.0) * (b.1 - tip.1) - (a.1 - tip.1) * (b.0 - tip.0)).abs();
                let area = twice * s * (u.1 - u.0) * (v.1 - v.0);
                (tip.0 + s * (side.0 - tip.0), tip.1 + s * (side.1 - tip.1), area)
            }
        }
    }

    fn quarters(&self) -> [Shape; 4] {
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| {
            let half = |(from, to): (f64, f64), i: i32| {
                let middle = 0.5 * (from + to);
                if i == 0 { (from, middle) } else { (middle, to) }
            };
            match *self {
                Shape::Square { x, y, width, height } => Shape::Square {
                    x: x + 0.5 * width * f64::from(i),
                    y: y + 0.5 * height * f64::from(j),
                    width: 0.5 * width,
                    height: 0.5 * height,
                },
                Shape::Fan { tip, a, b, u, v } => Shape::Fan { tip, a, b, u: half(u, i), v: half(v, j) },
            }
        })
    }
}

impl<'a> Sampler<'a> {
    pub(super) fn new(march: March<'a>, view: &'a View, wish: &'a Wish, floor: &'a [f64]) -> Sampler<'a> {
        let place =
            |star: &crate::physics::dust::scene::Star| view.camera.place(star.position, view.width, view.height);
        let finer = if march.fineness.nodes == 1 { Fineness::LADDER[3] } else { march.fineness };
        let stars = march.scene.stars().iter().filter_map(place).collect();
        Sampler { march, near_star: March { fineness: finer, ..march }, view, wish, floor, stars }
    }

    /// One ray through the middle of each pixel of a row.
    pub(super) fn middles(&self, y: usize) -> Vec<Pixel> {
        (0..self.view.width)
            .map(|x| {
                let mut tally = Tally::default();
                let centre = (x as f64 + 0.5, y as f64 + 0.5);
                let dark =
                    Pixel { radiance: [0.0; MOST_BANDS], column: 0.0, error: 0.0, given_up: false, tally, met: false };
                // Outside a dome's circle is nothing.
                if self.view.camera.ray(centre.0, centre.1, self.view.width, self.view.height).is_none() {
                    return dark;
                }
                let (radiance, column) = self.sample(centre, &mut tally);
                Pixel { radiance, column, tally, met: tally.cells > 0, ..dark }
            })
            .collect()
    }

    /// The averages of a row, from the middles of it and of its neighbours; `first` is the row that `rows` begins with.
    pub(super) fn averages(&self, rows: &[Vec<Pixel>], first: usize, y: usize) -> Vec<(Pixel, Kind)> {
        (0..self.view.width).map(|x| self.average(rows, first, x, y)).collect()
    }

    fn average(&self, rows: &[Vec<Pixel>], first: usize, x: usize, y: usize) -> (Pixel, Kind) {
        let row = &rows[y - first];
        let middle = &row[x];
        let above = y.checked_sub(1).and_then(|above| above.checked_sub(first)).and_then(|i| rows.get(i));
        let below = rows.get(y + 1 - first);
        let across = (x.checked_sub(1).map(|i| &row[i]), row.get(x + 1));
        let along = (above.map(|row| &row[x]), below.map(|row| &row[x]));
        let neighbours = [across.0, across.1, along.0, along.1];
        let (from, to) = (x.saturating_sub(1), (x + 1).min(self.view.width - 1));
        let met =
            [above, Some(row), below].into_iter().flatten().any(|row| row[from..=to].iter().any(|pixel| pixel.met));
        let centre = (x as f64 + 0.5, y as f64 + 0.5);
        let outside = self.view.camera.ray(centre.0, centre.1, self.view.width, self.view.height).is_none();
        // Where the middle goes through bricks that hold dust but meets none, a corner of the pixel may.
        let may_hide = !middle.met && middle.tally.ways > 0;
        if outside || !met && !may_hide && self.view.width > 1 {
            return (middle.clone(), Kind::Missed);
        }
        let star = self.stars.iter().any(|(sx, sy)| (sx - centre.0).hypot(sy - centre.1) < NEAR_STAR);
        let mut corrected = middle.clone();
        let mut bent = [0.0; MOST_BANDS];
        if let [Some(left), Some(right), Some(up), Some(down)] = neighbours {
            let corner = |row: Option<&'_ Vec<Pixel>>, x: usize| row.map_or(middle, |row| &row[x]).radiance;
            let corners = [corner(above, from), corner(above, to), corner(below, from), corner(below, to)];
            // The middle is below the average by a 24th of the curvature. Curvatures across and along may cancel, and those along the
            // diagonals: the larger of the sums of what they are without their signs is the error that is believed.
            for (band, value) in corrected.radiance.iter_mut().enumerate().take(self.floor.len()) {
                let twice = 2.0 * middle.radiance[band];
                let across = (left.radiance[band] + right.radiance[band] - twice) / 24.0;
                let along = (up.radiance[band] + down.radiance[band] - twice) / 24.0;
                let [a, b, c, d] = corners.map(|corner| corner[band]);
                let diagonals = ((a + d - twice).abs() + (b + c - twice).abs()) / 48.0;
                *value = (*value + across + along).max(0.0);
                bent[band] = (across.abs() + along.abs()).max(diagonals);
            }
            let scale = |band: usize| middle.radiance[band].max(self.floor[band]);
            let error = (0..self.floor.len()).map(|band| bent[band] / scale(band)).fold(0.0, f64::max);
            if error <= 0.25 * self.wish.tolerance && !star && !may_hide && !self.wish.everything {
                corrected.error = error;
                return (corrected, Kind::OneRay);
            }
        }
        self.many(&corrected, &bent, star || may_hide, x, y)
    }

    /// Parts of the pixel, the worst of which is quartered until the sum is good enough.
    fn many(&self, middle: &Pixel, bent: &[f64; MOST_BANDS], unknown: bool, x: usize, y: usize) -> (Pixel, Kind) {
        let mut tally = middle.tally;
        let whole = Shape::Square { x: x as f64, y: y as f64, width: 1.0, height: 1.0 };
        let mut shapes = Vec::new();
        let starred = self.around_stars(whole, 0, &mut shapes);
        let mut patches: Vec<Patch> = shapes.into_iter().map(|shape| self.patch(shape, &mut tally)).collect();
        // What the middle and its neighbours say of the average is the second opinion on 2 x 2 rays; where a star is near, they say little,
        // and the errors are known when the parts have been quartered once.
        let bands = self.floor.len();
        // Where it is bent by many tolerances, four rays and the middle may agree by chance.
        let scale = |band: usize| middle.radiance[band].max(self.floor[band]);
        let strongly = (0..bands).any(|band| bent[band] > STRONGLY * self.wish.tolerance * scale(band));
        if let ([whole], false) = (&mut patches[..], unknown || strongly || self.wish.everything) {
            for (band, least) in bent.iter().enumerate().take(bands) {
                whole.error[band] = (whole.integral[band] - middle.radiance[band])
                    .abs()
                    .max(0.2 * least)
                    .max(UNSEEN * whole.spread[band]);
            }
        } else {
            patches = patches.iter().flat_map(|patch| self.quarter(patch, &mut tally)).collect();
        }
        let most = if starred { MOST_STAR_RAYS } else { MOST_RAYS };
        let wanted = if self.wish.everything { 0.3 } else { 0.5 } * self.wish.tolerance;
        loop {
            let mut pixel =
                Pixel { radiance: [0.0; MOST_BANDS], column: 0.0, error: 0.0, given_up: false, tally, met: middle.met };
            let mut errors = [0.0; MOST_BANDS];
            for patch in &patches {
                pixel.column += patch.column;
                for (band, error) in errors.iter_mut().enumerate().take(bands) {
                    pixel.radiance[band] += patch.integral[band];
                    *error += patch.error[band];
                }
            }
            let scale = |band: usize| pixel.radiance[band].max(self.floor[band]);
            pixel.error = (0..bands).map(|band| errors[band] / scale(band)).fold(0.0, f64::max);
            let good = pixel.error <= wanted;
            if good || tally.rays >= most {
                pixel.given_up = !good && pixel.error > self.wish.tolerance;
                return (pixel, if starred { Kind::Starred } else { Kind::Many });
            }
            // All parts that hold a good share of the error are quartered at one time, so that the sums are not taken too often.
            let share = |patch: &Patch| (0..bands).map(|b| patch.error[b] / scale(b)).fold(0.0, f64::max);
            let worst = patches.iter().map(share).fold(0.0, f64::max);
            let chosen: Vec<bool> = patches.iter().map(|patch| share(patch) >= 0.5 * worst).collect();
            let parts = std::mem::take(&mut patches);
            for (patch, quartered) in parts.into_iter().zip(chosen) {
                if quartered {
                    patches.extend(self.quarter(&patch, &mut tally));
                } else {
                    patches.push(patch);
                }
            }
        }
    }

    /// Cuts a square so that each part has at most one star, at its tip; true if there was any.
    fn around_stars(&self, square: Shape, depth: u32, shapes: &mut Vec<Shape>) -> bool {
        let Shape::Square { x, y, width, height } = square else { return false };
        let inside = |star: &&(f64, f64)| (x..=x + width).contains(&star.0) && (y..=y + height).contains(&star.1);
        let mut stars = self.stars.iter().filter(inside);
        let Some(&tip) = stars.next() else {
            shapes.push(square);
            return false;
        };
        let apart = stars.any(|other| (other.0 - tip.0).hypot(other.1 - tip.1) > 1e-6);
        if apart && depth < 16 {
            for part in square.quarters() {
                self.around_stars(part, depth + 1, shapes);
            }
            return true;
        }
        let corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)];
        for side in 0..4 {
            let (a, b) = (corners[side], corners[(side + 1) % 4]);
            let twice = ((a.0 - tip.0) * (b.1 - tip.1) - (a.1 - tip.1) * (b.0 - tip.0)).abs();
            if twice > 1e-12 * width * height {
                shapes.push(Shape::Fan { tip, a, b, u: (0.0, 1.0), v: (0.0, 1.0) });
            }
        }
        true
    }

    /// The integral over a part by 2 x 2 nodes; its error is not known yet.
    fn patch(&self, shape: Shape, tally: &mut Tally) -> Patch {
        let mut patch = Patch {
            shape,
            integral: [0.0; MOST_BANDS],
            column: 0.0,
            error: [0.0; MOST_BANDS],
            spread: [0.0; MOST_BANDS],
        };
        let mut four = [[0.0; MOST_BANDS]; 4];
        for (node, parts) in four.iter_mut().enumerate() {
            let (x, y, area) = shape.place(GAUSS[node & 1], GAUSS[node >> 1]);
            let (radiance, column) = self.sample((x, y), tally);
            patch.column += 0.25 * area * column;
            for (band, value) in radiance.iter().enumerate().take(self.floor.len()) {
                parts[band] = 0.25 * area * value;
                patch.integral[band] += parts[band];
            }
        }
        for band in 0..self.floor.len() {
            let mean = 0.25 * patch.integral[band];
            patch.spread[band] = four.iter().map(|parts| (parts[band] - mean).abs()).sum();
        }
        patch
    }

    /// Four parts of a part. What their sum differs from the whole is the whole's error; theirs is believed to be a third of it (a sixteenth
    /// where the radiance is smooth, a quarter to an eighth where it has kinks).
    fn quarter(&self, whole: &Patch, tally: &mut Tally) -> [Patch; 4] {
        let mut parts = whole.shape.quarters().map(|shape| self.patch(shape, tally));
        for band in 0..self.floor.len() {
            let sum: f64 = parts.iter().map(|part| part.integral[band]).sum();
            for part in &mut parts {
                part.error[band] = ((sum - whole.integral[band]).abs() / 12.0).max(UNSEEN * part.spread[band]);
            }
        }
        parts
    }

    fn sample(&self, (x, y): (f64, f64), tally: &mut Tally) -> ([f64; MOST_BANDS], f64) {
        let Some(ray) = self.view.ray(x, y) else { return ([0.0; MOST_BANDS], 0.0) };
        let close = self.stars.iter().any(|(sx, sy)| (sx - x).hypot(sy - y) < NEAR_STAR);
        let got = if close { &self.near_star } else { &self.march }.gather(&ray, self.view.near);
        *tally += got.tally;
        (got.radiance, got.column)
    }
}
