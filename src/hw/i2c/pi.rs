//! The bus of a Raspberry Pi, through rppal. The number is the one under `/dev/i2c-N`, which a DPI overlay may have moved.

use rppal::i2c::{Error, I2c};

use super::{I2cBus, I2cError};

/// An open bus of a Raspberry Pi (it opens on other Linux machines too).
#[derive(Debug)]
pub struct PiBus {
    number: u8,
    bus: I2c,
    address: Option<u8>,
}

impl PiBus {
    /// Opens the bus of that number.
    ///
    /// # Errors
    /// It is not there or not ours.
    pub fn open(number: u8) -> Result<PiBus, I2cError> {
        let bus = I2c::with_bus(number)
            .map_err(|error| I2cError::Open { bus: format!("/dev/i2c-{number}"), why: error.to_string() })?;
        // Units of the call are milliseconds; a transaction of these controllers takes less than one.
        // A driver without the setting keeps its own time-out.
        let _ = bus.set_timeout(100);
        Ok(PiBus { number, bus, address: None })
    }

    fn turn_to(&mut self, address: u8) -> Result<(), I2cError> {
        if self.address != Some(address) {
            self.bus.set_slave_address(u16::from(address)).map_err(|error| self.failed(address, &error))?;
            self.address = Some(address);
        }
        Ok(())
    }

    fn failed(&self, address: u8, error: &Error) -> I2cError {
        use rustix::io::Errno;
        let code = match error {
            Error::Io(error) => error.raw_os_error().map(Errno::from_raw_os_error),
            _ => None,
        };
        match code {
            Some(Errno::NXIO | Errno::REMOTEIO | Errno::IO) => I2cError::Nack { address },
            Some(Errno::TIMEDOUT | Errno::BUSY) => I2cError::Stuck,
            Some(Errno::AGAIN) => I2cError::Arbitration,
            _ => I2cError::Gone { bus: format!("pi:{}", self.number), why: error.to_string() },
        }
    }
}

impl I2cBus for PiBus {
    fn write(&mut self, address: u8, bytes: &[u8]) -> Result<(), I2cError> {
        self.turn_to(address)?;
        match self.bus.write(bytes) {
            Ok(count) if count == bytes.len() => Ok(()),
            Ok(got) => Err(I2cError::Short { wanted: bytes.len(), got }),
            Err(error) => Err(self.failed(address, &error)),
        }
    }

    fn read(&mut self, address: u8, buffer: &mut [u8]) -> Result<(), I2cError> {
        self.turn_to(address)?;
        match self.bus.read(buffer) {
            Ok(count) if count == buffer.len() => Ok(()),
            Ok(got) => Err(I2cError::Short { wanted: buffer.len(), got }),
            Err(error) => Err(self.failed(address, &error)),
        }
    }

    fn describe(&self) -> String {
        format!("I2C bus {} of the Raspberry Pi", self.number)
    }
}
