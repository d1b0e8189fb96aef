//! Files as settings need them, behind a small trait, so that every single operation can be made to fail in a test.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// What is done with files.
pub trait Disk {
    /// All bytes of a file, `None` if it is not there.
    ///
    /// # Errors
    /// It is there and cannot be read, or is larger than `largest_bytes`.
    fn read(&mut self, path: &Path, largest_bytes: u64) -> io::Result<Option<Vec<u8>>>;
    /// Makes a folder and those above it.
    ///
    /// # Errors
    /// As the system says.
    fn make_folder(&mut self, path: &Path) -> io::Result<()>;
    /// Writes a whole file and waits until the disk has it.
    ///
    /// # Errors
    /// As the system says; the file may then hold a part.
    fn write_and_sync(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()>;
    /// Gives a file another name, replacing what had it.
    ///
    /// # Errors
    /// As the system says; then nothing has changed.
    fn rename(&mut self, from: &Path, to: &Path) -> io::Result<()>;
    /// Waits until the disk has a folder's names.
    ///
    /// # Errors
    /// As the system says.
    fn sync_folder(&mut self, path: &Path) -> io::Result<()>;
}

/// Saves so that at every instant, and after a crash at any instant, `path` holds the whole old text or the whole new one:
/// written beside it, synced, renamed over it, the folder synced.
///
/// # Errors
/// The first operation that failed. The old text is then still there, unless only the last sync failed.
pub fn save(disk: &mut dyn Disk, path: &Path, text: &str) -> io::Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    disk.make_folder(folder)?;
    let beside = with_suffix(path, "new");
    disk.write_and_sync(&beside, text.as_bytes())?;
    disk.rename(&beside, path)?;
    disk.sync_folder(folder)
}

/// `state.toml` with `new`: `state.toml.new`.
#[must_use]
pub fn with_suffix(path: &Path, suffix: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".");
    name.push(suffix);
    name.into()
}

/// The real files.
#[derive(Debug, Clone, Copy, Default)]
pub struct Files;

impl Disk for Files {
    fn read(&mut self, path: &Path, largest_bytes: u64) -> io::Result<Option<Vec<u8>>> {
        let file = match File::open(path) {
            Ok(file) => file,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(error),
        };
        let mut bytes = Vec::new();
        file.take(largest_bytes + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > largest_bytes {
            return Err(io::Error::other(format!("it is larger than {largest_bytes} bytes")));
        }
        Ok(Some(bytes))
    }

    fn make_folder(&mut self, path: &Path) -> io::Result<()> {
        fs::create_dir_all(path)
    }

    fn write_and_sync(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let mut file = File::create(path)?;
        file.write_all(bytes)?;
        file.sync_all()
    }

    fn rename(&mut self, from: &Path, to: &Path) -> io::Result<()> {
        fs::rename(from, to)
    }

    fn sync_folder(&mut self, path: &Path) -> io::Result<()> {
        // "" is where we are.
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        File::open(path)?.sync_all()
    }
}

#[cfg(test)]
pub(super) use memory::Memory;

#[cfg(test)]
mod memory;
