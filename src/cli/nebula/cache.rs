//! What was computed before, kept in the user's cache folder under all that it depends on.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use etcetera::BaseStrategy;

use crate::numerics::hash::fnv;

/// The folder in which one kind of thing is kept, if the user has a cache.
#[must_use]
pub fn folder(kind: &str) -> Option<PathBuf> {
    etcetera::choose_base_strategy().ok().map(|base| base.cache_dir().join("scotopic").join(kind))
}

/// Where a thing with this key stands. The name is a hash; that it is the right key is for the reader to see.
#[must_use]
pub fn path(folder: &Path, key: &str, ending: &str) -> PathBuf {
    folder.join(format!("{:016x}.{ending}", fnv(key.as_bytes())))
}

/// Writes a file beside its place and moves it there, so that nobody finds half of it.
///
/// # Errors
/// The disk's.
pub fn keep(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    std::fs::create_dir_all(path.parent().unwrap_or(Path::new("")))?;
    let beside = path.with_extension(format!("{}.part", std::process::id()));
    let written = std::fs::write(&beside, bytes).and_then(|()| std::fs::rename(&beside, path));
    if written.is_err() {
        // Half of a file is of no use to anybody.
        let _ = std::fs::remove_file(&beside);
    }
    written
}

/// Removes the oldest files with an ending until the others hold no more than so many bytes.
pub fn trim(folder: &Path, ending: &str, most: u64) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    let mut files: Vec<(SystemTime, u64, PathBuf)> = entries
        .flatten()
        .filter(|entry| entry.path().extension().is_some_and(|there| there == ending))
        .filter_map(|entry| {
            let about = entry.metadata().ok()?;
            Some((about.modified().ok()?, about.len(), entry.path()))
        })
        .collect();
    files.sort_by(|a, b| b.cmp(a));
    let mut kept = 0u64;
    for (index, (_, bytes, path)) in files.into_iter().enumerate() {
        kept = kept.saturating_add(bytes);
        // The newest stays, however large.
        if index > 0 && kept > most {
            // Another process may have been faster.
            let _ = std::fs::remove_file(path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_files_go_first_and_the_newest_stays() {
        let folder = std::env::temp_dir().join(format!("scotopic-trim-{}", std::process::id()));
        for (name, age) in [("a.field", 30), ("b.field", 20), ("c.field", 10), ("d.csv", 40)] {
            keep(&folder.join(name), &[0; 100]).unwrap();
            let then = SystemTime::now() - std::time::Duration::from_secs(age);
            std::fs::File::options().write(true).open(folder.join(name)).unwrap().set_modified(then).unwrap();
        }
        let there = || ["a.field", "b.field", "c.field", "d.csv"].map(|name| folder.join(name).exists());
        trim(&folder, "field", 250);
        assert_eq!(there(), [false, true, true, true]);
        trim(&folder, "field", 1);
        assert_eq!(there(), [false, false, true, true]);
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
