//! Exact single scattering: star light that one grain turns towards the eye.

use glam::DVec3;

use super::camera::Ray;
use super::light::column;
use super::light::lattice::Lattice;
use super::model::Scattering;
use super::scene::Scene;
use super::volume::Volume;

/// Radius of a star, voxels: nearer to its centre its light grows no more, so that no eye meets an infinity.
const STAR_RADIUS: f64 = 1e-6;

/// Light that has scattered once.
///
/// ```text
/// S_b = albedo * sum over stars of p(cos) I_b / r^2 * exp(-kappa_b c*)
/// ```
///
/// r is the distance from the star, c* the column of dust on that way, p the law of Henyey and Greenstein per steradian for the angle
/// between the way from the star and the way to the eye.
pub struct Single<'a> {
    volume: &'a Volume,
    scene: &'a Scene,
    lattice: Option<&'a Lattice>,
    least: f64,
}

impl<'a> Single<'a> {
    /// With columns to the stars computed for every point.
    #[must_use]
    pub fn exact(volume: &'a Volume, scene: &'a Scene) -> Single<'a> {
        Single { volume, scene, lattice: None, least: STAR_RADIUS * volume.voxel().min_element() }
    }

    /// With columns from a lattice that was made for this volume and these stars.
    #[must_use]
    pub fn quick(volume: &'a Volume, scene: &'a Scene, lattice: &'a Lattice) -> Single<'a> {
        Single { lattice: Some(lattice), ..Single::exact(volume, scene) }
    }
}

impl Scattering for Single<'_> {
    fn name(&self) -> &'static str {
        "single"
    }

    fn source(&self, point: DVec3, towards: DVec3, out: &mut [f64]) {
        out.fill(0.0);
        let dust = self.scene.dust();
        for (index, star) in self.scene.stars().iter().enumerate() {
            let way = point - star.position;
            let distance = way.length().max(self.least);
            let column = match self.lattice {
                Some(lattice) => lattice.column(self.volume, index, point),
                None => column(self.volume, star.position, point),
            };
            let turned = dust.phase.per_steradian(way.dot(towards) / distance);
            let share = dust.albedo * turned / (distance * distance);
            for ((sum, intensity), extinction) in out.iter_mut().zip(&star.intensity).zip(&dust.extinction) {
                *sum += share * intensity * (-extinction * column).exp();
            }
        }
    }

    /// No dust on the way from the star, the nearest distance, the better of the two ends' angles: the angle grows steadily along a ray.
    fn ceiling(&self, ray: &Ray, from: f64, to: f64, out: &mut [f64]) {
        out.fill(0.0);
        let dust = self.scene.dust();
        for star in self.scene.stars() {
            let way = ray.origin - star.position;
            let nearest = (-way.dot(ray.direction)).clamp(from, to);
            let least = (way + ray.direction * nearest).length().max(self.least);
            let turned = [from, to].map(|t| {
                let way = way + ray.direction * t;
                dust.phase.per_steradian(-way.dot(ray.direction) / way.length().max(self.least))
            });
            let most = dust.albedo * turned[0].max(turned[1]) / (least * least);
            for (sum, intensity) in out.iter_mut().zip(&star.intensity) {
                *sum += most * intensity;
            }
        }
    }

    fn error(&self) -> f64 {
        0.0
    }
}
