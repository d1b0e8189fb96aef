//! The line at 9600 baud, both ways, and what goes wrong on it.

mod garble;

use std::collections::VecDeque;
use std::time::Duration;

use super::answer::Answer;
use super::fault::{Faults, Span};
use super::settings::Settings;
use crate::numerics::streams::Stream;

/// One byte at 9600 baud, 8N1: ten bits.
pub(super) const BYTE: Duration = Duration::from_nanos(1_041_667);
/// How often a USB adapter hands on what it has.
const USB_PERIOD: Duration = Duration::from_millis(16);
/// A busy mount says so within 10 ms.
const NAK_WITHIN_S: f64 = 0.010;
/// What the mount keeps of commands that it has not got to; what is more is lost.
const INCOMING_MOST: usize = 4096;
/// What waits to be sent; a client that never reads loses the rest.
const OUTGOING_MOST: usize = 16_384;
/// How long the port stays away when a command took it.
const UNPLUGGED: Duration = Duration::from_secs(2);

/// The line between computer and mount. Half-duplex as the firmware is: a command waits until the reply before it is out.
#[derive(Debug)]
pub(super) struct Wire {
    /// Bytes under way to the mount, with the time when each is complete.
    incoming: VecDeque<(Duration, u8)>,
    /// When the last byte to the mount is complete.
    incoming_free: Duration,
    /// Bytes to the computer, with the time when each can be read.
    outgoing: VecDeque<(Duration, u8)>,
    /// When the last byte to the computer is out.
    outgoing_free: Duration,
    /// Until when the mount is occupied with its reply.
    busy_until: Duration,
    /// Held back until the next byte arrives, or until the next reply.
    held: Vec<u8>,
    glued: Vec<u8>,
    previous: Vec<u8>,
    nak_left: u32,
    flood_left: usize,
    flood_at: Duration,
    broken: bool,
    unplugged: Option<Span>,
    /// What was under way when the plug was pulled has been lost.
    pulled: bool,
    unplug_at: Option<Vec<u8>>,
    random: Stream,
    delay: (Duration, Duration),
    usb_batching: bool,
    faults: Faults,
}

impl Wire {
    pub(super) fn new(settings: &Settings) -> Wire {
        let faults = settings.faults.clone();
        Wire {
            incoming: VecDeque::new(),
            incoming_free: Duration::ZERO,
            outgoing: VecDeque::new(),
            outgoing_free: Duration::ZERO,
            busy_until: Duration::ZERO,
            held: Vec::new(),
            glued: Vec::new(),
            previous: Vec::new(),
            nak_left: 0,
            flood_left: faults.flood.map_or(0, |(_, bytes)| bytes),
            flood_at: faults.flood.map_or(Duration::ZERO, |(at, _)| at),
            broken: false,
            unplugged: faults.unplug,
            pulled: false,
            unplug_at: faults.unplug_at.clone().map(String::into_bytes),
            random: Stream::seeded(settings.seed ^ 0x7769_7265),
            delay: settings.reply_delay,
            usb_batching: settings.usb_batching,
            faults,
        }
    }

    pub(super) fn room(&self) -> usize {
        INCOMING_MOST.saturating_sub(self.incoming.len())
    }

    /// Bytes from the computer: each takes its time on the line.
    pub(super) fn arrive(&mut self, bytes: &[u8], now: Duration) {
        if !self.plugged(now) {
            return;
        }
        for byte in bytes.iter().take(self.room()) {
            self.incoming_free = self.incoming_free.max(now) + BYTE;
            self.incoming.push_back((self.incoming_free, *byte));
        }
    }

    /// The byte that the mount hears at `at`, if one is complete by then.
    pub(super) fn hear(&mut self, at: Duration) -> Option<u8> {
        if self.heard_at()? > at {
            return None;
        }
        let (_, byte) = self.incoming.pop_front()?;
        if self.broken_at(at) {
            return None;
        }
        if self.faults.looped || self.faults.echo {
            self.send_raw(&[byte], at);
        }
        if self.faults.looped {
            return None;
        }
        if !self.held.is_empty() {
            let held = std::mem::take(&mut self.held);
            self.send(&held, at);
        }
        Some(self.misheard(byte))
    }

    /// When the next byte on its way will be heard: not before the mount is done with its reply.
    pub(super) fn heard_at(&self) -> Option<Duration> {
        self.incoming.front().map(|(at, _)| (*at).max(self.busy_until))
    }

    /// The port goes when the command is heard that takes it.
    pub(super) fn command_heard(&mut self, body: &[u8], at: Duration) {
        if self.unplug_at.as_ref().is_some_and(|beginning| body.starts_with(beginning)) {
            self.unplug_at = None;
            self.unplugged = Some(Span { from: at, lasts: UNPLUGGED });
            self.pulled = false;
        }
    }

