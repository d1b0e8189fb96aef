//! Real spherical harmonics, orthonormal over the sphere, of orders 0 to 8.

use glam::DVec3;

/// Highest order that can be asked for.
pub const HIGHEST: usize = 8;
/// Coefficients of the highest order.
pub const MOST: usize = (HIGHEST + 1) * (HIGHEST + 1);

/// The functions up to an order, with the constants of their recurrences made once.
///
/// ```text
/// Y_lm = sqrt(2) N P_l^m(z) cos(m phi)    at index l^2 + l + m
/// Y_l-m = sqrt(2) N P_l^m(z) sin(m phi)   at index l^2 + l - m, no Condon-Shortley phase
/// (z^2 - 1) is never divided by: sin^m(theta) is held in (x + i y)^m, so that the poles are ordinary points
/// ```
///
/// Recurrences of the fully normalised functions: Press et al. (2007), Numerical Recipes, section 6.7.
#[derive(Debug, Clone)]
pub struct Harmonics {
    order: usize,
    // By index l^2 + l + m: P_lm = rise (z P_(l-1)m - fall P_(l-2)m).
    rise: [f64; MOST],
    fall: [f64; MOST],
}

impl Harmonics {
    /// The functions up to an order; an order above [`HIGHEST`] is taken for it.
    #[must_use]
    pub fn new(order: usize) -> Harmonics {
        let order = order.min(HIGHEST);
        let (mut rise, mut fall) = ([0.0; MOST], [0.0; MOST]);
        for l in 1..=order {
            for m in 0..l {
                let (lf, mf) = (l as f64, m as f64);
                rise[l * l + l + m] = ((4.0 * lf * lf - 1.0) / (lf * lf - mf * mf)).sqrt();
                let below = lf - 1.0;
                if l >= m + 2 {
                    fall[l * l + l + m] = ((below * below - mf * mf) / (4.0 * below * below - 1.0)).sqrt();
                }
            }
        }
        Harmonics { order, rise, fall }
    }

    /// The highest order.
    #[must_use]
    pub fn order(&self) -> usize {
        self.order
    }

    /// How many functions: (order + 1)^2.
    #[must_use]
    pub fn count(&self) -> usize {
        (self.order + 1) * (self.order + 1)
    }

    /// All functions at a direction of length 1, by index l^2 + l + m; zeros behind [`Harmonics::count`].
    #[must_use]
    pub fn at(&self, direction: DVec3) -> [f64; MOST] {
        let mut all = [0.0; MOST];
        let DVec3 { x, y, z } = direction;
        let (mut sectoral, mut cosine, mut sine) = ((0.25 / std::f64::consts::PI).sqrt(), 1.0, 0.0);
        for m in 0..=self.order {
            if m > 0 {
                (cosine, sine) = (x * cosine - y * sine, x * sine + y * cosine);
                sectoral *= ((2 * m + 1) as f64 / (2 * m) as f64).sqrt();
            }
            let turn = if m == 0 { 1.0 } else { std::f64::consts::SQRT_2 };
            let (mut before, mut here) = (0.0, sectoral);
            for l in m..=self.order {
                let centre = l * l + l;
                if l > m {
                    (before, here) = (here, self.rise[centre + m] * (z * here - self.fall[centre + m] * before));
                }
                all[centre + m] = turn * here * cosine;
                if m > 0 {
                    all[centre - m] = turn * here * sine;
                }
            }
        }
        all
    }

