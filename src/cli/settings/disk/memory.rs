//! Files in memory, for tests.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use super::Disk;

/// Files in memory, for tests: any operation can be made to fail, and a failed write leaves half of the bytes.
#[derive(Debug, Clone, Default)]
pub(in crate::cli::settings) struct Memory {
    files: BTreeMap<PathBuf, Vec<u8>>,
    operations: usize,
    fails_at: Option<usize>,
}

impl Memory {
    /// The same files on a disk whose operation number `n`, counted from 0, fails, and all after it: a crash.
    pub(in crate::cli::settings) fn failing_at(&self, n: usize) -> Memory {
        Memory { files: self.files.clone(), operations: 0, fails_at: Some(n) }
    }

    /// How many operations there were.
    pub(in crate::cli::settings) fn operations(&self) -> usize {
        self.operations
    }

    /// Puts a file there.
    pub(in crate::cli::settings) fn put(&mut self, path: &Path, bytes: &[u8]) {
        self.files.insert(path.into(), bytes.into());
    }

    /// A file's bytes.
    pub(in crate::cli::settings) fn get(&self, path: &Path) -> Option<&[u8]> {
        self.files.get(path).map(Vec::as_slice)
    }

    /// All names.
    pub(in crate::cli::settings) fn names(&self) -> impl Iterator<Item = &Path> {
        self.files.keys().map(PathBuf::as_path)
    }

    fn operation(&mut self) -> io::Result<()> {
        let now = self.operations;
        self.operations += 1;
        if self.fails_at.is_some_and(|n| now >= n) { Err(io::Error::other("the disk is gone")) } else { Ok(()) }
    }
}

impl Disk for Memory {
    fn read(&mut self, path: &Path, _largest_bytes: u64) -> io::Result<Option<Vec<u8>>> {
        self.operation()?;
        Ok(self.files.get(path).cloned())
    }

    fn make_folder(&mut self, _path: &Path) -> io::Result<()> {
        self.operation()
    }

    fn write_and_sync(&mut self, path: &Path, bytes: &[u8]) -> io::Result<()> {
        let failed = self.operation();
        let written = if failed.is_ok() { bytes } else { &bytes[..bytes.len() / 2] };
        self.files.insert(path.into(), written.into());
        failed
    }

    fn rename(&mut self, from: &Path, to: &Path) -> io::Result<()> {
        self.operation()?;
        let bytes = self.files.remove(from).ok_or(io::ErrorKind::NotFound)?;
        self.files.insert(to.into(), bytes);
        Ok(())
    }

    fn sync_folder(&mut self, _path: &Path) -> io::Result<()> {
        self.operation()
    }
}
