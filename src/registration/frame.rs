//! A photograph as numbers: one brightness a pixel, as the file has it.

use super::linear::quantile;

/// The least side of a photograph that can hold a Moon of use.
pub const LEAST_SIDE: usize = 64;

/// The longest side that is looked at.
pub const LONGEST_SIDE: usize = 16_384;

/// A value from which on a pixel counts as full.
pub(super) const FULL: f32 = 0.99;

/// Why a photograph gives no Moon.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MoonError {
    /// Too small or too large.
    #[error(
        "it has {width} x {height} pixels, and {LEAST_SIDE} to {LONGEST_SIDE} a side are wanted: photograph the Moon so that its disc is 800 pixels or more"
    )]
    Size {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// Values that are no numbers.
    #[error("{count} of its pixels are no finite numbers: save it again, or mend the dead pixels first")]
    NotFinite {
        /// How many.
        count: usize,
    },
    /// All white.
    #[error(
        "it is overexposed, {percent:.0} % of the lit part is at full white: expose about {} times shorter",
        if *percent > 95.0 { 8 } else { 3 }
    )]
    Saturated {
        /// Share of the pixels that matter, percent.
        percent: f64,
    },
    /// Nothing stands out.
    #[error(
        "nothing in it is brighter than the rest by more than its noise ({contrast:.3} of full white, noise {noise:.3}): expose longer, and see that the Moon is in the picture"
    )]
    Dark {
        /// Between the darkest and the brightest parts.
        contrast: f64,
        /// One standard deviation.
        noise: f64,
    },
    /// No circle.
    #[error(
        "no limb of the Moon was found in it: {found} of its edges lie on one circle, {wanted} are wanted; focus the bright limb and keep it in the picture"
    )]
    NoLimb {
        /// Degrees of arc on the best circle.
        found: String,
        /// Degrees of arc that are wanted.
        wanted: String,
    },
}

/// A photograph: brightness 0 to 1 as the file encodes it. Pixel (i, j) covers `i..i+1`, `j..j+1`, x to the right and y down.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    width: usize,
    height: usize,
    values: Vec<f32>,
}

impl Frame {
    /// A photograph of `width` x `height` values, row by row from the top.
    ///
    /// # Errors
    /// [`MoonError::Size`] also where the number of values is another, [`MoonError::NotFinite`].
    pub fn new(width: usize, height: usize, values: Vec<f32>) -> Result<Frame, MoonError> {
        let sides = LEAST_SIDE..=LONGEST_SIDE;
        if !sides.contains(&width) || !sides.contains(&height) || values.len() != width * height {
            return Err(MoonError::Size { width, height });
        }
        match values.iter().filter(|value| !value.is_finite()).count() {
            0 => Ok(Frame { width, height, values }),
            count => Err(MoonError::NotFinite { count }),
        }
    }

    /// Columns.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// All values, row by row from the top.
    #[must_use]
    pub fn values(&self) -> &[f32] {
        &self.values
    }

    pub(super) fn pixel(&self, x: usize, y: usize) -> f64 {
        f64::from(self.values[y * self.width + x])
    }

    /// Between the pixels' middles, bilinear; `None` outside of them.
    pub(super) fn at(&self, x: f64, y: f64) -> Option<f64> {
        let (x, y) = (x - 0.5, y - 0.5);
        if !(x >= 0.0 && y >= 0.0 && x < (self.width - 1) as f64 && y < (self.height - 1) as f64) {
            return None;
        }
        let (i, j) = (x as usize, y as usize);
        let (u, v) = (x - i as f64, y - j as f64);
        let upper = &self.values[j * self.width + i..][..2];
        let lower = &self.values[(j + 1) * self.width + i..][..2];
        let mix = |pair: &[f32]| f64::from(pair[0]) * (1.0 - u) + f64::from(pair[1]) * u;
        Some(mix(upper) * (1.0 - v) + mix(lower) * v)
    }

