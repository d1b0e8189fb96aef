//! The shape of a blurred edge across the limb, and where in it the limb is.

use super::linear::Normal;

/// A profile: distance outwards in pixels, and brightness there.
pub(super) type Point = (f64, f64);

/// Brightness across the limb. With `d` the depth inside, `s` the blur and G its Gaussian:
///
/// ```text
/// v = dark + (G * [step + root sqrt(d/s) + ramp d/s])^tone          d > 0
/// ```
///
/// `root` is how a Lambertian limb rises, `ramp` how any other does to first order; `tone` is the camera's curve (1 linear,
/// 0.45 the usual JPEG), which moves the half maximum by up to 0.6 `s` and makes the edge unlike its own mirror image: so it is
/// known from the shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Profile {
    /// Where the limb is, outwards.
    pub(super) edge: f64,
    /// Logarithm of the blur, a Gaussian's standard deviation in pixels.
    ln_blur: f64,
    ln_tone: f64,
    dark: f64,
    step: f64,
    root: f64,
    ramp: f64,
    /// Standard deviation of the noise that the file cut off at black, and at white; zero if it did not.
    cut: f64,
}

/// What is believed of the logarithm of the tone before the photograph: between linear and JPEG.
const TONE: (f64, f64) = (-0.35, 0.5);

impl Profile {
    /// A plain step of a blur.
    pub(super) fn plain(blur: f64, dark: f64, step: f64, cut: f64) -> Profile {
        Profile { edge: 0.0, ln_blur: blur.ln(), ln_tone: TONE.0, dark, step, root: 0.0, ramp: 0.0, cut }
    }

    /// The same with the limb at another place.
    pub(super) fn with_edge(self, edge: f64) -> Profile {
        Profile { edge, ..self }
    }

    pub(super) fn blur(&self) -> f64 {
        self.ln_blur.exp()
    }

    pub(super) fn tone(&self) -> f64 {
        self.ln_tone.exp()
    }

    /// The brightness `x` pixels outwards.
    pub(super) fn at(&self, x: f64) -> f64 {
        let depth = (self.edge - x) / self.blur();
        let light =
            self.step * risen(depth) + self.root * rooted(depth) + self.ramp * (depth * risen(depth) + bell(depth));
        let level = self.dark + light.max(1e-9).powf(self.tone());
        if self.cut > 0.0 { kept(level, self.cut) - (kept(level - 1.0, self.cut)) } else { level }
    }

    /// The profile that fits points best, by damped Gauss-Newton (Levenberg 1944), and the error of its edge; `noise` is the
    /// error of a point.
    pub(super) fn fitted(self, points: &[Point], noise: f64) -> (Profile, f64) {
        let weight = 1.0 / (noise * noise);
        let level = self.step.abs().max(1e-6);
        let cost = |p: &Profile| {
            let misfit: f64 = points.iter().map(|(x, v)| (v - p.at(*x)).powi(2) * weight).sum();
            misfit + p.beliefs(level).iter().map(|(off, sigma)| (off / sigma).powi(2)).sum::<f64>()
        };
        let (mut best, mut damping) = (self, 1e-3);
        let mut least = cost(&best);
        for _ in 0..150 {
            let Some((next, _)) = best.stepped(points, weight, level, damping) else { break };
            let now = cost(&next);
            if now < least {
                let gained = least - now;
                (best, least) = (next, now);
                damping = (damping * 0.3).max(1e-9);
                if gained < 1e-9 * least.max(1.0) {
                    break;
                }
            } else {
                damping *= 8.0;
                if damping > 1e8 {
                    break;
                }
            }
        }
        let error = best.stepped(points, weight, level, 1e-9).map_or(best.blur(), |(_, variance)| variance.sqrt());
        (best, error)
    }

    /// What is believed before the photograph: how far off it is, and its standard deviation. They only keep the fit from
    /// wandering where the photograph says nothing.
    fn beliefs(&self, level: f64) -> [(f64, f64); 3] {
        [(self.ln_tone - TONE.0, TONE.1), (self.root, level), (self.ramp, 0.3 * level)]
    }

    fn numbers(&self) -> [f64; 7] {
        [self.edge, self.ln_blur, self.ln_tone, self.dark, self.step, self.root, self.ramp]
    }

    fn with(&self, n: [f64; 7]) -> Profile {
        Profile {
            edge: n[0],
            ln_blur: n[1].clamp(-1.2, 4.0),
            ln_tone: n[2].clamp(-1.6, 1.0),
            dark: n[3],
            step: n[4],
            root: n[5],
            ramp: n[6],
            cut: self.cut,
        }
    }

    fn stepped(&self, points: &[Point], weight: f64, level: f64, damping: f64) -> Option<(Profile, f64)> {
        let numbers = self.numbers();
        let steps = [1e-4, 1e-4, 1e-4, 1e-5 * level, 1e-5 * level, 1e-5 * level, 1e-5 * level];
        let moved: Vec<Profile> = (0..7)
            .map(|k| {
                let mut n = numbers;
                n[k] += steps[k];
                self.with(n)
            })
            .collect();
        let mut normal = Normal::<7>::new();
        let mut size = [0.0; 7];
        for (x, v) in points {
            let here = self.at(*x);
            let mut gradient = [0.0; 7];
            for (k, slope) in gradient.iter_mut().enumerate() {
                *slope = (moved[k].at(*x) - here) / steps[k];
                size[k] += weight * *slope * *slope;
            }
            normal.add(&gradient, v - here, weight);
        }
        for (k, (off, sigma)) in [2, 5, 6].into_iter().zip(self.beliefs(level)) {
            let mut gradient = [0.0; 7];
            gradient[k] = 1.0;
            normal.add(&gradient, -off, sigma.powi(-2));
        }
        for (k, size) in size.into_iter().enumerate() {
            let mut gradient = [0.0; 7];
            gradient[k] = 1.0;
            normal.add(&gradient, 0.0, damping * size.max(1e-12));
        }
        let (by, inverse) = normal.solve()?;
        let mut next = numbers;
        next.iter_mut().zip(by).for_each(|(number, by)| *number += by);
        next.iter().all(|number| number.is_finite()).then(|| (self.with(next), inverse[0][0]))
    }
}