    /// Sends a reply, which begins some milliseconds after `at`.
    pub(super) fn reply(&mut self, answer: Answer, at: Duration) {
        if self.silent(at) {
            return;
        }
        self.busy_until = self.busy_until.max(at + Duration::from_millis(1));
        if answer.parts.is_empty() {
            return;
        }
        let (shortest, longest) = self.delay;
        let wait = shortest + longest.saturating_sub(shortest).mul_f64(self.random.uniform()) + self.faults.delay;
        let mut start = at + wait;
        let parts = answer.parts.len();
        for (number, (after, bytes)) in answer.parts.into_iter().enumerate() {
            start = start.max(self.outgoing_free) + after;
            if answer.held && number + 1 == parts {
                self.held = bytes;
                self.held.truncate(OUTGOING_MOST);
            } else {
                self.spoken(bytes, start);
            }
        }
        self.busy_until = self.busy_until.max(self.outgoing_free);
    }

    fn silent(&self, at: Duration) -> bool {
        self.faults.silence.is_some_and(|span| span.holds(at))
    }

    /// A busy mount answers a command with NAK and does not obey it.
    pub(super) fn busy(&mut self, at: Duration) -> bool {
        if self.nak_left == 0 && self.faults.nak > 0.0 && self.random.chance(self.faults.nak) {
            self.nak_left = 1 + u32::from(self.random.byte() % 3);
        }
        if self.nak_left == 0 {
            return false;
        }
        self.nak_left -= 1;
        let after = Duration::from_secs_f64(self.random.uniform() * NAK_WITHIN_S);
        if !self.silent(at) {
            self.send(&[0x15], at + after);
            self.busy_until = self.outgoing_free;
        }
        true
    }

    /// Puts bytes on the line from `start` on, one after the other, with the faults of each byte.
    fn send(&mut self, bytes: &[u8], start: Duration) {
        for byte in bytes {
            if self.random.chance(self.faults.drop) {
                continue;
            }
            if self.random.chance(self.faults.insert) {
                let extra = self.random.byte();
                self.send_raw(&[extra], start);
            }
            let sent = self.misread(*byte);
            self.send_raw(&[sent], start);
            if self.random.chance(self.faults.duplicate) {
                self.send_raw(&[sent], start);
            }
        }
    }

    fn send_raw(&mut self, bytes: &[u8], start: Duration) {
        for byte in bytes {
            let done = self.outgoing_free.max(start) + BYTE;
            self.outgoing_free = done;
            if self.outgoing.len() < OUTGOING_MOST && !self.broken_at(done) {
                self.outgoing.push_back((self.batched(done), *byte));
            }
        }
    }

    fn batched(&self, at: Duration) -> Duration {
        if !self.usb_batching {
            return at;
        }
        let periods = at.as_millis().div_ceil(USB_PERIOD.as_millis());
        Duration::from_millis(u64::try_from(periods * USB_PERIOD.as_millis()).unwrap_or(u64::MAX)).max(at)
    }

    /// When something happens on the line by itself.
    pub(super) fn next_event(&self) -> Option<Duration> {
        let flood = (self.flood_left > 0).then_some(self.flood_at);
        let broken = self.faults.line_break.filter(|_| !self.broken).map(|span| span.from);
        let unplugged = self.unplugged.filter(|_| !self.pulled).map(|span| span.from);
        [flood, broken, unplugged].into_iter().flatten().min()
    }

    /// What happens on the line by itself at `at`.
    pub(super) fn happen(&mut self, at: Duration) {
        let begun = |span: Option<Span>| span.is_some_and(|span| span.from <= at);
        if !self.broken && begun(self.faults.line_break) {
            self.outgoing.push_back((at, 0));
            self.broken = true;
        }
        if !self.pulled && begun(self.unplugged) {
            // What was under way is lost, both ways; what had arrived has arrived.
            self.pulled = true;
            self.incoming.clear();
            self.outgoing.retain(|(out, _)| *out <= at);
            self.held.clear();
            self.glued.clear();
        }
        if self.flood_left > 0 && self.flood_at <= at {
            self.flood_left -= 1;
            let byte = self.random.byte();
            self.send_raw(&[if byte == b'#' { b'!' } else { byte }], at);
            self.flood_at = self.outgoing_free;
        }
    }

    fn broken_at(&self, at: Duration) -> bool {
        self.faults.line_break.is_some_and(|span| span.holds(at))
    }

    pub(super) fn sent(&mut self, now: Duration) -> Vec<u8> {
        let ready = self.outgoing.iter().take_while(|(at, _)| *at <= now).count();
        self.outgoing.drain(..ready).map(|(_, byte)| byte).collect()
    }

    /// When the first byte that waits to be sent is out.
    pub(super) fn first_to_send(&self) -> Option<Duration> {
        self.outgoing.front().map(|(at, _)| *at)
    }

    pub(super) fn client_came(&mut self, now: Duration) {
        if self.faults.stale {
            self.send(b"+37\xDF17:16#05:2", now);
        }
    }

    pub(super) fn client_left(&mut self) {
        self.outgoing.clear();
        self.held.clear();
        self.glued.clear();
    }

    pub(super) fn plugged(&self, now: Duration) -> bool {
        !self.unplugged.is_some_and(|span| span.holds(now))
    }
}
