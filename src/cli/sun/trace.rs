//! `scotopic sun trace`: one ray from the eye through the air.

use clap::Args;
use clap::builder::PossibleValuesParser;
use serde_json::json;

use super::atmosphere;
use crate::cli::{Failure, answer, answer_json};
use crate::physics::aerosol::climate::Climate;
use crate::physics::aerosol::components::Humidity;
use crate::physics::ozone::OzoneLayer;
use crate::physics::refraction::ray::{self, Launch, Medium, Ray};
use crate::units::Angle;

/// To this fraction particles are computed: the tables they rest on have three digits.
const PARTICLES_TOLERANCE: f64 = 1e-3;

/// The ray, the air, and the method.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic sun trace                                                     the horizon, through the standard atmosphere\n  \
    scotopic sun trace --apparent-altitude-arcmin -4.38 --atmosphere omega\n  \
    scotopic sun trace --climate maritime-polluted --humidity 70 --ozone-du 300\n  \
    scotopic sun trace --atmosphere my-air.toml --method lehn --layers 300 --json\n\n\
    A profile is TOML, or CSV with the columns height_m,temperature_k[,relative_humidity_percent].\n\
    For a ray that ends on the ground or is trapped, the numbers are those of the path that was followed.")]
pub struct Arguments {
    /// Altitude at which the eye sees the ray, arcminutes
    #[arg(long, value_name = "ARCMIN", default_value_t = 0.0, allow_negative_numbers = true)]
    apparent_altitude_arcmin: f64,
    /// Wavelength in vacuum, nanometres (300 to 1700)
    #[arg(long, value_name = "NM", default_value_t = 550.0, allow_negative_numbers = true)]
    wavelength_nm: f64,
    /// Height of the eye above the ground, metres [default: the preset's, else 2]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    observer_height_m: Option<f64>,
    /// us76, standard, omega, mock-mirage, weak-mock-mirage, bruton, desert, green-flash, red-flash, or a file
    #[arg(long, value_name = "NAME|FILE", default_value = "us76")]
    atmosphere: String,
    /// Radius of the Earth, metres
    #[arg(long, value_name = "M", default_value_t = 6_371_000.0, allow_negative_numbers = true)]
    earth_radius_m: f64,
    /// Where the air ends, kilometres
    #[arg(long, value_name = "KM", default_value_t = 100.0, allow_negative_numbers = true)]
    top_km: f64,
    /// Particles in the air: a climate of `scotopic sun aerosol` [default: none]
    #[arg(long, value_name = "NAME")]
    climate: Option<Climate>,
    /// Relative humidity in which the climate's particles grow, percent (0 to 99)
    #[arg(long, value_name = "PERCENT", default_value_t = 80.0, requires = "climate", allow_negative_numbers = true)]
    humidity: f64,
    /// Ozone over the observer, Dobson units (the Earth has about 300)
    #[arg(long, value_name = "DU", default_value_t = 0.0, allow_negative_numbers = true)]
    ozone_du: f64,
    /// How the ray is traced
    #[arg(long, value_name = "METHOD", default_value = "exact", value_parser = PossibleValuesParser::new(ray::METHODS))]
    method: String,
    /// Number of layers, for Lehn's methods [default: as many as the tolerance needs]
    #[arg(long, value_name = "N")]
    layers: Option<usize>,
    /// The error to stay below, arcseconds
    #[arg(long, value_name = "ARCSEC", default_value_t = 0.001, allow_negative_numbers = true)]
    tolerance_arcsec: f64,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

/// Traces and prints.
///
/// # Errors
/// The air, the ray or the method cannot be so; the sentence says how they can.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let air = atmosphere::open(&arguments.atmosphere)?;
    let nm = arguments.wavelength_nm;
    let mut medium =
        Medium::new(&air.profile, nm, arguments.earth_radius_m, arguments.top_km * 1e3).map_err(Failure::asked)?;
    let particles = match arguments.climate {
        None => None,
        Some(climate) => {
            let humidity = Humidity::percent(arguments.humidity).map_err(Failure::asked)?;
            Some(climate.column(humidity, nm, PARTICLES_TOLERANCE).map_err(Failure::asked)?)
        }
    };
    if let Some(particles) = &particles {
        medium = medium.with_aerosol(particles);
    }
    let ozone = match arguments.ozone_du {
        0.0 => None,
        column_du => Some(OzoneLayer::new(column_du, nm).map_err(Failure::asked)?),
    };
    if let Some(ozone) = &ozone {
        medium = medium.with_ozone(ozone);
    }
    let launch = Launch {
        apparent_altitude: Angle::arcminutes(arguments.apparent_altitude_arcmin),
        height_m: arguments.observer_height_m.or(air.observer_height_m).unwrap_or(2.0),
    };
    if arguments.layers.is_some() && !arguments.method.starts_with("lehn") {
        return Err(Failure::asked(format!(
            "{} has no layers: leave --layers out, or ask for a lehn method",
            arguments.method
        )));
    }
    let method = ray::method(&arguments.method, arguments.layers)
        .ok_or_else(|| Failure::asked(format!("no method is called {}", arguments.method)))?;
    let tracer = method.prepare(&medium, Angle::arcseconds(arguments.tolerance_arcsec)).map_err(Failure::asked)?;
    let ray = tracer.trace(&launch).map_err(Failure::asked)?;
    if arguments.json { answer_json(&as_json(&ray)) } else { answer(&in_words(&ray)) }
}

fn as_json(ray: &Ray) -> serde_json::Value {
    json!({
        "outcome": ray.outcome.word(),
        "refraction_arcsec": ray.refraction.to_arcseconds(),
        "true_altitude_arcmin": ray.true_altitude.to_arcminutes(),
        "path_length_m": ray.path_length_m,
        "tangent_height_m": ray.tangent_height_m,
        "rayleigh_optical_depth": ray.depths.rayleigh,
        "aerosol_optical_depth": ray.depths.aerosol,
        "ozone_optical_depth": ray.depths.ozone,
        "steps": ray.steps,
        "believed_error_arcsec": ray.believed_error.to_arcseconds(),
    })
}

fn in_words(ray: &Ray) -> String {
    let tangent = ray.tangent_height_m.map_or_else(|| "none".to_owned(), |height| format!("{height:.4} m"));
    format!(
        "outcome               {}\n\
         refraction            {:.4}\" (believed to {:.1e}\", {} steps)\n\
         true altitude         {:.5}'\n\
         path length           {:.1} m\n\
         tangent height        {tangent}\n\
         Rayleigh depth        {:.5}\n\
         aerosol depth         {:.5}\n\
         ozone depth           {:.5}",
        ray.outcome.word(),
        ray.refraction.to_arcseconds(),
        ray.believed_error.to_arcseconds(),
        ray.steps,
        ray.true_altitude.to_arcminutes(),
        ray.path_length_m,
        ray.depths.rayleigh,
        ray.depths.aerosol,
        ray.depths.ozone,
    )
}
