//! The table `[light]`: which module lights the projector, and how bright.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Deserializer};

use super::disk::{Disk, Files};
use super::{LARGEST_BYTES, parsed};
use crate::hw::i2c::BusAddress;
use crate::hw::light::Module;
use crate::hw::light::lamp::Input;

/// The projector's light. Without a module its LEDs are left alone.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Light {
    /// The family of the module.
    #[serde(deserialize_with = "parsed")]
    pub module: Option<Module>,
    /// Its bus.
    #[serde(deserialize_with = "parsed")]
    pub bus: Option<BusAddress>,
    /// What was measured of it.
    pub calibration: Option<PathBuf>,
    /// Where its picture comes from: "as-it-is" or "parallel".
    #[serde(deserialize_with = "input")]
    pub input: Input,
    /// Full brightness of the overlay at the eyepiece, cd/m2.
    pub luminance_cd_m2: f64,
    /// Never brighter, cd/m2; the calibration's ceiling counts too.
    pub ceiling_cd_m2: Option<f64>,
    /// The filter that is in the tray, by its name in the calibration.
    pub filter: Option<String>,
}

impl Default for Light {
    fn default() -> Light {
        Light {
            module: None,
            bus: None,
            calibration: None,
            input: Input::AsItIs,
            luminance_cd_m2: 0.3,
            ceiling_cd_m2: None,
            filter: None,
        }
    }
}

fn input<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Input, D::Error> {
    match String::deserialize(deserializer)?.as_str() {
        "as-it-is" => Ok(Input::AsItIs),
        "parallel" => Ok(Input::Parallel),
        _ => Err(serde::de::Error::custom("input is \"as-it-is\" or \"parallel\"")),
    }
}

impl Light {
    /// Module and bus out of settings that are otherwise wrong: enough to switch the light off. Nothing else is believed.
    #[must_use]
    pub fn salvaged(path: &Path) -> Light {
        let bytes = Files.read(path, LARGEST_BYTES).ok().flatten().unwrap_or_default();
        let table: toml::Table = String::from_utf8(bytes).ok().and_then(|text| text.parse().ok()).unwrap_or_default();
        let text = |key: &str| table.get("light")?.get(key)?.as_str().map(str::to_owned);
        Light {
            module: text("module").and_then(|text| text.parse().ok()),
            bus: text("bus").and_then(|text| text.parse().ok()),
            ..Light::default()
        }
    }

    /// Paths are counted from the folder of the settings.
    pub(super) fn based_at(mut self, folder: &Path) -> Light {
        self.calibration = self.calibration.map(|file| folder.join(file));
        self
    }
}
