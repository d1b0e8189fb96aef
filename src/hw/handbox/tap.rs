//! The tapped line: a serial port that is opened for reading only. There is no way to write to it.

mod line;

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read};
use std::os::fd::AsFd;
use std::os::unix::fs::{FileTypeExt, MetadataExt, OpenOptionsExt};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{FlockOperation, OFlags, flock};
use rustix::termios::{ioctl_tiocexcl, ioctl_tiocnxcl};

use self::line::Marks;
use super::Heard;
use super::decoder::Decoder;
use super::keymap::Line;
use crate::hw::mount::address::MountAddress;
use crate::hw::port::PortError;

/// The first pause before a lost port is opened again; each further one is twice as long.
const FIRST_PAUSE: Duration = Duration::from_millis(250);
/// The longest pause: a plug that is put back is heard within a second.
const LONGEST_PAUSE: Duration = Duration::from_secs(1);
/// The longest wait for a byte, and how often the listener shows that it is alive.
const LOOK: Duration = Duration::from_millis(100);

/// Why a port must not be tapped.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TapError {
    /// It is the port over which the mount is commanded.
    #[error(
        "{tap} is the mount's own command port ({mount}): what passes there are commands, not keys; tap the hand controller's \
         cable with an adapter of its own and give that port"
    )]
    MountsPort {
        /// What was to be tapped.
        tap: String,
        /// The mount's port.
        mount: String,
    },
}

/// What the listener tells.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TapSaid {
    /// The port is open.
    Opened,
    /// The port cannot be opened or was lost. It is opened again by itself.
    Lost {
        /// Why, in words that say what to do.
        why: PortError,
    },
    /// Bytes came: for recordings and for showing that there is life on the line.
    Bytes {
        /// The bytes.
        bytes: Vec<u8>,
        /// How many characters were not well formed (wrong speed, noise, a line held low).
        malformed: usize,
        /// When, since the start that was handed in.
        at: Duration,
    },
    /// A key, or bytes of no key.
    Heard(Heard),
    /// Nothing happened for a tenth of a second: the listener is alive.
    Alive,
}

/// What was read in one go.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Received {
    /// The bytes.
    pub bytes: Vec<u8>,
    /// Characters that were not well formed.
    pub malformed: usize,
}

/// An open tapped line.
#[derive(Debug)]
pub struct Tap {
    name: String,
    port: File,
    marks: Marks,
}

impl Tap {
    /// Opens a port for listening.
    ///
    /// # Errors
    /// It is not there, held by another program, not ours to open, or no serial port.
    pub fn open(path: &str, line: &Line) -> Result<Tap, PortError> {
        let flags = OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let flags = i32::try_from(flags.bits()).unwrap_or_default();
        let port = OpenOptions::new().read(true).custom_flags(flags).open(path).map_err(|e| opening(path, &e))?;
        let unusable = |why: String| PortError::Unusable { name: path.into(), why };
        // Both locks that other programs look at: the advisory one, and the terminal's.
        flock(&port, FlockOperation::NonBlockingLockExclusive).map_err(|error| match error {
            rustix::io::Errno::WOULDBLOCK => PortError::Held { name: path.into() },
            error => unusable(error.to_string()),
        })?;
        if !port.metadata().is_ok_and(|data| data.file_type().is_char_device()) {
            return Err(unusable("it is no serial port".into()));
        }
        line::set(&port, line).map_err(|error| unusable(error.to_string()))?;
        // Not for root, and a pty may refuse; the advisory lock holds then.
        let _ = ioctl_tiocexcl(&port);
        Ok(Tap { name: path.into(), port, marks: Marks::default() })
    }

    /// Changes the speed and the form of characters.
    ///
    /// # Errors
    /// The port cannot do that, or is gone.
    pub fn set(&mut self, line: &Line) -> Result<(), PortError> {
        self.marks = Marks::default();
        line::set(&self.port, line)
            .map_err(|error| PortError::Unusable { name: self.name.clone(), why: error.to_string() })
    }

