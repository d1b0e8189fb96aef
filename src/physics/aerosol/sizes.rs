//! Many spheres of one substance: Mie's efficiencies averaged over a log-normal distribution of sizes.

use std::f64::consts::PI;

use num_complex::Complex64;

use super::mie::{self, MieError};

/// No sphere in air extinguishes more than this many times its cross-section, with the indices that [`super::components`]
/// has. The largest that a scan over all of them finds is 4.38 (tested there).
pub const LARGEST_EFFICIENCY: f64 = 5.0;

/// What is believed of the first rule's error, before anything is known of it: this fraction of the extinction.
const FIRST_ERROR: f64 = 0.3;

/// A halving of the step is not believed to lessen the error to less than this: two coarse rules may agree by chance.
const DOUBT: f64 = 1.0 / 4.0;

/// Spheres that are computed together: neighbours in size.
const TOGETHER: usize = 8;

/// Number of particles against radius, normalised to one particle over all radii.
///
/// ```text
/// dN/dr = 1/(sqrt(2 pi) r ln 10 lg sigma) exp(-(lg r - lg r_mod)^2 / (2 lg^2 sigma))
/// ```
///
/// Source: Hess, Koepke & Schult (1998), Bull. Am. Meteorol. Soc. 79, 831, eq. 3a. Particles outside the smallest and the
/// largest radius are counted and do nothing, as there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogNormal {
    /// Mode radius of the number distribution, micrometres.
    pub mode_um: f64,
    /// Width: the geometric standard deviation, above 1.
    pub sigma: f64,
    /// Smallest radius that is there, micrometres.
    pub smallest_um: f64,
    /// Largest radius that is there, micrometres.
    pub largest_um: f64,
}

impl LogNormal {
    /// Natural logarithm of the width.
    fn width(&self) -> f64 {
        self.sigma.ln()
    }

    /// Geometric cross-section per particle over all radii, square micrometres: pi r_mod^2 exp(2 ln^2 sigma).
    #[must_use]
    pub fn area_um2(&self) -> f64 {
        PI * self.mode_um.powi(2) * (2.0 * self.width().powi(2)).exp()
    }

    /// Cross-section per unit of ln r at a radius, square micrometres.
    fn area_density_um2(&self, radius_um: f64) -> f64 {
        let z = (radius_um / self.mode_um).ln() / self.width();
        PI * radius_um * radius_um * (-0.5 * z * z).exp() / ((2.0 * PI).sqrt() * self.width())
    }

    /// The radii outside which all particles together extinguish less than `allowed_um2`, and that bound: the area outside
    /// is a Gaussian's tail, below exp(-z^2/2)/2 on each side, and no efficiency is above [`LARGEST_EFFICIENCY`].
    fn window(&self, allowed_um2: f64) -> Window {
        let whole = LARGEST_EFFICIENCY * self.area_um2();
        let z = (2.0 * (whole / allowed_um2).ln()).max(0.0).sqrt();
        let centre = self.mode_um.ln() + 2.0 * self.width().powi(2);
        let tail_um2 = 0.5 * whole * (-0.5 * z * z).exp();
        let (low, high) = (centre - z * self.width(), centre + z * self.width());
        let (smallest, largest) = (self.smallest_um.ln(), self.largest_um.ln());
        let mut left_out_um2 = 0.0;
        for cut in [low > smallest, high < largest] {
            left_out_um2 += if cut { tail_um2 } else { 0.0 };
        }
        // A window beside the distribution is no window: then all is computed, which is little.
        if low >= largest || high <= smallest {
            return Window { low: smallest, high: largest, left_out_um2: 0.0 };
        }
        Window { low: low.max(smallest), high: high.min(largest), left_out_um2 }
    }
}

/// The part of a distribution that is computed: natural logarithms of the radii in micrometres.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Window {
    low: f64,
    high: f64,
    left_out_um2: f64,
}

/// What one particle of a distribution does to light on average.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CrossSections {
    /// Extinction, square micrometres a particle.
    pub extinction_um2: f64,
    /// Scattering, square micrometres a particle.
    pub scattering_um2: f64,
    /// Absorption, square micrometres a particle.
    pub absorption_um2: f64,
    /// Scattering times the mean cosine of its angle, square micrometres a particle.
    pub forward_um2: f64,
    /// Believed error of each of them, square micrometres: the last halving of the step and what was left out.
    pub error_um2: f64,
    /// Spheres computed.
    pub spheres: usize,
}

/// Why an average is not computed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SizesError {
    /// A sphere is refused.
    #[error(transparent)]
    Mie(#[from] MieError),
    /// The distribution is none.
    #[error(
        "size distribution with mode {mode_um} um, width {sigma}, from {smallest_um} to {largest_um} um: all must be above 0, the width above 1, the largest above the smallest"
    )]
    Distribution {
        /// Mode radius, micrometres.
        mode_um: f64,
        /// Geometric standard deviation.
        sigma: f64,
        /// Smallest radius, micrometres.
        smallest_um: f64,
        /// Largest radius, micrometres.
        largest_um: f64,
    },
    /// Fewer than two intervals.
    #[error("{0} size intervals: give two or more")]
    Intervals(usize),
}

