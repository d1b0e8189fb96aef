//! Pixels between rays: found from their neighbours, and whether they can be.

use rayon::prelude::*;

use super::shade::BANDS;

/// The picture between points that stand on every second pixel: cubic through four of them (Catmull and Rom 1974).
pub(super) struct Between<'a> {
    pub(super) points: &'a [[f32; BANDS]],
    /// Points across and down.
    pub(super) count: (usize, usize),
}

/// What a pixel is from its neighbours, and how far the cubic is from the straight line.
type Guess = ([f32; BANDS], f32);

impl Between<'_> {
    fn at(&self, x: isize, y: isize) -> [f32; BANDS] {
        let clamped = |n: isize, count: usize| n.clamp(0, count as isize - 1) as usize;
        self.points[clamped(y, self.count.1) * self.count.0 + clamped(x, self.count.0)]
    }

    /// Half way between the second and the third of four.
    fn half(four: [[f32; BANDS]; 4]) -> Guess {
        let (mut value, mut bend) = ([0.0; BANDS], 0.0f32);
        for band in 0..BANDS {
            let (inner, outer) = (0.5 * (four[1][band] + four[2][band]), 0.5 * (four[0][band] + four[3][band]));
            let bent = 0.125 * (inner - outer);
            value[band] = (inner + bent).max(0.0);
            bend = bend.max(bent.abs());
        }
        (value, bend)
    }

    fn across(&self, x: isize, y: isize) -> Guess {
        Between::half([-1, 0, 1, 2].map(|n| self.at(x + n, y)))
    }

    fn down(&self, x: isize, y: isize) -> Guess {
        Between::half([-1, 0, 1, 2].map(|n| self.at(x, y + n)))
    }

    /// A pixel of the whole picture.
    fn guess(&self, x: usize, y: usize) -> Guess {
        let (i, j) = ((x / 2) as isize, (y / 2) as isize);
        match (x % 2, y % 2) {
            (0, 0) => (self.at(i, j), 0.0),
            (1, 0) => self.across(i, j),
            (0, _) => self.down(i, j),
            _ => {
                let rows = [-1, 0, 1, 2].map(|n| self.across(i, j + n));
                let (value, bend) = Between::half(rows.map(|(value, _)| value));
                (value, rows[1].1.max(rows[2].1).max(bend))
            }
        }
    }

    /// The whole picture, and which of its pixels need a ray of their own: those where the cubic is further from the straight line than
    /// this share of the pixel's light and a hundredth of `typical` together.
    pub(super) fn picture(
        &self,
        width: usize,
        height: usize,
        share: f32,
        typical: f32,
    ) -> (Vec<[f32; BANDS]>, Vec<bool>) {
        let mut picture = vec![[0.0; BANDS]; width * height];
        let mut wanted = vec![false; width * height];
        picture.par_chunks_mut(width).zip(wanted.par_chunks_mut(width)).enumerate().for_each(|(y, (row, wanted))| {
            for (x, (pixel, wanted)) in row.iter_mut().zip(wanted).enumerate() {
                let (value, bend) = self.guess(x, y);
                let light = value.into_iter().fold(0.0, f32::max);
                *pixel = value;
                *wanted = bend > share * (light + 0.01 * typical);
            }
        });
        (picture, wanted)
    }
}
