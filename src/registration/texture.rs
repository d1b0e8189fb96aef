//! The Moon's face as a square of relative brightness: each photograph's shading and exposure taken out, so that maria and
//! craters alone are left to be compared.

use std::borrow::Cow;

use super::frame::Frame;
use super::limb::Limb;
use super::map::Placing;

/// The square reaches so far from the middle, in half widths of the disc.
const REACH: f64 = 1.02;
/// What is further out is limb, not face.
const FACE: f64 = 0.93;
/// Shading is what is wider than the square's side over this.
const SHADING: usize = 19;
/// Two faces of like light still differ by so much: a map is not the Moon.
const UNLIKE: f32 = 0.03;

/// A photograph at the fineness of a square of cells, so that a cell is 0.75 to 1.5 of its pixels or a part of one.
pub(super) struct Source<'a> {
    frame: Cow<'a, Frame>,
    factor: f64,
    noise: f32,
    /// Cells a side.
    side: usize,
}

impl<'a> Source<'a> {
    pub(super) fn of(frame: &'a Frame, limb: &Limb, side: usize) -> Source<'a> {
        let cell_px = 2.0 * REACH * limb.radius / side as f64;
        let factor = (cell_px * 0.75).floor().max(1.0) as usize;
        Source {
            frame: if factor > 1 { Cow::Owned(frame.reduced(factor)) } else { Cow::Borrowed(frame) },
            factor: factor as f64,
            noise: frame.noise().max(0.002) as f32,
            side,
        }
    }

    /// Brightness on the disc's square as the photograph has it.
    pub(super) fn cut(&self, placing: &Placing) -> Cut {
        let side = self.side;
        let (mut values, mut inside) = (vec![0.0; side * side], vec![0.0; side * side]);
        // Four places of each cell: their mean has less noise than one.
        let quarter = 0.5 * REACH / side as f64;
        let four = [(-quarter, -quarter), (quarter, -quarter), (-quarter, quarter), (quarter, quarter)];
        for row in 0..side {
            let v = disc(row, side);
            for column in 0..side {
                let u = disc(column, side);
                if u * u + v * v > FACE * FACE {
                    continue;
                }
                let at = |(across, down): (f64, f64)| {
                    let (x, y) = placing.at(u + across, v + down);
                    self.frame.at(x / self.factor, y / self.factor)
                };
                if let [Some(a), Some(b), Some(c), Some(d)] = four.map(at) {
                    values[row * side + column] = ((a + b + c + d) / 4.0) as f32;
                    inside[row * side + column] = 1.0;
                }
            }
        }
        Cut { values, inside, noise: self.noise, side }
    }
}

/// The disc's square cut out of a photograph.
pub(super) struct Cut {
    values: Vec<f32>,
    /// 1 on the face and in the picture, else 0.
    inside: Vec<f32>,
    noise: f32,
    side: usize,
}

impl Cut {
    /// Where a face is bright enough, and not burnt out, for its structure to be seen.
    fn lit(&self) -> Vec<f32> {
        let near = self.blurred(&self.values, &self.inside, self.side / 96);
        let mut levels: Vec<f64> =
            near.iter().zip(&self.inside).filter(|(_, k)| **k > 0.0).map(|(v, _)| f64::from(*v)).collect();
        let bright = super::linear::quantile(&mut levels, 0.9) as f32;
        let well = |level: f32| level > 0.3 * bright && level < 0.97;
        near.iter().zip(&self.inside).map(|(level, inside)| if well(*level) { *inside } else { 0.0 }).collect()
    }

