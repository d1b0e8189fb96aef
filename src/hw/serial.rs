//! A serial port, or a pty that looks like one.

use std::fs;
use std::io::{self, Read, Write};
use std::os::fd::{AsRawFd, BorrowedFd, OwnedFd};
use std::path::{Path, PathBuf};
use std::time::Duration;

use serialport::{ClearBuffer, DataBits, ErrorKind, FlowControl, Parity, SerialPort, StopBits, TTYPort};

use super::port::{Port, PortError};

/// A read waits this long for a first byte: short, so that a stop is never held up by it.
const PATIENCE: Duration = Duration::from_millis(10);

/// An open serial port: 8 data bits, no parity, 1 stop bit, no flow control, held exclusively.
#[derive(Debug)]
pub struct SerialLine {
    name: String,
    port: TTYPort,
}

impl SerialLine {
    /// Opens the device at `path`.
    ///
    /// # Errors
    /// It is not there, held by another program, or not ours to open.
    pub fn open(path: &str, baud: u32) -> Result<SerialLine, PortError> {
        let port = serialport::new(path, baud)
            .data_bits(DataBits::Eight)
            .parity(Parity::None)
            .stop_bits(StopBits::One)
            .flow_control(FlowControl::None)
            .timeout(PATIENCE)
            .exclusive(true)
            .open_native()
            .map_err(|error| opening(path, &error))?;
        // What came before the settings were right is noise. A pty may refuse; the driver drains the line anyway.
        let _ = port.clear(ClearBuffer::Input);
        Ok(SerialLine { name: path.into(), port })
    }

    fn unplugged(&self, why: impl ToString) -> PortError {
        PortError::Unplugged { name: self.name.clone(), why: why.to_string() }
    }
}

impl Port for SerialLine {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        match self.port.read(buffer) {
            // A serial port is never "at its end": zero bytes without a timeout is a cable pulled out.
            Ok(0) => Err(self.unplugged("no more bytes")),
            Ok(count) => Ok(count),
            Err(error) if quiet(&error) => Ok(0),
            Err(error) => Err(self.unplugged(error)),
        }
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        match self.port.write(bytes) {
            Ok(count) => Ok(count),
            Err(error) if quiet(&error) => Ok(0),
            Err(error) => Err(self.unplugged(error)),
        }
    }

    #[expect(unsafe_code, reason = "the serial library lends its descriptor as a bare number")]
    fn duplicate(&self) -> Option<OwnedFd> {
        // SAFETY: the descriptor is open, and stays so while it is borrowed, because `self.port` owns it.
        let borrowed = unsafe { BorrowedFd::borrow_raw(self.port.as_raw_fd()) };
        borrowed.try_clone_to_owned().ok()
    }
}

/// Whether a read or write ended for want of bytes or room, not because the port has gone.
fn quiet(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted)
}

fn opening(path: &str, error: &serialport::Error) -> PortError {
    let name = path.to_owned();
    match error.kind {
        ErrorKind::Io(io::ErrorKind::PermissionDenied) => PortError::Permission { name },
        ErrorKind::Io(io::ErrorKind::NotFound) => PortError::NotThere { name },
        // The library says "no device" for a device that is busy; the difference is whether it is there.
        ErrorKind::NoDevice if Path::new(path).exists() => PortError::Held { name },
        ErrorKind::Io(io::ErrorKind::ResourceBusy) => PortError::Held { name },
        ErrorKind::NoDevice => PortError::NotThere { name },
        _ if !Path::new(path).exists() => PortError::NotThere { name },
        _ => PortError::Unusable { name, why: error.to_string() },
    }
}

/// The name under /dev/serial/by-id (or by-path) that leads to this device: it stays when a USB adapter that dropped out
/// comes back under another number. The path itself where there is none.
#[must_use]
pub fn stable_name(path: &str) -> String {
    stable_name_in(&["/dev/serial/by-id", "/dev/serial/by-path"].map(Path::new), path)
}

fn stable_name_in(folders: &[&Path], path: &str) -> String {
    let Ok(device) = fs::canonicalize(path) else { return path.into() };
    if folders.iter().any(|folder| Path::new(path).starts_with(folder)) {
        return path.into();
    }
    let mut names: Vec<PathBuf> = folders
        .iter()
        .filter_map(|folder| fs::read_dir(folder).ok())
        .flatten()
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|name| fs::canonicalize(name).is_ok_and(|target| target == device))
        .collect();
    names.sort();
    names.first().and_then(|name| name.to_str()).map_or_else(|| path.into(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_opened_says_why() {
        assert!(matches!(SerialLine::open("/dev/no-such-tty", 9600), Err(PortError::NotThere { .. })));
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
        assert!(matches!(SerialLine::open(file, 9600), Err(PortError::Unusable { .. })));
    }

    #[test]
    fn a_port_that_is_held_is_said_to_be_held() {
        let (_master, slave) = TTYPort::pair().unwrap();
        let path = slave.name().unwrap();
        drop(slave);
        let first = SerialLine::open(&path, 9600).unwrap();
        assert!(matches!(SerialLine::open(&path, 9600), Err(PortError::Held { .. })));
        drop(first);
        assert!(SerialLine::open(&path, 9600).is_ok());
    }

    #[test]
    fn bytes_pass_both_ways_silence_is_no_error_and_a_closed_end_is_an_unplugged_cable() {
        let (mut master, slave) = TTYPort::pair().unwrap();
        let path = slave.name().unwrap();
        drop(slave);
        let mut line = SerialLine::open(&path, 9600).unwrap();
        let mut buffer = [0; 32];
        assert_eq!(line.receive(&mut buffer), Ok(0));
        assert_eq!(line.send(b":GD#"), Ok(4));
        master.set_timeout(Duration::from_secs(2)).unwrap();
        let mut asked = [0; 4];
        master.read_exact(&mut asked).unwrap();
        assert_eq!(&asked, b":GD#");
        master.write_all(b"+51\xDF14:20#").unwrap();
        let mut got: Vec<u8> = Vec::new();
        while got.len() < 10 {
            let count = line.receive(&mut buffer).unwrap();
            got.extend(&buffer[..count]);
        }
        assert_eq!(got, b"+51\xDF14:20#");
        drop(master);
        assert!(matches!(line.receive(&mut buffer), Err(PortError::Unplugged { .. })));
    }

    #[test]
    fn a_device_is_remembered_by_the_name_that_stays() {
        let folder = std::env::temp_dir().join(format!("scotopic-by-id-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let (device, name) = (folder.join("ttyUSB0"), folder.join("usb-FTDI_A1-if00"));
        fs::write(&device, "").unwrap();
        std::os::unix::fs::symlink(&device, &name).unwrap();
        let by_id = folder.join("by-id");
        fs::create_dir_all(&by_id).unwrap();
        std::os::unix::fs::symlink(&device, by_id.join("usb-FTDI_A1-if00")).unwrap();
        let stable = stable_name_in(&[&by_id], device.to_str().unwrap());
        assert_eq!(stable, by_id.join("usb-FTDI_A1-if00").to_str().unwrap());
        assert_eq!(stable_name_in(&[&by_id], "/dev/no-such-tty"), "/dev/no-such-tty");
        fs::remove_dir_all(&folder).unwrap();
    }
}