    /// Smaller by a whole factor: each value the mean of `factor` x `factor`.
    pub(super) fn reduced(&self, factor: usize) -> Frame {
        let (width, height) = (self.width / factor, self.height / factor);
        let mut values = vec![0.0f32; width * height];
        for y in 0..height * factor {
            let row = &self.values[y * self.width..][..width * factor];
            let into = &mut values[y / factor * width..][..width];
            for (sum, of) in into.iter_mut().zip(row.chunks_exact(factor)) {
                *sum += of.iter().sum::<f32>();
            }
        }
        let share = 1.0 / (factor * factor) as f32;
        values.iter_mut().for_each(|value| *value *= share);
        Frame { width, height, values }
    }

    /// Blurred by a small kernel, the binomial of five values both ways (standard deviation 1 pixel).
    pub(super) fn softened(&self) -> Frame {
        const KERNEL: [f32; 5] = [1.0 / 16.0, 4.0 / 16.0, 6.0 / 16.0, 4.0 / 16.0, 1.0 / 16.0];
        let (w, h) = (self.width, self.height);
        let mut across = vec![0.0f32; w * h];
        for y in 0..h {
            for x in 0..w {
                let at = |k: usize| self.values[y * w + (x + k).saturating_sub(2).min(w - 1)];
                across[y * w + x] = KERNEL.iter().enumerate().map(|(k, weight)| weight * at(k)).sum();
            }
        }
        let mut values = vec![0.0f32; w * h];
        for y in 0..h {
            for (k, weight) in KERNEL.iter().enumerate() {
                let from = (y + k).saturating_sub(2).min(h - 1);
                for x in 0..w {
                    values[y * w + x] += weight * across[from * w + x];
                }
            }
        }
        Frame { width: w, height: h, values }
    }

    /// One standard deviation of the noise, from second differences along rows: what they have in the middle of their sizes.
    pub(super) fn noise(&self) -> f64 {
        let mut bends: Vec<f64> = Vec::new();
        let step = (self.values.len() / 40_000).max(1);
        for start in (0..self.values.len().saturating_sub(2)).step_by(step) {
            let of = &self.values[start..start + 3];
            if start % self.width + 2 < self.width && of.iter().all(|v| *v > 0.0 && *v < FULL) {
                bends.push(f64::from(of[0] - 2.0 * of[1] + of[2]).abs());
            }
        }
        // Median of |N(0, 6 sigma^2)|.
        quantile(&mut bends, 0.5) / (0.6745 * 6f64.sqrt())
    }

    /// The values below which shares of all pixels lie.
    pub(super) fn quantiles(&self, shares: [f64; 2]) -> [f64; 2] {
        let step = (self.values.len() / 100_000).max(1);
        let mut some: Vec<f64> = self.values.iter().step_by(step).map(|value| f64::from(*value)).collect();
        shares.map(|share| quantile(&mut some, share))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_too_small_or_no_number_is_refused_with_what_to_do() {
        assert_eq!(Frame::new(1, 1, vec![0.5]), Err(MoonError::Size { width: 1, height: 1 }));
        let mut values = vec![0.5; 64 * 64];
        values[77] = f32::NAN;
        values[78] = f32::INFINITY;
        let error = Frame::new(64, 64, values).unwrap_err();
        assert_eq!(error, MoonError::NotFinite { count: 2 });
        assert!(error.to_string().contains("save it again"));
    }

    #[test]
    fn a_value_between_pixels_is_their_mean() {
        let values = (0..64 * 64).map(|k| (k % 64) as f32).collect();
        let frame = Frame::new(64, 64, values).unwrap();
        assert!((frame.at(10.5, 20.2).unwrap() - 10.0).abs() < 1e-6);
        assert!((frame.at(11.0, 20.2).unwrap() - 10.5).abs() < 1e-6);
        assert_eq!(frame.at(0.2, 20.0), None);
        assert!((frame.reduced(2).pixel(3, 3) - 6.5).abs() < 1e-6);
        assert!((frame.softened().pixel(30, 30) - 30.0).abs() < 1e-5);
    }
}
