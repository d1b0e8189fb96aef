//! The atmosphere that a name or a file stands for.

use std::path::Path;

use crate::cli::Failure;
use crate::physics::air::presets;
use crate::physics::air::read::{Described, from_csv, from_toml};

/// Opens a preset by its name, or a profile in a file: CSV by its ending, TOML otherwise.
///
/// # Errors
/// It is neither a preset nor a readable file, or its rows are no atmosphere.
pub fn open(name: &str) -> Result<Described, Failure> {
    if let Some(preset) = presets::named(name) {
        return preset.map_err(Failure::failed);
    }
    let path = Path::new(name);
    let text = std::fs::read_to_string(path).map_err(|error| {
        Failure::asked(format!("{name}: {error}; the atmospheres known by name are {}", presets::NAMES.join(", ")))
    })?;
    let in_file = |error| Failure::asked(format!("{name}: {error}"));
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
        let profile = from_csv(&text).map_err(in_file)?;
        return Ok(Described { name: name.to_owned(), source: String::new(), observer_height_m: None, profile });
    }
    from_toml(&text).map_err(in_file)
}