/// The efficiencies of spheres of one index at one wavelength, averaged over a size distribution, as fine as it has been made.
///
/// ```text
/// C = integral over ln r of Q(2 pi r/lambda, m) pi r^2 dN/dln r
/// ```
///
/// by the trapezoid rule in t, where ln r goes from one end of the window to the other as t^3 (10 - 15 t + 6 t^2), so that
/// the ends, which may be cut sharply, carry no weight (order 4, and higher where the tails are inside). Each halving of the
/// step keeps the old spheres; the difference it makes is the believed error, or a quarter of the one before. Clear spheres have resonances much narrower
/// than any step: they make the last digits converge like the mean of random samples, and the believed error shows it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Average {
    sizes: LogNormal,
    m: Complex64,
    wavelength_um: f64,
    window: Window,
    intervals: usize,
    result: CrossSections,
}

impl Average {
    /// The first rule, over all sizes. `intervals` is two or more.
    ///
    /// # Errors
    /// The distribution, a sphere or the number of intervals is refused.
    pub fn new(sizes: LogNormal, m: Complex64, wavelength_um: f64, intervals: usize) -> Result<Average, SizesError> {
        let LogNormal { mode_um, sigma, smallest_um, largest_um } = sizes;
        if !(mode_um > 0.0 && sigma > 1.0 && smallest_um > 0.0 && largest_um > smallest_um && largest_um.is_finite()) {
            return Err(SizesError::Distribution { mode_um, sigma, smallest_um, largest_um });
        }
        if intervals < 2 {
            return Err(SizesError::Intervals(intervals));
        }
        let window = Window { low: smallest_um.ln(), high: largest_um.ln(), left_out_um2: 0.0 };
        let mut first = Average { sizes, m, wavelength_um, window, intervals, result: CrossSections::default() };
        first.result = first.trapezoid(intervals, 1)?;
        first.result.error_um2 = FIRST_ERROR * first.result.extinction_um2;
        Ok(first)
    }

    /// Begins again without the sizes that together extinguish less than `allowed_um2` a particle.
    ///
    /// # Errors
    /// A sphere is refused.
    pub fn without(self, allowed_um2: f64) -> Result<Average, SizesError> {
        let mut next = Average { window: self.sizes.window(allowed_um2), ..self };
        next.result = next.trapezoid(next.intervals, 1)?;
        next.result.error_um2 = FIRST_ERROR * next.result.extinction_um2;
        next.result.spheres += self.result.spheres;
        Ok(next)
    }

    /// Halves the step.
    ///
    /// # Errors
    /// A sphere is refused.
    pub fn halved(self) -> Result<Average, SizesError> {
        let intervals = 2 * self.intervals;
        let (old, new) = (self.result, self.trapezoid(intervals, 2)?);
        let mut error_um2 = DOUBT * old.error_um2;
        let mut join = |old: f64, new: f64| {
            let joined = 0.5 * old + new;
            error_um2 = error_um2.max((joined - old).abs());
            joined
        };
        let result = CrossSections {
            extinction_um2: join(old.extinction_um2, new.extinction_um2),
            scattering_um2: join(old.scattering_um2, new.scattering_um2),
            absorption_um2: join(old.absorption_um2, new.absorption_um2),
            forward_um2: join(old.forward_um2, new.forward_um2),
            error_um2: 0.0,
            spheres: old.spheres + new.spheres,
        };
        let result = CrossSections { error_um2: error_um2.max(self.window.left_out_um2), ..result };
        Ok(Average { intervals, result, ..self })
    }

    /// The averages so far.
    #[must_use]
    pub const fn result(&self) -> CrossSections {
        self.result
    }

    /// Intervals of the rule so far.
    #[must_use]
    pub const fn intervals(&self) -> usize {
        self.intervals
    }

    /// The sum over every `stride`-th node of the rule with `intervals` intervals, from the first inner one.
    fn trapezoid(&self, intervals: usize, stride: usize) -> Result<CrossSections, SizesError> {
        let nodes: Vec<usize> = (1..intervals).step_by(stride).collect();
        let mut sum = CrossSections { spheres: nodes.len(), ..CrossSections::default() };
        for few in nodes.chunks(TOGETHER) {
            // The last few may be fewer: the first of them is computed again, and not counted.
            let places: [(f64, f64); TOGETHER] =
                std::array::from_fn(|i| self.node(*few.get(i).unwrap_or(&few[0]), intervals));
            let efficiencies =
                mie::spheres(places.map(|(radius_um, _)| 2.0 * PI * radius_um / self.wavelength_um), self.m)?;
            for (q, (_, weight)) in efficiencies.iter().zip(places).take(few.len()) {
                sum.extinction_um2 += weight * q.extinction;
                sum.scattering_um2 += weight * q.scattering;
                sum.absorption_um2 += weight * q.absorption;
                sum.forward_um2 += weight * q.scattering * q.asymmetry;
            }
        }
        Ok(sum)
    }

