//! What is to be seen: the air, the eye, the Sun, and the frame of the picture.

use super::irradiance::Spectrum;
use super::limb::Law;
use crate::physics::aerosol::climate::{AerosolError, Climate};
use crate::physics::aerosol::components::Humidity;
use crate::physics::air::profile::Profile;
use crate::physics::ozone::OzoneError;
use crate::physics::refraction::ray::exact::Exact;
use crate::physics::refraction::ray::{MediumError, Method, RayError};
use crate::physics::skylight::SkyError;
use crate::units::Angle;

/// Radius of the Sun as seen from 1 au: 959.63" (Auwers 1891, the almanacs' value).
pub const SUN_RADIUS: Angle = Angle::arcseconds(959.63);

/// The longest side of a picture, pixels.
pub const LONGEST_SIDE: usize = 8192;

/// The most wavelengths.
pub const MOST_WAVELENGTHS: usize = 256;

/// The frame: square pixels, level, the Sun in the middle of its width. A pixel's place across is the azimuth times the cosine
/// of its altitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Apparent altitude of the lower edge.
    pub bottom: Angle,
    /// Height and width of a pixel.
    pub pixel: Angle,
}

impl View {
    /// Apparent altitude of the upper edge.
    #[must_use]
    pub fn top(&self) -> Angle {
        self.bottom + self.pixel * self.height as f64
    }
}

/// Particles in the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Haze {
    /// The place.
    pub climate: Climate,
    /// Relative humidity in which they grow.
    pub humidity: Humidity,
    /// The thesis' law: what is scattered forward counts as sunlight, extinction times (1 - g).
    pub less_forward: bool,
}

/// What is to be seen.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// The air.
    pub profile: &'a Profile,
    /// Height of the eye, metres.
    pub observer_height_m: f64,
    /// Radius of the globe, metres.
    pub earth_radius_m: f64,
    /// Where the air ends, metres.
    pub top_m: f64,
    /// True altitude of the Sun's centre: where it would appear without air.
    pub sun_altitude: Angle,
    /// Radius of the Sun.
    pub sun_radius: Angle,
    /// Particles, if there are any.
    pub haze: Option<Haze>,
    /// Ozone over the observer, Dobson units.
    pub ozone_du: f64,
    /// Sunlight above the air.
    pub spectrum: Spectrum,
    /// How the disc darkens.
    pub limb: Law,
    /// The frame.
    pub view: View,
    /// How many wavelengths; `None` for as many as the tolerance needs.
    pub wavelengths: Option<usize>,
    /// The error to stay below: of the places of the monochromatic pictures.
    pub tolerance: Angle,
    /// How rays are traced.
    pub method: &'a dyn Method,
}

/// Why there is no picture.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// The air cannot be.
    #[error(transparent)]
    Medium(#[from] MediumError),
    /// The ray cannot be.
    #[error(transparent)]
    Ray(#[from] RayError),
    /// The particles cannot be.
    #[error(transparent)]
    Aerosol(#[from] AerosolError),
    /// The ozone cannot be.
    #[error(transparent)]
    Ozone(#[from] OzoneError),
    /// The sky cannot be.
    #[error(transparent)]
    Sky(#[from] SkyError),
    /// No such picture.
    #[error("a picture of {width} x {height} pixels: give 1 to 8192 for each side")]
    Size {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// No such frame.
    #[error(
        "a picture from {bottom_deg:.3} to {top_deg:.3} degrees of altitude: keep it between -80 and 80, and not empty"
    )]
    Frame {
        /// Lower edge, degrees.
        bottom_deg: f64,
        /// Upper edge, degrees.
        top_deg: f64,
    },
    /// No such Sun.
    #[error("the Sun at {0} degrees of altitude: give -90 to 90")]
    SunAltitude(f64),
    /// No such Sun.
    #[error("a Sun of {0} arcminutes radius: give 0.1 to 60 (it has 15.7 to 16.3)")]
    SunRadius(f64),
    /// Too few or too many.
    #[error("{0} wavelengths: give 1 to 256 (the thesis took 8)")]
    Wavelengths(usize),
    /// No such tolerance.
    #[error("tolerance {0} arcsec: give 0.001 to 60")]
    Tolerance(f64),
}

impl<'a> Scene<'a> {
    /// A scene in clean air with nothing asked for: rays traced exactly through air that ends at 100 km, to 0.1 arcsecond, in 8 wavelengths as in
    /// the thesis.
    #[must_use]
    pub fn clear(profile: &'a Profile, observer_height_m: f64, sun_altitude: Angle, view: View) -> Scene<'a> {
        Scene {
            profile,
            observer_height_m,
            earth_radius_m: 6_371_000.0,
            top_m: 1e5,
            sun_altitude,
            sun_radius: SUN_RADIUS,
            haze: None,
            ozone_du: 0.0,
            spectrum: Spectrum::Kurucz,
            limb: Law::NeckelLabs,
            view,
            wavelengths: Some(8),
            tolerance: Angle::arcseconds(0.1),
            method: &Exact,
        }
    }

    /// Whether such a picture can be made.
    ///
    /// # Errors
    /// What is wrong with it, and what to do.
    pub fn check(&self) -> Result<(), SceneError> {
        let View { width, height, bottom, pixel } = self.view;
        if ![width, height].iter().all(|side| (1..=LONGEST_SIDE).contains(side)) {
            return Err(SceneError::Size { width, height });
        }
        let (bottom_deg, top_deg) = (bottom.to_degrees(), self.view.top().to_degrees());
        // Infinite and NaN edges are outside as well; a pixel below a microarcsecond is none.
        if !(bottom_deg >= -80.0 && top_deg <= 80.0 && pixel.to_arcseconds() > 1e-6) {
            return Err(SceneError::Frame { bottom_deg, top_deg });
        }
        let altitude = self.sun_altitude.to_degrees();
        if !(-90.0..=90.0).contains(&altitude) {
            return Err(SceneError::SunAltitude(altitude));
        }
        if !(0.1..=60.0).contains(&self.sun_radius.to_arcminutes()) {
            return Err(SceneError::SunRadius(self.sun_radius.to_arcminutes()));
        }
        if let Some(count) = self.wavelengths.filter(|count| !(1..=MOST_WAVELENGTHS).contains(count)) {
            return Err(SceneError::Wavelengths(count));
        }
        if !(1e-3..=60.0).contains(&self.tolerance.to_arcseconds()) {
            return Err(SceneError::Tolerance(self.tolerance.to_arcseconds()));
        }
        Ok(())
    }
}
