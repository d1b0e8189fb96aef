//! The circle's corrections from displacements along an arc, with errors that know of mountains: neighbouring places of the
//! limb are high together, and an arc of forty degrees is no longer a thousand independent points.

use super::linear::{Normal, cholesky, forward, median};

/// A stretch of limb: how far it lies outside the circle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stretch {
    /// Direction from the middle, radians from x to y.
    pub(super) angle: f64,
    /// What one pixel of radius moves it.
    pub(super) per_radius: f64,
    /// Outwards, pixels.
    pub(super) off: f64,
    /// Its error relative to the others'.
    pub(super) error: f64,
}

impl Stretch {
    fn gradient(&self) -> [f64; 3] {
        [self.angle.cos(), self.angle.sin(), self.per_radius]
    }
}

/// Corrections of middle and radius.
#[derive(Debug, Clone, Copy)]
pub(super) struct Correction {
    /// x, y, radius: pixels.
    pub(super) by: [f64; 3],
    /// Their covariance.
    pub(super) covariance: [[f64; 3]; 3],
}

/// Robust least squares with Tukey's biweight (Beaton and Tukey 1974): craters and the terminator fall out. Gives the
/// correction, and which stretches were kept.
pub(super) fn robust(stretches: &[Stretch]) -> Option<([f64; 3], Vec<bool>)> {
    let mut weights = vec![1.0; stretches.len()];
    let mut by = [0.0; 3];
    let mut kept = vec![true; stretches.len()];
    for _ in 0..12 {
        let mut normal = Normal::<3>::new();
        for (stretch, weight) in stretches.iter().zip(&weights) {
            normal.add(&stretch.gradient(), stretch.off, weight / stretch.error.powi(2));
        }
        by = normal.solve()?.0;
        let rest: Vec<f64> = stretches.iter().map(|s| (s.off - dot(&s.gradient(), &by)) / s.error).collect();
        let mut sizes: Vec<f64> = rest.iter().map(|r| r.abs()).collect();
        let scale = (median(&mut sizes) / 0.6745).max(1e-4);
        for ((weight, kept), rest) in weights.iter_mut().zip(&mut kept).zip(&rest) {
            let u = rest / (6.0 * scale);
            *weight = if u.abs() < 1.0 { (1.0 - u * u).powi(2) } else { 0.0 };
            *kept = rest.abs() < 4.0 * scale;
        }
    }
    Some((by, kept))
}

/// Shares of correlated variance (in the independent one) that are weighed.
const SHARES: [f64; 7] = [0.0, 0.25, 1.0, 4.0, 16.0, 64.0, 256.0];
/// Lengths of correlation (in stretches) that are weighed.
const LENGTHS: [f64; 6] = [0.7, 1.5, 3.0, 6.0, 12.0, 24.0];

/// Generalised least squares under `C = s^2 (diag(error^2) + share exp(-gap/length))`. Share and length are not known: each
/// pair is weighed by its restricted likelihood (Patterson and Thompson 1971, Biometrika 58, 545), and the spread between them
/// adds to the error.
pub(super) fn weighed(stretches: &[Stretch], step: f64) -> Option<Correction> {
    let mut models: Vec<(f64, Correction)> = Vec::new();
    for share in SHARES {
        for length in LENGTHS {
            models.extend(under(stretches, share, length * step));
            if share == 0.0 {
                break;
            }
        }
    }
    let most = models.iter().map(|(likelihood, _)| *likelihood).fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = models.iter().map(|(likelihood, _)| (likelihood - most).exp()).collect();
    let whole: f64 = weights.iter().sum();
    if !(whole.is_finite() && whole > 0.0) {
        return None;
    }
    let mut mean = Correction { by: [0.0; 3], covariance: [[0.0; 3]; 3] };
    for (weight, (_, model)) in weights.iter().zip(&models) {
        (0..3).for_each(|i| mean.by[i] += weight / whole * model.by[i]);
    }
    for (weight, (_, model)) in weights.iter().zip(&models) {
        for i in 0..3 {
            for j in 0..3 {
                let between = (model.by[i] - mean.by[i]) * (model.by[j] - mean.by[j]);
                mean.covariance[i][j] += weight / whole * (model.covariance[i][j] + between);
            }
        }
    }
    Some(mean)
}

