//! The conversation with the mount, written down while it goes on: one file over all openings of the line.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use crate::cli::Failure;
use crate::hw::mount::link::Opener;
use crate::hw::port::Port;
use crate::hw::trace::Recording;

/// Why nothing more could be written, told once: a full disk must not go unseen, nor hold up the mount.
#[derive(Clone, Default)]
pub(super) struct Complaint(Arc<Mutex<(Option<String>, bool)>>);

impl Complaint {
    fn make(&self, path: &Path, error: &io::Error) {
        let mut held = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !std::mem::replace(&mut held.1, true) {
            held.0 = Some(format!(
                "{} cannot be written any more ({error}): the recording has gaps from here on; make room on the disk",
                path.display()
            ));
        }
    }

    /// The complaint, if there is a new one.
    pub(super) fn take(&self) -> Option<String> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).0.take()
    }
}

/// The file, and whether a header is on its way that stands in it already.
struct Sink {
    file: Arc<Mutex<File>>,
    path: PathBuf,
    complaint: Complaint,
    in_header: bool,
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let rest = match bytes.iter().position(|byte| *byte == b'\n') {
            _ if !self.in_header => bytes,
            None => &[],
            Some(end) => {
                self.in_header = false;
                &bytes[end + 1..]
            }
        };
        let written = self.file.lock().unwrap_or_else(PoisonError::into_inner).write_all(rest);
        if let Err(error) = &written {
            self.complaint.make(&self.path, error);
        }
        written.map(|()| bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The same opener, each of whose lines is written to `path`.
///
/// # Errors
/// The file cannot be made.
pub(super) fn recorded(mut opener: Opener, path: &Path, mount: &str, complaint: &Complaint) -> Result<Opener, Failure> {
    let file = File::create(path).map_err(|error| {
        Failure::Failed(format!("{} cannot be written ({error}): give a file in a folder of yours", path.display()))
    })?;
    let file = Arc::new(Mutex::new(file));
    let header = serde_json::json!({
        "what": "a session of scotopic with a mount",
        "version": env!("CARGO_PKG_VERSION"),
        "mount": mount,
    });
    let (path, complaint) = (path.to_owned(), complaint.clone());
    let mut opened_before = false;
    Ok(Box::new(move || {
        let line = opener()?;
        let sink = Sink {
            file: Arc::clone(&file),
            path: path.clone(),
            complaint: complaint.clone(),
            in_header: std::mem::replace(&mut opened_before, true),
        };
        Ok(Box::new(Recording::scrubbed(line, Box::new(sink), &header)) as Box<dyn Port>)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hw::mount::sim::Simulator;
    use crate::hw::mount::sim::port::SimulatedMount;
    use crate::hw::mount::sim::settings::Settings;
    use std::time::Duration;

    #[test]
    fn a_line_that_is_opened_twice_gives_one_file_with_one_header() {
        let path = std::env::temp_dir().join(format!("scotopic-record-{}.jsonl", std::process::id()));
        let mount = SimulatedMount::new(Simulator::new(Settings::default()));
        let opener: Opener = Box::new(move || Ok(Box::new(mount.open()?) as Box<dyn Port>));
        let mut opener = recorded(opener, &path, "sim", &Complaint::default()).unwrap();
        for _ in 0..2 {
            let mut line = opener().unwrap();
            line.set_now(Duration::from_secs(1));
            line.send(b":GVP#").unwrap();
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 3, "{text}");
        assert!(
            lines[0].contains("\"version\"") && lines[1..].iter().all(|line| line.contains("3a47565023")),
            "{text}"
        );
        std::fs::remove_file(path).unwrap();
    }

    #[test]
    fn a_full_disk_is_told_once_and_the_mount_is_spoken_on_to() {
        let mount = SimulatedMount::new(Simulator::new(Settings::default()));
        let opener: Opener = Box::new(move || Ok(Box::new(mount.open()?) as Box<dyn Port>));
        let complaint = Complaint::default();
        let mut line = recorded(opener, Path::new("/dev/full"), "sim", &complaint).unwrap()().unwrap();
        for _ in 0..2 {
            assert_eq!(line.send(b":GVP#").unwrap(), 5);
        }
        let told = complaint.take().unwrap();
        assert!(told.contains("/dev/full") && told.contains("make room"), "{told}");
        assert_eq!(complaint.take(), None);
    }
}
