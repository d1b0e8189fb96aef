//! A projector in a thread of its own: a slow disk or a display that waits for its next frame never holds up the caller, and
//! only the latest picture is shown.

use std::fmt;
use std::io;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use super::{Dimmed, Projector, ProjectorError};
use crate::picture::Picture;

/// A device that has not answered for so long is taken for dead.
const PATIENCE: Duration = Duration::from_secs(5);

/// A device that did not go dark is told again so often.
const AGAIN: Duration = Duration::from_millis(250);

/// At the end a device gets so long to go dark.
const LAST: Duration = Duration::from_secs(2);

/// Tells what time it is: since the program started.
pub type Now = Arc<dyn Fn() -> Duration + Send + Sync>;

/// When a picture reached the eye. All instants since the program started.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stamp {
    /// The instant that the mount's position in it was predicted for.
    pub predicted_for: Duration,
    /// When it was handed over with [`Output::show`].
    pub asked: Duration,
    /// When the device had it: after the flip where the device says so.
    pub presented: Duration,
}

impl Stamp {
    /// How old the position was that the picture was drawn for when it was seen.
    #[must_use]
    pub fn age(&self) -> Duration {
        self.presented.saturating_sub(self.predicted_for)
    }
}

/// What the thread says.
#[derive(Debug, Clone, PartialEq)]
pub enum Told {
    /// A picture is there.
    Shown(Stamp),
    /// It is dark, since this instant.
    Dark(Duration),
    /// What came of [`Output::dim`].
    Dimmed(Dimmed),
    /// The device refused, or broke. It is told to be dark until it is; told once until something works again.
    Failed(ProjectorError),
}

/// What the thread is to do next. Each has one place: the latest wins.
#[derive(Default)]
struct Slot {
    picture: Option<(Arc<Picture>, Duration, Duration)>,
    dark: bool,
    dim: Option<f32>,
    end: bool,
    /// Since when the device has been at work.
    busy_since: Option<Duration>,
    /// The thread is gone and the projector closed.
    gone: bool,
    overtaken: u64,
}

/// The slot and its bell.
#[derive(Default)]
struct Shared {
    slot: Mutex<Slot>,
    bell: Condvar,
}

impl Shared {
    fn slot(&self) -> MutexGuard<'_, Slot> {
        // Nothing is left half done under the lock.
        self.slot.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn change(&self, change: impl FnOnce(&mut Slot)) {
        change(&mut self.slot());
        self.bell.notify_all();
    }
}

/// A projector at work in its thread.
///
/// ```
/// use std::sync::{Arc, mpsc};
/// use std::time::{Duration, Instant};
/// use scotopic::hw::projector::memory::Memory;
/// use scotopic::hw::projector::output::{Output, Told};
/// use scotopic::picture::Picture;
///
/// let (tell, told) = mpsc::channel();
/// let start = Instant::now();
/// let output = Output::start(Box::new(Memory::default()), Arc::new(move || start.elapsed()), move |said| {
///     // Whoever listened may be gone.
///     let _ = tell.send(said);
/// })?;
/// output.show(Arc::new(Picture::black(4, 3)), Duration::ZERO);
/// assert!(matches!(told.recv()?, Told::Shown(stamp) if stamp.predicted_for == Duration::ZERO));
/// assert!(output.alive());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Output {
    shared: Arc<Shared>,
    now: Now,
    described: String,
    thread: Option<JoinHandle<()>>,
}

impl fmt::Debug for Output {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Output({})", self.described)
    }
}

impl Output {
    /// Gives a projector a thread of its own. `told` is called there, with everything that happens.
    ///
    /// # Errors
    /// The system has no more threads.
    pub fn start(
        projector: Box<dyn Projector>,
        now: Now,
        told: impl FnMut(Told) + Send + 'static,
    ) -> io::Result<Output> {
        let shared = Arc::new(Shared::default());
        let described = projector.describe();
        let worker = Worker {
            projector: Some(projector),
            shared: Arc::clone(&shared),
            now: Arc::clone(&now),
            told: Box::new(told),
            failing: false,
        };
        let thread = thread::Builder::new().name("projector".into()).spawn(move || worker.work())?;
        Ok(Output { shared, now, described, thread: Some(thread) })
    }

    /// Shows a picture, whose position was predicted for an instant. It overtakes a picture that is still waiting.
    pub fn show(&self, picture: Arc<Picture>, predicted_for: Duration) {
        let asked = (self.now)();
        self.shared.change(|slot| {
            if slot.picture.replace((picture, predicted_for, asked)).is_some() {
                slot.overtaken += 1;
            }
        });
    }

