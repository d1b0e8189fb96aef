//! The pump that joins driver and port, and opens the port again for ever.
//!
//! A thread turns it in a session (`Pump::step` waits for bytes no longer than the port does, a few milliseconds); a test
//! turns it with a virtual clock.

use std::os::fd::OwnedFd;
use std::time::Duration;

use super::address::MountAddress;
use super::belief::Belief;
use super::command::STOP;
use super::driver::{Driver, Ours, Settings, Timing};
use super::order::{Order, Report};
use crate::hw::port::{Port, PortError};
use crate::hw::serial::{SerialLine, stable_name};
use crate::hw::tcp::TcpLine;
use crate::numerics::streams::Stream;

/// Opens a line to the mount; called again after each loss.
pub type Opener = Box<dyn FnMut() -> Result<Box<dyn Port>, PortError> + Send>;

/// The opener of a real line; `None` for the embedded simulator, whose opener knows site and time.
///
/// A serial port is remembered by its name under /dev/serial/by-id, which stays when its number changes.
#[must_use]
pub fn opener(address: &MountAddress) -> Option<Opener> {
    match address.clone() {
        MountAddress::Sim => None,
        MountAddress::Serial { path, baud } => {
            let mut stable = path;
            Some(Box::new(move || {
                stable = stable_name(&stable);
                Ok(Box::new(SerialLine::open(&stable, baud)?))
            }))
        }
        MountAddress::Tcp { host, port } => Some(Box::new(move || Ok(Box::new(TcpLine::open(&host, port)?)))),
    }
}

/// The timing that a line needs.
#[must_use]
pub fn timing(address: &MountAddress) -> Timing {
    match address {
        MountAddress::Tcp { .. } => Timing::TCP,
        MountAddress::Sim | MountAddress::Serial { .. } => Timing::SERIAL,
    }
}

/// What one step of the pump brought: the belief after it and everything reported in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Update {
    /// When (since the program started).
    pub at: Duration,
    /// What is believed now.
    pub belief: Belief,
    /// What was reported, oldest first.
    pub reports: Vec<Report>,
}

/// The first pause before a lost port is opened again; each further one is twice as long, up to [`LONGEST_PAUSE`].
const FIRST_PAUSE: Duration = Duration::from_millis(250);
const LONGEST_PAUSE: Duration = Duration::from_secs(10);
/// A line that was good for so long begins with the first pause again.
const HEALTHY: Duration = Duration::from_secs(30);
/// Bytes that the port does not take: more than a stop and a command mean that it takes none.
const MOST_UNSENT: usize = 256;

/// A driver with its port, moved by [`Pump::step`].
pub struct Pump {
    driver: Driver,
    opener: Opener,
    port: Option<Box<dyn Port>>,
    unsent: Vec<u8>,
    open_at: Duration,
    opened_at: Duration,
    pause: Duration,
    tries: u32,
    opened_before: bool,
    jitter: Stream,
}

impl Pump {
    /// A pump whose port is opened at its first step.
    #[must_use]
    pub fn new(settings: Settings, opener: Opener) -> Pump {
        Pump {
            driver: Driver::new(settings),
            opener,
            port: None,
            unsent: Vec::new(),
            open_at: Duration::ZERO,
            opened_at: Duration::ZERO,
            pause: FIRST_PAUSE,
            tries: 0,
            opened_before: false,
            jitter: Stream::seeded(0x006c_7832_3030),
        }
    }

    /// Moves bytes both ways and lets time pass; `None` when nothing was reported.
    pub fn step(&mut self, now: Duration) -> Option<Update> {
        if self.port.is_none() && now >= self.open_at {
            self.open(now);
        }
        if let Err(why) = self.exchange(now) {
            self.lose(now);
            self.driver.link_lost(why, now);
        } else if self.driver.wants_reopening() && self.port.is_some() {
            self.lose(now);
        }
        let reports: Vec<Report> = std::iter::from_fn(|| self.driver.poll()).collect();
        (!reports.is_empty()).then(|| Update { at: now, belief: self.driver.belief().clone(), reports })
    }

