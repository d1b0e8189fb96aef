//! A picture between its pixels, half as large, mirrored, turned.

use super::Picture;

impl Picture {
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

    /// The picture turned clockwise by so many quarters.
    #[must_use]
    pub fn turned(self, quarters: u8) -> Picture {
        match quarters % 4 {
            0 => self,
            2 => self.flipped(true, true),
            quarter => {
                let mut turned = Picture::black(self.height, self.width);
                for y in 0..turned.height {
                    // A clockwise quarter brings the left column, read upwards, into the top row.
                    let column = if quarter == 1 { y } else { self.width - 1 - y };
                    for (x, pixel) in turned.row_mut(y).iter_mut().enumerate() {
                        let row = if quarter == 1 { self.height - 1 - x } else { x };
                        *pixel = self.pixels[row * self.width + column];
                    }
                }
                turned
            }
        }
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
    fn mirrors_move_the_dot_to_the_other_corners() {
        assert_eq!(dotted().flipped(true, false).row(0)[3], [1.0; 3]);
        assert_eq!(dotted().flipped(false, true).row(1)[0], [1.0; 3]);
        assert_eq!(dotted().flipped(true, true).row(1)[3], [1.0; 3]);
    }

    #[test]
    fn a_clockwise_quarter_brings_the_upper_left_corner_to_the_upper_right() {
        let quarter = dotted().turned(1);
        assert_eq!((quarter.width(), quarter.height(), quarter.row(0)[1]), (2, 4, [1.0; 3]));
        assert_eq!(dotted().turned(2).row(1)[3], [1.0; 3]);
        assert_eq!(dotted().turned(3).row(3)[0], [1.0; 3]);
        assert_eq!(dotted().turned(4), dotted());
    }

    #[test]
    fn between_two_pixels_is_their_mean() {
        assert_eq!(dotted().sample(1.0, 0.5), [0.5; 3]);
        assert_eq!(dotted().sample(0.5, 0.5), [1.0; 3]);
        assert_eq!(dotted().sample(1.0, 1.0), [0.25; 3]);
    }
}
