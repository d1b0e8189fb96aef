//! A second, tiny process that stops the mount if this program is killed, or hangs, while the mount moves.
//!
//! ```text
//! session --- one byte per turn of its loop ---> pipe ---> supervisor
//!    \___________________ the line to the mount ______________/   (one open file, shared)
//! ```
//!
//! The line to a mount is held exclusively, so the child cannot open it again: it is born with a duplicate of the open file.
//! One child therefore belongs to one opening of the line, and is gone before the line is opened anew
//! (`Guard::release`): there is no moment at which two children hold lines, and none at which a child holds an old one
//! while the session speaks on a new one. The pipe needs no protocol for death: when the session dies, however it dies,
//! the kernel closes the pipe.

use std::io::IsTerminal;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
use rustix::io::Errno;

/// The supervisor's mind, without pipe, line or clock.
pub mod vigil;

use vigil::{Beat, Duty, Outcome, STOP, Vigil};

/// The hidden subcommand that the child runs.
pub const SUBCOMMAND: &str = "supervise";

/// A child with nothing to do ends within this time after it was told.
const PATIENCE: Duration = Duration::from_millis(500);

/// Why there is no supervisor (any more).
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum SupervisorError {
    /// The child could not be started.
    #[error("the supervisor could not be started ({why}): if this program dies during a slew, cut the mount's power")]
    NotStarted {
        /// The system's words.
        why: String,
    },
    /// The child has ended: it took us for dead and stopped the mount, or was itself killed.
    #[error("the supervisor has ended ({why}): the mount was stopped if it was moving")]
    Ended {
        /// The system's words.
        why: String,
    },
    /// Somebody started the subcommand by hand.
    #[error(
        "'{SUBCOMMAND}' is started by the session itself, with a pipe and the mount's line: there is nothing to do by hand"
    )]
    ByHand,
}

/// Starts supervisors.
#[derive(Debug, Clone)]
pub struct Supervisor {
    program: PathBuf,
}

impl Supervisor {
    /// Supervisors that run this program.
    ///
    /// # Errors
    /// The system does not say where this program lies.
    pub fn of_this_program() -> Result<Supervisor, SupervisorError> {
        // The link still leads to this program when its file was replaced by an upgrade.
        let link = Path::new("/proc/self/exe");
        let program = if link.exists() {
            link.to_owned()
        } else {
            std::env::current_exe().map_err(|error| SupervisorError::NotStarted { why: error.to_string() })?
        };
        Ok(Supervisor { program })
    }

    /// Supervisors that run another program, which must know the subcommand: for tests.
    #[must_use]
    pub fn of_program(program: &Path) -> Supervisor {
        Supervisor { program: program.to_owned() }
    }

    /// Starts a child that watches over an open line to the mount. `line` is a duplicate of it.
    ///
    /// # Errors
    /// The child cannot be started.
    pub fn guard(&self, line: OwnedFd) -> Result<Guard, SupervisorError> {
        let not_started = |why: String| SupervisorError::NotStarted { why };
        let mut child = Command::new(&self.program)
            .arg0("scotopic")
            .arg(SUBCOMMAND)
            .stdin(Stdio::piped())
            .stdout(line)
            .stderr(Stdio::null())
            .process_group(0) // Ctrl-C and a closed terminal are for the session, not for its supervisor.
            .spawn()
            .map_err(|error| not_started(error.to_string()))?;
        let pipe = child.stdin.take().map(OwnedFd::from);
        // A beat must never block the session, even if the child hangs and the pipe fills up.
        let unblocked =
            pipe.as_ref().ok_or(Errno::BADF).and_then(|pipe| fcntl_setfl(pipe, fcntl_getfl(pipe)? | OFlags::NONBLOCK));
        let guard = Guard { child, pipe, moving: false };
        match unblocked {
            Ok(()) => Ok(guard),
            Err(error) => Err(not_started(error.to_string())),
        }
    }
}

/// A running supervisor. Beat at least twice a second, from the loop whose life matters.
///
/// Dropped while the mount moves (a panic), it leaves the child to stop the mount; dropped at rest, the child ends first.
#[derive(Debug)]
pub struct Guard {
    child: Child,
    pipe: Option<OwnedFd>,
    moving: bool,
}

