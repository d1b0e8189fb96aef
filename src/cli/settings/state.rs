//! What the program remembers from session to session: how far the cable is wound, and the nudge. A file of its own in the
//! user's state folder, so that nothing a person has written is ever written over.

use std::path::{Path, PathBuf};

use etcetera::BaseStrategy;
use serde::{Deserialize, Serialize};

use super::disk::{self, Disk};
use super::{LARGEST_BYTES, SettingsError};
use crate::safety::TurnCounter;
use crate::units::Angle;

/// The first line of the file.
const HEADER: &str = "# Written by scotopic: what it remembers from session to session. Delete it to forget.\n";

/// The observer's correction of the pointing, kept until the next sync.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct KeptNudge {
    /// Eastwards on the sky, arcseconds.
    pub east_arcsec: f64,
    /// Northwards on the sky, arcseconds.
    pub north_arcsec: f64,
}

impl KeptNudge {
    /// From angles on the sky.
    #[must_use]
    pub fn new(east: Angle, north: Angle) -> KeptNudge {
        KeptNudge { east_arcsec: east.to_arcseconds(), north_arcsec: north.to_arcseconds() }
    }

    /// (east, north) as angles; nothing at all if the file held no numbers, or more than ten degrees.
    #[must_use]
    pub fn angles(&self) -> (Angle, Angle) {
        let sane = |arcsec: f64| if arcsec.abs() <= 36_000.0 { Angle::arcseconds(arcsec) } else { Angle::ZERO };
        (sane(self.east_arcsec), sane(self.north_arcsec))
    }
}

/// What is remembered of one real mount. A simulated one has no cable: nothing is read or saved for it.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct State {
    /// The turns of the azimuth axis since the cable was unwound.
    pub turns: TurnCounter,
    /// The nudge.
    pub nudge: KeptNudge,
}

