//! One row of pixels: what each line through the disc adds to it. The row is the same on both sides of its middle, so that one
//! half is computed.

use crate::physics::colour::Xyz;
use crate::physics::sun::chord::Chord;
use crate::physics::sun::limb::Darkening;

/// Nearer than this (pixels) to the limb a pixel's average is taken in closed form; further inside, the value in its middle
/// differs from it by less than 1e-3 of itself.
const NEAR_LIMB: f64 = 3.0;

/// Half a row.
pub(super) struct Line {
    width: usize,
    /// Distances of the pixels' borders from the middle; one more than pixels.
    borders: Vec<f64>,
    /// Squared distances of the pixels' middles.
    squares: Vec<f32>,
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    /// Pixels that have got light.
    used: usize,
}

impl Line {
    pub(super) fn new(width: usize) -> Line {
        let half = width.div_ceil(2);
        // With an odd width the middle pixel is half on this side.
        let shift = if width % 2 == 1 { 0.5 } else { 0.0 };
        let borders: Vec<f64> = (0..=half).map(|i| (i as f64 - shift).max(0.0)).collect();
        let squares = borders.windows(2).map(|pair| (0.5 * (pair[0] + pair[1])).powi(2) as f32).collect();
        let zeros = vec![0.0; half];
        Line { width, borders, squares, x: zeros.clone(), y: zeros.clone(), z: zeros, used: 0 }
    }

    pub(super) fn clear(&mut self) {
        for list in [&mut self.x, &mut self.y, &mut self.z] {
            list[..self.used].fill(0.0);
        }
        self.used = 0;
    }

    /// Adds a line through the disc whose centre has a light.
    pub(super) fn add(&mut self, chord: &Chord, darkening: &Darkening, light: Xyz) {
        let half = chord.half();
        if half == 0.0 {
            return;
        }
        let count = self.squares.len();
        // Pixels whose outer border lies well inside.
        let inside = self.borders[1..].partition_point(|border| *border <= half - NEAR_LIMB);
        let [lx, ly, lz] = light.map(|part| part as f32);
        let [a0, a1, a2, a3, a4, a5] = darkening.0.map(|a| a as f32);
        let (w2, per_radius) = (chord.half_squared as f32, (1.0 / chord.radius_squared) as f32);
        let lists = self.x[..inside].iter_mut().zip(&mut self.y[..inside]).zip(&mut self.z[..inside]);
        for (((x, y), z), square) in lists.zip(&self.squares[..inside]) {
            let mu = ((w2 - square) * per_radius).sqrt();
            let bright = a0 + mu * (a1 + mu * (a2 + mu * (a3 + mu * (a4 + mu * a5))));
            *x += lx * bright;
            *y += ly * bright;
            *z += lz * bright;
        }
        // The rest up to the limb.
        let end = self.borders[..count].partition_point(|border| *border < half);
        let mut before = chord.integral(darkening, self.borders[inside]);
        for i in inside..end {
            let here = chord.integral(darkening, self.borders[i + 1]);
            let bright = ((here - before) / (self.borders[i + 1] - self.borders[i])) as f32;
            self.x[i] += lx * bright;
            self.y[i] += ly * bright;
            self.z[i] += lz * bright;
            before = here;
        }
        self.used = self.used.max(end);
    }

    /// Writes the row; whether there is light in it.
    pub(super) fn finish(&self, row: &mut [[f32; 3]]) -> bool {
        let middle = self.width / 2;
        for i in 0..self.used {
            let pixel = [self.x[i], self.y[i], self.z[i]];
            // Right of the middle, and its mirror.
            row[(self.width - 1) - (self.width - 1 - middle).saturating_sub(i)] = pixel;
            row[(self.width - 1 - middle).saturating_sub(i)] = pixel;
        }
        self.used > 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disc of even brightness: each pixel is the share of it that the chord covers.
    #[test]
    fn coverage_is_exact_and_the_row_is_the_same_on_both_sides() {
        let even = Darkening([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let chord = Chord { half_squared: 2.25, radius_squared: 9.0 };
        for (width, expected) in [
            (6usize, vec![0.0, 0.5, 1.0, 1.0, 0.5, 0.0]),
            (5, vec![0.0, 1.0, 1.0, 1.0, 0.0]),
            (1, vec![1.0]),
            (2, vec![1.0; 2]),
        ] {
            let mut line = Line::new(width);
            line.add(&chord, &even, [1.0, 2.0, 3.0]);
            let mut row = vec![[0.0; 3]; width];
            assert!(line.finish(&mut row));
            for (pixel, share) in row.iter().zip(expected) {
                assert!((pixel[0] - share).abs() < 1e-6 && (pixel[1] - 2.0 * share).abs() < 1e-6, "{width}: {row:?}");
            }
            line.clear();
            assert!(!line.finish(&mut row));
        }
    }
}
