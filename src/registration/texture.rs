//! The Moon's face as a square of relative brightness: each photograph's shading and exposure taken out, so that maria and
//! craters alone are left to be compared.

use super::frame::Frame;
use super::limb::Limb;

/// Cells a side of the square that holds the disc.
pub(super) const SIDE: usize = 384;
/// The square reaches so far from the middle, in half widths of the disc.
pub(super) const REACH: f64 = 1.02;
/// What is further out is limb, not face.
const FACE: f64 = 0.93;
/// Shading is what is wider than so many cells.
const SHADING: usize = 20;

/// Relative brightness over the disc.
#[derive(Debug, Clone)]
pub(super) struct Texture {
    /// Brightness less its surroundings', over it; zero where nothing is known.
    pub(super) values: Vec<f32>,
    /// 1 where the face is lit and in the picture, else 0.
    pub(super) known: Vec<f32>,
}

/// Where the disc's own coordinates (half widths, x right and y down) are in a photograph: `(x, y) + across u + down v`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Placing {
    pub(super) middle: (f64, f64),
    pub(super) across: (f64, f64),
    pub(super) down: (f64, f64),
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

    /// Pixels of half a width.
    fn size(&self) -> f64 {
        (self.across.0 * self.down.1 - self.across.1 * self.down.0).abs().sqrt()
    }
}

/// Brightness on the disc's square as the photograph has it; `None` out of the face or out of the picture.
pub(super) fn sampled(frame: &Frame, placing: &Placing) -> Vec<Option<f32>> {
    let cell_px = 2.0 * REACH * placing.size() / SIDE as f64;
    let factor = (cell_px * 0.75).floor().max(1.0) as usize;
    let reduced;
    let (source, scale) = if factor > 1 {
        reduced = frame.reduced(factor);
        (&reduced, factor as f64)
    } else {
        (frame, 1.0)
    };
    let mut raw = vec![None; SIDE * SIDE];
    for row in 0..SIDE {
        for column in 0..SIDE {
            let (u, v) = (disc(column as f64), disc(row as f64));
            if u * u + v * v <= FACE * FACE {
                // Four places of each cell: their mean has less noise than one.
                let quarter = 0.5 * REACH / SIDE as f64;
                let four = [(-quarter, -quarter), (quarter, -quarter), (-quarter, quarter), (quarter, quarter)];
                let values = four.map(|(across, down)| {
                    let (x, y) = placing.at(u + across, v + down);
                    source.at(x / scale, y / scale)
                });
                let whole = values.iter().all(Option::is_some);
                raw[row * SIDE + column] = whole.then(|| values.iter().flatten().sum::<f64>() as f32 / 4.0);
            }
        }
    }
    raw
}

/// The face of one photograph, by itself.
pub(super) fn alone(raw: &[Option<f32>]) -> Texture {
    let known = lit(raw);
    relative(raw, known)
}

/// The faces of two photographs where both are lit, treated alike: what the border of one does to its surroundings, it does to
/// the other's as well.
pub(super) fn together(one: &[Option<f32>], other: &[Option<f32>]) -> (Texture, Texture) {
    let both: Vec<f32> = lit(one).iter().zip(lit(other)).map(|(a, b)| a * b).collect();
    (relative(one, both.clone()), relative(other, both))
}

/// Where a face is bright enough, and not burnt out, for its structure to be seen.
fn lit(raw: &[Option<f32>]) -> Vec<f32> {
    let inside: Vec<f32> = raw.iter().map(|value| f32::from(u8::from(value.is_some()))).collect();
    let values: Vec<f32> = raw.iter().map(|value| value.unwrap_or(0.0)).collect();
    let near = blurred(&values, &inside, 4);
    let mut levels: Vec<f64> =
        near.iter().zip(&inside).filter(|(_, k)| **k > 0.0).map(|(v, _)| f64::from(*v)).collect();
    let bright = super::linear::quantile(&mut levels, 0.9) as f32;
    let well = |level: f32| level > 0.3 * bright && level < 0.97;
    near.iter().zip(&inside).map(|(level, inside)| if well(*level) { *inside } else { 0.0 }).collect()
}

