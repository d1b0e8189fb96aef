//! A TCP port of this machine, one client at a time; the next waits in the queue of the system.

use std::io::{self, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::os::fd::AsFd;
use std::time::Duration;

use super::{Happened, Line, readable};

/// A listening port with its client, if there is one.
#[derive(Debug)]
pub(super) struct Tcp {
    listener: Option<TcpListener>,
    client: Option<TcpStream>,
    address: SocketAddr,
}

impl Tcp {
    pub(super) fn open(address: SocketAddr) -> io::Result<Tcp> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        let address = listener.local_addr()?;
        Ok(Tcp { listener: Some(listener), client: None, address })
    }

    fn accept(&mut self, most: Duration) -> io::Result<Happened> {
        let Some(listener) = &self.listener else { return Ok(Happened::Nothing) };
        if !readable(listener.as_fd(), most)? {
            return Ok(Happened::Nothing);
        }
        // A client that has already gone again is no failure of ours.
        let Ok((client, _)) = listener.accept() else { return Ok(Happened::Nothing) };
        client.set_nonblocking(true)?;
        client.set_nodelay(true)?;
        self.client = Some(client);
        Ok(Happened::Came)
    }
}

impl Line for Tcp {
    fn endpoint(&self) -> String {
        format!("tcp:{}", self.address)
    }

    fn wait(&mut self, most: Duration, room: usize) -> io::Result<Happened> {
        let Some(client) = &mut self.client else { return self.accept(most) };
        if room == 0 {
            std::thread::sleep(most.min(Duration::from_millis(1)));
            return Ok(Happened::Nothing);
        }
        if !readable(client.as_fd(), most)? {
            return Ok(Happened::Nothing);
        }
        let mut bytes = vec![0; room.min(4096)];
        match client.read(&mut bytes) {
            Ok(0) => {}
            Ok(count) => {
                bytes.truncate(count);
                return Ok(Happened::Bytes(bytes));
            }
            Err(error) if matches!(error.kind(), io::ErrorKind::WouldBlock | io::ErrorKind::Interrupted) => {
                return Ok(Happened::Nothing);
            }
            Err(_reset) => {}
        }
        self.client = None;
        Ok(Happened::Left)
    }

    fn send(&mut self, bytes: &[u8]) {
        // A client that does not read, or has gone, loses the bytes, as on a serial line; the next read finds out.
        if let Some(client) = &mut self.client {
            let _ = client.write(bytes);
        }
    }

    fn unplug(&mut self) -> io::Result<()> {
        self.client = None;
        self.listener = None;
        Ok(())
    }

    fn replug(&mut self) -> io::Result<()> {
        *self = Tcp::open(self.address)?;
        Ok(())
    }
}