/// The mean of a level with noise whose negative values have been made zero.
fn kept(level: f64, noise: f64) -> f64 {
    let z = level / noise;
    noise * (z * risen(z) + bell(z))
}

/// The noise in a dark part of a file that has no negative values, from the share of its zeros and the mean of all: zero where
/// hardly any is zero.
///
/// ```text
/// share = Phi(-z),  mean = noise (z Phi(z) + phi(z))
/// ```
pub(super) fn cut_noise(zeros: f64, mean: f64) -> f64 {
    if !(0.02..=0.98).contains(&zeros) {
        return 0.0;
    }
    let (mut low, mut high) = (-3.0, 3.0);
    for _ in 0..50 {
        let z = f64::midpoint(low, high);
        if risen(-z) > zeros { low = z } else { high = z }
    }
    let z = f64::midpoint(low, high);
    (mean / (z * risen(z) + bell(z)).max(1e-6)).min(0.2)
}

/// The Gaussian's density.
fn bell(x: f64) -> f64 {
    (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt()
}

/// The Gaussian's distribution: Abramowitz and Stegun (1964), 26.2.17, to 7.5e-8.
fn risen(x: f64) -> f64 {
    let t = 1.0 / (1.0 + 0.231_641_9 * x.abs());
    let series =
        ((((1.330_274_429 * t - 1.821_255_978) * t + 1.781_477_937) * t - 0.356_563_782) * t + 0.319_381_530) * t;
    let tail = bell(x) * series;
    if x >= 0.0 { 1.0 - tail } else { tail }
}

/// The square root of the depth, blurred: `integral over u > 0 of sqrt(u) bell(x - u)`, with `u = t^2` by the trapezoid rule,
/// which converges fast for so smooth an integrand.
fn rooted(x: f64) -> f64 {
    if x < -6.0 {
        return 0.0;
    }
    if x > 12.0 {
        // The first terms of its series in 1/x^2.
        return x.sqrt() * (1.0 - 0.125 / (x * x));
    }
    let step = (x + 6.0).max(0.25).sqrt() / 40.0;
    (1..=40).map(|k| (f64::from(k) * step).powi(2)).map(|u| 2.0 * u * bell(x - u)).sum::<f64>() * step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_blurred_functions_are_those_of_the_tables() {
        // Phi(1) and Phi(-2): Abramowitz and Stegun, table 26.1.
        assert!((risen(1.0) - 0.841_344_746).abs() < 1e-7 && (risen(-2.0) - 0.022_750_132).abs() < 1e-7);
        // The integral of sqrt(u) bell(u) over u > 0 is 2^(-1/4) Gamma(3/4) / sqrt(2 pi), Gamma(3/4) = 1.225416702.
        let half = 2f64.powf(-0.25) * 1.225_416_702 / (2.0 * std::f64::consts::PI).sqrt();
        assert!((rooted(0.0) - half).abs() < 2e-4, "{} {half}", rooted(0.0));
        assert!((rooted(12.0) - rooted(12.000_001)).abs() < 1e-4);
    }

    #[test]
    fn noise_that_was_cut_off_at_black_is_known_from_its_zeros_and_its_mean() {
        // Half of a Gaussian of 0.05 about 0 is cut off; what is left has a mean of 0.05 / sqrt(2 pi).
        assert!((cut_noise(0.5, 0.05 / (2.0 * std::f64::consts::PI).sqrt()) - 0.05).abs() < 1e-6);
        assert_eq!(cut_noise(0.0, 0.1), 0.0);
        assert!((kept(0.5, 0.05) - 0.5).abs() < 1e-9 && (kept(0.0, 0.05) - 0.019_947).abs() < 1e-6);
    }

    #[test]
    fn the_edge_is_found_whatever_the_camera_s_curve() {
        for (tone, root) in [(1.0, 0.0), (0.45, 0.0), (1.0, 0.4), (0.45, 0.4)] {
            let there = Profile {
                edge: 0.7,
                ln_blur: 0.7,
                ln_tone: f64::ln(tone),
                dark: 0.02,
                step: 0.5,
                root,
                ramp: 0.01,
                cut: 0.0,
            };
            let points: Vec<Point> = (-50..=30).map(|k| f64::from(k) * 0.5).map(|x| (x, there.at(x))).collect();
            let (found, error) = Profile::plain(1.5, 0.0, 0.5, 0.0).fitted(&points, 3e-4);
            // The points have no noise of their own: what is off is what was believed of the camera before.
            let off = (found.edge - 0.7).abs();
            assert!(off < 0.06 && off < 2.5 * error, "tone {tone}, root {root}: {off} ± {error}, {found:?}");
        }
    }
}
