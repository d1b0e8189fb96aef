//! What a model of scattering must tell the renderer: the light that dust sends towards an eye, for each unit of extinction.

use glam::DVec3;

use super::camera::Ray;

/// A model of the light scattered by dust.
///
/// The radiance that a ray gathers is
///
/// ```text
/// L_b = integral of kappa_b rho(t) exp(-kappa_b c(t)) S_b(x(t), -d) dt,     c(t) = integral of rho from 0 to t
/// ```
///
/// with kappa the extinction per unit of length and density, rho the density, d the ray's direction, and S the source that a model
/// gives: for single scattering S = albedo p(cos) I / r^2 exp(-kappa c*), summed over the stars. S of two models may be added
/// ([`Together`]): `multiple` is single scattering and the light that has scattered before.
pub trait Scattering: Sync {
    /// As a person calls it: single, multiple, table.
    fn name(&self) -> &'static str;

    /// The source in each band: radiance for each unit of extinction depth at a point, going `towards` a direction of length 1 (the way
    /// the light takes: to the eye). `out` has one number for each band of the scene, and is overwritten.
    fn source(&self, point: DVec3, towards: DVec3, out: &mut [f64]);

    /// Not less than [`Scattering::source`] anywhere on a ray between two distances from its origin, in each band; by it a ray that sees
    /// nothing more ends early. The default knows no bound: rays go to their ends.
    fn ceiling(&self, ray: &Ray, from: f64, to: f64, out: &mut [f64]) {
        let _ = (ray, from, to);
        out.fill(f64::INFINITY);
    }

    /// The believed relative error of the source, its own part only: 0 for what is exact.
    fn error(&self) -> f64;
}

/// Models whose light adds up.
pub struct Together<'a> {
    name: &'static str,
    parts: Vec<&'a dyn Scattering>,
}

impl<'a> Together<'a> {
    /// The sum of models, under a name of its own.
    #[must_use]
    pub fn new(name: &'static str, parts: Vec<&'a dyn Scattering>) -> Together<'a> {
        Together { name, parts }
    }

    fn sum(out: &mut [f64], parts: &[&dyn Scattering], each: impl Fn(&dyn Scattering, &mut [f64])) {
        out.fill(0.0);
        // Scenes have at most `MOST_BANDS` bands.
        let mut buffer = [0.0; super::scene::MOST_BANDS];
        let one = &mut buffer[..out.len().min(super::scene::MOST_BANDS)];
        for part in parts {
            each(*part, one);
            for (sum, value) in out.iter_mut().zip(&*one) {
                *sum += value;
            }
        }
    }
}

impl Scattering for Together<'_> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn source(&self, point: DVec3, towards: DVec3, out: &mut [f64]) {
        Together::sum(out, &self.parts, |part, one| part.source(point, towards, one));
    }

    fn ceiling(&self, ray: &Ray, from: f64, to: f64, out: &mut [f64]) {
        Together::sum(out, &self.parts, |part, one| part.ceiling(ray, from, to, one));
    }

    /// The largest of the parts': light is positive, so that the sum's error is not larger.
    fn error(&self) -> f64 {
        self.parts.iter().map(|part| part.error()).fold(0.0, f64::max)
    }
}
