//! The simulator behind a real port: TCP on this machine, or a pty. One client after the other.

mod pty;
mod tcp;

use std::fmt;
use std::io;
use std::net::SocketAddr;
use std::str::FromStr;
use std::time::{Duration, Instant};

use self::pty::Pty;
use self::tcp::Tcp;
use super::Simulator;

/// The longest time between two looks at the line.
const LONGEST_NAP: Duration = Duration::from_millis(50);

/// Where the simulator listens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Listen {
    /// A new pseudo terminal, which is opened like a serial port.
    Pty,
    /// A TCP address of this machine; port 0 chooses a free one.
    Tcp(SocketAddr),
}

impl fmt::Display for Listen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Listen::Pty => f.write_str("pty"),
            Listen::Tcp(address) => write!(f, "tcp:{address}"),
        }
    }
}

/// Why a place to listen was refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ListenError {
    /// Neither form.
    #[error("'{0}' is no place to listen: write pty, or tcp:127.0.0.1:PORT (port 0 chooses a free one)")]
    Form(String),
    /// An address that others can reach.
    #[error("{0} can be reached from other machines: the simulator listens only on this one, tcp:127.0.0.1:PORT")]
    NotLocal(SocketAddr),
}

impl FromStr for Listen {
    type Err = ListenError;

    fn from_str(text: &str) -> Result<Listen, ListenError> {
        let form = || ListenError::Form(text.chars().filter(|c| !c.is_control()).take(80).collect());
        if text == "pty" {
            return Ok(Listen::Pty);
        }
        let address = text.strip_prefix("tcp:").ok_or_else(form)?;
        let address = address.strip_prefix("localhost:").map_or(address.to_owned(), |port| format!("127.0.0.1:{port}"));
        let address: SocketAddr = address.parse().map_err(|_not_an_address| form())?;
        if address.ip().is_loopback() { Ok(Listen::Tcp(address)) } else { Err(ListenError::NotLocal(address)) }
    }
}

/// A line that clients can open: what both kinds have in common.
trait Line: fmt::Debug {
    /// The name that clients open.
    fn endpoint(&self) -> String;
    /// Waits for something to happen, at most so long, and says what did.
    fn wait(&mut self, most: Duration, room: usize) -> io::Result<Happened>;
    /// Sends; what the client does not take is lost.
    fn send(&mut self, bytes: &[u8]);
    /// Pulls the plug: the client is thrown out and the name is gone.
    fn unplug(&mut self) -> io::Result<()>;
    /// Puts the plug in again, perhaps under another name.
    fn replug(&mut self) -> io::Result<()>;
}

/// What a line brought.
#[derive(Debug, PartialEq, Eq)]
enum Happened {
    Nothing,
    Came,
    Left,
    Bytes(Vec<u8>),
}

