//! Atmospheres known by name, each with its source and the height of the eye it was made for.

use super::profile::Profile;
use super::read::{Described, ReadError, from_toml};
use super::surface_layer::SurfaceLayer;
use super::us76;

/// The names that can be asked for.
pub const NAMES: [&str; 10] = [
    "us76",
    "standard",
    "omega",
    "mock-mirage",
    "weak-mock-mirage",
    "bruton",
    "desert",
    "green-flash",
    "red-flash",
    "weak-inversion",
];

/// The atmosphere of a name; `None` for a name that is not in [`NAMES`].
///
/// # Errors
/// None for the names there are (tested); the readers' errors are passed on.
pub fn named(name: &str) -> Option<Result<Described, ReadError>> {
    Some(match name {
        "us76" | "standard" => Ok(Described {
            name: "US Standard Atmosphere 1976".to_owned(),
            source: "NOAA-S/T 76-1562".to_owned(),
            observer_height_m: Some(2.0),
            profile: us76::profile(),
        }),
        "omega" => from_toml(include_str!("presets/omega.toml")),
        "mock-mirage" => from_toml(include_str!("presets/mock-mirage.toml")),
        "weak-mock-mirage" => from_toml(include_str!("presets/weak-mock-mirage.toml")),
        "bruton" => from_toml(include_str!("presets/bruton.toml")),
        "red-flash" => from_toml(include_str!("presets/red-flash.toml")),
        "weak-inversion" => from_toml(include_str!("presets/weak-inversion.toml")),
        "green-flash" => over_warm_ground(
            "Green flash over a warm sea",
            "Obukhov length after A. T. Young, aty.sdsu.edu/explain/simulations/how.html; the other parameters are ours",
            4.0,
            SurfaceLayer { ground_k: 288.0, scale_k: -0.10, obukhov_length_m: -10.0, roughness_m: 1e-3 },
        ),
        "desert" => over_warm_ground(
            "Hot desert at noon",
            "Businger-Dyer similarity; heat flux about 350 W/m2 in a light wind, sand 1 mm rough; the parameters are ours",
            2.0,
            SurfaceLayer { ground_k: 325.0, scale_k: -1.2, obukhov_length_m: -5.0, roughness_m: 1e-3 },
        ),
        _ => return None,
    })
}

fn over_warm_ground(name: &str, source: &str, eye_m: f64, layer: SurfaceLayer) -> Result<Described, ReadError> {
    let profile = Profile::new(&layer.rows(), us76::P0_PA)?;
    Ok(Described { name: name.to_owned(), source: source.to_owned(), observer_height_m: Some(eye_m), profile })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_gives_air_with_a_source_and_an_eye_above_the_ground() {
        for name in NAMES {
            let preset = named(name).unwrap().unwrap();
            assert!(
                !preset.name.is_empty() && !preset.source.is_empty() && preset.observer_height_m > Some(0.0),
                "{name}"
            );
            let surface = preset.profile.parcel(0.0);
            assert!((surface.pressure_pa - 101_325.0).abs() < 1e-6, "{name}");
            assert!((280.0..330.0).contains(&surface.temperature_k), "{name}");
        }
        assert!(named("no-such-air").is_none());
    }
}
