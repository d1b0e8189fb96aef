//! What is asked of a picture of the Sun: flags, a scene file, and what fits where neither says it.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use super::atmosphere;
use crate::cli::Failure;
use crate::physics::aerosol::climate::Climate;
use crate::physics::aerosol::components::Humidity;
use crate::physics::air::read::Described;
use crate::physics::colour::Tone;
use crate::physics::refraction::ray::exact::Exact;
use crate::physics::refraction::ray::{self, Launch, Medium, Method, Outcome};
use crate::physics::sun::irradiance::Spectrum;
use crate::physics::sun::limb::Law;
use crate::physics::sun::scene::{Haze, SUN_RADIUS};
use crate::physics::sun::{Scene, View};
use crate::units::Angle;

/// Scene files.
mod file;
/// Sides of a picture.
mod size;

pub use size::Size;

/// Light that is shown as full, cd/m2: that of the Sun's centre above the air.
const WHITE: f64 = 2.4e9;

/// The frame reaches so far below the horizon, arcminutes.
const BELOW_HORIZON: f64 = 3.0;

/// Green light, by which the frame is laid.
const GREEN_NM: f64 = 550.0;

/// The scene and the picture.
#[derive(Debug, Clone, Default, Args)]
pub struct PictureArguments {
    /// us76, standard, omega, mock-mirage, weak-mock-mirage, bruton, desert, green-flash, red-flash, weak-inversion, or a profile [default: us76]
    #[arg(long, visible_alias = "atmosphere", value_name = "NAME|FILE", conflicts_with = "scene")]
    preset: Option<String>,
    /// A scene in a TOML file; flags go before what it says
    #[arg(long, value_name = "FILE")]
    scene: Option<PathBuf>,
    /// Particles in the air: a climate of `scotopic sun aerosol` [default: none]
    #[arg(long, value_name = "NAME")]
    climate: Option<Climate>,
    /// Relative humidity in which the climate's particles grow, percent (0 to 99) [default: 80]
    #[arg(long, value_name = "PERCENT", allow_negative_numbers = true)]
    humidity: Option<f64>,
    /// The thesis' law: what particles scatter forward counts as sunlight, extinction times (1 - g)
    #[arg(long)]
    less_forward: bool,
    /// Ozone over the observer, Dobson units [default: 300]
    #[arg(long, value_name = "DU", allow_negative_numbers = true)]
    ozone_du: Option<f64>,
    /// Height of the eye above the ground, metres [default: the preset's, else 2]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    observer_height_m: Option<f64>,
    /// True altitude of the Sun's centre, without air, arcminutes [default: the preset's, else lower limb on the horizon]
    #[arg(long, value_name = "ARCMIN", allow_negative_numbers = true)]
    sun_altitude_arcmin: Option<f64>,
    /// Radius of the Sun, arcminutes [default: 15.994, at 1 au]
    #[arg(long, value_name = "ARCMIN", allow_negative_numbers = true)]
    sun_radius_arcmin: Option<f64>,
    /// Sides of the picture, pixels: one number, or WIDTHxHEIGHT [default: 512]
    #[arg(long, value_name = "N|WxH")]
    size: Option<Size>,
    /// Height of the picture, arcminutes [default: 40]
    #[arg(long, value_name = "ARCMIN", allow_negative_numbers = true)]
    field_arcmin: Option<f64>,
    /// Apparent altitude of the picture's lower edge, arcminutes [default: so that Sun or horizon are in the frame]
    #[arg(long, value_name = "ARCMIN", allow_negative_numbers = true)]
    bottom_arcmin: Option<f64>,
    /// Number of wavelengths from 380 to 720 nm [default: as many as the tolerance needs, 8 to 64]
    #[arg(long, value_name = "N")]
    wavelengths: Option<usize>,
    /// How rays are traced [default: exact]
    #[arg(long, value_name = "METHOD", value_parser = PossibleValuesParser::new(ray::METHODS))]
    method: Option<String>,
    /// Number of layers, for Lehn's methods [default: as many as the tolerance needs]
    #[arg(long, value_name = "N")]
    layers: Option<usize>,
    /// The error of place to stay below, arcseconds [default: 0.1]
    #[arg(long, value_name = "ARCSEC", allow_negative_numbers = true)]
    tolerance_arcsec: Option<f64>,
    /// Sunlight above the air: kurucz, g173 or e490 [default: kurucz]
    #[arg(long, value_name = "NAME")]
    spectrum: Option<Spectrum>,
    /// Darkening towards the limb: neckel-labs, or linear (u = 0.6) [default: neckel-labs]
    #[arg(long, value_name = "NAME")]
    limb: Option<Law>,
    /// Light that is shown as full, cd/m2, or auto: the brightest of the picture [default: 2.4e9, the Sun without air]
    #[arg(long, value_name = "CD_M2|auto")]
    white: Option<White>,
    /// Add the light of the sky and of the ground under it (some seconds)
    #[arg(long)]
    sky: bool,
    /// With --sky: share of the light that the ground gives back [default: 0.1]
    #[arg(long, value_name = "SHARE", allow_negative_numbers = true)]
    ground_albedo: Option<f64>,
    /// How light becomes codes: thesis (Y^(1/2.5), codes straight from XYZ), or srgb (linear up to white, hues as computed)
    #[arg(long, value_name = "NAME")]
    tone: Option<Tone>,
    /// Radius of the Earth, metres [default: 6371000]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    earth_radius_m: Option<f64>,
    /// Where the air ends, kilometres [default: 100]
    #[arg(long, value_name = "KM", allow_negative_numbers = true)]
    top_km: Option<f64>,
}

