//! A bridge that carries a serial line over TCP, or a simulator that pretends to be one.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::os::fd::OwnedFd;
use std::time::Duration;

use super::port::{Port, PortError};

/// A connection that is not there by then is tried again later.
const CONNECT: Duration = Duration::from_secs(2);
/// A read waits this long for a first byte.
const PATIENCE: Duration = Duration::from_millis(10);
/// A name may have many addresses; so many are tried.
const MOST_ADDRESSES: usize = 3;

/// An open connection to a bridge.
#[derive(Debug)]
pub struct TcpLine {
    name: String,
    stream: TcpStream,
}

impl TcpLine {
    /// Connects, within two seconds for each address of the host.
    ///
    /// # Errors
    /// Nobody is there.
    pub fn open(host: &str, port: u16) -> Result<TcpLine, PortError> {
        let name = format!("{host}:{port}");
        let failed = |error: io::Error| PortError::NoConnection { name: name.clone(), why: error.to_string() };
        let mut last = io::Error::new(ErrorKind::NotFound, "the name has no address");
        for address in (host, port).to_socket_addrs().map_err(failed)?.take(MOST_ADDRESSES) {
            match TcpStream::connect_timeout(&address, CONNECT) {
                Ok(stream) => {
                    stream.set_nodelay(true).map_err(failed)?;
                    stream.set_read_timeout(Some(PATIENCE)).map_err(failed)?;
                    stream.set_write_timeout(Some(PATIENCE)).map_err(failed)?;
                    return Ok(TcpLine { name, stream });
                }
                Err(error) => last = error,
            }
        }
        Err(failed(last))
    }

    fn unplugged(&self, why: impl ToString) -> PortError {
        PortError::Unplugged { name: self.name.clone(), why: why.to_string() }
    }
}

impl Port for TcpLine {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        match self.stream.read(buffer) {
            Ok(0) => Err(self.unplugged("the bridge closed the connection")),
            Ok(count) => Ok(count),
            Err(error) if quiet(&error) => Ok(0),
            Err(error) => Err(self.unplugged(error)),
        }
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        match self.stream.write(bytes) {
            Ok(count) => Ok(count),
            Err(error) if quiet(&error) => Ok(0),
            Err(error) => Err(self.unplugged(error)),
        }
    }

    fn duplicate(&self) -> Option<OwnedFd> {
        self.stream.try_clone().ok().map(OwnedFd::from)
    }
}

fn quiet(error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::TimedOut | ErrorKind::WouldBlock | ErrorKind::Interrupted)
}

#[cfg(test)]
mod tests {
    use std::net::TcpListener;

    use super::*;

    #[test]
    fn bytes_pass_both_ways_and_a_closed_bridge_is_noticed() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let mut line = TcpLine::open("127.0.0.1", listener.local_addr().unwrap().port()).unwrap();
        let (mut bridge, _) = listener.accept().unwrap();
        let mut buffer = [0; 32];
        assert_eq!(line.receive(&mut buffer), Ok(0));
        assert_eq!(line.send(b"\x06"), Ok(1));
        let mut asked = [0; 1];
        bridge.read_exact(&mut asked).unwrap();
        bridge.write_all(b"A").unwrap();
        while line.receive(&mut buffer).unwrap() == 0 {}
        assert_eq!(buffer[0], b'A');
        drop(bridge);
        let lost = loop {
            match line.receive(&mut buffer) {
                Ok(_) => {}
                Err(lost) => break lost,
            }
        };
        assert!(matches!(lost, PortError::Unplugged { .. }));
    }

    #[test]
    fn nobody_there_is_said_with_the_address() {
        let unused = TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
        let Err(error) = TcpLine::open("127.0.0.1", unused) else { panic!("somebody answered") };
        assert!(error.to_string().contains(&format!("127.0.0.1:{unused}")), "{error}");
    }
}