    /// Shows black: overtakes everything that is still waiting.
    pub fn dark(&self) {
        self.shared.change(|slot| {
            slot.picture = None;
            slot.dark = true;
        });
    }

    /// See [`Projector::dim`]; the answer comes as [`Told::Dimmed`].
    pub fn dim(&self, share: f32) {
        self.shared.change(|slot| slot.dim = Some(share));
    }

    /// Whether the thread lives and the device answers: nothing has kept it busy for five seconds.
    #[must_use]
    pub fn alive(&self) -> bool {
        let slot = self.shared.slot();
        !slot.gone && slot.busy_since.is_none_or(|since| (self.now)().saturating_sub(since) < PATIENCE)
    }

    /// Pictures that a later one overtook before they were shown.
    #[must_use]
    pub fn overtaken(&self) -> u64 {
        self.shared.slot().overtaken
    }

    /// See [`Projector::describe`].
    #[must_use]
    pub fn describe(&self) -> &str {
        &self.described
    }
}

impl Drop for Output {
    fn drop(&mut self) {
        self.shared.change(|slot| (slot.end, slot.picture) = (true, None));
        // A device that hangs must not hold up the program's end.
        let slot = self.shared.slot();
        let waited = self.shared.bell.wait_timeout_while(slot, LAST, |slot| !slot.gone);
        let gone = waited.map_or_else(|poisoned| poisoned.into_inner().0.gone, |(slot, _)| slot.gone);
        if gone && let Some(thread) = self.thread.take() {
            // That it broke was told when it did.
            let _ = thread.join();
        }
    }
}

/// What to do now.
enum Task {
    Dark,
    Dim(f32),
    Picture(Arc<Picture>, Duration, Duration),
    End,
}

/// The thread.
struct Worker {
    projector: Option<Box<dyn Projector>>,
    shared: Arc<Shared>,
    now: Now,
    told: Box<dyn FnMut(Told) + Send>,
    /// Whether the last thing that was asked of the device failed, and that has been told.
    failing: bool,
}

impl Worker {
    fn work(mut self) {
        loop {
            let task = self.next();
            let Some(projector) = &mut self.projector else { return };
            let (done, was_dark) = match task {
                Task::End => return,
                Task::Dark => (projector.dark().map(|()| Told::Dark((self.now)())), true),
                Task::Dim(share) => (projector.dim(share).map(Told::Dimmed), false),
                Task::Picture(picture, predicted_for, asked) => {
                    let shown = projector.present(&picture);
                    (shown.map(|()| Told::Shown(Stamp { predicted_for, asked, presented: (self.now)() })), false)
                }
            };
            self.shared.slot().busy_since = None;
            match done {
                Ok(said) => {
                    self.failing = false;
                    (self.told)(said);
                }
                Err(error) => {
                    if !self.failing {
                        self.failing = true;
                        (self.told)(Told::Failed(error));
                    }
                    // Whatever failed, it must not stay lit; a dark that failed is tried again after a while.
                    self.shared.slot().dark = true;
                    if was_dark {
                        self.pause();
                    }
                }
            }
        }
    }

    /// Waits for the next task: dark before dimming before pictures, the end before all.
    fn next(&self) -> Task {
        let mut slot = self.shared.slot();
        loop {
            let task = if slot.end {
                Some(Task::End)
            } else if std::mem::take(&mut slot.dark) {
                Some(Task::Dark)
            } else if let Some(share) = slot.dim.take() {
                Some(Task::Dim(share))
            } else {
                slot.picture.take().map(|(picture, predicted_for, asked)| Task::Picture(picture, predicted_for, asked))
            };
            if let Some(task) = task {
                slot.busy_since = Some((self.now)());
                return task;
            }
            slot = self.shared.bell.wait(slot).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn pause(&self) {
        let slot = self.shared.slot();
        drop(self.shared.bell.wait_timeout_while(slot, AGAIN, |slot| !slot.end));
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        if let Some(mut projector) = self.projector.take() {
            // Nobody is left to tell of a failure; the device's own drop tries once more.
            let _ = projector.dark();
            if thread::panicking() {
                let path = projector.describe();
                (self.told)(Told::Failed(ProjectorError::Lost { path, why: "its part of scotopic broke".into() }));
            }
        }
        self.shared.change(|slot| slot.gone = true);
    }
}

#[cfg(test)]
mod tests;
