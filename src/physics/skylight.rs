//! The light of the sky around a low Sun: sunlight scattered once and many times on its way through a spherical, refracting
//! atmosphere.
//!
//! ```text
//! L(view) = int exp(-tau) [ beta_R (P_R E_sun + S_R) + beta_a (P_a E_sun + S_a) ] ds  +  exp(-tau) L_ground
//! ```
//!
//! E_sun is the direct beam at a point (`sunlight`), S what has been scattered before, averaged over directions with the
//! phase function of molecules and of haze (`field`). The path of the view ray is bent and stops at the ground; points in
//! the Earth's shadow get no direct beam.

use glam::DVec3;

use crate::physics::aerosol::climate::Column;
use crate::physics::air::ciddor::AirError;
use crate::physics::air::profile::Profile;
use crate::physics::ozone::OzoneLayer;
use crate::units::Angle;

/// Light that has been scattered before.
pub mod field;
/// The same sky by chance: photons followed backwards, an independent reference.
pub mod monte_carlo;
/// How molecules and haze spread light over directions.
pub mod phase;
/// The air as concentric shells, and walks through them.
pub mod shells;
/// The direct beam at every height.
pub mod sunlight;

use field::Field;
use shells::{Exit, Shells, Walk};
use sunlight::Sunlight;

/// A piece of the view ray is not longer than this, metres.
const LONGEST_PIECE_M: f64 = 5e3;
/// ... nor deeper than this.
const DEEPEST_PIECE: f64 = 0.15;

/// What the sky is made of and lit by, at one wavelength.
#[derive(Debug, Clone, Copy)]
pub struct Scene<'a> {
    /// The air.
    pub profile: &'a Profile,
    /// Its particles; none is a clean sky.
    pub aerosol: Option<&'a Column>,
    /// Its ozone.
    pub ozone: Option<&'a OzoneLayer>,
    /// Vacuum wavelength, nanometres.
    pub wavelength_nm: f64,
    /// Radius of the globe, metres.
    pub earth_radius_m: f64,
    /// Height of the eye above the ground, metres.
    pub observer_height_m: f64,
    /// The Sun's altitude at the eye without refraction.
    pub sun_true_altitude: Angle,
    /// Share of the light that the ground gives back, in all directions alike.
    pub ground_albedo: f64,
}

/// Why there is no sky.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SkyError {
    /// The index of the air is not known there.
    #[error(transparent)]
    Air(#[from] AirError),
    /// The eye must stand in the air.
    #[error("observer height {0} m: give 0 to 90000")]
    Height(f64),
    /// The ground cannot.
    #[error("ground albedo {0}: give 0 (black) to 1 (white)")]
    Albedo(f64),
    /// The method is for a Sun near the horizon.
    #[error("Sun at {0} degrees: the light of the sky is computed for -12 to 60 degrees")]
    Sun(f64),
    /// There is no such globe.
    #[error("radius of the Earth {0} m: give 1e6 to 1e9")]
    Radius(f64),
}

/// Radiance of the sky for a Sun of one unit of irradiance: per steradian.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Radiance {
    /// Scattered once.
    pub single: f64,
    /// Scattered more than once, or given back by the ground.
    pub multiple: f64,
}

impl Radiance {
    /// All of it.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.single + self.multiple
    }
}

/// The sky of a scene, made ready for any number of directions.
#[derive(Debug)]
pub struct Skylight {
    shells: Shells,
    sunlight: Sunlight,
    field: Field,
    sun: DVec3,
    eye: DVec3,
}

impl Scene<'_> {
    fn checked(&self) -> Result<(), SkyError> {
        let sun_deg = self.sun_true_altitude.to_degrees();
        if !(0.0..=9e4).contains(&self.observer_height_m) {
            Err(SkyError::Height(self.observer_height_m))
        } else if !(0.0..=1.0).contains(&self.ground_albedo) {
            Err(SkyError::Albedo(self.ground_albedo))
        } else if !(-12.0 - 1e-9..=60.0 + 1e-9).contains(&sun_deg) {
            Err(SkyError::Sun(sun_deg))
        } else if !(1e6..=1e9).contains(&self.earth_radius_m) {
            Err(SkyError::Radius(self.earth_radius_m))
        } else {
            Ok(())
        }
    }

    /// The direction of the Sun without refraction, where the zenith of the eye is z and the Sun stands over x.
    fn sun(&self) -> DVec3 {
        let (sin, cos) = self.sun_true_altitude.to_radians().sin_cos();
        DVec3::new(cos, 0.0, sin)
    }

    fn eye(&self) -> DVec3 {
        DVec3::new(0.0, 0.0, self.earth_radius_m + self.observer_height_m)
    }
}

