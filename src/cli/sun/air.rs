//! `scotopic sun air`: the refractive index of moist air.

use clap::Args;
use serde_json::json;

use crate::cli::{Failure, answer, answer_json};
use crate::physics::air::ciddor::{STANDARD_CO2_PPM, refractivity};

/// The air, and the light.
#[derive(Debug, Clone, Args)]
#[command(after_help = "Examples:\n  \
    scotopic sun air                                                          the standard's air at the ground\n  \
    scotopic sun air --wavelength-nm 633 --temperature-k 313.15 --pressure-pa 120000 --humidity 75 --json")]
pub struct Arguments {
    /// Wavelength in vacuum, nanometres (300 to 1700)
    #[arg(long, value_name = "NM", default_value_t = 550.0, allow_negative_numbers = true)]
    wavelength_nm: f64,
    /// Temperature, kelvin
    #[arg(long, value_name = "K", default_value_t = 288.15, allow_negative_numbers = true)]
    temperature_k: f64,
    /// Pressure, pascal
    #[arg(long, value_name = "PA", default_value_t = 101_325.0, allow_negative_numbers = true)]
    pressure_pa: f64,
    /// Relative humidity over liquid water, percent
    #[arg(long, value_name = "PERCENT", default_value_t = 0.0, allow_negative_numbers = true)]
    humidity: f64,
    /// Carbon dioxide, parts per million
    #[arg(long, value_name = "PPM", default_value_t = STANDARD_CO2_PPM, allow_negative_numbers = true)]
    co2_ppm: f64,
    /// Answer as JSON
    #[arg(long)]
    json: bool,
}

/// Computes and prints n - 1.
///
/// # Errors
/// The air or the wavelength lies outside what the equation is for.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { wavelength_nm, temperature_k, pressure_pa, humidity, co2_ppm, json } = *arguments;
    let value = refractivity(wavelength_nm, temperature_k, pressure_pa, humidity, co2_ppm).map_err(Failure::asked)?;
    if json {
        return answer_json(&json!({ "refractivity": value }));
    }
    answer(&format!("n - 1 = {:.3}e-8", value * 1e8))
}
