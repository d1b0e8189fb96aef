//! A line to a device: bytes out, bytes in, and why it failed.

use std::os::fd::OwnedFd;
use std::time::Duration;

/// A line to a device. Serial ports, TCP, recorded traces and simulators are all ports.
pub trait Port: Send {
    /// Takes the bytes that have come in, waiting at most a few milliseconds for the first. `Ok(0)` means quiet, never closed.
    ///
    /// # Errors
    /// The line is gone; open a new one.
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError>;

    /// Sends what the line takes at once and says how many bytes that were; `Ok(0)` means the line is full for the moment.
    ///
    /// # Errors
    /// The line is gone; open a new one.
    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError>;

    /// Says what time it is (since the program started). Only ports without a clock of their own listen: simulators,
    /// recordings.
    fn set_now(&mut self, now: Duration) {
        let _ = now;
    }

    /// A duplicate of the open file, for a supervisor that may have to send the stop after us; `None` where there is none.
    fn duplicate(&self) -> Option<OwnedFd> {
        None
    }
}

impl<P: Port + ?Sized> Port for Box<P> {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        (**self).receive(buffer)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        (**self).send(bytes)
    }

    fn set_now(&mut self, now: Duration) {
        (**self).set_now(now);
    }

    fn duplicate(&self) -> Option<OwnedFd> {
        (**self).duplicate()
    }
}

/// Why a line cannot be opened, or was lost. The text says what to do.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PortError {
    /// No such device or address.
    #[error("{name} is not there: plug the cable in, or look in /dev/serial/by-id for its name")]
    NotThere {
        /// What was to be opened.
        name: String,
    },
    /// Another program has it open.
    #[error("{name} is held by another program: end that program (or ModemManager) and it will be opened")]
    Held {
        /// What was to be opened.
        name: String,
    },
    /// The user may not open it.
    #[error(
        "{name} may not be opened by this user: join the group dialout (sudo adduser $USER dialout) and log in again"
    )]
    Permission {
        /// What was to be opened.
        name: String,
    },
    /// Nobody listens at the address, or no answer in time.
    #[error("no connection to {name} ({why}): is the bridge switched on, and are its address and port right?")]
    NoConnection {
        /// What was to be opened.
        name: String,
        /// The system's words.
        why: String,
    },
    /// It was open and has gone.
    #[error("{name} was unplugged or closed ({why}): plug it in again, it is reopened by itself")]
    Unplugged {
        /// What was open.
        name: String,
        /// The system's words.
        why: String,
    },
    /// Anything else the system says.
    #[error("{name} cannot be used: {why}")]
    Unusable {
        /// What was to be opened.
        name: String,
        /// The system's words.
        why: String,
    },
    /// A replayed conversation did not go as recorded.
    #[error("the conversation left its recording at step {step}: {why}")]
    OffScript {
        /// Line of the recording, the header being 0.
        step: usize,
        /// What was expected and what came.
        why: String,
    },
}
