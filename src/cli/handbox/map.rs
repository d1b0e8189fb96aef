//! Key maps by the name of a built-in one, or from a file.

use std::path::{Path, PathBuf};

use crate::cli::settings::disk::{Disk, Files};
use crate::cli::settings::{self, explain};
use crate::cli::{Failure, printable};
use crate::hw::handbox::keymap::SHIPPED;
use crate::hw::handbox::{KeyMap, KeyMapError};

/// Larger files are no key maps.
const LARGEST_BYTES: u64 = 64 * 1024;
/// What is listened with where nothing was learned.
const FALLBACK: &str = "autostar2-guess";

/// Where a learned key map is kept unless the user says otherwise: `handbox.toml` beside the settings.
#[must_use]
pub fn default_path() -> Option<PathBuf> {
    settings::default_path().map(|path| path.with_file_name("handbox.toml"))
}

/// The key map of a name or a file; without either the learned one, or else the guess.
///
/// # Errors
/// There is no such map, or something is wrong with it: then none is used.
pub fn load(wanted: Option<&str>) -> Result<KeyMap, Failure> {
    let Some(wanted) = wanted else {
        let learned = default_path().filter(|path| path.exists());
        return match learned {
            Some(path) => read(&path),
            None => load(Some(FALLBACK)),
        };
    };
    match KeyMap::shipped(wanted) {
        Some(map) => Ok(map),
        None if Path::new(wanted).exists() => read(Path::new(wanted)),
        None => Err(Failure::Asked(format!(
            "the key map {} is neither built in ({}) nor a file: teach one with `scotopic handbox learn`",
            printable(wanted),
            SHIPPED.iter().map(|shipped| shipped.name).collect::<Vec<_>>().join(", ")
        ))),
    }
}

/// Reads a file.
fn read(path: &Path) -> Result<KeyMap, Failure> {
    let wrong = |line: Option<usize>, what: &str| {
        let line = line.map(|line| format!(", line {line}")).unwrap_or_default();
        Failure::Asked(format!("{}{line}: {what}", path.display()))
    };
    let bytes = Files
        .read(path, LARGEST_BYTES)
        .map_err(|error| Failure::Failed(format!("{} cannot be read: {error}", path.display())))?
        .ok_or_else(|| Failure::Failed(format!("{} is not there", path.display())))?;
    let text = String::from_utf8(bytes).map_err(|error| wrong(None, &format!("it is not text ({error})")))?;
    KeyMap::from_toml(&text).map_err(|error| match &error {
        KeyMapError::Toml { error, .. } => {
            let explained = explain::wrong(error, &text);
            wrong(explained.line, &explained.what)
        }
        error => wrong(None, &error.to_string()),
    })
}
