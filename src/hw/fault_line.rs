//! A bad cable: a port around a port that loses, delays and mistakes bytes, and comes out of its socket, all by a seed.
//!
//! ```text
//! driver <-> FaultLine <-> port       Cable: the spells, the seed, the ledger; it outlives the ports
//! ```
//!
//! It stands between any two ports, under a virtual clock or a real one (`Port::set_now` tells it which), and can pace the
//! bytes to a baud rate, which no pseudo terminal does. It knows no protocol: a reply is what comes in after something
//! was sent, or after a pause.

mod bytes;
mod cable;
mod mischief;
mod replies;
#[cfg(test)]
mod tests;

use std::collections::VecDeque;
use std::time::Duration;

pub use self::cable::{Cable, Ledger};
pub use self::mischief::{MENU, Mischief, Side, Spell, When};

use self::cable::Active;
use self::replies::Replies;
use super::port::{Port, PortError};

/// What the port takes before it is full, as a serial driver's buffer.
const ROOM: usize = 4096;
/// A device restarted by DTR is deaf for so long.
const RESTART: Duration = Duration::from_secs(2);

/// An open line through a [`Cable`].
#[derive(Debug)]
pub struct FaultLine<P> {
    port: P,
    cable: Cable,
    now: Duration,
    opened: Duration,
    /// What goes wrong now.
    active: Vec<Active>,
    /// Bytes sent, each with the time when its last bit is out.
    outgoing: VecDeque<(Duration, u8)>,
    outgoing_free: Duration,
    /// What was sent lately, for spells that wait for it.
    recent: Vec<u8>,
    /// Bytes that [`Mischief::Slow`] has let pass.
    let_pass: u64,
    replies: Replies,
    /// When the port behind was read last: it may wait for bytes, and need not while there are some here.
    read_at: Option<Duration>,
    gone: bool,
}

impl<P: Port> FaultLine<P> {
    fn new(cable: Cable, port: P, now: Duration) -> FaultLine<P> {
        let mut line = FaultLine {
            replies: Replies::new(cable.clone(), now),
            port,
            cable,
            now,
            opened: now,
            active: Vec::new(),
            outgoing: VecDeque::new(),
            outgoing_free: now,
            recent: Vec::new(),
            let_pass: 0,
            read_at: None,
            gone: false,
        };
        line.refresh();
        line
    }

    /// Takes in what the cable does now.
    fn refresh(&mut self) {
        self.active = self.cable.active();
        let port_taken =
            self.active.iter().find(|(mischief, ..)| mischief.takes_the_port()).map(|(mischief, ..)| *mischief);
        if let (Some(mischief), false) = (port_taken, self.gone) {
            self.gone = true;
            self.cable.strike(mischief);
        }
    }

    fn standing(&self) -> Result<(), PortError> {
        if !self.gone {
            return Ok(());
        }
        Err(PortError::Unplugged { name: "the cable".into(), why: "a spell has it out".into() })
    }

    fn find<T>(&self, wanted: impl Fn(Mischief) -> Option<T>) -> Option<(T, Duration)> {
        self.active.iter().find_map(|(mischief, _, since)| wanted(*mischief).map(|value| (value, *since)))
    }

    /// Whether the device is deaf and mute because opening has restarted it.
    fn restarting(&self) -> bool {
        self.now < self.opened + RESTART && self.find(|m| (m == Mischief::Reset).then_some(())).is_some()
    }

    fn byte_time(&self) -> Duration {
        self.cable.baud().map_or(Duration::ZERO, |baud| Duration::from_secs_f64(10.0 / f64::from(baud.max(1))))
    }

