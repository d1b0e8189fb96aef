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
/// A port of this machine is looked for this often at least: looking costs nothing, and one that is back must be spoken on
/// again within two seconds.
const LOOK_AGAIN: Duration = Duration::from_millis(500);
/// A stop whose first command the port has not taken after this is not on its way: the alarm is due.
const STOP_TAKEN: Duration = Duration::from_millis(20);
/// Bytes of the stop behind its first command, `#:Q#`.
const BEHIND_THE_STOP: usize = STOP.len() - 4;
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
    tell_at: Duration,
    opened_before: bool,
    /// When the port must have taken a stop.
    stop_by: Option<Duration>,
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
            tell_at: Duration::ZERO,
            opened_before: false,
            stop_by: None,
            jitter: Stream::seeded(0x006c_7832_3030),
        }
    }

    /// Moves bytes both ways and lets time pass; `None` when nothing was reported.
    pub fn step(&mut self, now: Duration) -> Option<Update> {
        if self.port.is_none() && now >= self.open_at {
            self.open(now);
        }
        if let Err(why) = self.exchange(now).and_then(|()| self.see_the_stop_off(now)) {
            self.lose(now, LOOK_AGAIN);
            self.driver.link_lost(why, now);
        } else if self.driver.wants_reopening() && self.port.is_some() {
            self.lose(now, LONGEST_PAUSE);
        }
        let reports: Vec<Report> = std::iter::from_fn(|| self.driver.poll()).collect();
        (!reports.is_empty()).then(|| Update { at: now, belief: self.driver.belief().clone(), reports })
    }

    /// Gives an order. A stop is on its way to the port before this returns, ahead of all that the port has not taken.
    pub fn order(&mut self, order: Order, now: Duration) {
        if order == Order::Stop {
            self.unsent.clear();
            self.stop_by = Some(now + STOP_TAKEN);
        }
        self.driver.order(order, now);
        if let Err(why) = self.write() {
            self.lose(now, LOOK_AGAIN);
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
        let line = if self.port.is_none() { self.open_at } else { self.stop_by.unwrap_or(Duration::MAX) };
        line.min(self.driver.wake_at())
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
                self.stop_by = self.driver.belief().stopping.then_some(now + STOP_TAKEN);
            }
            Err(why) => {
                self.tries += 1;
                let here =
                    matches!(why, PortError::NotThere { .. } | PortError::Held { .. } | PortError::Permission { .. });
                // Looked for often, told ever more seldom.
                if here && now < self.tell_at {
                    self.open_at = now + LOOK_AGAIN;
                    return;
                }
                self.tell_at = now + self.back_off(now, LONGEST_PAUSE);
                if here {
                    self.open_at = self.open_at.min(now + LOOK_AGAIN);
                }
                let retry_in = self.open_at - now;
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

    /// A port that does not take a stop is as good as lost: the alarm is shown, and the next line gets the stop first.
    fn see_the_stop_off(&mut self, now: Duration) -> Result<(), PortError> {
        if self.unsent.len() <= BEHIND_THE_STOP {
            self.stop_by = None;
        }
        match self.stop_by {
            Some(by) if self.port.is_some() && now >= by => {
                let why = "it does not take the stop".into();
                Err(PortError::Unplugged { name: "the line to the mount".into(), why })
            }
            _ => Ok(()),
        }
    }

    /// Closes the port; it is opened again after a pause of at most so long.
    fn lose(&mut self, now: Duration, at_most: Duration) {
        self.port = None;
        self.unsent.clear();
        self.stop_by = None;
        self.tell_at = now;
        if now.saturating_sub(self.opened_at) >= HEALTHY {
            self.pause = FIRST_PAUSE;
        }
        self.back_off(now, at_most);
    }

    /// The pause before the next try: a quarter of it is chance, so that two programs do not try in step.
    fn back_off(&mut self, now: Duration, at_most: Duration) -> Duration {
        let pause = self.pause.min(at_most).mul_f64(0.75 + 0.25 * self.jitter.uniform());
        self.pause = (self.pause * 2).min(LONGEST_PAUSE);
        self.open_at = now + pause;
        pause
    }
}

#[cfg(test)]
mod tests {
    use std::sync::{Arc, Mutex};

    use super::*;
    use crate::sky::time::Utc;

    /// A port that takes so many bytes, and keeps them.
    #[derive(Clone, Default)]
    struct Narrow(Arc<Mutex<(usize, Vec<u8>)>>);

    impl Narrow {
        fn widen(&self, bytes: usize) {
            self.0.lock().unwrap().0 = bytes;
        }
    }

    impl Port for Narrow {
        fn receive(&mut self, _buffer: &mut [u8]) -> Result<usize, PortError> {
            Ok(0)
        }

        fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
            let (room, taken) = &mut *self.0.lock().unwrap();
            let count = bytes.len().min(*room);
            *room -= count;
            taken.extend(&bytes[..count]);
            Ok(count)
        }
    }

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    fn pump(opener: Opener) -> Pump {
        Pump::new(Settings::new(Timing::SERIAL, Ours { utc_at_start: Utc(1_795_730_400.0), site: None }), opener)
    }

    #[test]
    fn a_stop_goes_ahead_of_bytes_that_the_port_has_not_taken() {
        let port = Narrow::default();
        let line = port.clone();
        let mut pump = pump(Box::new(move || Ok(Box::new(line.clone()))));
        // The probe of a new line waits in a port that takes nothing.
        (0..20).for_each(|turn| drop(pump.step(ms(10 * turn))));
        pump.order(Order::Stop, ms(200));
        port.widen(100);
        pump.step(ms(205));
        assert!(port.0.lock().unwrap().1.starts_with(b"#:Q#"), "{:?}", port.0.lock().unwrap().1);
    }

    #[test]
    fn a_stop_that_the_port_does_not_take_is_an_alarm_at_once_and_first_on_the_next_line() {
        let port = Narrow::default();
        let line = port.clone();
        let mut pump = pump(Box::new(move || Ok(Box::new(line.clone()))));
        (0..20).for_each(|turn| drop(pump.step(ms(10 * turn))));
        pump.order(Order::Stop, ms(200));
        let mut reports = Vec::new();
        for turn in 21..25 {
            reports.extend(pump.step(ms(10 * turn)).into_iter().flat_map(|update| update.reports));
        }
        assert!(reports.iter().any(|report| matches!(report, Report::StopNotObeyed { .. })), "{reports:?}");
        assert!(!pump.is_open());
        port.widen(100);
        (25..60).for_each(|turn| drop(pump.step(ms(10 * turn))));
        assert!(port.0.lock().unwrap().1.starts_with(b"#:Q#"));
    }

    #[test]
    fn a_port_that_is_not_there_is_looked_for_twice_a_second_and_told_ever_more_seldom() {
        let looks = Arc::new(Mutex::new(0));
        let counted = Arc::clone(&looks);
        let mut pump = pump(Box::new(move || {
            *counted.lock().unwrap() += 1;
            Err(PortError::NotThere { name: "ttyUSB0".into() })
        }));
        let told = (0..6000).filter(|turn| pump.step(ms(10 * turn)).is_some()).count();
        let looks = *looks.lock().unwrap();
        assert!((115..=130).contains(&looks), "{looks} looks in a minute");
        assert!((6..=14).contains(&told), "told {told} times in a minute");
    }
}
