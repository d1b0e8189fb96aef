//! Writes what must be remembered over restarts, in a thread of its own: a slow disk must not hold up a stop.

use std::path::PathBuf;
use std::sync::mpsc::{Sender, channel};
use std::thread::{self, JoinHandle};

use super::alarm::rehearse;
use super::clock::Clock;
use crate::cli::settings::disk::Files;
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
            while let Ok(mut state) = heard.recv() {
                // Only the latest is worth writing.
                while let Ok(later) = heard.try_recv() {
                    state = later;
                }
                rehearse("keeper", clock.now());
                if let Err(error) = state.save(&path, &mut Files) {
                    failed(error.to_string());
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

impl Drop for Keeper {
    /// What was given is written before the program ends.
    fn drop(&mut self) {
        self.states = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
