//! The simulated hand controller behind a pseudo terminal. A listener that opens it at the wrong speed reads what it would read
//! on a real line.

use std::fs::File;
use std::io::{self, Write};
use std::os::fd::AsFd;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::termios::tcgetattr;

use super::Handset;
use super::uart::misread;
use crate::hw::pty;
use crate::numerics::streams::Stream;

/// A pseudo terminal with a hand controller behind it.
#[derive(Debug)]
pub struct Server {
    handset: Handset,
    master: File,
    name: String,
    start: Instant,
    /// Characters sent one right after the other, for a listener at another speed.
    together: Vec<u8>,
    phases: Stream,
}

impl Server {
    /// Opens the pseudo terminal.
    ///
    /// # Errors
    /// The system's: there are no more of them.
    pub fn open(handset: Handset, seed: u64) -> io::Result<Server> {
        let (master, name) = pty::open()?;
        Ok(Server { handset, master, name, start: Instant::now(), together: Vec::new(), phases: Stream::seeded(seed) })
    }

    /// What a listener opens.
    #[must_use]
    pub fn endpoint(&self) -> &str {
        &self.name
    }

    /// Time since it was opened.
    #[must_use]
    pub fn now(&self) -> Duration {
        self.start.elapsed()
    }

    /// The hand controller, to press its keys.
    pub fn handset(&mut self) -> &mut Handset {
        &mut self.handset
    }

    /// Sends what has passed by now, and waits for the next byte, at most so long. Without a listener the bytes are lost, as on
    /// a cable. Says whether there is a listener.
    ///
    /// # Errors
    /// The pseudo terminal is gone.
    pub fn step(&mut self, most: Duration) -> io::Result<bool> {
        let now = self.now();
        let passed = self.handset.drain(now);
        let listened = self.has_listener()?;
        self.together.extend(passed);
        let sent = self.handset.map().line().baud;
        let read = tcgetattr(&self.master).map_or(sent, |modes| modes.input_speed());
        if read == sent || read == 0 {
            let bytes = std::mem::take(&mut self.together);
            self.write(&bytes, listened);
        } else if !self.handset.is_sending() {
            let bytes: Vec<u8> = misread(&std::mem::take(&mut self.together), sent, read, self.phases.uniform())
                .into_iter()
                .map(|(byte, _)| byte)
                .collect();
            self.write(&bytes, listened);
        }
        let now = self.now();
        let nap = self.handset.wake_at().map_or(most, |at| at.saturating_sub(now).min(most));
        std::thread::sleep(nap.max(Duration::from_micros(200)));
        Ok(listened)
    }

    fn write(&mut self, bytes: &[u8], listened: bool) {
        if listened && !bytes.is_empty() {
            // A listener that does not read loses bytes, as on a cable.
            let _ = self.master.write(bytes);
        }
    }

    /// Whether the other end is open.
    fn has_listener(&self) -> io::Result<bool> {
        let mut files = [PollFd::from_borrowed_fd(self.master.as_fd(), PollFlags::IN)];
        poll(&mut files, Some(&Timespec { tv_sec: 0, tv_nsec: 0 }))?;
        Ok(!files[0].revents().contains(PollFlags::HUP))
    }
}
