//! Which mount, and over which line.

use std::fmt;
use std::str::FromStr;

/// The mount that is wanted: `sim`, `serial:PATH[@BAUD]` or `tcp:HOST:PORT`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum MountAddress {
    /// The embedded simulator.
    Sim,
    /// A serial port: give the name under /dev/serial/by-id, which stays when the number changes.
    Serial {
        /// Path of the device.
        path: String,
        /// Bits a second; 9600 unless the mount was told otherwise.
        baud: u32,
    },
    /// A bridge that carries the serial line over TCP.
    Tcp {
        /// Name or number of the host.
        host: String,
        /// Port, 4030 by custom.
        port: u16,
    },
}

/// Why an address was refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is not a mount: write sim, serial:/dev/serial/by-id/NAME, serial:/dev/ttyUSB0@9600, or tcp:HOST:4030")]
pub struct AddressError(String);

impl FromStr for MountAddress {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<MountAddress, AddressError> {
        let refused = || AddressError(text.chars().filter(|c| !c.is_control()).take(80).collect());
        match text.split_once(':') {
            None if text == "sim" => Ok(MountAddress::Sim),
            Some(("serial", rest)) => {
                let (path, baud) = match rest.rsplit_once('@') {
                    Some((path, baud)) => (path, baud.parse().map_err(|_not_a_number| refused())?),
                    None => (rest, 9600),
                };
                if path.is_empty() || baud == 0 {
                    return Err(refused());
                }
                Ok(MountAddress::Serial { path: path.into(), baud })
            }
            Some(("tcp", rest)) => {
                let (host, port) = rest.rsplit_once(':').ok_or_else(refused)?;
                let port = port.parse().map_err(|_not_a_number| refused())?;
                if host.is_empty() || port == 0 {
                    return Err(refused());
                }
                Ok(MountAddress::Tcp { host: host.trim_matches(['[', ']']).into(), port })
            }
            _ => Err(refused()),
        }
    }
}

impl fmt::Display for MountAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            MountAddress::Sim => f.write_str("sim"),
            MountAddress::Serial { path, baud: 9600 } => write!(f, "serial:{path}"),
            MountAddress::Serial { path, baud } => write!(f, "serial:{path}@{baud}"),
            MountAddress::Tcp { host, port } if host.contains(':') => write!(f, "tcp:[{host}]:{port}"),
            MountAddress::Tcp { host, port } => write!(f, "tcp:{host}:{port}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_written_as_it_is_read() {
        for text in [
            "sim",
            "serial:/dev/ttyUSB0",
            "serial:/dev/serial/by-id/usb-FTDI_A1@19200",
            "tcp:10.0.0.1:4030",
            "tcp:[::1]:4030",
        ] {
            assert_eq!(text.parse::<MountAddress>().unwrap().to_string(), text);
        }
    }

    #[test]
    fn what_is_no_address_is_refused_with_the_forms_that_are() {
        for text in [
            "",
            "simulator",
            "serial:",
            "serial:/dev/x@fast",
            "serial:/dev/x@0",
            "tcp:host",
            "tcp::4030",
            "tcp:h:99999",
            "usb:1",
        ] {
            assert!(text.parse::<MountAddress>().unwrap_err().to_string().contains("tcp:HOST:4030"), "{text}");
        }
    }
}