/// What is shown as full.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum White {
    /// A luminance, cd/m2.
    Fixed(f64),
    /// The brightest of the picture.
    Brightest,
}

impl std::str::FromStr for White {
    type Err = String;

    fn from_str(text: &str) -> Result<White, String> {
        match text.parse() {
            _ if text == "auto" => Ok(White::Brightest),
            Ok(level) if (1e-12..=1e12).contains(&level) => Ok(White::Fixed(level)),
            _ => Err(format!("'{text}': give auto, or cd/m2 from 1e-12 to 1e12 (the Sun above the air has 2e9)")),
        }
    }
}

/// Everything of a picture, ready to be made; the frame and the Sun's altitude may still be changed.
pub struct Picture {
    /// The air.
    pub air: Described,
    method: Box<dyn Method>,
    observer_height_m: f64,
    earth_radius_m: f64,
    top_m: f64,
    /// True altitude of the Sun's centre, if it was said.
    pub sun_altitude: Option<Angle>,
    sun_radius: Angle,
    haze: Option<Haze>,
    ozone_du: f64,
    spectrum: Spectrum,
    limb: Law,
    size: Size,
    field: Angle,
    bottom: Option<Angle>,
    wavelengths: Option<usize>,
    tolerance: Angle,
    /// What is shown as full.
    pub white: White,
    /// How light becomes codes.
    pub tone: Tone,
    /// Whether the light of the sky is added, and what share of it the ground gives back.
    pub sky: Option<f64>,
}

impl PictureArguments {
    /// Puts flags and scene file together.
    ///
    /// # Errors
    /// A file cannot be read, or says what cannot be.
    pub fn open(&self) -> Result<Picture, Failure> {
        let (said, air) = match &self.scene {
            Some(path) => file::open(path)?,
            None => {
                let name = self.preset.as_deref().unwrap_or("us76");
                let said = PictureArguments { sun_altitude_arcmin: usual_altitude_arcmin(name), ..Default::default() };
                (said, atmosphere::open(name)?)
            }
        };
        let climate = self.climate.or(said.climate);
        let haze = match (climate, self.humidity.or(said.humidity)) {
            (Some(climate), humidity) => {
                let humidity = Humidity::percent(humidity.unwrap_or(80.0)).map_err(Failure::asked)?;
                Some(Haze { climate, humidity, less_forward: self.less_forward || said.less_forward })
            }
            (None, None) if !self.less_forward => None,
            (None, _) => {
                return Err(Failure::asked(
                    "--humidity and --less-forward are about particles: give a --climate too (scotopic sun aerosol --help names them)",
                ));
            }
        };
        let method = self.method.as_deref().or(said.method.as_deref()).unwrap_or("exact");
        let layers = self.layers.or(said.layers);
        if layers.is_some() && !method.starts_with("lehn") {
            return Err(Failure::asked(format!(
                "{method} has no layers: leave --layers out, or ask for a lehn method"
            )));
        }
        let arcmin = |flag: Option<f64>, file: Option<f64>| flag.or(file).map(Angle::arcminutes);
        Ok(Picture {
            method: ray::method(method, layers).ok_or_else(|| {
                Failure::asked(format!("no method is called {method}: there are {}", ray::METHODS.join(", ")))
            })?,
            observer_height_m: self
                .observer_height_m
                .or(said.observer_height_m)
                .or(air.observer_height_m)
                .unwrap_or(2.0),
            air,
            earth_radius_m: self.earth_radius_m.or(said.earth_radius_m).unwrap_or(6_371_000.0),
            top_m: self.top_km.or(said.top_km).unwrap_or(100.0) * 1e3,
            sun_altitude: arcmin(self.sun_altitude_arcmin, said.sun_altitude_arcmin),
            sun_radius: arcmin(self.sun_radius_arcmin, said.sun_radius_arcmin).unwrap_or(SUN_RADIUS),
            haze,
            ozone_du: self.ozone_du.or(said.ozone_du).unwrap_or(300.0),
            spectrum: self.spectrum.or(said.spectrum).unwrap_or_default(),
            limb: self.limb.or(said.limb).unwrap_or_default(),
            size: self.size.or(said.size).unwrap_or(Size { width: 512, height: 512 }),
            field: arcmin(self.field_arcmin, said.field_arcmin).unwrap_or(Angle::arcminutes(40.0)),
            bottom: arcmin(self.bottom_arcmin, said.bottom_arcmin),
            wavelengths: self.wavelengths.or(said.wavelengths),
            tolerance: Angle::arcseconds(self.tolerance_arcsec.or(said.tolerance_arcsec).unwrap_or(0.1)),
            white: self.white.or(said.white).unwrap_or(White::Fixed(WHITE)),
            tone: self.tone.or(said.tone).unwrap_or_default(),
            sky: (self.sky || said.sky).then(|| self.ground_albedo.or(said.ground_albedo).unwrap_or(0.1)),
        })
    }
}

