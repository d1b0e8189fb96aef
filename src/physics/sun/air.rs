//! What the matter on the way takes from light: columns along a ray, and what each kind takes at a wavelength.

use super::scene::{Scene, SceneError};
use crate::physics::aerosol::shape::Shape;
use crate::physics::ozone::{self, OzoneLayer};
use crate::physics::rayleigh;
use crate::physics::refraction::ray::{Medium, Ray};

/// Kinds of matter: molecules, the three parts of the haze, ozone.
pub(super) const KINDS: usize = 5;

/// What a ray gathers: its refraction in radians, then the columns of matter along it. Molecules and ozone are counted per
/// square metre; the parts of the haze are lengths in metres (see [`Shape`]).
pub(super) type Path = [f64; 1 + KINDS];

/// At this wavelength ozone's absorption is laid into the air, to be counted as a column; nanometres.
const OZONE_NM: f64 = 600.0;

/// To this fraction particles are computed: the tables they rest on have three digits.
pub(super) const PARTICLES_TOLERANCE: f64 = 1e-3;

/// How the matter of a scene lies in the air, whatever the wavelength.
pub(super) struct Matter {
    shape: Option<Shape>,
    ozone: Option<(OzoneLayer, f64)>,
}

impl Matter {
    pub(super) fn of(scene: &Scene<'_>) -> Result<Matter, SceneError> {
        let ozone = match scene.ozone_du {
            0.0 => None,
            column => Some((OzoneLayer::new(column, OZONE_NM)?, ozone::cross_section_m2(OZONE_NM)?)),
        };
        Ok(Matter { shape: scene.haze.map(|haze| Shape::of(haze.climate)), ozone })
    }

    /// The air at a wavelength with this matter in it.
    pub(super) fn medium<'a>(&'a self, scene: &Scene<'a>, nm: f64) -> Result<Medium<'a>, SceneError> {
        let mut medium = Medium::new(scene.profile, nm, scene.earth_radius_m, scene.top_m)?;
        if let Some(shape) = &self.shape {
            medium = medium.with_aerosol(shape);
        }
        if let Some((ozone, _)) = &self.ozone {
            medium = medium.with_ozone(ozone);
        }
        Ok(medium)
    }

    /// What a ray traced in that air has gathered.
    pub(super) fn path(&self, ray: &Ray, molecule_m2: f64) -> Path {
        let mut path = [0.0; 1 + KINDS];
        path[0] = ray.refraction.to_radians();
        path[1] = ray.depths.rayleigh / molecule_m2;
        if let Some(shape) = &self.shape {
            for crossing in &ray.crossings {
                let part = shape.part(0.5 * (crossing.low_m + crossing.high_m));
                if part < 3 {
                    path[2 + part] += crossing.depths.aerosol;
                }
            }
        }
        if let Some((_, molecule_m2)) = &self.ozone {
            path[5] = ray.depths.ozone / molecule_m2;
        }
        path
    }
}

/// What each kind of matter takes at a wavelength, for each unit of its column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Takes(pub(super) [f64; KINDS]);

impl Takes {
    pub(super) fn at(scene: &Scene<'_>, nm: f64) -> Result<Takes, SceneError> {
        let haze = match scene.haze {
            None => [0.0; 3],
            Some(haze) => {
                let column = haze.climate.column(haze.humidity, nm, PARTICLES_TOLERANCE)?;
                let column = if haze.less_forward { column.less_forward() } else { column };
                column.parts_per_m()
            }
        };
        let ozone = if scene.ozone_du == 0.0 { 0.0 } else { ozone::cross_section_m2(nm)? };
        Ok(Takes([molecule_m2(scene, nm), haze[0], haze[1], haze[2], ozone]))
    }

    /// Optical depth of a path.
    pub(super) fn depth(&self, path: &Path) -> f64 {
        self.0.iter().zip(&path[1..]).map(|(take, column)| take * column).sum()
    }
}

/// Cross-section of a molecule of the scene's air.
pub(super) fn molecule_m2(scene: &Scene<'_>, nm: f64) -> f64 {
    rayleigh::cross_section_m2(nm, scene.profile.co2_ppm)
}
