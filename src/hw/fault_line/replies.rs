//! What becomes of whole replies on the way in: cut, held up, exchanged, glued; and what comes unasked.

use std::collections::VecDeque;
use std::time::Duration;

use super::bytes;
use super::cable::{Active, Cable};
use super::mischief::{Mischief, Side};

/// After such a pause what comes is another reply, or packet.
const PAUSE: Duration = Duration::from_millis(30);
/// So much of a reply is remembered, to be mistaken for the next.
const REMEMBERED: usize = 256;
/// A GPS sentence without a fix, as a mount may send by itself.
const UNASKED: &[u8] = b"$GPRMC,235959.00,V,,,,,,,010100,,,N*7F\r\n";

/// The way in.
#[derive(Debug)]
pub(super) struct Replies {
    cable: Cable,
    /// Bytes with the time from which they can be read.
    incoming: VecDeque<(Duration, u8)>,
    free: Duration,
    last: Duration,
    /// The next byte begins a reply.
    fresh: bool,
    /// Bytes that have come in this reply, and that were handed on of it.
    come: usize,
    handed: usize,
    this: Vec<u8>,
    previous: Vec<u8>,
    swapping: bool,
    glued: Vec<u8>,
    gluing: bool,
    held_until: Duration,
    missed: usize,
    flooded: usize,
    broken: bool,
    booted: bool,
}

impl Replies {
    pub(super) fn new(cable: Cable, now: Duration) -> Replies {
        Replies {
            cable,
            incoming: VecDeque::new(),
            free: now,
            last: now,
            fresh: true,
            come: 0,
            handed: 0,
            this: Vec::new(),
            previous: Vec::new(),
            swapping: false,
            glued: Vec::new(),
            gluing: false,
            held_until: Duration::ZERO,
            missed: 0,
            flooded: 0,
            broken: false,
            booted: false,
        }
    }

    /// Something was sent: what comes now is its reply.
    pub(super) fn asked(&mut self) {
        self.fresh = true;
    }

    /// How many bytes of the reply under way have been handed on.
    pub(super) fn in_this_reply(&self) -> usize {
        self.handed
    }

    /// A byte that was sent comes back.
    pub(super) fn echo(&mut self, byte: u8, now: Duration, byte_time: Duration) {
        self.push(byte, now, byte_time);
    }

    /// A byte has come through the port.
    pub(super) fn come(&mut self, byte: u8, active: &[Active], now: Duration, byte_time: Duration) {
        if std::mem::take(&mut self.fresh) || now.saturating_sub(self.last) > PAUSE {
            self.begin(active, now, byte_time);
        }
        self.last = now;
        let find = |wanted: fn(Mischief) -> bool| active.iter().map(|(m, ..)| *m).find(|m| wanted(*m));
        if let Some(Mischief::MidPacket(most)) = find(|m| matches!(m, Mischief::MidPacket(_)))
            && self.missed < most
        {
            self.missed += 1;
            self.cable.strike(Mischief::MidPacket(most));
            return;
        }
        if find(|m| m == Mischief::Break).is_some() {
            return;
        }
        self.come += 1;
        if self.this.len() < REMEMBERED {
            self.this.push(byte);
        }
        if self.swapping {
            return;
        }
        if let Some(Mischief::Truncate(most)) = find(|m| matches!(m, Mischief::Truncate(_)))
            && self.come > most
        {
            self.cable.strike(Mischief::Truncate(most));
            return;
        }
        if let Some(Mischief::Stall(after, pause)) = find(|m| matches!(m, Mischief::Stall(..)))
            && self.come == after + 1
        {
            self.cable.strike(Mischief::Stall(after, pause));
            self.held_until = now + pause;
        }
        for come in bytes::disturbed(byte, active, Side::Replies, &self.cable, now) {
            if self.gluing && self.glued.len() < REMEMBERED {
                self.glued.push(come);
            } else {
                self.delayed(come, active, now, byte_time);
            }
        }
        if let Some(Mischief::Unasked(chance)) = find(|m| matches!(m, Mischief::Unasked(_)))
            && byte == b'#'
            && self.cable.chance(chance)
        {
            self.cable.strike(Mischief::Unasked(chance));
            for byte in UNASKED {
                self.delayed(*byte, active, now, byte_time);
            }
        }
    }

