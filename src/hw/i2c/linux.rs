//! `/dev/i2c-N` of Linux: on a Raspberry Pi, or a laptop with a USB adapter.

use std::path::{Path, PathBuf};

use i2cdev::core::I2CDevice;
use i2cdev::linux::{LinuxI2CDevice, LinuxI2CError};
use rustix::io::Errno;

use super::{I2cBus, I2cError};

/// An open bus. The kernel ends every transaction by itself, at the latest after the adapter's own time-out (a second
/// unless its driver says less).
#[derive(Debug)]
pub struct LinuxBus {
    path: PathBuf,
    /// The address that the open device speaks to.
    open: Option<(u8, LinuxI2CDevice)>,
}

impl LinuxBus {
    /// Opens the bus for one address. An address that a driver of the kernel holds is refused.
    ///
    /// # Errors
    /// It is not there, not ours, or the address is taken.
    pub fn open(path: &Path, address: u8) -> Result<LinuxBus, I2cError> {
        let mut bus = LinuxBus { path: path.into(), open: None };
        bus.device(address)?;
        Ok(bus)
    }

    fn device(&mut self, address: u8) -> Result<&mut LinuxI2CDevice, I2cError> {
        let LinuxBus { path, open } = self;
        let device = match open.take().filter(|(at, _)| *at == address) {
            Some((_, device)) => device,
            None => LinuxI2CDevice::new(&*path, u16::from(address))
                .map_err(|error| I2cError::Open { bus: path.display().to_string(), why: words(&error) })?,
        };
        Ok(&mut open.insert((address, device)).1)
    }

    fn failed(&self, address: u8, error: &LinuxI2CError) -> I2cError {
        let code = match error {
            LinuxI2CError::Errno(code) => Some(*code),
            LinuxI2CError::Io(error) => error.raw_os_error(),
        };
        match code.map(Errno::from_raw_os_error) {
            // Documentation/i2c/fault-codes of the kernel.
            Some(Errno::NXIO | Errno::REMOTEIO | Errno::IO) => I2cError::Nack { address },
            Some(Errno::TIMEDOUT | Errno::BUSY) => I2cError::Stuck,
            Some(Errno::AGAIN) => I2cError::Arbitration,
            _ => I2cError::Gone { bus: self.path.display().to_string(), why: words(error) },
        }
    }
}

/// The system's words for an error.
fn words(error: &LinuxI2CError) -> String {
    match error {
        LinuxI2CError::Errno(code) => std::io::Error::from_raw_os_error(*code).to_string(),
        LinuxI2CError::Io(error) => error.to_string(),
    }
}

impl I2cBus for LinuxBus {
    fn write(&mut self, address: u8, bytes: &[u8]) -> Result<(), I2cError> {
        let done = self.device(address)?.write(bytes);
        done.map_err(|error| self.failed(address, &error))
    }

    fn read(&mut self, address: u8, buffer: &mut [u8]) -> Result<(), I2cError> {
        let done = self.device(address)?.read(buffer);
        done.map_err(|error| self.failed(address, &error))
    }

    fn describe(&self) -> String {
        format!("I2C bus {}", self.path.display())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bus_that_is_not_there_and_a_file_that_is_no_bus_are_refused_in_words() {
        let error = LinuxBus::open(Path::new("/dev/i2c-none"), 0x1B).unwrap_err();
        assert!(error.to_string().contains("modprobe i2c-dev"), "{error}");
        let error = LinuxBus::open(Path::new("/dev/null"), 0x1B).unwrap_err();
        assert!(matches!(error, I2cError::Open { .. }), "{error}");
    }

    #[test]
    fn the_kernels_fault_codes_are_told_apart() {
        // Documentation/i2c/fault-codes.rst: ENXIO no acknowledge of the address, ETIMEDOUT the bus is held,
        // EAGAIN arbitration lost, ENODEV the adapter is gone.
        let bus = LinuxBus { path: "/dev/i2c-1".into(), open: None };
        let of = |errno: Errno| bus.failed(0x1B, &LinuxI2CError::Errno(errno.raw_os_error()));
        assert_eq!(of(Errno::NXIO), I2cError::Nack { address: 0x1B });
        assert_eq!(of(Errno::TIMEDOUT), I2cError::Stuck);
        assert_eq!(of(Errno::AGAIN), I2cError::Arbitration);
        assert!(!of(Errno::NODEV).may_pass());
    }
}