/// A direction at the eye: apparent altitude, and azimuth counted from the Sun's.
fn direction(altitude: Angle, azimuth: Angle) -> DVec3 {
    let ((sin_a, cos_a), (sin_z, cos_z)) = (altitude.to_radians().sin_cos(), azimuth.to_radians().sin_cos());
    DVec3::new(cos_a * cos_z, cos_a * sin_z, sin_a)
}

impl Skylight {
    /// Computes the direct beam and the light scattered before.
    ///
    /// # Errors
    /// The scene is none that can be computed.
    pub fn new(scene: &Scene) -> Result<Skylight, SkyError> {
        scene.checked()?;
        let shells = Shells::fine(scene)?;
        let zenith = std::f64::consts::FRAC_PI_2 - scene.sun_true_altitude.to_radians();
        let sunlight = Sunlight::new(&shells, zenith);
        let field = Field::new(&Shells::coarse(scene)?, zenith, scene.ground_albedo);
        Ok(Skylight { shells, sunlight, field, sun: scene.sun(), eye: scene.eye() })
    }

    /// How much the last round of scattering changed the light scattered before: a share of it.
    #[must_use]
    pub fn believed_error(&self) -> f64 {
        self.field.last_change()
    }

    /// The radiance in a direction: apparent altitude, and azimuth counted from the Sun's.
    #[must_use]
    pub fn radiance(&self, altitude: Angle, azimuth: Angle) -> Radiance {
        let mut walk = Walk::new(&self.shells, self.eye, direction(altitude, azimuth));
        let (mut light, mut clear) = (Radiance::default(), 1.0);
        loop {
            let begin = walk.position;
            let along = walk.direction;
            let shell = self.shells.shell(walk.shell);
            let (length, exit) = walk.step(&self.shells);
            let by_depth = (shell.extinction() * length / DEEPEST_PIECE).ceil();
            let pieces = (length / LONGEST_PIECE_M).ceil().max(by_depth).clamp(1.0, 1e4);
            let piece = length / pieces;
            let depth = shell.extinction() * piece;
            for k in 0..pieces as usize {
                let point = begin + along * ((k as f64 + 0.5) * piece);
                let (single, multiple) = self.source(shell, point, along);
                let reached = clear * -(-depth).exp_m1() / depth.max(1e-300) * piece;
                light.single += reached * single;
                light.multiple += reached * multiple;
                clear *= (-depth).exp();
            }
            match exit {
                Exit::Top => return light,
                Exit::Ground => {
                    light.multiple += clear * self.field.ground_radiance(self.zenith(walk.position));
                    return light;
                }
                Exit::Shell if clear < 1e-12 => return light,
                Exit::Shell => {}
            }
        }
    }

    /// Light sent along the view ray by a metre of air: from the direct beam, and from light scattered before.
    fn source(&self, shell: &shells::Shell, point: DVec3, along: DVec3) -> (f64, f64) {
        let up = point.normalize();
        let height_m = self.shells.height_m(point);
        let zenith = up.dot(self.sun).clamp(-1.0, 1.0).acos();
        let beam = self.sunlight.at(height_m, zenith);
        let mut single = 0.0;
        if beam.irradiance > 0.0 {
            // The beam comes from where refraction lifts the Sun to.
            let lifted = sunlight::lifted(self.sun, up, beam.bending);
            let cos = along.dot(lifted);
            single = beam.irradiance
                * (shell.rayleigh_per_m * phase::rayleigh(cos)
                    + shell.haze_per_m * phase::henyey_greenstein(cos, shell.asymmetry));
        }
        let [molecules, haze] = self.field.scattered_before(height_m, zenith, up, self.sun, along);
        (single, shell.rayleigh_per_m * molecules + shell.haze_per_m * haze)
    }

    fn zenith(&self, point: DVec3) -> f64 {
        point.normalize().dot(self.sun).clamp(-1.0, 1.0).acos()
    }
}

#[cfg(test)]
mod tests;
