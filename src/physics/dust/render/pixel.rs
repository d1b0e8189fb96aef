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
/// Of a part's spread, where the light is not smooth at its scale.
const STEP: f64 = 0.25;
/// Of the whole's spread (an integral, as a quarter's is: an eighth is smooth, a quarter a step): what is not smooth.
const STEPS: f64 = 0.19;
/// Quarters are believed to have this share of the whole's error at least, each by how much its rays differ: two sums may agree by chance. (A
/// sixteenth where the light is smooth.)
const SLOWEST: f64 = 0.1;
/// A pixel whose curvature is more than so many tolerances has 16 rays at once.
const STRONGLY: f64 = 3.0;
/// Beside a pixel with a star the neighbours' curvature is believed up to this many times what the rays within the pixel differ by.
const AT_MOST: f64 = 10.0;
/// Nearer to a star's image than this, pixels, the neighbours are not asked whether one ray is enough.
const NEAR_STAR: f64 = 3.0;
/// Pixels beyond the picture's edges whose middles are known too.
pub(super) const MARGIN: usize = 2;
/// What is narrower, pixels, is not cut off.
const LEAST_PART: f64 = 1e-9;
/// Sine of an angle below which a face is seen on its edge.
const LEVEL: f64 = 1e-9;
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
    /// Columns and rows of the picture along which the box ends at once.
    faces: [Vec<f64>; 2],
}