impl State {
    /// Reads what is remembered. Nothing is ever lost and nothing stops the session: a file that is not there is a first
    /// night; one that cannot be understood is kept aside under another name, the turns are then a guess, and the second
    /// value says so in words.
    #[must_use]
    pub fn load(path: &Path, disk: &mut dyn Disk) -> (State, Option<String>) {
        let forgotten = State { turns: TurnCounter::guess(), ..State::default() };
        let why = match disk.read(path, LARGEST_BYTES) {
            Ok(None) => return (State::default(), None),
            Ok(Some(bytes)) => match read(&bytes) {
                Ok(state) => return (state, None),
                Err(why) => why,
            },
            Err(error) => error.to_string(),
        };
        let why: String = why.chars().filter(|c| !c.is_control()).take(200).collect();
        let told = match keep_aside(path, disk) {
            Ok(aside) => format!("it is kept as {}", aside.display()),
            Err(error) => format!("it stays where it is ({error})"),
        };
        let notice = format!(
            "{} cannot be understood ({why}); {told}. Look at the cable: if it hangs free, mark it unwound",
            path.display()
        );
        (forgotten, Some(notice))
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

fn read(bytes: &[u8]) -> Result<State, String> {
    let text = std::str::from_utf8(bytes).map_err(|error| error.to_string())?;
    let state: State = toml::from_str(text).map_err(|error| error.message().to_owned())?;
    Ok(State { turns: state.turns.sane(), ..state })
}

/// Renames what cannot be understood to the first free of `.unreadable-1`, `.unreadable-2`...
fn keep_aside(path: &Path, disk: &mut dyn Disk) -> std::io::Result<PathBuf> {
    for n in 1..=99 {
        let aside = disk::with_suffix(path, &format!("unreadable-{n}"));
        if matches!(disk.read(&aside, LARGEST_BYTES), Ok(None)) {
            disk.rename(path, &aside)?;
            return Ok(aside);
        }
    }
    Err(std::io::Error::other("there are 99 of its kind beside it already"))
}

/// `scotopic/state.toml` in the user's state folder, if there is one.
#[must_use]
pub fn default_path() -> Option<PathBuf> {
    let base = etcetera::choose_base_strategy().ok()?;
    Some(base.state_dir().unwrap_or_else(|| base.data_dir()).join("scotopic").join("state.toml"))
}

#[cfg(test)]
mod tests {
    use super::super::disk::{Files, Memory};
    use super::*;
    use std::time::Duration;

    const PATH: &str = "/home/observer/.local/state/scotopic/state.toml";

    fn wound(degrees: u32) -> State {
        let mut turns = TurnCounter::unwound();
        for i in 0..=degrees {
            turns.observe(Angle::degrees(f64::from(i)), Duration::from_secs(i.into()));
        }
        State { turns, nudge: KeptNudge { east_arcsec: 12.0, north_arcsec: -3.5 } }
    }

    #[test]
    fn what_is_saved_is_read_again() {
        let mut disk = Memory::default();
        wound(300).save(Path::new(PATH), &mut disk).unwrap();
        let (read, notice) = State::load(Path::new(PATH), &mut disk);
        assert_eq!(notice, None);
        assert!((read.turns.turned().to_degrees() - 300.0).abs() < 1e-9 && read.turns.is_certain());
        assert_eq!(read.nudge, wound(300).nudge);
    }

    #[test]
    fn whichever_operation_of_a_save_fails_the_file_is_wholly_old_or_wholly_new() {
        let path = Path::new(PATH);
        let mut disk = Memory::default();
        wound(100).save(path, &mut disk).unwrap();
        let old = disk.get(path).map(<[u8]>::to_vec).unwrap();
        let mut whole = disk.failing_at(usize::MAX);
        wound(200).save(path, &mut whole).unwrap();
        let new = whole.get(path).map(<[u8]>::to_vec).unwrap();
        assert_ne!(old, new);

        let mut kept = 0;
        for n in 0..whole.operations() {
            let mut failing = disk.failing_at(n);
            let error = wound(200).save(path, &mut failing).unwrap_err();
            assert!(error.to_string().contains("the disk is gone"), "{error}");
            let now = failing.get(path).unwrap();
            assert!(now == old || now == new, "operation {n} left {:?}", String::from_utf8_lossy(now));
            kept += usize::from(now == old);
            // The next start reads it, and the next save succeeds over whatever lies about.
            let mut after = failing.failing_at(usize::MAX);
            assert_eq!(State::load(path, &mut after).1, None);
            wound(200).save(path, &mut after).unwrap();
            assert_eq!(after.get(path).unwrap(), new);
        }
        assert_eq!((whole.operations(), kept), (4, 3), "only a failed sync of the folder leaves the new text");
    }

    #[test]
    fn what_cannot_be_understood_is_kept_aside_and_told() {
        let path = Path::new(PATH);
        for (broken, n) in [(&b"turns = 3"[..], 1), (b"\xff\xfe", 2), (b"[turns]\nturned_degg = 4", 3)] {
            let mut disk = Memory::default();
            for earlier in 1..n {
                disk.put(&disk::with_suffix(path, &format!("unreadable-{earlier}")), b"older");
            }
            disk.put(path, broken);
            let (state, notice) = State::load(path, &mut disk);
            assert!(!state.turns.is_certain());
            let aside = disk::with_suffix(path, &format!("unreadable-{n}"));
            assert_eq!(disk.get(&aside), Some(broken));
            assert!(notice.unwrap().contains(&*aside.to_string_lossy()));
            assert_eq!(disk.names().count(), n, "nothing is deleted");
        }
    }

    #[test]
    fn a_disk_that_fails_while_reading_stops_nobody() {
        let mut disk = Memory::default();
        wound(300).save(Path::new(PATH), &mut disk).unwrap();
        for n in 0..3 {
            let (state, notice) = State::load(Path::new(PATH), &mut disk.failing_at(n));
            assert_eq!(state.turns.is_certain(), notice.is_none());
        }
    }

    #[test]
    fn real_files_are_saved_in_a_folder_that_is_made_for_them() {
        let folder = std::env::temp_dir().join(format!("scotopic-state-{}", std::process::id()));
        let path = folder.join("a").join("state.toml");
        wound(100).save(&path, &mut Files).unwrap();
        wound(200).save(&path, &mut Files).unwrap();
        let (read, notice) = State::load(&path, &mut Files);
        assert_eq!(notice, None);
        assert!((read.turns.turned().to_degrees() - 200.0).abs() < 1e-9);
        assert!(std::fs::read_to_string(&path).unwrap().starts_with("# Written by scotopic"));
        assert_eq!(std::fs::read_dir(path.parent().unwrap()).unwrap().count(), 1, "no leftovers");
        std::fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn a_nudge_that_is_no_number_is_none() {
        let nudge = KeptNudge { east_arcsec: f64::NAN, north_arcsec: 1e9 };
        assert_eq!(nudge.angles(), (Angle::ZERO, Angle::ZERO));
    }
}
