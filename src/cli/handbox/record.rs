//! Recordings of what was heard: JSON lines, written as it comes.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use crate::cli::Failure;
use crate::cli::settings::disk::{Disk, Files};
use crate::hw::handbox::capture::{self, Event};
use crate::hw::handbox::keymap::Line;

/// Larger recordings are not replayed.
const LARGEST_BYTES: u64 = 64 << 20;

/// A recording under way, or none.
#[derive(Debug, Default)]
pub(super) struct Recorder(Option<BufWriter<File>>);

impl Recorder {
    /// Begins a file with its header, if there is to be one.
    pub(super) fn create(path: Option<&Path>, map: &str, line: &Line) -> Result<Recorder, Failure> {
        let Some(path) = path else { return Ok(Recorder::default()) };
        let file = File::create(path)
            .map_err(|error| Failure::Failed(format!("{} cannot be written: {error}", path.display())))?;
        let mut recorder = Recorder(Some(BufWriter::new(file)));
        recorder.write(&capture::header(map, line).to_string());
        Ok(recorder)
    }

    /// Writes an event down.
    pub(super) fn event(&mut self, event: &Event) {
        self.write(&capture::line(event));
    }

    fn write(&mut self, line: &str) {
        if let Some(file) = &mut self.0 {
            // A full disk must not stop the listening; the recording ends there.
            let _ = writeln!(file, "{line}").and_then(|()| file.flush());
        }
    }
}

/// Reads a recording.
pub(super) fn read(path: &Path) -> Result<Vec<Event>, Failure> {
    let failed = |why: String| Failure::Failed(format!("{} cannot be replayed: {why}", path.display()));
    let bytes = Files.read(path, LARGEST_BYTES).map_err(|error| failed(error.to_string()))?;
    let bytes = bytes.ok_or_else(|| failed("it is not there".into()))?;
    capture::read(&String::from_utf8_lossy(&bytes)).map_err(|error| failed(error.to_string()))
}
