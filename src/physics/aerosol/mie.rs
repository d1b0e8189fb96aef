//! Light scattered and absorbed by one homogeneous sphere: Mie's series.

use std::ops::RangeInclusive;

use num_complex::Complex64;

/// Size parameters that are accepted: 0 is no sphere; above 1e5 the memory for the recurrence is no longer small.
pub const SIZE_PARAMETERS: RangeInclusive<f64> = 0.0..=1e5;

/// Largest modulus of the refractive index that is accepted.
const LARGEST_INDEX: f64 = 100.0;

/// Spheres of a smaller size parameter do nothing: their x^4 is below any number.
const SMALLEST: f64 = 1e-50;

/// How strongly a sphere extinguishes, per geometric cross-section.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Efficiencies {
    /// Extinction: scattering plus absorption.
    pub extinction: f64,
    /// Scattering.
    pub scattering: f64,
    /// Absorption, never negative; exactly 0 where the index is real.
    pub absorption: f64,
    /// Mean cosine of the scattering angle, from -1 to 1; 0 where nothing is scattered.
    pub asymmetry: f64,
}

/// Why a sphere is not computed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MieError {
    /// The size parameter is negative, too large or no number.
    #[error("size parameter {0} is outside 0 to 1e5: give 2 pi radius / wavelength, both in one unit")]
    SizeParameter(f64),
    /// The refractive index is no index of a passive sphere.
    #[error(
        "refractive index {re} + {im} i: the real part must be above 0, the imaginary part 0 (clear) or above (absorbing), both below 100"
    )]
    Index {
        /// Real part.
        re: f64,
        /// Imaginary part.
        im: f64,
    },
}

/// The efficiencies of a sphere of size parameter `x` = 2 pi radius / wavelength and refractive index `m` relative to
/// the medium, m = n + i k with k positive where it absorbs.
///
/// ```text
/// a_n = ((D_n(mx)/m + n/x) psi_n - psi_n-1) / ((D_n(mx)/m + n/x) xi_n - xi_n-1),  b_n with m D_n     eq. 4.88
/// Qext = 2/x^2 sum (2n+1) Re(a_n + b_n)                                                               eq. 4.62
/// Qsca = 2/x^2 sum (2n+1) (|a_n|^2 + |b_n|^2)                                                         eq. 4.61
/// g Qsca = 4/x^2 sum [n(n+2)/(n+1) Re(a_n a*_n+1 + b_n b*_n+1) + (2n+1)/(n(n+1)) Re(a_n b*_n)]       section 4.5
/// ```
///
/// Source: Bohren & Huffman (1983), *Absorption and Scattering of Light by Small Particles*. The logarithmic derivative
/// D_n runs downwards from well above |mx|, which is stable for every m; psi_n and
/// chi_n (xi = psi - i chi) run upwards to the term of Wiscombe (1980), Applied Optics 19, 1505, eq. 17. Absorption is
/// summed by itself and not as a difference:
///
/// ```text
/// Re a - |a|^2 = -Im(D_n/m) / |denominator|^2          with the Wronskian psi_n-1 chi_n - psi_n chi_n-1 = 1
/// ```
///
/// so that a sphere that hardly absorbs keeps all digits of it. Measured: the 15 cases with finite index of Wiscombe's
/// MIEV0 to 1e-6 in Q, and 80-digit arithmetic to 1e-9 in Q and 1e-11 in g from x = 1e-3 to 1e4 (`tests/aerosol.rs`).
///
/// # Errors
/// The size parameter is negative, above 1e5 or not finite; the index is not that of a passive sphere.
pub fn sphere(x: f64, m: Complex64) -> Result<Efficiencies, MieError> {
    spheres([x], m).map(|[efficiencies]| efficiencies)
}

/// Several [`sphere`]s of one index, best of like sizes: their recurrences run side by side, which a processor does in hardly
/// more time than one, because each step waits for the one before.
///
/// # Errors
/// As for one sphere.
pub fn spheres<const N: usize>(x: [f64; N], m: Complex64) -> Result<[Efficiencies; N], MieError> {
    if let Some(&wrong) = x.iter().find(|x| !SIZE_PARAMETERS.contains(*x)) {
        return Err(MieError::SizeParameter(wrong));
    }
    if !(m.re > 0.0 && m.im >= 0.0 && m.re <= LARGEST_INDEX && m.im <= LARGEST_INDEX) {
        return Err(MieError::Index { re: m.re, im: m.im });
    }
    if m == Complex64::ONE {
        return Ok([Efficiencies::default(); N]);
    }
    let mut all = series(x.map(|x| x.max(SMALLEST)), m);
    for (efficiencies, x) in all.iter_mut().zip(x) {
        if x < SMALLEST {
            *efficiencies = Efficiencies::default();
        }
    }
    Ok(all)
}

