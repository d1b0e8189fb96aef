//! Small dense systems of linear equations, symmetric and positive.

/// The lower triangle `L` of a symmetric positive matrix (row by row, `n` a side), `L Lᵀ = A`; `None` if it is not positive.
pub(super) fn cholesky(matrix: &[f64], n: usize) -> Option<Vec<f64>> {
    let mut lower = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let (row_i, row_j) = (&lower[i * n..i * n + j], &lower[j * n..j * n + j]);
            let rest = matrix[i * n + j] - row_i.iter().zip(row_j).map(|(a, b)| a * b).sum::<f64>();
            lower[i * n + j] = if i == j {
                if rest <= 0.0 || !rest.is_finite() {
                    return None;
                }
                rest.sqrt()
            } else {
                rest / lower[j * n + j]
            };
        }
    }
    Some(lower)
}

/// `L⁻¹ b` for the triangle of [`cholesky`].
pub(super) fn forward(lower: &[f64], n: usize, right: &[f64]) -> Vec<f64> {
    let mut x = vec![0.0; n];
    for i in 0..n {
        let known: f64 = lower[i * n..i * n + i].iter().zip(&x).map(|(a, b)| a * b).sum();
        x[i] = (right[i] - known) / lower[i * n + i];
    }
    x
}

/// `L⁻ᵀ b` for the triangle of [`cholesky`].
fn backward(lower: &[f64], n: usize, right: &[f64]) -> Vec<f64> {
    let mut x = vec![0.0; n];
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|j| lower[j * n + i] * x[j]).sum();
        x[i] = (right[i] - known) / lower[i * n + i];
    }
    x
}

/// Sums of a least squares problem of `N` unknowns: `A = Σ w g gᵀ`, `b = Σ w g r`.
#[derive(Debug, Clone)]
pub(super) struct Normal<const N: usize> {
    matrix: Vec<f64>,
    right: [f64; N],
}

impl<const N: usize> Normal<N> {
    pub(super) fn new() -> Normal<N> {
        Normal { matrix: vec![0.0; N * N], right: [0.0; N] }
    }

    /// One equation `g x = r` of weight `w`.
    pub(super) fn add(&mut self, gradient: &[f64; N], right: f64, weight: f64) {
        for i in 0..N {
            self.right[i] += weight * gradient[i] * right;
            for j in 0..N {
                self.matrix[i * N + j] += weight * gradient[i] * gradient[j];
            }
        }
    }

    /// A cell of two faces: `A += w sym(g h')`, `b += w r / 2`, of which noise in one face alone has no mean.
    pub(super) fn cross(&mut self, one: &[f64; N], other: &[f64; N], right: impl Fn(usize) -> f64, weight: f64) {
        for i in 0..N {
            self.right[i] += 0.5 * weight * right(i);
            for j in 0..N {
                self.matrix[i * N + j] += 0.5 * weight * (one[i] * other[j] + one[j] * other[i]);
            }
        }
    }

    /// Adds the sums of another part.
    pub(super) fn join(&mut self, part: &Normal<N>) {
        self.matrix.iter_mut().zip(&part.matrix).for_each(|(sum, part)| *sum += part);
        self.right.iter_mut().zip(&part.right).for_each(|(sum, part)| *sum += part);
    }

    /// The sums without a part of them.
    pub(super) fn without(&self, part: &Normal<N>) -> Normal<N> {
        let mut rest = self.clone();
        rest.matrix.iter_mut().zip(&part.matrix).for_each(|(sum, part)| *sum -= part);
        rest.right.iter_mut().zip(&part.right).for_each(|(sum, part)| *sum -= part);
        rest
    }

    /// The solution and the inverse of the matrix; `None` if the equations do not determine it.
    pub(super) fn solve(&self) -> Option<([f64; N], [[f64; N]; N])> {
        let lower = cholesky(&self.matrix, N)?;
        let mut inverse = [[0.0; N]; N];
        for (column, row) in inverse.iter_mut().enumerate() {
            let mut unit = [0.0; N];
            unit[column] = 1.0;
            let solved = backward(&lower, N, &forward(&lower, N, &unit));
            row.copy_from_slice(&solved);
        }
        let solved = backward(&lower, N, &forward(&lower, N, &self.right));
        let mut solution = [0.0; N];
        solution.copy_from_slice(&solved);
        solution.iter().all(|x| x.is_finite()).then_some((solution, inverse))
    }
}

/// The middle of numbers by size; zero of none. The order is lost.
pub(super) fn median(numbers: &mut [f64]) -> f64 {
    quantile(numbers, 0.5)
}

/// The number below which a share of all lies; zero of none. The order is lost.
pub(super) fn quantile(numbers: &mut [f64], share: f64) -> f64 {
    if numbers.is_empty() {
        return 0.0;
    }
    let place = ((numbers.len() - 1) as f64 * share).round() as usize;
    *numbers.select_nth_unstable_by(place, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_through_three_points_is_found_with_the_inverse_of_its_equations() {
        let mut normal = Normal::<3>::new();
        for x in [-1.0, 0.0, 2.0] {
            normal.add(&[1.0, x, x * x], 3.0 - 2.0 * x + 0.5 * x * x, 1.0);
        }
        let (found, inverse) = normal.solve().unwrap();
        for (found, there) in found.iter().zip([3.0, -2.0, 0.5]) {
            assert!((found - there).abs() < 1e-12, "{found} {there}");
        }
        assert!((0..3).all(|i| inverse[i][i] > 0.0));
        assert!(Normal::<3>::new().solve().is_none());
    }

    #[test]
    fn quantiles_are_numbers_of_the_list() {
        let mut numbers = [5.0, 1.0, 4.0, 2.0, 3.0];
        assert_eq!((quantile(&mut numbers, 0.0), median(&mut numbers), quantile(&mut numbers, 1.0)), (1.0, 3.0, 5.0));
        assert_eq!(median(&mut []), 0.0);
    }
}
