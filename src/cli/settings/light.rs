//! The table `[light]`: which module lights the projector, and how bright.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::parsed;
use crate::hw::i2c::BusAddress;
use crate::hw::light::Module;

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
    /// Full brightness of the overlay at the eyepiece, cd/m2.
    pub luminance_cd_m2: f64,
    /// Never brighter, cd/m2; the calibration's ceiling counts too.
    pub ceiling_cd_m2: Option<f64>,
    /// The filter that is in the tray, by its name in the calibration.
    pub filter: Option<String>,
}

impl Default for Light {
    fn default() -> Light {
        Light { module: None, bus: None, calibration: None, luminance_cd_m2: 0.3, ceiling_cd_m2: None, filter: None }
    }
}

impl Light {
    /// Paths are counted from the folder of the settings.
    pub(super) fn based_at(mut self, folder: &Path) -> Light {
        self.calibration = self.calibration.map(|file| folder.join(file));
        self
    }
}