impl Guard {
    /// Tells the supervisor that the session lives, and whether the mount moves.
    ///
    /// # Errors
    /// The supervisor has ended: start another, on the same line.
    pub fn beat(&mut self, moving: bool) -> Result<(), SupervisorError> {
        self.moving = moving;
        self.tell(if moving { Beat::Moving } else { Beat::Still })
    }

    /// Ends the supervisor, whether the mount moves or not, and returns when it has let go of the line. The caller lives and
    /// sees to the mount by itself. To be called before the line is opened again.
    pub fn release(mut self) {
        self.moving = false;
    }

    fn tell(&mut self, beat: Beat) -> Result<(), SupervisorError> {
        let pipe = self.pipe.as_ref().ok_or(SupervisorError::Ended { why: "released".into() })?;
        loop {
            match rustix::io::write(pipe, &[beat.to_byte()]) {
                Ok(_) => return Ok(()),
                Err(Errno::INTR) => {}
                Err(error) => return Err(SupervisorError::Ended { why: error.to_string() }),
            }
        }
    }
}

impl Drop for Guard {
    fn drop(&mut self) {
        if self.moving {
            // The closed pipe is the alarm. The child stops the mount and outlives us if need be.
            self.pipe = None;
            return;
        }
        // A child that has ended already cannot be told, which is just as well.
        let _ = self.tell(Beat::Release);
        self.pipe = None;
        let told = Instant::now();
        while told.elapsed() < PATIENCE {
            match self.child.try_wait() {
                Ok(None) => std::thread::sleep(Duration::from_millis(2)),
                Ok(Some(_)) | Err(_) => return,
            }
        }
        // It hangs: it must not keep the line.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The child's whole life: beats on standard input, the line to the mount on standard output.
///
/// # Errors
/// It was started by hand, or the system fails it before it has begun.
pub fn supervise() -> Result<Outcome, SupervisorError> {
    let (stdin, stdout) = (std::io::stdin(), std::io::stdout());
    if stdin.is_terminal() {
        return Err(SupervisorError::ByHand);
    }
    // The session's end is told by the pipe; a signal to the whole group must not take the supervisor first.
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM, signal_hook::consts::SIGHUP] {
        signal_hook::flag::register(signal, Arc::new(AtomicBool::new(false)))
            .map_err(|error| SupervisorError::NotStarted { why: error.to_string() })?;
    }
    Ok(watch(stdin.as_fd(), stdout.as_fd()))
}

/// Listens to the beats and does what the vigil says.
fn watch(beats: BorrowedFd<'_>, line: BorrowedFd<'_>) -> Outcome {
    let started = Instant::now();
    let mut vigil = Vigil::begun();
    loop {
        match vigil.duty(started.elapsed()) {
            Duty::Leave(outcome) => return outcome,
            Duty::SendStop => send(line, STOP),
            Duty::Pause(time) => std::thread::sleep(time),
            Duty::Listen(at_most) => {
                let mut waiting = [PollFd::new(&beats, PollFlags::IN)];
                // An interrupted wait is a short one.
                let heard = poll(&mut waiting, at_most.and_then(timespec).as_ref()).unwrap_or(0);
                if heard > 0 {
                    listen(beats, &mut vigil, started);
                }
            }
        }
    }
}

fn timespec(wait: Duration) -> Option<Timespec> {
    Timespec::try_from(wait).ok()
}

/// Takes what has come through the pipe.
fn listen(beats: BorrowedFd<'_>, vigil: &mut Vigil, started: Instant) {
    let mut bytes = [0; 64];
    match rustix::io::read(beats, &mut bytes) {
        Ok(0) => vigil.session_gone(started.elapsed()),
        Ok(count) => bytes[..count].iter().for_each(|byte| vigil.hear(*byte, started.elapsed())),
        Err(Errno::INTR | Errno::AGAIN) => {}
        Err(_) => vigil.session_gone(started.elapsed()),
    }
}

/// Sends as well as it can: a full line is waited for a little, a lost one is left to the next try.
fn send(line: BorrowedFd<'_>, mut bytes: &[u8]) {
    for _ in 0..20 {
        match rustix::io::write(line, bytes) {
            Ok(count) if count == bytes.len() => return,
            Ok(count) => bytes = &bytes[count..],
            Err(Errno::INTR) => {}
            Err(Errno::AGAIN) => {
                let mut waiting = [PollFd::new(&line, PollFlags::OUT)];
                let _ = poll(&mut waiting, timespec(Duration::from_millis(20)).as_ref());
            }
            Err(_) => return,
        }
    }
}
