//! A pseudo terminal, which clients open like a serial port, one after the other.
//!
//! No slave is kept open here: while no client has it open, the master reads an end of file, and that is how coming and going
//! are noticed. The master lives through it, and the name stays.

use std::fs::File;
use std::io::{self, Read, Write};
use std::os::fd::AsFd;
use std::time::Duration;

use super::{Happened, Line, readable};
use crate::hw::pty;

/// How often a pty without a client is looked at.
const LOOK: Duration = Duration::from_millis(20);

/// The master of a pseudo terminal.
#[derive(Debug)]
pub(super) struct Pty {
    master: Option<File>,
    name: String,
    client: bool,
    /// The first bytes of a client that is announced first.
    first: Vec<u8>,
}

impl Pty {
    pub(super) fn open() -> io::Result<Pty> {
        let (master, name) = pty::open()?;
        Ok(Pty { master: Some(master), name, client: false, first: Vec::new() })
    }
}

impl Line for Pty {
    fn endpoint(&self) -> String {
        self.name.clone()
    }

    fn wait(&mut self, most: Duration, room: usize) -> io::Result<Happened> {
        let Some(master) = &mut self.master else { return Ok(Happened::Nothing) };
        if !self.first.is_empty() {
            return Ok(Happened::Bytes(std::mem::take(&mut self.first)));
        }
        if room == 0 {
            std::thread::sleep(most.min(Duration::from_millis(1)));
            return Ok(Happened::Nothing);
        }
        if !readable(master.as_fd(), most)? {
            // Open and quiet. Without a client the master is always "readable".
            let came = !std::mem::replace(&mut self.client, true);
            return Ok(if came { Happened::Came } else { Happened::Nothing });
        }
        let mut bytes = vec![0; room.min(4096)];
        match master.read(&mut bytes) {
            Ok(count) if count > 0 => {
                bytes.truncate(count);
                if !std::mem::replace(&mut self.client, true) {
                    self.first = bytes;
                    return Ok(Happened::Came);
                }
                Ok(Happened::Bytes(bytes))
            }
            Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted) => {
                Ok(Happened::Nothing)
            }
            // EIO: no client has it open.
            _ => {
                let left = std::mem::replace(&mut self.client, false);
                if left {
                    return Ok(Happened::Left);
                }
                std::thread::sleep(most.min(LOOK));
                Ok(Happened::Nothing)
            }
        }
    }

    fn send(&mut self, bytes: &[u8]) {
        // Nobody there, or nobody reading: the bytes are lost, as on a serial line.
        if let Some(master) = self.master.as_mut().filter(|_| self.client) {
            let _ = master.write(bytes);
        }
    }

    fn unplug(&mut self) -> io::Result<()> {
        // The next name is taken before this one is given up, so that it comes back under another.
        let next = Pty::open()?;
        self.name = next.name;
        self.master = next.master;
        self.client = false;
        Ok(())
    }

    fn replug(&mut self) -> io::Result<()> {
        Ok(())
    }
}