    fn relative(&self, known: &[f32]) -> Texture {
        let around = self.blurred(&self.values, known, self.side / SHADING);
        let part = |k: usize| {
            if known[k] > 0.0 && around[k] > 0.0 { (self.values[k] / around[k] - 1.0).clamp(-0.9, 0.9) } else { 0.0 }
        };
        let noise = |k: usize| (self.noise / around[k].max(1e-3)).powi(2);
        let cells = 0..self.side * self.side;
        Texture {
            values: cells.clone().map(part).collect(),
            weights: cells.map(|k| known[k] / (noise(k) + UNLIKE * UNLIKE)).collect(),
            known: known.to_vec(),
            side: self.side,
        }
    }

    fn blurred(&self, values: &[f32], known: &[f32], cells: usize) -> Vec<f32> {
        blurred(values, known, self.side, cells)
    }
}

/// Relative brightness over the disc.
#[derive(Debug, Clone)]
pub(super) struct Texture {
    /// Brightness less its surroundings', over it; zero where nothing is known.
    pub(super) values: Vec<f32>,
    /// 1 where the face is lit and in the picture, else 0.
    pub(super) known: Vec<f32>,
    /// One over the variance of the values.
    pub(super) weights: Vec<f32>,
    /// Cells a side.
    pub(super) side: usize,
}

impl Texture {
    /// The face of one photograph, by itself.
    pub(super) fn alone(cut: &Cut) -> Texture {
        cut.relative(&cut.lit())
    }

    /// The faces of two photographs where both are lit, treated alike: what the border of one does to its surroundings, it does
    /// to the other's as well.
    pub(super) fn together(one: &Cut, other: &Cut) -> (Texture, Texture) {
        let both: Vec<f32> = one.lit().iter().zip(other.lit()).map(|(a, b)| a * b).collect();
        (one.relative(&both), other.relative(&both))
    }

    /// The same, blurred twice over so many cells to each side.
    pub(super) fn softened(mut self, cells: usize) -> Texture {
        for _ in 0..2 {
            self.values = blurred(&self.values, &self.known, self.side, cells);
        }
        self.values.iter_mut().zip(&self.known).for_each(|(value, known)| *value *= known);
        self
    }

    /// Value at a place of the disc; `None` where nothing is known.
    pub(super) fn at(&self, u: f64, v: f64) -> Option<f64> {
        let cell = |w: f64| ((w / REACH + 1.0) / 2.0 * self.side as f64) as usize;
        let place = (cell(v) < self.side && cell(u) < self.side).then(|| cell(v) * self.side + cell(u))?;
        (self.known[place] > 0.0).then(|| f64::from(self.values[place]))
    }

    /// Cells of one half width of the disc.
    pub(super) fn cells_per_radius(&self) -> f64 {
        self.side as f64 / (2.0 * REACH)
    }
}

/// The disc's coordinate of a cell's middle.
pub(super) fn disc(cell: usize, side: usize) -> f64 {
    ((cell as f64 + 0.5) / side as f64 * 2.0 - 1.0) * REACH
}

/// The mean of what is known in a square about each cell.
fn blurred(values: &[f32], known: &[f32], side: usize, cells: usize) -> Vec<f32> {
    let product: Vec<f32> = values.iter().zip(known).map(|(value, known)| value * known).collect();
    let (sums, counts) = (boxed(&product, side, cells), boxed(known, side, cells));
    sums.iter().zip(counts).map(|(sum, count)| if count > 0.5 { sum / count } else { 0.0 }).collect()
}

/// Sums over squares, by running sums along rows and then columns.
fn boxed(values: &[f32], side: usize, cells: usize) -> Vec<f32> {
    let line = |from: &dyn Fn(usize) -> f32, into: &mut dyn FnMut(usize, f32)| {
        let mut sum = 0.0f64;
        for k in 0..side + cells {
            if k < side {
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
    let mut across = vec![0.0; side * side];
    for row in 0..side {
        line(&|k| values[row * side + k], &mut |k, sum| across[row * side + k] = sum);
    }
    let mut sums = vec![0.0; side * side];
    for column in 0..side {
        line(&|k| across[k * side + column], &mut |k, sum| sums[k * side + column] = sum);
    }
    sums
}
