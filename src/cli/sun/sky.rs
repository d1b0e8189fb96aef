//! `scotopic sun sky`: how bright the sky is in a direction around the low Sun.

use clap::Args;
use serde_json::json;

use super::atmosphere;
use crate::cli::{Failure, answer, answer_json};
use crate::physics::aerosol::climate::Climate;
use crate::physics::aerosol::components::Humidity;
use crate::physics::ozone::OzoneLayer;
use crate::physics::skylight::monte_carlo::MonteCarlo;
use crate::physics::skylight::{Scene, Skylight};
use crate::units::Angle;

/// To this fraction particles are computed: more than the sky is good for.
const PARTICLES_TOLERANCE: f64 = 0.01;

/// The direction, the Sun, the air.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic sun sky --sun-altitude-deg 1 --altitude-deg 8 --azimuth-deg 10\n  \
    scotopic sun sky --climate continental-clean --humidity 50 --wavelength-nm 450\n  \
    scotopic sun sky --photons 20000                    the same by chance, as a check\n\n\
    Radiance is for a Sun of one unit of irradiance above the air: multiply by the spectrum.")]
pub struct Arguments {
    /// Altitude of the Sun without refraction, degrees (-12 to 60)
    #[arg(long, value_name = "DEG", default_value_t = 1.0, allow_negative_numbers = true)]
    sun_altitude_deg: f64,
    /// Apparent altitude of the direction, degrees
    #[arg(long, value_name = "DEG", default_value_t = 5.0, allow_negative_numbers = true)]
    altitude_deg: f64,
    /// Azimuth of the direction, counted from the Sun's, degrees
    #[arg(long, value_name = "DEG", default_value_t = 10.0, allow_negative_numbers = true)]
    azimuth_deg: f64,
    /// Wavelength in vacuum, nanometres
    #[arg(long, value_name = "NM", default_value_t = 550.0, allow_negative_numbers = true)]
    wavelength_nm: f64,
    /// Height of the eye above the ground, metres
    #[arg(long, value_name = "M", default_value_t = 2.0, allow_negative_numbers = true)]
    observer_height_m: f64,
    /// us76, a preset of `scotopic sun trace`, or a file
    #[arg(long, value_name = "NAME|FILE", default_value = "us76")]
    atmosphere: String,
    /// Radius of the Earth, metres
    #[arg(long, value_name = "M", default_value_t = 6_371_000.0, allow_negative_numbers = true)]
    earth_radius_m: f64,
    /// Particles in the air: a climate of `scotopic sun aerosol` [default: none]
    #[arg(long, value_name = "NAME")]
    climate: Option<Climate>,
    /// Relative humidity in which the climate's particles grow, percent (0 to 99)
    #[arg(long, value_name = "PERCENT", default_value_t = 80.0, requires = "climate", allow_negative_numbers = true)]
    humidity: f64,
    /// Ozone over the observer, Dobson units
    #[arg(long, value_name = "DU", default_value_t = 0.0, allow_negative_numbers = true)]
    ozone_du: f64,
    /// Share of the light that the ground gives back
    #[arg(long, value_name = "SHARE", default_value_t = 0.1, allow_negative_numbers = true)]
    ground_albedo: f64,
    /// Follow so many photons as well (10000 take about half a second)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
    photons: Option<u32>,
    /// Seed of the photons
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    seed: u64,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

/// Computes and prints.
///
/// # Errors
/// The air, the Sun or the direction cannot be so; the sentence says how they can.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let altitude = arguments.altitude_deg;
    if !(-90.0..=90.0).contains(&altitude) || !arguments.azimuth_deg.is_finite() {
        return Err(Failure::asked(format!("altitude {altitude} degrees: give -90 to 90, and any azimuth")));
    }
    let air = atmosphere::open(&arguments.atmosphere)?;
    let nm = arguments.wavelength_nm;
    let aerosol = match arguments.climate {
        None => None,
        Some(climate) => {
            let humidity = Humidity::percent(arguments.humidity).map_err(Failure::asked)?;
            Some(climate.column(humidity, nm, PARTICLES_TOLERANCE).map_err(Failure::asked)?)
        }
    };
    let ozone = match arguments.ozone_du {
        0.0 => None,
        column_du => Some(OzoneLayer::new(column_du, nm).map_err(Failure::asked)?),
    };
    let scene = Scene {
        profile: &air.profile,
        aerosol: aerosol.as_ref(),
        ozone: ozone.as_ref(),
        wavelength_nm: nm,
        earth_radius_m: arguments.earth_radius_m,
        observer_height_m: arguments.observer_height_m,
        sun_true_altitude: Angle::degrees(arguments.sun_altitude_deg),
        ground_albedo: arguments.ground_albedo,
    };
    let sky = Skylight::new(&scene).map_err(Failure::asked)?;
    let (altitude, azimuth) = (Angle::degrees(altitude), Angle::degrees(arguments.azimuth_deg));
    let light = sky.radiance(altitude, azimuth);
    let chance = match arguments.photons {
        None => None,
        Some(photons) => {
            let method = MonteCarlo::new(&scene).map_err(Failure::asked)?;
            Some(method.radiance(altitude, azimuth, photons as usize, arguments.seed))
        }
    };
    if arguments.json {
        return answer_json(&json!({
            "single_per_sr": light.single,
            "multiple_per_sr": light.multiple,
            "radiance_per_sr": light.total(),
            "last_change": sky.believed_error(),
            "photons_per_sr": chance.map(|chance| chance.radiance.total()),
            "photons_standard_error_per_sr": chance.map(|chance| chance.standard_error),
        }));
    }
    let mut words = format!(
        "scattered once          {:.4e} /sr\n\
         more often, and ground  {:.4e} /sr\n\
         radiance                {:.4e} /sr (the last round of scattering changed {:.1e} of it)",
        light.single,
        light.multiple,
        light.total(),
        sky.believed_error(),
    );
    if let Some(chance) = chance {
        words += &format!(
            "\nby photons              {:.4e} /sr, standard error {:.1e}",
            chance.radiance.total(),
            chance.standard_error
        );
    }
    answer(&words)
}
