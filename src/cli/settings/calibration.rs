//! What was measured of how the picture lies on the sky, kept from session to session in a file of its own.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::disk::{self, Disk};
use super::{LARGEST_BYTES, SettingsError, state};
use crate::sky::optics::Calibration;

/// The first line of the file.
const HEADER: &str = "# Written by scotopic calibrate moon. `scotopic calibrate forget` takes it away.\n";

/// A calibration as it is kept.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kept {
    /// When the Moon was photographed, if that was told; else nothing.
    #[serde(default)]
    pub photographed: String,
    /// Which photographs: the same two are not counted twice.
    pub photographs: String,
    /// All that was measured so far.
    pub now: Calibration,
    /// What had been measured before these photographs.
    pub before: Calibration,
}

impl Kept {
    /// This after what is kept already: photographs show what was drawn with that. The same two photographs replace themselves.
    #[must_use]
    pub fn after(kept: Option<&Kept>, photographs: &str, photographed: &str, measured: &Calibration) -> Kept {
        let before = match kept {
            Some(kept) if kept.photographs == photographs => kept.before,
            Some(kept) => kept.now,
            None => Calibration::default(),
        };
        Kept { photographed: photographed.into(), photographs: photographs.into(), now: before.then(measured), before }
    }

    /// Reads what is kept; nothing where nothing is.
    ///
    /// # Errors
    /// The file cannot be read or understood: then nothing is guessed.
    pub fn load(path: &Path, disk: &mut dyn Disk) -> Result<Option<Kept>, SettingsError> {
        let wrong = |what: String| SettingsError::Wrong {
            path: path.into(),
            line: None,
            what: format!("{what}; calibrate again after `scotopic calibrate forget`"),
        };
        let bytes = match disk.read(path, LARGEST_BYTES) {
            Ok(Some(bytes)) => bytes,
            Ok(None) => return Ok(None),
            Err(error) => return Err(SettingsError::Unreadable { path: path.into(), why: error.to_string() }),
        };
        let text = String::from_utf8(bytes).map_err(|error| wrong(error.to_string()))?;
        let kept: Kept = toml::from_str(&text).map_err(|error| wrong(error.message().to_owned()))?;
        if kept.now.is_sane() && kept.before.is_sane() {
            Ok(Some(kept))
        } else {
            Err(wrong(format!("a scale of {} and its other numbers are no projector's", kept.now.scale)))
        }
    }

    /// Saves it, whole or not at all.
    ///
    /// # Errors
    /// The disk's words.
    pub fn save(&self, path: &Path, disk: &mut dyn Disk) -> Result<(), SettingsError> {
        let not_saved = |why: String| SettingsError::NotSaved { path: path.into(), why };
        let text = toml::to_string(self).map_err(|error| not_saved(error.to_string()))?;
        disk::save(disk, path, &format!("{HEADER}{text}")).map_err(|error| not_saved(error.to_string()))
    }
}

/// `scotopic/calibration.toml` in the user's state folder, if there is one.
#[must_use]
pub fn default_path() -> Option<PathBuf> {
    state::default_path().map(|path| path.with_file_name("calibration.toml"))
}

#[cfg(test)]
mod tests {
    use super::super::disk::Memory;
    use super::*;

    const PATH: &str = "/home/observer/.local/state/scotopic/calibration.toml";

    fn measured(scale: f64) -> Calibration {
        Calibration { scale, scale_error: 0.001, ..Calibration::default() }
    }

    #[test]
    fn what_is_kept_is_read_again_and_the_same_photographs_count_once() {
        let (path, mut disk) = (Path::new(PATH), Memory::default());
        assert_eq!(Kept::load(path, &mut disk).unwrap(), None);
        let first = Kept::after(None, "a", "2026-11-22T20:00:00Z", &measured(0.6));
        first.save(path, &mut disk).unwrap();
        let read = Kept::load(path, &mut disk).unwrap().unwrap();
        assert_eq!(read, first);
        assert_eq!(Kept::after(Some(&read), "a", "", &measured(0.61)).now.scale, 0.61);
        let second = Kept::after(Some(&read), "b", "", &measured(1.1));
        assert!((second.now.scale - 0.66).abs() < 1e-12 && second.before.scale == 0.6);
    }

    #[test]
    fn what_no_projector_has_is_refused_with_what_to_do() {
        let path = Path::new(PATH);
        for broken in ["now = 3", "photographs = \"a\"\n", "\u{fffd}"] {
            let mut disk = Memory::default();
            disk.put(path, broken.as_bytes());
            let error = Kept::load(path, &mut disk).unwrap_err().to_string();
            assert!(error.contains("calibrate forget"), "{error}");
        }
        let mut disk = Memory::default();
        Kept::after(None, "a", "", &measured(1e9)).save(path, &mut disk).unwrap();
        assert!(Kept::load(path, &mut disk).is_err());
    }

    #[test]
    fn whichever_operation_of_a_save_fails_the_file_is_wholly_old_or_wholly_new() {
        let path = Path::new(PATH);
        let mut disk = Memory::default();
        let (old, new) = (Kept::after(None, "a", "", &measured(0.6)), Kept::after(None, "b", "", &measured(0.7)));
        old.save(path, &mut disk).unwrap();
        for n in 0..4 {
            let mut failing = disk.failing_at(n);
            assert!(new.save(path, &mut failing).is_err());
            let read = Kept::load(path, &mut failing.failing_at(usize::MAX)).unwrap().unwrap();
            assert!(read == old || read == new);
        }
    }
}