    /// Waits at most so long for bytes, and gives all that have come.
    ///
    /// # Errors
    /// The port is gone; open it again.
    pub fn read(&mut self, patience: Duration) -> Result<Received, PortError> {
        let gone = |why: String| PortError::Unplugged { name: self.name.clone(), why };
        let mut files = [PollFd::from_borrowed_fd(self.port.as_fd(), PollFlags::IN)];
        let timeout = Timespec {
            tv_sec: i64::try_from(patience.as_secs()).unwrap_or(i64::MAX),
            tv_nsec: patience.subsec_nanos().into(),
        };
        match poll(&mut files, Some(&timeout)) {
            Ok(0) | Err(rustix::io::Errno::INTR) => return Ok(Received::default()),
            Ok(_) => {}
            Err(error) => return Err(gone(error.to_string())),
        }
        let mut raw = [0; 1024];
        match (&self.port).read(&mut raw) {
            Ok(0) => Err(gone("no more bytes".into())),
            Ok(count) => Ok(self.marks.read(&raw[..count])),
            Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted) => {
                Ok(Received::default())
            }
            Err(error) => Err(gone(error.to_string())),
        }
    }

    /// Listens until `stop` is set or `told` answers `false`, opening the port again for as long as it takes. Times are
    /// counted from `start`. Made for a thread of its own.
    pub fn run(
        port: &str,
        mut decoder: Decoder,
        start: Instant,
        stop: &AtomicBool,
        mut told: impl FnMut(TapSaid) -> bool,
    ) {
        let line = decoder.map().line();
        let mut pause = FIRST_PAUSE;
        while !stop.load(Ordering::Relaxed) {
            let why = match Tap::open(port, &line) {
                Ok(tap) => {
                    decoder.reset();
                    if !told(TapSaid::Opened) {
                        return;
                    }
                    let opened = Instant::now();
                    let why = tap.listen(&mut decoder, start, stop, &mut told);
                    if opened.elapsed() > LONGEST_PAUSE {
                        pause = FIRST_PAUSE;
                    }
                    why
                }
                Err(why) => Some(why),
            };
            let Some(why) = why else { return };
            if !told(TapSaid::Lost { why }) {
                return;
            }
            let again = Instant::now() + pause;
            while Instant::now() < again && !stop.load(Ordering::Relaxed) {
                thread::sleep(LOOK.min(again.saturating_duration_since(Instant::now())));
                if !told(TapSaid::Alive) {
                    return;
                }
            }
            pause = (2 * pause).min(LONGEST_PAUSE);
        }
    }

    /// Listens until the port is lost (then why), or nobody wants to hear more (`None`).
    fn listen(
        mut self,
        decoder: &mut Decoder,
        start: Instant,
        stop: &AtomicBool,
        told: &mut impl FnMut(TapSaid) -> bool,
    ) -> Option<PortError> {
        while !stop.load(Ordering::Relaxed) {
            let due = decoder.wake_at().map_or(LOOK, |at| at.saturating_sub(start.elapsed()).min(LOOK));
            let read = match self.read(due) {
                Ok(read) => read,
                Err(why) => return Some(why),
            };
            let at = start.elapsed();
            let heard = if read.bytes.is_empty() { decoder.tick(at) } else { decoder.feed(&read.bytes, at) };
            let quiet = read == Received::default();
            if !quiet && !told(TapSaid::Bytes { bytes: read.bytes, malformed: read.malformed, at }) {
                return None;
            }
            if quiet && heard.is_empty() && !told(TapSaid::Alive) {
                return None;
            }
            if !heard.into_iter().all(|heard| told(TapSaid::Heard(heard))) {
                return None;
            }
        }
        None
    }
}

impl Drop for Tap {
    fn drop(&mut self) {
        let _ = ioctl_tiocnxcl(&self.port);
    }
}

/// Refuses to tap the port over which the mount is commanded, under whatever name.
///
/// # Errors
/// It is that port.
pub fn refuse_mounts_port(tap: &str, mount: &MountAddress) -> Result<(), TapError> {
    let MountAddress::Serial { path, .. } = mount else { return Ok(()) };
    let same_name = tap == path;
    let same_file =
        fs::canonicalize(tap).ok().is_some_and(|tap| fs::canonicalize(path).is_ok_and(|mount| mount == tap));
    let device =
        |path: &str| fs::metadata(Path::new(path)).ok().filter(|d| d.file_type().is_char_device()).map(|d| d.rdev());
    let same_device = device(tap).is_some_and(|tap| device(path) == Some(tap));
    if same_name || same_file || same_device {
        let plain = |text: &str| text.chars().filter(|c| !c.is_control()).collect();
        return Err(TapError::MountsPort { tap: plain(tap), mount: plain(path) });
    }
    Ok(())
}

fn opening(path: &str, error: &io::Error) -> PortError {
    let name = path.to_owned();
    match error.kind() {
        io::ErrorKind::NotFound => PortError::NotThere { name },
        io::ErrorKind::PermissionDenied => PortError::Permission { name },
        io::ErrorKind::ResourceBusy => PortError::Held { name },
        // No such device: a name that leads to a plug that is not there.
        _ if matches!(error.raw_os_error(), Some(6 | 19)) => PortError::NotThere { name },
        _ => PortError::Unusable { name, why: error.to_string() },
    }
}