    /// The same at eight directions at once, f32: for what is seen many times a second.
    #[must_use]
    #[inline(always)]
    pub fn eight(&self, [x, y, z]: [[f32; 8]; 3]) -> [[f32; 8]; MOST] {
        let mut all = [[0.0; 8]; MOST];
        let mut sectoral = (0.25 / std::f64::consts::PI).sqrt();
        let (mut cosine, mut sine) = ([1.0f32; 8], [0.0f32; 8]);
        for m in 0..=self.order {
            if m > 0 {
                for n in 0..8 {
                    (cosine[n], sine[n]) = (x[n] * cosine[n] - y[n] * sine[n], x[n] * sine[n] + y[n] * cosine[n]);
                }
                sectoral *= ((2 * m + 1) as f64 / (2 * m) as f64).sqrt();
            }
            let turn = if m == 0 { 1.0 } else { std::f32::consts::SQRT_2 };
            let (mut before, mut here) = ([0.0f32; 8], [sectoral as f32 * turn; 8]);
            for l in m..=self.order {
                let centre = l * l + l;
                if l > m {
                    let (rise, fall) = (self.rise[centre + m] as f32, self.fall[centre + m] as f32);
                    for n in 0..8 {
                        (before[n], here[n]) = (here[n], rise * (z[n] * here[n] - fall * before[n]));
                    }
                }
                for n in 0..8 {
                    all[centre + m][n] = here[n] * cosine[n];
                }
                if m > 0 {
                    for n in 0..8 {
                        all[centre - m][n] = here[n] * sine[n];
                    }
                }
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::streams::Stream;
    use crate::physics::dust::phase::HenyeyGreenstein;

    fn any(stream: &mut Stream) -> DVec3 {
        let (z, turn) = (2.0 * stream.uniform() - 1.0, std::f64::consts::TAU * stream.uniform());
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * turn.cos(), across * turn.sin(), z)
    }

    #[test]
    fn low_orders_are_those_of_the_tables() {
        let at = Harmonics::new(2).at(DVec3::new(0.6, 0.0, 0.8));
        let expected = [
            0.282_094_79,
            0.0,
            0.488_602_51 * 0.8,
            0.488_602_51 * 0.6,
            0.0,
            0.0,
            0.315_391_57 * (3.0 * 0.64 - 1.0),
            1.092_548_43 * 0.48,
            0.546_274_22 * 0.36,
        ];
        for (index, (there, here)) in at.iter().zip(expected).enumerate() {
            assert!((there - here).abs() < 1e-8, "{index}: {there} and {here}");
        }
    }

    #[test]
    fn the_addition_theorem_holds_to_order_8() {
        // Sum over m of Y_lm(a) Y_lm(b) = (2 l + 1) P_l(a.b) / (4 pi); with g^l it is the series of Henyey and Greenstein's law.
        let (harmonics, mut stream) = (Harmonics::new(HIGHEST), Stream::seeded(3));
        for _ in 0..50 {
            let (a, b) = (any(&mut stream), any(&mut stream));
            let (at, bt, cosine) = (harmonics.at(a), harmonics.at(b), a.dot(b));
            let (mut below, mut here) = (1.0, cosine);
            for l in 0..=HIGHEST {
                let sum: f64 = (l * l..(l + 1) * (l + 1)).map(|i| at[i] * bt[i]).sum();
                let legendre = match l {
                    0 => 1.0,
                    1 => cosine,
                    _ => {
                        let lf = l as f64;
                        (below, here) = (here, ((2.0 * lf - 1.0) * cosine * here - (lf - 1.0) * below) / lf);
                        here
                    }
                };
                let expected = (2 * l + 1) as f64 * legendre / (4.0 * std::f64::consts::PI);
                assert!((sum - expected).abs() < 1e-12, "order {l}: {sum} and {expected}");
            }
            let g: f64 = 0.2;
            let series: f64 = (0..MOST).map(|i| g.powi((i as f64).sqrt() as i32) * at[i] * bt[i]).sum();
            let law = HenyeyGreenstein::new(g).unwrap().per_steradian(cosine);
            assert!((series - law).abs() < 2e-5, "{series} and {law}");
        }
    }

    #[test]
    fn eight_directions_at_once_give_what_one_gives() {
        let (harmonics, mut stream) = (Harmonics::new(HIGHEST), Stream::seeded(4));
        let directions: [DVec3; 8] = std::array::from_fn(|_| any(&mut stream));
        let eight = harmonics.eight([0, 1, 2].map(|axis| directions.map(|d| d[axis] as f32)));
        for (n, direction) in directions.iter().enumerate() {
            for (index, one) in harmonics.at(*direction).iter().enumerate() {
                assert!((one - f64::from(eight[index][n])).abs() < 3e-6, "{index}: {one}");
            }
        }
    }

    #[test]
    fn the_poles_are_ordinary_points() {
        for z in [1.0, -1.0] {
            assert!(Harmonics::new(HIGHEST).at(DVec3::new(0.0, 0.0, z)).iter().all(|y| y.is_finite()));
        }
    }
}