    /// Radius of a node, micrometres, and the cross-section that it stands for, square micrometres.
    fn node(&self, node: usize, intervals: usize) -> (f64, f64) {
        let Window { low, high, .. } = self.window;
        let t = node as f64 / intervals as f64;
        let place = t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
        let slope = 30.0 * (t * (1.0 - t)).powi(2);
        let radius_um = (low + (high - low) * place).exp();
        (radius_um, self.sizes.area_density_um2(radius_um) * slope * (high - low) / intervals as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SALT: LogNormal = LogNormal { mode_um: 0.209, sigma: 2.03, smallest_um: 0.005, largest_um: 20.0 };

    /// Particles so small that Rayleigh's law holds: their mean absorption is 4 pi k Im(contrast) times the mean of r^3, which a
    /// log-normal distribution has in closed form: r_mod^3 exp(9/2 ln^2 sigma).
    #[test]
    fn dust_far_smaller_than_light_absorbs_as_its_volume() {
        let dust = LogNormal { mode_um: 1e-4, sigma: 1.5, smallest_um: 1e-6, largest_um: 1e-2 };
        let m = Complex64::new(1.75, 0.44);
        let mut average = Average::new(dust, m, 0.55, 16).unwrap();
        for _ in 0..4 {
            average = average.halved().unwrap();
        }
        let contrast = (m * m - 1.0) / (m * m + 2.0);
        let volume = 1e-12 * (4.5 * 1.5_f64.ln().powi(2)).exp();
        let expected = 4.0 * PI * (2.0 * PI / 0.55) * contrast.im * volume;
        let ratio = average.result().absorption_um2 / expected;
        assert!((ratio - 1.0).abs() < 1e-4, "{ratio}");
    }

    /// Spheres far larger than light: extinction is twice their area, which is known in closed form.
    #[test]
    fn boulders_take_twice_their_area() {
        let boulders = LogNormal { mode_um: 100.0, sigma: 1.3, smallest_um: 30.0, largest_um: 500.0 };
        let average = Average::new(boulders, Complex64::new(1.5, 0.1), 0.55, 64).unwrap();
        let ratio = average.result().extinction_um2 / (2.0 * boulders.area_um2());
        assert!((1.0..1.02).contains(&ratio), "{ratio}");
    }

    #[test]
    fn what_the_window_leaves_out_is_below_its_bound() {
        let m = Complex64::new(1.5, 0.0);
        let fine = |mut average: Average| {
            while average.intervals() < 1024 {
                average = average.halved().unwrap();
            }
            average.result()
        };
        let whole = fine(Average::new(SALT, m, 0.55, 16).unwrap());
        for share in [0.2, 0.05] {
            let allowed_um2 = share * whole.extinction_um2;
            let part = fine(Average::new(SALT, m, 0.55, 16).unwrap().without(allowed_um2).unwrap());
            let missing = whole.extinction_um2 - part.extinction_um2;
            assert!(missing > 1e-4 * whole.extinction_um2, "nothing was left out at {share}");
            assert!(missing < allowed_um2 + part.error_um2, "{missing} of {allowed_um2}");
        }
    }

    #[test]
    fn what_is_no_distribution_is_refused() {
        let m = Complex64::new(1.5, 0.0);
        for wrong in [
            LogNormal { sigma: 1.0, ..SALT },
            LogNormal { mode_um: 0.0, ..SALT },
            LogNormal { smallest_um: 30.0, ..SALT },
            LogNormal { largest_um: f64::INFINITY, ..SALT },
            LogNormal { mode_um: f64::NAN, ..SALT },
        ] {
            assert!(matches!(Average::new(wrong, m, 0.55, 16), Err(SizesError::Distribution { .. })), "{wrong:?}");
        }
        assert_eq!(Average::new(SALT, m, 0.55, 1), Err(SizesError::Intervals(1)));
        assert!(matches!(Average::new(SALT, m, 0.0, 16), Err(SizesError::Mie(_))));
    }

    proptest! {
        #[test]
        fn averages_keep_what_spheres_keep(mode_um in 0.01..0.5_f64, sigma in 1.2..2.5_f64, k in 0.0..0.5_f64) {
            let sizes = LogNormal { mode_um, sigma, smallest_um: 0.005, largest_um: 20.0 };
            let c = Average::new(sizes, Complex64::new(1.5, k), 0.55, 32).unwrap().result();
            prop_assert!((c.extinction_um2 / (c.scattering_um2 + c.absorption_um2) - 1.0).abs() < 1e-9, "{:?}", c);
            prop_assert!(c.forward_um2.abs() <= c.scattering_um2 && c.absorption_um2 >= 0.0);
        }
    }
}
