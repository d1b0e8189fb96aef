//! `scotopic sun trace`: one ray from the eye through the air.

use clap::Args;
use clap::builder::PossibleValuesParser;
use serde_json::json;

use super::atmosphere;
use crate::cli::{Failure, answer, answer_json};
use crate::physics::aerosol::climate::{Climate, Column};
use crate::physics::aerosol::components::Humidity;
use crate::physics::ozone::OzoneLayer;
use crate::physics::refraction::ray::{self, Crossing, Launch, Medium, Ray};
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
    /// us76, standard, omega, mock-mirage, weak-mock-mirage, bruton, desert, green-flash, red-flash, weak-inversion, or a file
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
    /// The thesis' law: what particles scatter forward counts as sunlight, so that the aerosol depth is (1 - g) times as much
    #[arg(long, requires = "climate")]
    less_forward: bool,
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
    let less_forward = particles.map(Column::less_forward);
    let (shown, beside) = if arguments.less_forward { (less_forward, particles) } else { (particles, less_forward) };
    if let Some(shown) = &shown {
        medium = medium.with_aerosol(shown);
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
    // The other law is shown beside the one asked for: the parts of each layer's depth are those of its extinction.
    let other = match (&shown, &beside) {
        (Some(shown), Some(beside)) => ray.crossings.iter().map(|crossing| under(crossing, shown, beside)).sum(),
        _ => 0.0,
    };
    let (plain, less) = if arguments.less_forward { (other, ray.depths.aerosol) } else { (ray.depths.aerosol, other) };
    if arguments.json {
        answer_json(&as_json(&ray, plain, less))
    } else {
        answer(&in_words(&ray, plain, less, arguments.less_forward))
    }
}

/// The depth of a passage under another law, whose extinction is the same multiple everywhere in a layer.
fn under(crossing: &Crossing, shown: &Column, beside: &Column) -> f64 {
    let km = 0.5e-3 * (crossing.low_m + crossing.high_m);
    let (shown, beside) = (shown.at(km).extinction_per_km, beside.at(km).extinction_per_km);
    if shown > 0.0 { crossing.depths.aerosol * beside / shown } else { 0.0 }
}

fn as_json(ray: &Ray, plain: f64, less_forward: f64) -> serde_json::Value {
    json!({
        "outcome": ray.outcome.word(),
        "refraction_arcsec": ray.refraction.to_arcseconds(),
        "true_altitude_arcmin": ray.true_altitude.to_arcminutes(),
        "path_length_m": ray.path_length_m,
        "tangent_height_m": ray.tangent_height_m,
        "rayleigh_optical_depth": ray.depths.rayleigh,
        "aerosol_optical_depth": ray.depths.aerosol,
        "aerosol_optical_depth_plain": plain,
        "aerosol_optical_depth_less_forward": less_forward,
        "ozone_optical_depth": ray.depths.ozone,
        "steps": ray.steps,
        "believed_error_arcsec": ray.believed_error.to_arcseconds(),
    })
}

fn in_words(ray: &Ray, plain: f64, less_forward: f64, asked: bool) -> String {
    let (law, other) = if asked { ("less forward", plain) } else { ("plain", less_forward) };
    let beside = if asked { "plain" } else { "less what is scattered forward" };
    let tangent = ray.tangent_height_m.map_or_else(|| "none".to_owned(), |height| format!("{height:.4} m"));
    format!(
        "outcome               {}\n\
         refraction            {:.4}\" (believed to {:.1e}\", {} steps)\n\
         true altitude         {:.5}'\n\
         path length           {:.1} m\n\
         tangent height        {tangent}\n\
         Rayleigh depth        {:.5}\n\
         aerosol depth         {:.5} ({law}; {beside}: {other:.5})\n\
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