/// What passed on the line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Passed<'a> {
    /// A client opened it.
    ClientCame,
    /// The client closed it.
    ClientLeft,
    /// Bytes to the mount.
    ToMount(&'a [u8]),
    /// Bytes from the mount.
    FromMount(&'a [u8]),
}

/// Hears all that passes, with the time since the start.
pub type Watcher = Box<dyn FnMut(Duration, Passed<'_>)>;

/// A simulator that listens.
pub struct Server {
    simulator: Simulator,
    line: Box<dyn Line>,
    plugged: bool,
    start: Instant,
    watcher: Watcher,
}

impl Server {
    /// Opens the place to listen.
    ///
    /// # Errors
    /// The system's: the port is taken, or there are no more pseudo terminals.
    pub fn open(simulator: Simulator, listen: Listen) -> io::Result<Server> {
        let line: Box<dyn Line> = match listen {
            Listen::Pty => Box::new(Pty::open()?),
            Listen::Tcp(address) => Box::new(Tcp::open(address)?),
        };
        Ok(Server { simulator, line, plugged: true, start: Instant::now(), watcher: Box::new(|_, _| {}) })
    }

    /// What a client opens: `tcp:127.0.0.1:PORT`, or the path of the pty.
    #[must_use]
    pub fn endpoint(&self) -> String {
        self.line.endpoint()
    }

    /// Tells this watcher all that passes on the line.
    pub fn watch(&mut self, watcher: Watcher) {
        self.watcher = watcher;
    }

    /// Serves client after client until `ended` says so; `renamed` hears each new name of the port.
    ///
    /// # Errors
    /// The system's, when the place to listen is lost.
    pub fn serve(&mut self, ended: &dyn Fn() -> bool, renamed: &mut dyn FnMut(&str)) -> io::Result<()> {
        let mut announced = self.line.endpoint();
        while !ended() {
            let now = self.now();
            self.simulator.tick(now);
            if self.simulator.plugged(now) != self.plugged {
                self.plugged = !self.plugged;
                if self.plugged {
                    self.line.replug()?;
                } else {
                    self.line.unplug()?;
                }
                if self.plugged && self.line.endpoint() != announced {
                    announced = self.line.endpoint();
                    renamed(&announced);
                }
            }
            self.pass_on(now)?;
        }
        Ok(())
    }

    /// Time since the start in whole microseconds, as recordings have it.
    fn now(&self) -> Duration {
        Duration::from_micros(u64::try_from(self.start.elapsed().as_micros()).unwrap_or(u64::MAX))
    }

    /// Hands bytes on, both ways.
    fn pass_on(&mut self, now: Duration) -> io::Result<()> {
        let bytes = self.simulator.drain(now);
        if !bytes.is_empty() {
            (self.watcher)(now, Passed::FromMount(&bytes));
            self.line.send(&bytes);
        }
        let nap = self.simulator.wake_at().map_or(LONGEST_NAP, |at| at.saturating_sub(now).min(LONGEST_NAP));
        if !self.plugged {
            std::thread::sleep(nap);
            return Ok(());
        }
        let happened = self.line.wait(nap, self.simulator.room())?;
        let now = self.now();
        match happened {
            Happened::Nothing => {}
            Happened::Came => {
                (self.watcher)(now, Passed::ClientCame);
                self.simulator.client_came(now);
            }
            Happened::Left => {
                (self.watcher)(now, Passed::ClientLeft);
                self.simulator.client_left(now);
            }
            Happened::Bytes(bytes) => {
                (self.watcher)(now, Passed::ToMount(&bytes));
                self.simulator.feed(&bytes, now);
            }
        }
        Ok(())
    }
}

/// Waits for input on a file; `true` when there is some (or an end).
fn readable(file: rustix::fd::BorrowedFd<'_>, most: Duration) -> io::Result<bool> {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    let mut files = [PollFd::from_borrowed_fd(file, PollFlags::IN)];
    let timeout = Timespec { tv_sec: 0, tv_nsec: most.subsec_nanos().into() };
    match poll(&mut files, Some(&timeout)) {
        Ok(ready) => Ok(ready > 0),
        Err(rustix::io::Errno::INTR) => Ok(false),
        Err(error) => Err(error.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_this_machine_is_listened_to() {
        assert_eq!("pty".parse(), Ok(Listen::Pty));
        assert!("tcp:127.0.0.1:0".parse::<Listen>().is_ok());
        assert!("tcp:[::1]:4030".parse::<Listen>().is_ok());
        assert!(matches!("tcp:0.0.0.0:4030".parse::<Listen>(), Err(ListenError::NotLocal(_))));
        assert!(matches!("tcp:192.168.1.2:4030".parse::<Listen>(), Err(ListenError::NotLocal(_))));
        for text in ["", "tcp", "tcp:127.0.0.1", "tcp:127.0.0.1:99999", "udp:127.0.0.1:1", "/dev/ttyS0"] {
            assert!(matches!(text.parse::<Listen>(), Err(ListenError::Form(_))), "{text}");
        }
    }
}