/// The fit under one share and length, and its restricted log likelihood.
fn under(stretches: &[Stretch], share: f64, length: f64) -> Option<(f64, Correction)> {
    let n = stretches.len();
    if n < 6 {
        return None;
    }
    let mut matrix = vec![0.0; n * n];
    for (i, one) in stretches.iter().enumerate() {
        for (j, other) in stretches.iter().enumerate().take(i + 1) {
            let gap = (one.angle - other.angle).rem_euclid(std::f64::consts::TAU);
            let gap = gap.min(std::f64::consts::TAU - gap);
            matrix[i * n + j] = share * (-gap / length).exp();
        }
        matrix[i * n + i] += one.error.powi(2);
    }
    // Whitened by the triangle, it is ordinary least squares.
    let lower = cholesky(&matrix, n)?;
    let columns: Vec<Vec<f64>> =
        (0..3).map(|k| forward(&lower, n, &stretches.iter().map(|s| s.gradient()[k]).collect::<Vec<_>>())).collect();
    let right = forward(&lower, n, &stretches.iter().map(|s| s.off).collect::<Vec<_>>());
    let mut normal = Normal::<3>::new();
    for row in 0..n {
        normal.add(&[columns[0][row], columns[1][row], columns[2][row]], right[row], 1.0);
    }
    let (by, inverse) = normal.solve()?;
    let rest = |row: usize| right[row] - (0..3).map(|k| columns[k][row] * by[k]).sum::<f64>();
    let misfit: f64 = (0..n).map(|row| rest(row).powi(2)).sum();
    let free = (n - 3) as f64;
    let variance = (misfit / free).max(1e-12);
    let log_determinant: f64 = 2.0 * (0..n).map(|i| lower[i * n + i].ln()).sum::<f64>();
    let flat: Vec<f64> = inverse.iter().flatten().copied().collect();
    let log_inverse: f64 = 2.0 * cholesky(&flat, 3).map(|l| (0..3).map(|i| l[i * 3 + i].ln()).sum::<f64>())?;
    let likelihood = -0.5 * (free * variance.ln() + log_determinant - log_inverse);
    Some((likelihood, Correction { by, covariance: inverse.map(|row| row.map(|cell| cell * variance)) }))
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::streams::Stream;

    /// Three quarters of a turn of limb, off by 0.3 pixels of radius, under independent noise and mountains that neighbours share.
    fn limb(seed: u64, mountains: f64) -> Vec<Stretch> {
        let mut stream = Stream::seeded(seed);
        let mut normal = || (0..12).map(|_| stream.uniform()).sum::<f64>() - 6.0;
        let mut height = normal();
        (0..60)
            .map(|k| {
                height = 0.8 * height + 0.6 * normal();
                let angle = f64::from(k) * 0.08;
                Stretch { angle, per_radius: 1.0, off: 0.3 + 0.1 * normal() + mountains * height, error: 1.0 }
            })
            .collect()
    }

    #[test]
    fn the_stated_error_of_the_radius_knows_of_mountains() {
        for mountains in [0.0, 0.5] {
            let (mut inside, mut sizes) = (0, 0.0);
            for seed in 0..100 {
                let found = weighed(&limb(seed, mountains), 0.08).unwrap();
                let error = found.covariance[2][2].sqrt();
                inside += usize::from((found.by[2] - 0.3).abs() <= 2.0 * error);
                sizes += error / 100.0;
            }
            assert!((88..=100).contains(&inside), "mountains {mountains}: {inside} of 100 within two sigma");
            assert!(if mountains > 0.0 { sizes > 0.05 } else { sizes < 0.04 }, "mountains {mountains}: {sizes}");
        }
    }

    #[test]
    fn a_crater_falls_out() {
        let mut stretches = limb(1, 0.0);
        stretches[20..24].iter_mut().for_each(|stretch| stretch.off -= 3.0);
        let (by, kept) = robust(&stretches).unwrap();
        assert!((by[2] - 0.3).abs() < 0.1 && !kept[20] && !kept[23] && kept[30], "{by:?}");
    }
}