/// What the neighbours of a pixel's middle tell of its average, in each band.
#[derive(Debug, Clone, Copy)]
struct Bend {
    /// How far the middle is below it.
    below: [f64; MOST_BANDS],
    /// How far off that may be.
    error: [f64; MOST_BANDS],
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
        let faces = faces(&march, view);
        Sampler { march, near_star: March { fineness: finer, ..march }, view, wish, floor, stars, faces }
    }

    /// One ray through the middle of each pixel of a row, and of [`MARGIN`] pixels beyond either end of it: those on the picture's edges are
    /// averaged as all others are.
    pub(super) fn middles(&self, y: isize) -> Vec<Pixel> {
        let View { camera, width, height, .. } = self.view;
        (-(MARGIN as isize)..(width + MARGIN) as isize)
            .map(|x| {
                let mut tally = Tally::default();
                let centre = (x as f64 + 0.5, y as f64 + 0.5);
                let dark =
                    Pixel { radiance: [0.0; MOST_BANDS], column: 0.0, error: 0.0, given_up: false, tally, met: false };
                // Outside a dome's circle is nothing.
                if camera.ray(centre.0, centre.1, *width, *height).is_none() {
                    return dark;
                }
                let (radiance, column) = self.sample(centre, &mut tally);
                Pixel { radiance, column, tally, met: tally.cells > 0, ..dark }
            })
            .collect()
    }

    /// The averages of a row, from the middles of it and of [`MARGIN`] rows above and below.
    pub(super) fn averages(&self, rows: &[Vec<Pixel>], y: usize) -> Vec<(Pixel, Kind)> {
        let bends: Vec<Vec<Bend>> =
            rows.windows(3).map(|three| (1..=self.view.width + 2).map(|x| self.bend(three, x)).collect()).collect();
        (0..self.view.width).map(|x| self.average(rows, &bends, x, y)).collect()
    }

    /// What the middles about a pixel tell of it: an average is above the middle by a 24th of the curvature.
    fn bend(&self, three: &[Vec<Pixel>], x: usize) -> Bend {
        let at = |row: usize, column: usize| &three[row][column].radiance;
        let middle = at(1, x);
        let mut bend = Bend { below: [0.0; MOST_BANDS], error: [0.0; MOST_BANDS] };
        for band in 0..self.floor.len() {
            let twice = 2.0 * middle[band];
            let pair = |a: &[f64; MOST_BANDS], b: &[f64; MOST_BANDS]| a[band] + b[band] - twice;
            let across = pair(at(1, x - 1), at(1, x + 1)) / 24.0;
            let along = pair(at(0, x), at(2, x)) / 24.0;
            let diagonals = (pair(at(0, x - 1), at(2, x + 1)).abs() + pair(at(0, x + 1), at(2, x - 1)).abs()) / 48.0;
            // Curvatures across and along may cancel, and those along the diagonals: what they are without their signs is believed.
            bend.below[band] = across + along;
            bend.error[band] = (across.abs() + along.abs()).max(diagonals);
        }
        bend
    }

    fn average(&self, rows: &[Vec<Pixel>], bends: &[Vec<Bend>], x: usize, y: usize) -> (Pixel, Kind) {
        let middle = &rows[MARGIN][x + MARGIN];
        let met = rows[1..=3].iter().any(|row| row[x + 1..=x + 3].iter().any(|pixel| pixel.met));
        let centre = (x as f64 + 0.5, y as f64 + 0.5);
        let outside = self.view.camera.ray(centre.0, centre.1, self.view.width, self.view.height).is_none();
        // Where the middle goes through bricks that hold dust but meets none, a corner of the pixel may.
        let may_hide = !middle.met && middle.tally.ways > 0;
        if outside || !met && !may_hide && self.view.width > 1 {
            return (middle.clone(), Kind::Missed);
        }
        let star = self.stars.iter().any(|(sx, sy)| (sx - centre.0).hypot(sy - centre.1) < NEAR_STAR);
        let mut corrected = middle.clone();
        // Curvature may be small by chance: the largest round the pixel is believed.
        let mut bent = [0.0f64; MOST_BANDS];
        for bend in bends.iter().take(3).flat_map(|row| &row[x..x + 3]) {
            for (most, error) in bent.iter_mut().zip(&bend.error) {
                *most = most.max(*error);
            }
        }
        for (value, below) in corrected.radiance.iter_mut().zip(&bends[1][x + 1].below) {
            *value = (*value + below).max(0.0);
        }
        let scale = |band: usize| middle.radiance[band].max(self.floor[band]);
        let error = (0..self.floor.len()).map(|band| bent[band] / scale(band)).fold(0.0, f64::max);
        if error <= 0.25 * self.wish.tolerance && !star && !may_hide && !self.wish.everything {
            corrected.error = error;
            return (corrected, Kind::OneRay);
        }
        self.many(&corrected, &bent, (star, may_hide), x, y)
    }

    /// Parts of the pixel, the worst of which is quartered until the sum is good enough.
    fn many(
        &self,
        middle: &Pixel,
        bent: &[f64; MOST_BANDS],
        (near_star, may_hide): (bool, bool),
        x: usize,
        y: usize,
    ) -> (Pixel, Kind) {
        let mut tally = middle.tally;
        let mut shapes = Vec::new();
        let parts = self.along_faces(x as f64, y as f64);
        let unknown = near_star || may_hide || parts.len() > 1;
        let mut starred = false;
        for part in parts {
            starred |= self.around_stars(part, 0, &mut shapes);
        }
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
                    .max(0.3 * least)
                    .max(UNSEEN * whole.spread[band]);
            }
        } else {
            if !starred {
                for patch in &mut patches {
                    let Shape::Square { width, height, .. } = patch.shape else { continue };
                    // A neighbour's middle may go through a star, with any light: within this pixel the light bends by no more than what its own
                    // rays differ by, many times.
                    patch.error = std::array::from_fn(|band| {
                        let most = if near_star { AT_MOST * patch.spread[band] } else { f64::INFINITY };
                        (bent[band] * width * height).min(most)
                    });
                }
            }
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

    /// A pixel, cut where the box ends at once.
    fn along_faces(&self, x: f64, y: f64) -> Vec<Shape> {
        let cut = |from: f64, faces: &[f64]| {
            let mut at = vec![from];
            at.extend(
                faces.iter().copied().filter(|face| *face > from + LEAST_PART && *face < from + 1.0 - LEAST_PART),
            );
            at.push(from + 1.0);
            at
        };
        let (columns, rows) = (cut(x, &self.faces[0]), cut(y, &self.faces[1]));
        let part = |x: &[f64], y: &[f64]| Shape::Square { x: x[0], y: y[0], width: x[1] - x[0], height: y[1] - y[0] };
        rows.windows(2).flat_map(|y| columns.windows(2).map(move |x| part(x, y))).collect()
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
            let spread: f64 = parts.iter().map(|part| part.spread[band]).sum();
            let apart: f64 = parts.iter().map(|part| (part.integral[band] - 0.25 * sum).abs()).sum();
            // Where the light is smooth the parts' means differ by less than twice what the rays within them do; a step between two parts
            // may be seen by no ray of either.
            let between = 0.25 * STEP * (apart - 2.0 * spread).max(0.0);
            for part in &mut parts {
                // Rays of a part differ half as much as those of the whole where the light is smooth, as much where a step goes through it.
                let unseen = if part.spread[band] > STEPS * whole.spread[band] { STEP } else { UNSEEN };
                part.error[band] = ((sum - whole.integral[band]).abs() / 12.0)
                    .max(SLOWEST * whole.error[band] * if spread > 0.0 { part.spread[band] / spread } else { 0.25 })
                    .max(between)
                    .max(unseen * part.spread[band]);
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

/// Where parallel rays along a face of the box pass from all of its depth to nothing: columns and rows of the picture, if the face stands
/// upright or level in it. (From a point, and slanted, the way through the box grows from nothing.)
fn faces(march: &March<'_>, view: &View) -> [Vec<f64>; 2] {
    let mut lines = [Vec::new(), Vec::new()];
    let Some(forward) = view.camera.parallel() else { return lines };
    let place = |point| view.camera.place(point, view.width, view.height);
    for axis in 0..3 {
        let mut half = glam::DVec3::ZERO;
        half[axis] = 0.5 * march.volume.edges()[axis];
        let (Some(low), Some(high)) = (place(-half), place(half)) else { continue };
        if forward[axis].abs() < LEVEL {
            let (across, along) = (high.0 - low.0, high.1 - low.1);
            if along.abs() < LEVEL * across.abs() {
                lines[0].extend([low.0.min(high.0), low.0.max(high.0)]);
            } else if across.abs() < LEVEL * along.abs() {
                lines[1].extend([low.1.min(high.1), low.1.max(high.1)]);
            }
        }
    }
    lines
}
