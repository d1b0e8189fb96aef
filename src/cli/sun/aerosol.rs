//! `scotopic sun aerosol`: what the particles in the air of a climate do to light.

use clap::Args;
use serde_json::{Value, json};

use crate::cli::{Failure, answer, answer_json};
use crate::physics::aerosol::climate::{Climate, Column};
use crate::physics::aerosol::components::Humidity;

/// The place, the air, and the light.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic sun aerosol --climate maritime-polluted --humidity 80 --wavelength-nm 550 --json\n  \
    scotopic sun aerosol --climate desert --humidity 20 --wavelength-nm 400,500,600,700\n\n\
    Climates: continental-clean, continental-average, continental-polluted, urban, desert, maritime-clean,\n\
    maritime-polluted, maritime-tropical, arctic, antarctic (Hess, Koepke & Schult 1998). Extinction is scattering plus\n\
    absorption, per kilometre at the ground; (1 - g) times it is what dims the Sun when all that is scattered forward counts\n\
    as sunlight.")]
pub struct Arguments {
    /// The place
    #[arg(long, value_name = "NAME")]
    climate: Climate,
    /// Relative humidity at the ground, percent (0 to 99)
    #[arg(long, value_name = "PERCENT", default_value_t = 80.0, allow_negative_numbers = true)]
    humidity: f64,
    /// Wavelengths, nanometres (300 to 1000), with commas between
    #[arg(long, value_name = "NM", value_delimiter = ',', default_value = "550", allow_negative_numbers = true)]
    wavelength_nm: Vec<f64>,
    /// The error to stay below, as a fraction of the extinction (1e-4 to 0.1)
    #[arg(long, value_name = "FRACTION", default_value_t = 1e-3, allow_negative_numbers = true)]
    tolerance: f64,
    /// Answer as JSON: an object, or a list of them for several wavelengths
    #[arg(long)]
    json: bool,
}

/// Computes and prints.
///
/// # Errors
/// The humidity, a wavelength or the tolerance lies outside what the tables know.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { climate, humidity, tolerance, .. } = *arguments;
    let humidity = Humidity::percent(humidity).map_err(Failure::asked)?;
    let columns: Result<Vec<(f64, Column)>, _> = arguments
        .wavelength_nm
        .iter()
        .map(|&nm| climate.column(humidity, nm, tolerance).map(|column| (nm, column)))
        .collect();
    let columns = columns.map_err(Failure::asked)?;
    if !arguments.json {
        return answer(&in_words(climate, humidity, &columns));
    }
    let mut values: Vec<Value> = columns.iter().map(|(nm, column)| as_json(climate, humidity, *nm, column)).collect();
    match (values.len(), values.pop()) {
        (1, Some(one)) => answer_json(&one),
        (_, last) => {
            values.extend(last);
            answer_json(&values)
        }
    }
}

fn as_json(climate: Climate, humidity: Humidity, wavelength_nm: f64, column: &Column) -> Value {
    let Column { layer, ground, .. } = column;
    json!({
        "climate": climate.name(),
        "humidity_percent": humidity.to_percent(),
        "wavelength_nm": wavelength_nm,
        "extinction_per_km": ground.extinction_per_km,
        "scattering_per_km": ground.scattering_per_km,
        "absorption_per_km": ground.absorption_per_km,
        "single_scattering_albedo": ground.single_scattering_albedo(),
        "asymmetry": ground.asymmetry,
        "extinction_less_forward_per_km": ground.extinction_per_km * (1.0 - ground.asymmetry),
        "mixed_layer_top_km": layer.top_km,
        "scale_height_km": layer.scale_height_km,
        "column_optical_depth": column.optical_depth(),
        "believed_error_per_km": ground.error_per_km,
        "spheres": ground.spheres,
    })
}

fn in_words(climate: Climate, humidity: Humidity, columns: &[(f64, Column)]) -> String {
    let layer = climate.mixed_layer();
    let thinning =
        layer.scale_height_km.map_or("the same at every height".to_owned(), |km| format!("scale height {km} km"));
    let mut text = format!(
        "{climate}, relative humidity {} %; mixed layer to {} km, {thinning}\n\n\
         {:>8} {:>12} {:>12} {:>12} {:>8} {:>8} {:>13} {:>9}\n\
         {:>8} {:>12} {:>12} {:>12} {:>8} {:>8} {:>13} {:>9}",
        humidity.to_percent(),
        layer.top_km,
        "nm",
        "extinction",
        "scattering",
        "absorption",
        "albedo",
        "g",
        "(1-g) extinct",
        "column",
        "",
        "1/km",
        "1/km",
        "1/km",
        "",
        "",
        "1/km",
        "depth"
    );
    for (nm, column) in columns {
        let ground = &column.ground;
        text += &format!(
            "\n{nm:>8} {:>12.5} {:>12.5} {:>12.6} {:>8.4} {:>8.4} {:>13.5} {:>9.4}",
            ground.extinction_per_km,
            ground.scattering_per_km,
            ground.absorption_per_km,
            ground.single_scattering_albedo(),
            ground.asymmetry,
            ground.extinction_per_km * (1.0 - ground.asymmetry),
            column.optical_depth()
        );
    }
    text
}
