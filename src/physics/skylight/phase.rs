//! How molecules and haze spread light over directions: per steradian, one when summed over the sphere.

use std::f64::consts::PI;

use glam::DVec3;

/// Molecules: Rayleigh's phase function at a cosine of the scattering angle.
#[must_use]
pub fn rayleigh(cos: f64) -> f64 {
    3.0 / (16.0 * PI) * (1.0 + cos * cos)
}

/// Haze: the phase function of Henyey & Greenstein (1941) with a mean cosine g.
#[must_use]
pub fn henyey_greenstein(cos: f64, g: f64) -> f64 {
    (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * cos).powf(1.5))
}

/// A cosine drawn from Rayleigh's phase function, for a random number in 0 to 1: the real root of mu^3 + 3 mu = 8 u - 4.
#[must_use]
pub fn draw_rayleigh(u: f64) -> f64 {
    let half = 4.0 * u - 2.0;
    let root = (half + (half * half + 1.0).sqrt()).cbrt();
    (root - 1.0 / root).clamp(-1.0, 1.0)
}

/// A cosine drawn from Henyey's and Greenstein's, for a random number in 0 to 1.
#[must_use]
pub fn draw_henyey_greenstein(u: f64, g: f64) -> f64 {
    if g.abs() < 1e-6 {
        return 2.0 * u - 1.0;
    }
    let s = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
    ((1.0 + g * g - s * s) / (2.0 * g)).clamp(-1.0, 1.0)
}

/// A direction turned by an angle of this cosine, about itself by another (radians).
#[must_use]
pub fn turned(direction: DVec3, cos: f64, about: f64) -> DVec3 {
    let (across, over) = direction.any_orthonormal_pair();
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    (direction * cos + (across * about.cos() + over * about.sin()) * sin).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Midpoints of a fine rule in the cosine.
    fn over_sphere(f: impl Fn(f64) -> f64) -> f64 {
        let count = 200_000;
        (0..count).map(|i| f(-1.0 + (f64::from(i) + 0.5) * 2.0 / f64::from(count))).sum::<f64>() * 4.0 * PI
            / f64::from(count)
    }

    #[test]
    fn all_light_goes_somewhere_and_g_is_the_mean_cosine() {
        assert!((over_sphere(rayleigh) - 1.0).abs() < 1e-9);
        for g in [-0.5, 0.0, 0.6, 0.8] {
            assert!((over_sphere(|mu| henyey_greenstein(mu, g)) - 1.0).abs() < 1e-6, "{g}");
            assert!((over_sphere(|mu| mu * henyey_greenstein(mu, g)) - g).abs() < 1e-6, "{g}");
        }
    }

    #[test]
    fn what_is_drawn_has_the_moments_of_its_phase_function() {
        let count = 100_000;
        let mean = |f: &dyn Fn(f64) -> f64| {
            (0..count).map(|i| f((f64::from(i) + 0.5) / f64::from(count))).sum::<f64>() / f64::from(count)
        };
        // Rayleigh: mean cosine 0, mean square 2/5.
        assert!(mean(&draw_rayleigh).abs() < 1e-6);
        assert!((mean(&|u| draw_rayleigh(u).powi(2)) - 0.4).abs() < 1e-5);
        // Henyey & Greenstein: mean g, mean of the second Legendre polynomial g^2.
        for g in [0.3, 0.75] {
            assert!((mean(&|u| draw_henyey_greenstein(u, g)) - g).abs() < 1e-5);
            let second = mean(&|u| 1.5 * draw_henyey_greenstein(u, g).powi(2) - 0.5);
            assert!((second - g * g).abs() < 1e-4, "{second}");
        }
    }

    #[test]
    fn a_turn_keeps_its_angle() {
        let d = DVec3::new(0.3, -0.4, 0.866).normalize();
        let t = turned(d, 0.25, 1.1);
        assert!((t.dot(d) - 0.25).abs() < 1e-12 && (t.length() - 1.0).abs() < 1e-12);
    }
}
