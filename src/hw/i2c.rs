//! The I2C bus to a projector's controller: three calls, the errors a bus can make, and where a bus is found.
//!
//! ```text
//! controller (hw::light) --> I2cBus --> linux (/dev/i2c-N)  |  pi (rppal)  |  fake (a made-up controller, hw::light::fake)
//! ```
//!
//! Nothing here waits or retries: that is the controller's, within the time it was given.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

/// `/dev/i2c-N` of Linux.
pub mod linux;
/// Time for those who wait on a bus: read, slept, and made up.
pub mod pace;
/// The bus of a Raspberry Pi.
#[cfg(feature = "pi")]
pub mod pi;

/// An open I2C bus. Addresses are the 7-bit ones.
pub trait I2cBus: Send {
    /// Writes bytes to a device: start, address, bytes, stop.
    ///
    /// # Errors
    /// Nobody answered, or the bus is not well.
    fn write(&mut self, address: u8, bytes: &[u8]) -> Result<(), I2cError>;

    /// Fills the buffer from a device: start, address, bytes, stop.
    ///
    /// # Errors
    /// Nobody answered, fewer bytes came, or the bus is not well.
    fn read(&mut self, address: u8, buffer: &mut [u8]) -> Result<(), I2cError>;

    /// Writes, then reads, with a stop between them: the controllers take two transactions, not a repeated start.
    ///
    /// # Errors
    /// As [`I2cBus::write`] and [`I2cBus::read`].
    fn write_read(&mut self, address: u8, bytes: &[u8], buffer: &mut [u8]) -> Result<(), I2cError> {
        self.write(address, bytes)?;
        self.read(address, buffer)
    }

    /// What it is, in words: `I2C bus /dev/i2c-1`.
    fn describe(&self) -> String;
}

impl<B: I2cBus + ?Sized> I2cBus for Box<B> {
    fn write(&mut self, address: u8, bytes: &[u8]) -> Result<(), I2cError> {
        (**self).write(address, bytes)
    }

    fn read(&mut self, address: u8, buffer: &mut [u8]) -> Result<(), I2cError> {
        (**self).read(address, buffer)
    }

    fn write_read(&mut self, address: u8, bytes: &[u8], buffer: &mut [u8]) -> Result<(), I2cError> {
        (**self).write_read(address, bytes, buffer)
    }

    fn describe(&self) -> String {
        (**self).describe()
    }
}

/// Why a transaction did not happen.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum I2cError {
    /// Nobody acknowledged.
    #[error(
        "nothing answers at address 0x{address:02X}: check that the module has power and that SDA and SCL are not swapped"
    )]
    Nack {
        /// The 7-bit address.
        address: u8,
    },
    /// A line is held low, or the clock is stretched for ever.
    #[error("the bus is stuck (a line is held low): switch the module off and on, and check the wiring")]
    Stuck,
    /// Another master, or noise, took the bus in the middle.
    #[error("the bus was lost in the middle of a transfer: keep its wires short and away from the motor cables")]
    Arbitration,
    /// Fewer bytes came than were asked for.
    #[error("only {got} of {wanted} bytes came")]
    Short {
        /// Bytes asked for.
        wanted: usize,
        /// Bytes that came.
        got: usize,
    },
    /// The bus cannot be opened.
    #[error("the bus {bus} cannot be opened: {why}{}", advice(why))]
    Open {
        /// The device file or number.
        bus: String,
        /// What the system says.
        why: String,
    },
    /// The bus itself is gone (adapter unplugged), or fails in a way that trying again does not mend.
    #[error("the bus {bus} failed: {why}; check the adapter and its cable")]
    Gone {
        /// The device file or number.
        bus: String,
        /// What the system says.
        why: String,
    },
}

impl I2cError {
    /// Whether the same transaction may succeed a moment later.
    #[must_use]
    pub fn may_pass(&self) -> bool {
        matches!(self, I2cError::Nack { .. } | I2cError::Stuck | I2cError::Arbitration | I2cError::Short { .. })
    }
}

/// What to do about the commonest refusals of a bus.
fn advice(why: &str) -> &'static str {
    if why.contains("ermission denied") {
        "; add yourself to the group `i2c` and log in again"
    } else if why.contains("No such file") {
        "; list what is there with `ls /dev/i2c-*`, and load it with `modprobe i2c-dev` if there is none"
    } else if why.contains("busy") {
        "; a driver of the kernel holds this address: unbind it"
    } else {
        ""
    }
}

/// Where a bus is found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum BusAddress {
    /// A device file of Linux: `/dev/i2c-1`.
    Device(PathBuf),
    /// A bus of a Raspberry Pi, by its number.
    Pi(u8),
    /// No bus: a made-up controller whose registers are kept in a file.
    Fake(PathBuf),
}

/// A text that names no bus.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is no bus: give its number (1 is /dev/i2c-1), /dev/i2c-N, pi:N or fake:FILE")]
pub struct NoBus(String);

impl FromStr for BusAddress {
    type Err = NoBus;

    /// Reads `1`, `/dev/i2c-1`, `pi:1` or `fake:/path/state.json`.
    fn from_str(text: &str) -> Result<BusAddress, NoBus> {
        let wrong = || NoBus(text.chars().filter(|c| !c.is_control()).take(80).collect());
        match text.split_once(':') {
            Some(("pi", number)) => number.parse().map(BusAddress::Pi).map_err(|_digits| wrong()),
            Some(("fake", path)) if !path.is_empty() => Ok(BusAddress::Fake(path.into())),
            None if text.starts_with('/') => Ok(BusAddress::Device(text.into())),
            None => match text.parse::<u16>() {
                Ok(number) => Ok(BusAddress::Device(format!("/dev/i2c-{number}").into())),
                Err(_digits) => Err(wrong()),
            },
            Some(_) => Err(wrong()),
        }
    }
}

impl fmt::Display for BusAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            BusAddress::Device(path) => write!(f, "{}", path.display()),
            BusAddress::Pi(number) => write!(f, "pi:{number}"),
            BusAddress::Fake(path) => write!(f, "fake:{}", path.display()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_and_written_alike() {
        for text in ["/dev/i2c-1", "pi:3", "fake:/tmp/state.json"] {
            assert_eq!(text.parse::<BusAddress>().unwrap().to_string(), text);
        }
        assert_eq!("22".parse::<BusAddress>().unwrap().to_string(), "/dev/i2c-22");
        for wrong in ["", "i2c", "pi:", "pi:x", "fake:", "-1", "1:2", "70000", "\u{1b}[31m"] {
            let error = wrong.parse::<BusAddress>().unwrap_err();
            assert!(!error.to_string().chars().any(char::is_control), "{error:?}");
        }
    }

    #[test]
    fn a_bus_that_is_not_there_is_a_sentence_with_advice() {
        let error = I2cError::Open { bus: "/dev/i2c-9".into(), why: "No such file or directory (os error 2)".into() };
        assert!(error.to_string().contains("/dev/i2c-9") && error.to_string().contains("modprobe i2c-dev"), "{error}");
    }
}
