//! The table `[handbox]`: where the hand controller's keys come from, and what they mean.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use super::parsed;
use crate::app::bindings::Bindings;
use crate::hw::handbox::source::Source;

/// The hand controller.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Handbox {
    /// Where its keys come from.
    #[serde(deserialize_with = "parsed")]
    pub source: Option<Source>,
    /// Its key map: a built-in name, or a file.
    pub map: Option<String>,
    /// What its keys mean beyond the defaults of the map: key to command.
    pub keys: BTreeMap<String, String>,
}

impl Handbox {
    /// What its keys mean.
    ///
    /// # Errors
    /// A key with a command that is not there, or one that moves the telescope.
    pub fn bindings(&self, profile: &str) -> Result<Bindings, crate::app::bindings::BindingError> {
        Bindings::of_profile(profile).with(self.keys.iter().map(|(key, id)| (key.as_str(), id.as_str())))
    }

    /// Whether the table is right, whatever the profile.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(super) fn checked(&self) -> Result<(), String> {
        self.bindings("").map(drop).map_err(|error| error.to_string())
    }

    /// A map's file is counted from the folder of the settings.
    pub(super) fn based_at(mut self, folder: &Path) -> Handbox {
        let is_file = |map: &String| map.contains(['/', '.']);
        self.map =
            self.map.map(|map| if is_file(&map) { folder.join(map).to_string_lossy().into_owned() } else { map });
        self
    }
}
