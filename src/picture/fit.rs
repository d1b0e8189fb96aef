//! Making a picture fit another size, and mirroring it.

use super::Picture;

impl Picture {
    /// The picture as large as it fits into `width` x `height`, its shape kept, in the middle, black around it.
    ///
    /// Enlarged and shrunk bilinearly (in linear light); a whole factor of 1 copies.
    #[must_use]
    pub fn fitted(&self, width: usize, height: usize) -> Picture {
        if (width, height) == (self.width, self.height) || self.pixels.is_empty() {
            let mut same = Picture::black(width, height);
            if !self.pixels.is_empty() {
                same.pixels.copy_from_slice(&self.pixels);
            }
            return same;
        }
        let factor = (width as f32 / self.width as f32).min(height as f32 / self.height as f32);
        let (left, top) =
            ((width as f32 - self.width as f32 * factor) / 2.0, (height as f32 - self.height as f32 * factor) / 2.0);
        let mut fitted = Picture::black(width, height);
        for y in 0..height {
            let source_y = (y as f32 + 0.5 - top) / factor;
            for (x, pixel) in fitted.row_mut(y).iter_mut().enumerate() {
                let source_x = (x as f32 + 0.5 - left) / factor;
                if (0.0..self.width as f32).contains(&source_x) && (0.0..self.height as f32).contains(&source_y) {
                    *pixel = self.sample(source_x, source_y);
                }
            }
        }
        fitted
    }

    /// The light at a place between pixels, bilinearly; pixel (i, j) has its middle at (i + 0.5, j + 0.5). Beyond the middle
    /// of the outermost pixels the outermost pixels are taken.
    #[must_use]
    pub fn sample(&self, x: f32, y: f32) -> [f32; 3] {
        if self.pixels.is_empty() {
            return [0.0; 3];
        }
        let (x, y) = ((x - 0.5).clamp(0.0, self.width as f32 - 1.0), (y - 0.5).clamp(0.0, self.height as f32 - 1.0));
        let (i, j) = (x as usize, y as usize);
        let (right, below) = ((i + 1).min(self.width - 1), (j + 1).min(self.height - 1));
        let (fx, fy) = (x - i as f32, y - j as f32);
        let (upper, lower) = (&self.pixels[j * self.width..], &self.pixels[below * self.width..]);
        let mut light = [0.0; 3];
        for (c, light) in light.iter_mut().enumerate() {
            let above = upper[i][c] + (upper[right][c] - upper[i][c]) * fx;
            let under = lower[i][c] + (lower[right][c] - lower[i][c]) * fx;
            *light = above + (under - above) * fy;
        }
        light
    }

    /// The picture half as large: each pixel the mean of four. An odd last row or column is left out.
    #[must_use]
    pub fn halved(&self) -> Picture {
        let mut half = Picture::black((self.width / 2).max(1), (self.height / 2).max(1));
        for y in 0..half.height {
            let (upper, lower) = (self.row(2 * y), self.row((2 * y + 1).min(self.height - 1)));
            for (x, pixel) in half.row_mut(y).iter_mut().enumerate() {
                let right = (2 * x + 1).min(self.width - 1);
                for (c, light) in pixel.iter_mut().enumerate() {
                    *light = (upper[2 * x][c] + upper[right][c] + lower[2 * x][c] + lower[right][c]) / 4.0;
                }
            }
        }
        half
    }

    /// The picture mirrored left to right, or top to bottom, or both.
    #[must_use]
    pub fn flipped(mut self, horizontal: bool, vertical: bool) -> Picture {
        if horizontal {
            for y in 0..self.height {
                self.row_mut(y).reverse();
            }
        }
        if vertical {
            for y in 0..self.height / 2 {
                let (upper, lower) = self.pixels.split_at_mut((self.height - 1 - y) * self.width);
                upper[y * self.width..(y + 1) * self.width].swap_with_slice(&mut lower[..self.width]);
            }
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dotted() -> Picture {
        let mut picture = Picture::black(4, 2);
        picture.row_mut(0)[0] = [1.0; 3];
        picture
    }

    #[test]
    fn a_wide_picture_on_a_square_has_black_above_and_below() {
        let mut white = Picture::black(4, 2);
        white.pixels_mut().fill([1.0; 3]);
        let square = white.fitted(8, 8);
        assert_eq!(square.row(1)[4], [0.0; 3]);
        assert_eq!(square.row(2)[0], [1.0; 3]);
        assert_eq!(square.row(5)[7], [1.0; 3]);
        assert_eq!(square.row(6)[4], [0.0; 3]);
    }

    #[test]
    fn the_same_size_is_the_same_picture() {
        assert_eq!(dotted().fitted(4, 2), dotted());
        assert!(Picture::black(0, 0).fitted(4, 4).is_black());
    }

    #[test]
    fn mirrors_move_the_dot_to_the_other_corners() {
        assert_eq!(dotted().flipped(true, false).row(0)[3], [1.0; 3]);
        assert_eq!(dotted().flipped(false, true).row(1)[0], [1.0; 3]);
        assert_eq!(dotted().flipped(true, true).row(1)[3], [1.0; 3]);
    }

    #[test]
    fn between_two_pixels_is_their_mean() {
        assert_eq!(dotted().sample(1.0, 0.5), [0.5; 3]);
        assert_eq!(dotted().sample(0.5, 0.5), [1.0; 3]);
        assert_eq!(dotted().sample(1.0, 1.0), [0.25; 3]);
    }
}