    /// A reply begins.
    fn begin(&mut self, active: &[Active], now: Duration, byte_time: Duration) {
        (self.come, self.handed) = (0, 0);
        self.previous = std::mem::take(&mut self.this);
        self.swapping = false;
        for byte in std::mem::take(&mut self.glued) {
            self.delayed(byte, active, now, byte_time);
        }
        self.gluing = false;
        for (mischief, ..) in active {
            match mischief {
                Mischief::Swap(chance) if !self.previous.is_empty() && self.cable.chance(*chance) => {
                    self.cable.strike(*mischief);
                    self.swapping = true;
                    for byte in self.previous.clone() {
                        self.delayed(byte, active, now, byte_time);
                    }
                }
                Mischief::Glue(chance) if self.cable.chance(*chance) => {
                    self.cable.strike(*mischief);
                    self.gluing = true;
                }
                _ => {}
            }
        }
    }

    fn delayed(&mut self, byte: u8, active: &[Active], now: Duration, byte_time: Duration) {
        let delay = active.iter().find_map(|(m, ..)| if let Mischief::Delay(by) = m { Some(*by) } else { None });
        if let Some(by) = delay {
            self.cable.strike(Mischief::Delay(by));
        }
        self.push(byte, (now + delay.unwrap_or_default()).max(self.held_until), byte_time);
    }

    fn push(&mut self, byte: u8, from: Duration, byte_time: Duration) {
        // What is behind another byte never overtakes it.
        let behind = self.incoming.back().map_or(Duration::ZERO, |(at, _)| *at);
        self.free = self.free.max(from) + byte_time;
        self.incoming.push_back((self.free.max(behind), byte));
    }

    /// A device that was restarted has finished its start.
    pub(super) fn restarted(&mut self, since: Duration, now: Duration, cable: &Cable) {
        if !std::mem::replace(&mut self.booted, true) && now >= since {
            cable.strike(Mischief::Reset);
            self.push(b'X', now, Duration::ZERO);
        }
    }

    /// What comes by itself: the flood, and the NUL of a line held low.
    pub(super) fn by_themselves(&mut self, active: &[Active], now: Duration) {
        let broken = active.iter().any(|(m, ..)| *m == Mischief::Break);
        if broken && !self.broken {
            self.cable.strike(Mischief::Break);
            self.incoming.clear();
            self.push(0, now, Duration::ZERO);
        }
        self.broken = broken;
        for (mischief, ..) in active {
            if let Mischief::Flood(most) = mischief
                && self.flooded < *most
                && self.incoming.len() < 512
            {
                self.cable.strike(*mischief);
                for _ in 0..(*most - self.flooded).min(512) {
                    self.flooded += 1;
                    let byte = self.cable.byte();
                    self.push(if byte == b'#' { b'!' } else { byte }, now, Duration::ZERO);
                }
            }
        }
    }

    /// Whether anything can be handed on now.
    pub(super) fn has_some(&self, now: Duration) -> bool {
        self.incoming.front().is_some_and(|(at, _)| *at <= now)
    }

    /// Hands on what has come by now.
    pub(super) fn hand_on(&mut self, buffer: &mut [u8], now: Duration) -> usize {
        let due = self.incoming.iter().take(buffer.len()).take_while(|(at, _)| *at <= now).count();
        for (place, (_, byte)) in buffer.iter_mut().zip(self.incoming.drain(..due)) {
            *place = byte;
        }
        self.handed += due;
        due
    }
}
