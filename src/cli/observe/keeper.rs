//! Writes what must be remembered over restarts, in a thread of its own: a slow disk must not hold up a stop.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Sender, channel};
use std::thread::{self, JoinHandle};

use super::alarm::rehearse;
use super::clock::Clock;
use crate::cli::settings::disk::Files;
use crate::cli::settings::nudges;
use crate::cli::settings::state::State;

/// The thread that writes.
pub(super) struct Keeper {
    states: Option<Sender<State>>,
    thread: Option<JoinHandle<()>>,
}

impl Keeper {
    /// Writes to `path`; `failed` is told why it could not.
    ///
    /// # Errors
    /// The system has no more threads.
    pub(super) fn new(
        path: Option<PathBuf>,
        clock: Clock,
        mut failed: impl FnMut(String) + Send + 'static,
    ) -> std::io::Result<Keeper> {
        let Some(path) = path else { return Ok(Keeper { states: None, thread: None }) };
        let (states, heard) = channel::<State>();
        let thread = thread::Builder::new().name("keeper".into()).spawn(move || {
            let mut nudge = None;
            while let Ok(mut state) = heard.recv() {
                // Only the latest is worth writing.
                while let Ok(later) = heard.try_recv() {
                    state = later;
                }
                rehearse("keeper", clock.now());
                if let Err(error) = state.save(&path, &mut Files) {
                    failed(error.to_string());
                }
                // What was kept first is the nudge of the last session.
                if nudge.replace(state.nudge).is_some_and(|before| before != state.nudge) {
                    let at_s = clock.utc_at_start().0 + clock.now().as_secs_f64();
                    let line = nudges::line(at_s, state.nudge.east_arcsec, state.nudge.north_arcsec);
                    if let Err(error) = append(&path.with_file_name("nudges.csv"), &line) {
                        failed(format!(
                            "the nudge was not written down ({error}): the periodic error is learned without it"
                        ));
                    }
                }
            }
        })?;
        Ok(Keeper { states: Some(states), thread: Some(thread) })
    }

    /// Keeps a state.
    pub(super) fn keep(&self, state: State) {
        if let Some(states) = &self.states {
            // The thread ends with the session only.
            let _ = states.send(state);
        }
    }
}

/// Larger files of nudges do not grow any more.
const LARGEST_BYTES: u64 = 2 << 20;

/// Adds a line to a file.
fn append(path: &Path, line: &str) -> std::io::Result<()> {
    let mut file = OpenOptions::new().create(true).append(true).open(path)?;
    if file.metadata()?.len() < LARGEST_BYTES { file.write_all(line.as_bytes()) } else { Ok(()) }
}

impl Drop for Keeper {
    /// What was given is written before the program ends.
    fn drop(&mut self) {
        self.states = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