fn relative(raw: &[Option<f32>], known: Vec<f32>) -> Texture {
    let values: Vec<f32> = raw.iter().map(|value| value.unwrap_or(0.0)).collect();
    let around = blurred(&values, &known, SHADING);
    let part =
        |k: usize| if known[k] > 0.0 && around[k] > 0.0 { (values[k] / around[k] - 1.0).clamp(-0.9, 0.9) } else { 0.0 };
    Texture { values: (0..SIDE * SIDE).map(part).collect(), known }
}

impl Texture {
    /// The same, blurred over so many cells to each side.
    pub(super) fn softened(&self, cells: usize) -> Texture {
        if cells == 0 {
            return self.clone();
        }
        let twice = blurred(&blurred(&self.values, &self.known, cells), &self.known, cells);
        let values = twice.iter().zip(&self.known).map(|(value, known)| value * known).collect();
        Texture { values, known: self.known.clone() }
    }

    /// Value and slopes (per half width) between cells; `None` where one of the cells is unknown. The slopes are central
    /// differences: those between the two cells of the value itself would share its noise, and noise would look like a shift.
    pub(super) fn at(&self, u: f64, v: f64) -> Option<(f64, f64, f64)> {
        let (x, y) = (cell(u), cell(v));
        if !(x >= 1.0 && y >= 1.0 && x < (SIDE - 3) as f64 && y < (SIDE - 3) as f64) {
            return None;
        }
        let (i, j) = (x as usize, y as usize);
        let corner = j * SIDE + i;
        let four = [corner, corner + 1, corner + SIDE, corner + SIDE + 1];
        let known = |k: usize| {
            self.known[k] > 0.0
                && self.known[k + 1] * self.known[k - 1] * self.known[k + SIDE] * self.known[k - SIDE] > 0.0
        };
        if !four.into_iter().all(known) {
            return None;
        }
        let (s, t) = (x - i as f64, y - j as f64);
        let mix = |of: &dyn Fn(usize) -> f64| {
            let [a, b, c, d] = four.map(of);
            (a * (1.0 - s) + b * s) * (1.0 - t) + (c * (1.0 - s) + d * s) * t
        };
        let per_cell = SIDE as f64 / (4.0 * REACH);
        let value = |k: usize| f64::from(self.values[k]);
        Some((
            mix(&value),
            mix(&|k| value(k + 1) - value(k - 1)) * per_cell,
            mix(&|k| value(k + SIDE) - value(k - SIDE)) * per_cell,
        ))
    }
}

/// The disc's coordinate of a cell.
pub(super) fn disc(cell: f64) -> f64 {
    ((cell + 0.5) / SIDE as f64 * 2.0 - 1.0) * REACH
}

fn cell(disc: f64) -> f64 {
    (disc / REACH + 1.0) / 2.0 * SIDE as f64 - 0.5
}

/// The mean of what is known in a square about each cell.
fn blurred(values: &[f32], known: &[f32], cells: usize) -> Vec<f32> {
    let product: Vec<f32> = values.iter().zip(known).map(|(value, known)| value * known).collect();
    let (sums, counts) = (boxed(&product, cells), boxed(known, cells));
    sums.iter().zip(counts).map(|(sum, count)| if count > 0.5 { sum / count } else { 0.0 }).collect()
}

/// Sums over squares, by running sums along rows and then columns.
fn boxed(values: &[f32], cells: usize) -> Vec<f32> {
    let line = |from: &dyn Fn(usize) -> f32, into: &mut dyn FnMut(usize, f32)| {
        let mut sum = 0.0f64;
        for k in 0..SIDE + cells {
            if k < SIDE {
                sum += f64::from(from(k));
            }
            if k > 2 * cells {
                sum -= f64::from(from(k - 2 * cells - 1));
            }
            if k >= cells {
                into(k - cells, sum as f32);
            }
        }
    };
    let mut across = vec![0.0; SIDE * SIDE];
    for row in 0..SIDE {
        line(&|k| values[row * SIDE + k], &mut |k, sum| across[row * SIDE + k] = sum);
    }
    let mut sums = vec![0.0; SIDE * SIDE];
    for column in 0..SIDE {
        line(&|k| across[k * SIDE + column], &mut |k, sum| sums[k * SIDE + column] = sum);
    }
    sums
}