/// Number of terms: Wiscombe's (1980, eq. 17), and two more, without which a sphere of x = 0.1 has six digits of absorption.
fn terms(x: f64) -> f64 {
    let root = x.cbrt();
    let count = if x <= 8.0 {
        x + 4.0 * root + 1.0
    } else if x < 4200.0 {
        x + 4.05 * root + 2.0
    } else {
        x + 4.0 * root + 2.0
    };
    count.floor() + 2.0
}

/// Real and imaginary parts of N numbers.
#[derive(Clone, Copy)]
struct Lanes<const N: usize> {
    re: [f64; N],
    im: [f64; N],
}

impl<const N: usize> Lanes<N> {
    const ZERO: Lanes<N> = Lanes { re: [0.0; N], im: [0.0; N] };
}

/// The logarithmic derivatives D_1 to D_`last` of the Riccati-Bessel function psi at each m x, by downward recurrence:
///
/// ```text
/// D_n-1 = n/z - 1/(D_n + n/z)          Bohren & Huffman (1983), eq. 4.89
/// ```
///
/// It forgets its false start (0) only above order |z|, by exp(-1.9 c^1.5) from order |z| + c |z|^(1/3) down to |z|; c = 8 leaves
/// nothing in f64. (Their own start, 15 above |z|, leaves 1e-5 in Qext at |z| = 133.)
#[inline(always)]
fn logarithmic_derivatives<const N: usize>(x: [f64; N], m: Complex64, last: usize) -> Vec<Lanes<N>> {
    let size = m.norm() * x.iter().fold(0.0, |largest: f64, &x| largest.max(x));
    let start = last.max((size + 8.0 * size.cbrt()) as usize) + 16;
    let mut inverse = Lanes::<N>::ZERO;
    for (lane, x) in x.into_iter().enumerate() {
        let z = (m * x).inv();
        (inverse.re[lane], inverse.im[lane]) = (z.re, z.im);
    }
    let mut derivatives = vec![Lanes::ZERO; last];
    let mut d = Lanes::<N>::ZERO;
    for n in (2..=start).rev() {
        let order = n as f64;
        for lane in 0..N {
            let (step_re, step_im) = (inverse.re[lane] * order, inverse.im[lane] * order);
            let (re, im) = (d.re[lane] + step_re, d.im[lane] + step_im);
            let weight = (re * re + im * im).recip();
            d.re[lane] = step_re - re * weight;
            d.im[lane] = step_im + im * weight;
        }
        if n - 2 < last {
            derivatives[n - 2] = d;
        }
    }
    derivatives
}

/// psi_1(x) = sin x/x - cos x, by its power series where the two would cancel.
fn first_psi(x: f64, sine: f64, cosine: f64) -> f64 {
    if x > 0.5 {
        return sine / x - cosine;
    }
    // x j_1(x) = x^2/3 (1 - x^2/(2 5) (1 - x^2/(4 7) (1 - x^2/(6 9) ...)))
    let square = x * x;
    let tail = (1..=8).rev().fold(1.0, |tail, k| {
        let k = f64::from(k);
        1.0 - square / (2.0 * k * (2.0 * k + 3.0)) * tail
    });
    square / 3.0 * tail
}

/// One coefficient of the series, and what absorption takes from it.
#[derive(Clone, Copy)]
struct Coefficient {
    re: f64,
    im: f64,
    absorbed: f64,
}

impl Coefficient {
    /// The coefficient for `t` = D/m + n/x (a_n) or m D + n/x (b_n).
    #[inline(always)]
    fn new(t: (f64, f64), psi: (f64, f64), chi: (f64, f64)) -> Coefficient {
        let p = (t.0 * psi.1 - psi.0, t.1 * psi.1);
        let s = (t.0 * chi.1 - chi.0, t.1 * chi.1);
        let denominator = (p.0 + s.1, p.1 - s.0);
        let weight = (denominator.0 * denominator.0 + denominator.1 * denominator.1).recip();
        Coefficient {
            re: (p.0 * denominator.0 + p.1 * denominator.1) * weight,
            im: (p.1 * denominator.0 - p.0 * denominator.1) * weight,
            absorbed: (-t.1 * weight).max(0.0),
        }
    }

    /// Re(u v*).
    #[inline(always)]
    fn with(self, re: f64, im: f64) -> f64 {
        self.re * re + self.im * im
    }
}

/// Sums and the last coefficients of N spheres.
struct Sums<const N: usize> {
    extinction: [f64; N],
    scattering: [f64; N],
    absorption: [f64; N],
    asymmetry: [f64; N],
    a: Lanes<N>,
    b: Lanes<N>,
}