/// Where the Sun shows what a preset is for.
fn usual_altitude_arcmin(preset: &str) -> Option<f64> {
    Some(match preset {
        "omega" => -27.0,
        "mock-mirage" | "weak-mock-mirage" => -34.0,
        "red-flash" => -32.35,
        "weak-inversion" => -32.5,
        "bruton" => -40.0,
        "green-flash" => -50.3,
        "desert" => -14.0,
        _ => return None,
    })
}

impl Picture {
    /// The scene with the Sun at an altitude, in a frame.
    #[must_use]
    pub fn scene(&self, sun_altitude: Angle, view: View) -> Scene<'_> {
        Scene {
            profile: &self.air.profile,
            observer_height_m: self.observer_height_m,
            earth_radius_m: self.earth_radius_m,
            top_m: self.top_m,
            sun_altitude,
            sun_radius: self.sun_radius,
            haze: self.haze,
            ozone_du: self.ozone_du,
            spectrum: self.spectrum,
            limb: self.limb,
            view,
            wavelengths: self.wavelengths,
            tolerance: self.tolerance,
            method: &*self.method,
        }
    }

    /// The Sun's altitude, the one asked for or that at which its lower limb stands on the horizon; and the altitude at which
    /// its upper limb leaves it.
    ///
    /// # Errors
    /// The air or the eye cannot be.
    pub fn altitudes(&self) -> Result<(Angle, Angle), Failure> {
        let horizon = self.horizon()?;
        let medium = self.green()?;
        let tracer = Exact.prepare(&medium, Angle::arcseconds(0.01)).map_err(Failure::asked)?;
        let apparent_altitude = horizon + Angle::arcseconds(1e-3);
        let launch = Launch { apparent_altitude, height_m: self.observer_height_m };
        let truth = tracer.trace(&launch).map_err(Failure::asked)?.true_altitude;
        Ok((self.sun_altitude.unwrap_or(truth + self.sun_radius), truth - self.sun_radius))
    }

    /// The frame in which the Sun is seen at each of two altitudes: the one asked for, or one that holds both.
    ///
    /// # Errors
    /// The air or the eye cannot be.
    pub fn view(&self, altitudes: [Angle; 2]) -> Result<View, Failure> {
        let pixel = self.field / self.size.height as f64;
        let View { width, height, .. } =
            View { width: self.size.width, height: self.size.height, bottom: Angle::ZERO, pixel };
        let bottom = match self.bottom {
            Some(bottom) => bottom,
            None => {
                let lowest = self.horizon()? - Angle::arcminutes(BELOW_HORIZON);
                let middle = (self.appears(altitudes[0])? + self.appears(altitudes[1])?) * 0.5;
                lowest.max(middle - self.field * 0.5)
            }
        };
        Ok(View { width, height, bottom, pixel })
    }

    fn green(&self) -> Result<Medium<'_>, Failure> {
        Medium::new(&self.air.profile, GREEN_NM, self.earth_radius_m, self.top_m).map_err(Failure::asked)
    }

    /// The lowest altitude at which the sky is seen.
    fn horizon(&self) -> Result<Angle, Failure> {
        let height_m = self.observer_height_m;
        if !(0.0..self.top_m).contains(&height_m) {
            return Err(Failure::asked(ray::RayError::Height { height_m, top_m: self.top_m }));
        }
        let medium = self.green()?;
        Ok(medium.critical_altitudes(height_m).first().copied().unwrap_or(Angle::ZERO))
    }

    /// About where something at a true altitude appears; the horizon, if it would lie below.
    fn appears(&self, truth: Angle) -> Result<Angle, Failure> {
        let (horizon, medium) = (self.horizon()?, self.green()?);
        let tracer = Exact.prepare(&medium, Angle::arcseconds(1.0)).map_err(Failure::asked)?;
        let mut apparent = truth.max(horizon);
        for _ in 0..30 {
            let launch = Launch { apparent_altitude: apparent, height_m: self.observer_height_m };
            let ray = tracer.trace(&launch).map_err(Failure::asked)?;
            if ray.outcome != Outcome::Escaped {
                break;
            }
            apparent = horizon.max((apparent + truth + ray.refraction) * 0.5);
        }
        Ok(apparent)
    }
}
