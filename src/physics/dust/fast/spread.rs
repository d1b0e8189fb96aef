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

/// Half way between the second and the third of four.
fn half(four: [&[f32; BANDS]; 4]) -> Guess {
    let (mut value, mut bend) = ([0.0; BANDS], 0.0f32);
    for band in 0..BANDS {
        let (inner, outer) = (0.5 * (four[1][band] + four[2][band]), 0.5 * (four[0][band] + four[3][band]));
        let bent = 0.125 * (inner - outer);
        value[band] = (inner + bent).max(0.0);
        bend = bend.max(bent.abs());
    }
    (value, bend)
}

/// The places of the four about the gap behind `n`; beyond the ends stand the first and the last again.
fn four(n: usize, count: usize) -> [usize; 4] {
    [n.saturating_sub(1), n, n + 1, n + 2].map(|n| n.min(count - 1))
}

impl Between<'_> {
    /// The rows of points, with the pixels between them.
    fn rows(&self, width: usize) -> Vec<Guess> {
        let mut rows = vec![([0.0; BANDS], 0.0); width * self.count.1];
        rows.par_chunks_mut(width).zip(self.points.par_chunks(self.count.0)).for_each(|(row, points)| {
            for (x, guess) in row.iter_mut().enumerate() {
                *guess =
                    if x % 2 == 0 { (points[x / 2], 0.0) } else { half(four(x / 2, points.len()).map(|n| &points[n])) };
            }
        });
        rows
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
        let rows = self.rows(width);
        let row = |n: usize| &rows[n * width..][..width];
        let mut picture = vec![[0.0; BANDS]; width * height];
        let mut wanted = vec![false; width * height];
        picture.par_chunks_mut(width).zip(wanted.par_chunks_mut(width)).enumerate().for_each(|(y, (line, wanted))| {
            let about = four(y / 2, self.count.1).map(row);
            for (x, (pixel, wanted)) in line.iter_mut().zip(wanted).enumerate() {
                let guesses = about.map(|row| &row[x]);
                let (value, bend) = if y % 2 == 0 {
                    *guesses[1]
                } else {
                    let (value, bend) = half(guesses.map(|(value, _)| value));
                    (value, bend.max(guesses[1].1).max(guesses[2].1))
                };
                let light = value.into_iter().fold(0.0, f32::max);
                *pixel = value;
                *wanted = bend > share * (light + 0.01 * typical);
            }
        });
        (picture, wanted)
    }
}