    /// Gives an order. A stop is on its way to the port before this returns.
    pub fn order(&mut self, order: Order, now: Duration) {
        self.driver.order(order, now);
        if let Err(why) = self.write() {
            self.lose(now);
            self.driver.link_lost(why, now);
        }
    }

    /// Forgets all that is believed and asks anew: after a suspend, or when our clock or site has changed.
    pub fn forget(&mut self, ours: Ours, now: Duration) {
        self.driver.forget(ours, now);
    }

    /// The session ends: motion of ours is stopped, as well as the port still takes it.
    pub fn farewell(&mut self) {
        let belief = self.driver.belief();
        if belief.slewing_by_order() || belief.moving_by_order || belief.stopping {
            for _twice in 0..2 {
                self.unsent.extend(STOP);
                // The port may have gone: there is nothing more that this program can do then.
                let _ = self.write();
            }
        }
    }

    /// When [`Pump::step`] wants to be called at the latest, if no bytes come.
    #[must_use]
    pub fn wake_at(&self) -> Duration {
        if self.port.is_none() { self.open_at.min(self.driver.wake_at()) } else { self.driver.wake_at() }
    }

    /// Whether a port is open.
    #[must_use]
    pub fn is_open(&self) -> bool {
        self.port.is_some()
    }

    /// A duplicate of the open line for a supervisor; `None` when no port is open, or it has no file.
    #[must_use]
    pub fn duplicate_line(&self) -> Option<OwnedFd> {
        self.port.as_ref().and_then(|port| port.duplicate())
    }

    /// The driver.
    #[must_use]
    pub fn driver(&self) -> &Driver {
        &self.driver
    }

    fn open(&mut self, now: Duration) {
        match (self.opener)() {
            Ok(mut port) => {
                port.set_now(now);
                self.port = Some(port);
                self.opened_at = now;
                self.tries = 0;
                if std::mem::replace(&mut self.opened_before, true) {
                    self.driver.count_reconnect();
                }
                self.driver.link_opened(now);
            }
            Err(why) => {
                self.tries += 1;
                let retry_in = self.back_off(now);
                self.driver.report_line(Report::StillLost { why, tries: self.tries, retry_in });
            }
        }
    }

    /// Writes what the driver has, reads what has come, and writes what the driver has to that.
    fn exchange(&mut self, now: Duration) -> Result<(), PortError> {
        self.driver.tick(now);
        self.write()?;
        let Some(port) = &mut self.port else { return Ok(()) };
        port.set_now(now);
        let mut buffer = [0; 512];
        for _at_most in 0..8 {
            let count = port.receive(&mut buffer)?;
            if count == 0 {
                break;
            }
            self.driver.feed(&buffer[..count], now);
            if count < buffer.len() {
                break;
            }
        }
        self.write()
    }

    fn write(&mut self) -> Result<(), PortError> {
        let Some(port) = &mut self.port else { return Ok(()) };
        self.unsent.extend(self.driver.drain());
        if self.unsent.is_empty() {
            return Ok(());
        }
        let sent = port.send(&self.unsent)?.min(self.unsent.len());
        self.unsent.drain(..sent);
        if self.unsent.len() > MOST_UNSENT {
            let why = "it takes no more bytes".into();
            return Err(PortError::Unplugged { name: "the line to the mount".into(), why });
        }
        Ok(())
    }

    /// Closes the port; it is opened again after a pause.
    fn lose(&mut self, now: Duration) {
        self.port = None;
        self.unsent.clear();
        if now.saturating_sub(self.opened_at) >= HEALTHY {
            self.pause = FIRST_PAUSE;
        }
        self.back_off(now);
    }

    /// The pause before the next try: a quarter of it is chance, so that two programs do not try in step.
    fn back_off(&mut self, now: Duration) -> Duration {
        let pause = self.pause.mul_f64(0.75 + 0.25 * self.jitter.uniform());
        self.pause = (self.pause * 2).min(LONGEST_PAUSE);
        self.open_at = now + pause;
        pause
    }
}