    /// How many of so many bytes the port takes now.
    fn room(&mut self, wanted: usize) -> usize {
        let room = wanted.min(ROOM.saturating_sub(self.outgoing.len()));
        let Some((per_s, since)) = self.find(|m| if let Mischief::Slow(per_s) = m { Some(per_s) } else { None }) else {
            self.let_pass = 0;
            return room;
        };
        let allowed = (f64::from(per_s) * self.now.saturating_sub(since).as_secs_f64()) as u64;
        let room = room.min(usize::try_from(allowed.saturating_sub(self.let_pass)).unwrap_or(room));
        if room < wanted {
            self.cable.strike(Mischief::Slow(per_s));
        }
        self.let_pass += room as u64;
        room
    }

    /// Puts one byte on its way out.
    fn put(&mut self, byte: u8) {
        let broken = self.find(|m| (m == Mischief::Break).then_some(())).is_some();
        if broken || self.restarting() {
            return;
        }
        if self.find(|m| (m == Mischief::Echo).then_some(())).is_some() {
            self.cable.strike(Mischief::Echo);
            self.replies.echo(byte, self.now, self.byte_time());
        }
        for sent in bytes::disturbed(byte, &self.active, Side::Commands, &self.cable, self.now) {
            self.outgoing_free = self.outgoing_free.max(self.now) + self.byte_time();
            self.outgoing.push_back((self.outgoing_free, sent));
        }
    }

    /// Takes in what the port behind has.
    fn read(&mut self, restarting: bool) -> Result<(), PortError> {
        let (mut chunk, byte_time) = ([0; 512], self.byte_time());
        loop {
            let count = self.port.receive(&mut chunk)?;
            for byte in &chunk[..count] {
                if !restarting {
                    self.replies.come(*byte, &self.active, self.now, byte_time);
                }
            }
            if count < chunk.len() {
                break;
            }
        }
        Ok(())
    }

    /// Hands on what is out by now.
    fn carry(&mut self) -> Result<(), PortError> {
        let due = self.outgoing.iter().take_while(|(at, _)| *at <= self.now).count();
        if due == 0 {
            return Ok(());
        }
        let bytes: Vec<u8> = self.outgoing.iter().take(due).map(|(_, byte)| *byte).collect();
        let taken = self.port.send(&bytes)?.min(due);
        self.outgoing.drain(..taken);
        Ok(())
    }
}

impl<P: Port> Port for FaultLine<P> {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        self.refresh();
        self.standing()?;
        self.carry()?;
        let restarting = self.restarting();
        if let Some(((), since)) = self.find(|m| (m == Mischief::Reset).then_some(()))
            && !restarting
        {
            self.replies.restarted(self.opened.max(since), self.now, &self.cable);
        }
        self.replies.by_themselves(&self.active, self.now);
        if self.read_at != Some(self.now) || !self.replies.has_some(self.now) {
            self.read_at = Some(self.now);
            self.read(restarting)?;
        }
        let count = self.replies.hand_on(buffer, self.now);
        if count > 0 && self.cable.provoked(&[], self.replies.in_this_reply()) {
            self.refresh();
        }
        Ok(count)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        self.refresh();
        self.standing()?;
        let room = self.room(bytes.len());
        for (index, byte) in bytes[..room].iter().enumerate() {
            self.put(*byte);
            self.recent.push(*byte);
            if self.recent.len() > 64 {
                self.recent.drain(..32);
            }
            if self.cable.provoked(&self.recent, 0) {
                // The cable comes out in the middle of what is being sent: what is out is out.
                self.carry()?;
                return Ok(index + 1);
            }
        }
        if room > 0 {
            self.replies.asked();
        }
        self.carry()?;
        Ok(room)
    }

    fn set_now(&mut self, now: Duration) {
        self.now = self.now.max(now);
        self.cable.set_now(now);
        self.port.set_now(now);
        // What is out by now is on its way whether or not anybody reads.
        self.refresh();
        if !self.gone {
            // A port that is lost says so at the next read.
            let _ = self.carry();
        }
    }

    fn duplicate(&self) -> Option<std::os::fd::OwnedFd> {
        self.port.duplicate()
    }
}
