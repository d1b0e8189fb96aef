//! The protocol as a state machine without I/O: bytes in, bytes out, a clock handed in.

use std::collections::VecDeque;
use std::time::Duration;

use super::belief::{Belief, LinkState};
use super::order::{Order, Report};
use crate::hw::port::PortError;
use crate::sky::site::Site;
use crate::sky::time::Utc;

/// What we know of place and time without the mount.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ours {
    /// Our clock's UTC when "now" was zero.
    pub utc_at_start: Utc,
    /// Our site, if we have one.
    pub site: Option<Site>,
}

/// How long to wait for what.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Timing {
    /// From the command to the first byte of its reply.
    pub first_byte: Duration,
    /// From one byte of a reply to the next.
    pub next_byte: Duration,
}

impl Timing {
    /// For a serial line: a reply begins within 50 ms and a USB adapter adds 16 ms; ten times that is a fault.
    pub const SERIAL: Timing = Timing { first_byte: Duration::from_millis(500), next_byte: Duration::from_millis(100) };
    /// For a bridge over TCP: its round trip is 100 to 280 ms, and a reply may be split over two packets.
    pub const TCP: Timing = Timing { first_byte: Duration::from_millis(1500), next_byte: Duration::from_millis(300) };
}

/// What the driver needs to be told once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// How long to wait for what.
    pub timing: Timing,
    /// A move by hand that is not renewed ends after this.
    pub move_bound: Duration,
    /// Place and time without the mount.
    pub ours: Ours,
}

impl Settings {
    /// The usual settings for a line.
    #[must_use]
    pub fn new(timing: Timing, ours: Ours) -> Settings {
        Settings { timing, move_bound: Duration::from_millis(1000), ours }
    }
}

/// The driver: feed it bytes and time, write what it drains, read what it reports.
#[derive(Debug)]
pub struct Driver {
    settings: Settings,
    belief: Belief,
    reports: VecDeque<Report>,
    out: Vec<u8>,
}

impl Driver {
    /// A driver without a line.
    #[must_use]
    pub fn new(settings: Settings) -> Driver {
        Driver { settings, belief: Belief::default(), reports: VecDeque::new(), out: Vec::new() }
    }

    /// Takes bytes that came from the mount.
    pub fn feed(&mut self, bytes: &[u8], now: Duration) {
        let _ = (bytes, now);
    }

    /// Lets time pass.
    pub fn tick(&mut self, now: Duration) {
        let _ = now;
    }

    /// The bytes to write now; they are handed out once.
    #[must_use]
    pub fn drain(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.out)
    }

    /// The next report.
    pub fn poll(&mut self) -> Option<Report> {
        self.reports.pop_front()
    }

    /// Takes an order.
    pub fn order(&mut self, order: Order, now: Duration) {
        let _ = (order, now);
    }

    /// Everything believed of the mount.
    #[must_use]
    pub fn belief(&self) -> &Belief {
        &self.belief
    }

    /// When [`Driver::tick`] wants to be called at the latest.
    #[must_use]
    pub fn wake_at(&self) -> Duration {
        Duration::ZERO
    }

    /// The port is open: find out who is there.
    pub fn link_opened(&mut self, now: Duration) {
        let _ = (now, self.settings);
        self.belief.link = LinkState::Connecting;
    }

    /// The port is gone.
    pub fn link_lost(&mut self, why: PortError, now: Duration) {
        let _ = now;
        self.belief.link = LinkState::Closed;
        self.reports.push_back(Report::Lost(why));
    }

    /// Forgets everything believed: after a suspend, or when our own clock or site has changed.
    pub fn forget(&mut self, ours: Ours, now: Duration) {
        let _ = now;
        self.settings.ours = ours;
        self.belief = Belief { link: self.belief.link, counters: self.belief.counters, ..Belief::default() };
    }
}