/// The sum of the series, with wider registers where the processor has them: the same operations, hence the same bits.
fn series<const N: usize>(x: [f64; N], m: Complex64) -> [Efficiencies; N] {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        #[target_feature(enable = "avx2")]
        fn wide<const N: usize>(x: [f64; N], m: Complex64) -> [Efficiencies; N] {
            sum(x, m)
        }
        // SAFETY: the processor has been asked.
        #[expect(unsafe_code, reason = "wider registers are only for processors that have them")]
        return unsafe { wide(x, m) };
    }
    sum(x, m)
}

#[inline(always)]
fn sum<const N: usize>(x: [f64; N], m: Complex64) -> [Efficiencies; N] {
    let lasts = x.map(terms);
    let last = lasts.iter().fold(0.0, |largest: f64, &last| largest.max(last));
    let derivatives = logarithmic_derivatives(x, m, last as usize);
    let inverse_m = m.inv();
    let inverse_x = x.map(f64::recip);
    let cosines = x.map(f64::cos);
    let mut psi_before = x.map(f64::sin);
    let mut psi: [f64; N] = std::array::from_fn(|lane| first_psi(x[lane], psi_before[lane], cosines[lane]));
    let mut chi: [f64; N] = std::array::from_fn(|lane| cosines[lane] * inverse_x[lane] + psi_before[lane]);
    let mut chi_before = cosines;
    let zero = [0.0; N];
    let mut sums =
        Sums { extinction: zero, scattering: zero, absorption: zero, asymmetry: zero, a: Lanes::ZERO, b: Lanes::ZERO };
    for (n, d) in (1_u32..).zip(&derivatives) {
        let n = f64::from(n);
        let (degeneracy, within, between) =
            (2.0 * n + 1.0, (2.0 * n + 1.0) / (n * (n + 1.0)), (n - 1.0) * (n + 1.0) / n);
        for lane in 0..N {
            let (re, im) = (d.re[lane], d.im[lane]);
            let place = n * inverse_x[lane];
            let electric = (re * inverse_m.re - im * inverse_m.im + place, re * inverse_m.im + im * inverse_m.re);
            let magnetic = (re * m.re - im * m.im + place, re * m.im + im * m.re);
            let (p, c) = ((psi_before[lane], psi[lane]), (chi_before[lane], chi[lane]));
            let (a, b) = (Coefficient::new(electric, p, c), Coefficient::new(magnetic, p, c));
            // A sphere smaller than its neighbours has had all its terms; chi may then be infinite.
            let unless_done = |term: f64| if n <= lasts[lane] { term } else { 0.0 };
            let neighbours = a.with(sums.a.re[lane], sums.a.im[lane]) + b.with(sums.b.re[lane], sums.b.im[lane]);
            sums.extinction[lane] += unless_done(degeneracy * (a.re + b.re));
            sums.scattering[lane] += unless_done(degeneracy * (a.with(a.re, a.im) + b.with(b.re, b.im)));
            sums.absorption[lane] += unless_done(degeneracy * (a.absorbed + b.absorbed));
            sums.asymmetry[lane] += unless_done(within * a.with(b.re, b.im) + between * neighbours);
            (sums.a.re[lane], sums.a.im[lane]) = (a.re, a.im);
            (sums.b.re[lane], sums.b.im[lane]) = (b.re, b.im);
            let climb = degeneracy * inverse_x[lane];
            (psi_before[lane], psi[lane]) = (psi[lane], climb * psi[lane] - psi_before[lane]);
            (chi_before[lane], chi[lane]) = (chi[lane], climb * chi[lane] - chi_before[lane]);
        }
    }
    std::array::from_fn(|lane| {
        let area = 2.0 * inverse_x[lane] * inverse_x[lane];
        let scattering = sums.scattering[lane];
        Efficiencies {
            extinction: area * sums.extinction[lane],
            scattering: area * scattering,
            absorption: if m.im == 0.0 { 0.0 } else { area * sums.absorption[lane] },
            asymmetry: if scattering > 0.0 { 2.0 * sums.asymmetry[lane] / scattering } else { 0.0 },
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn efficiencies(x: f64, re: f64, im: f64) -> Efficiencies {
        sphere(x, Complex64::new(re, im)).unwrap()
    }

    /// Bohren & Huffman (1983), appendix A: a sphere of 0.525 micrometre and index 1.55 in light of 632.8 nm.
    #[test]
    fn bohren_and_huffmans_example_comes_out() {
        let q = efficiencies(std::f64::consts::TAU * 0.525 / 0.6328, 1.55, 0.0);
        assert!((q.extinction - 3.10543).abs() < 5e-6 && (q.asymmetry - 0.63314).abs() < 5e-6, "{q:?}");
    }

    #[test]
    fn a_sphere_of_the_mediums_own_index_scatters_nothing() {
        assert_eq!(efficiencies(10.0, 1.0, 0.0), Efficiencies::default());
        assert_eq!(efficiencies(0.0, 1.5, 0.1), Efficiencies::default());
    }

    /// Rayleigh and Gans: the scattering of a sphere with x |m - 1| far below 1 goes with |m - 1|^2; Bohren & Huffman (1983),
    /// section 6.1.
    #[test]
    fn a_nearly_invisible_sphere_fades_with_the_square_of_its_contrast() {
        let ratio = efficiencies(1.0, 1.0 + 1e-4, 0.0).scattering / efficiencies(1.0, 1.0 + 1e-6, 0.0).scattering;
        assert!((ratio / 1e4 - 1.0).abs() < 1e-3, "{ratio}");
    }

    #[test]
    fn what_is_no_sphere_is_refused_with_the_number() {
        for x in [-1.0, 1.1e5, f64::NAN, f64::INFINITY] {
            let error = sphere(x, Complex64::new(1.5, 0.0)).unwrap_err();
            assert!(error.to_string().contains(&x.to_string()), "{error}");
        }
        for m in [(0.0, 0.0), (-1.5, 0.0), (1.5, -0.1), (f64::NAN, 0.0), (1.5, f64::INFINITY), (101.0, 0.0)] {
            assert!(sphere(1.0, Complex64::new(m.0, m.1)).is_err(), "{m:?}");
        }
    }

    #[test]
    fn a_huge_black_sphere_takes_twice_its_shadow() {
        for (re, im) in [(1.5, 0.1), (1.75, 0.44), (10.0, 10.0), (1.33, 50.0)] {
            let q = efficiencies(1e4, re, im).extinction;
            // Nussenzveig & Wiscombe (1980): Qext - 2 = 1.99 x^(-2/3) + smaller terms.
            assert!(q > 2.0 && q - 2.0 < 3.0 * 1e4_f64.powf(-2.0 / 3.0), "{re} + {im} i: {q}");
        }
    }

    #[test]
    fn spheres_computed_side_by_side_are_those_computed_alone() {
        let m = Complex64::new(1.5, 0.01);
        let sizes = [0.0, 1e-3, 5.0, 300.0];
        assert_eq!(spheres(sizes, m).unwrap(), sizes.map(|x| sphere(x, m).unwrap()));
        assert_eq!(spheres([1.0, -2.0], m), Err(MieError::SizeParameter(-2.0)));
    }

    proptest! {
        #[test]
        fn what_is_taken_is_scattered_or_absorbed(lg_x in -3.0..3.0_f64, re in 0.5..5.0_f64, lg_k in -9.0..0.7_f64) {
            let q = efficiencies(10_f64.powf(lg_x), re, 10_f64.powf(lg_k));
            let sum = q.scattering + q.absorption;
            prop_assert!((q.extinction / sum - 1.0).abs() < 1e-9, "{:?}", q);
            prop_assert!(q.absorption > 0.0 && q.scattering > 0.0 && q.asymmetry.abs() <= 1.0);
        }

        #[test]
        fn a_clear_sphere_absorbs_nothing(lg_x in -3.0..3.0_f64, re in 0.5..5.0_f64) {
            let q = efficiencies(10_f64.powf(lg_x), re, 0.0);
            prop_assert!(q.absorption == 0.0 && (q.extinction / q.scattering - 1.0).abs() < 1e-9, "{:?}", q);
        }

        /// Rayleigh's law: Q = 8/3 x^4 |(m^2 - 1)/(m^2 + 2)|^2 and, absorbed, 4 x Im((m^2 - 1)/(m^2 + 2)); Bohren & Huffman
        /// (1983), eqs. 5.7 and 5.8. The next term is smaller by x^2.
        #[test]
        fn a_tiny_sphere_follows_rayleigh(lg_x in -6.0..-2.5_f64, re in 1.05..3.0_f64, im in 0.0..3.0_f64) {
            let (x, m) = (10_f64.powf(lg_x), Complex64::new(re, im));
            let q = efficiencies(x, re, im);
            let contrast = (m * m - 1.0) / (m * m + 2.0);
            prop_assert!((q.scattering / (8.0 / 3.0 * x.powi(4) * contrast.norm_sqr()) - 1.0).abs() < 1e-4, "{:?}", q);
            if im > 1e-3 {
                prop_assert!((q.absorption / (4.0 * x * contrast.im) - 1.0).abs() < 1e-3, "{:?}", q);
            }
            prop_assert!(q.asymmetry.abs() < 1e-4);
        }
    }
}
