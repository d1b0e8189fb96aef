//! Writes what passes between a client and the simulator: a header, then JSON lines `{t_us, dir, hex, note}`.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::Duration;

use serde_json::json;

use super::{Failure, Mount};
use crate::hw::mount::sim::serve::{Passed, Watcher};
use crate::hw::mount::sim::settings::Settings;

/// A reply whose bytes follow one another faster than this is one line.
const PAUSE: Duration = Duration::from_millis(4);

/// A recording under way.
pub(super) struct Recorder {
    file: BufWriter<File>,
    /// Bytes of a reply, and when the last of them came.
    reply: Vec<u8>,
    last: Duration,
}

impl Recorder {
    /// Begins a file with its header: who, version, date, seed, and what the simulator was told.
    pub(super) fn create(path: &Path, mount: &Mount, settings: &Settings) -> Result<Recorder, Failure> {
        let file = File::create(path)
            .map_err(|error| Failure::Failed(format!("{} cannot be written: {error}", path.display())))?;
        let site = settings.site;
        let header = json!({
            "who": "a client against `scotopic simulate mount`",
            "version": env!("CARGO_PKG_VERSION"),
            "date": settings.start.to_rfc3339(),
            "seed": settings.seed,
            "site": format!("{},{},{}", round(site.latitude.to_degrees()), round(site.longitude.to_degrees()), site.elevation_m),
            "time": settings.start.to_rfc3339(),
            "faults": mount.faults,
        });
        let mut recorder = Recorder { file: BufWriter::new(file), reply: Vec::new(), last: Duration::ZERO };
        recorder.line(&header);
        Ok(recorder)
    }

    /// Hands the recording over to the server.
    pub(super) fn watcher(mut self) -> Watcher {
        Box::new(move |now, passed| self.note(now, passed))
    }

    fn note(&mut self, now: Duration, passed: Passed<'_>) {
        if let Passed::FromMount(bytes) = passed {
            if now.saturating_sub(self.last) > PAUSE {
                self.finish_reply();
            }
            self.reply.extend(bytes);
            self.last = now;
            return;
        }
        self.finish_reply();
        match passed {
            Passed::ToMount(bytes) => self.entry(now, "to-mount", bytes, ""),
            Passed::ClientCame => self.entry(now, "none", &[], "client came"),
            Passed::ClientLeft => self.entry(now, "none", &[], "client left"),
            Passed::FromMount(_) => {}
        }
    }

    fn finish_reply(&mut self) {
        let reply = std::mem::take(&mut self.reply);
        if !reply.is_empty() {
            self.entry(self.last, "from-mount", &reply, "");
        }
    }

    fn entry(&mut self, now: Duration, dir: &str, bytes: &[u8], note: &str) {
        let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        self.line(&json!({ "t_us": now.as_micros() as u64, "dir": dir, "hex": hex, "note": note }));
    }

    fn line(&mut self, value: &serde_json::Value) {
        // A full disk must not stop the mount; the recording ends there.
        let _ = writeln!(self.file, "{value}").and_then(|()| self.file.flush());
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        self.finish_reply();
    }
}

/// Degrees to six decimals.
fn round(degrees: f64) -> f64 {
    (degrees * 1e6).round() / 1e6
}
