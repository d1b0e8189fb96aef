//! The thread that owns the port, and the pump that it turns: port to driver, driver to port, reopened for ever.

use std::time::Duration;

use super::belief::Belief;
use super::driver::{Driver, Ours, Settings};
use super::order::{Order, Report};
use crate::hw::port::{Port, PortError};

/// Opens a line to the mount; called again after each loss.
pub type Opener = Box<dyn FnMut() -> Result<Box<dyn Port>, PortError> + Send>;

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

/// A driver with its port, moved by [`Pump::step`]: by a thread in a session, by a virtual clock in tests.
pub struct Pump {
    driver: Driver,
    opener: Opener,
    port: Option<Box<dyn Port>>,
}

impl Pump {
    /// A pump whose port is opened at its first step.
    #[must_use]
    pub fn new(settings: Settings, opener: Opener) -> Pump {
        Pump { driver: Driver::new(settings), opener, port: None }
    }

    /// Moves bytes both ways and lets time pass; `None` when nothing was reported.
    pub fn step(&mut self, now: Duration) -> Option<Update> {
        if self.port.is_none() {
            self.port = (self.opener)().ok();
            self.driver.link_opened(now);
        }
        self.driver.tick(now);
        let reports: Vec<Report> = std::iter::from_fn(|| self.driver.poll()).collect();
        (!reports.is_empty()).then(|| Update { at: now, belief: self.driver.belief().clone(), reports })
    }

    /// Gives an order.
    pub fn order(&mut self, order: Order, now: Duration) {
        self.driver.order(order, now);
    }

    /// Forgets all that is believed and asks anew: after a suspend.
    pub fn forget(&mut self, ours: Ours, now: Duration) {
        self.driver.forget(ours, now);
    }

    /// When [`Pump::step`] wants to be called at the latest, if no bytes come.
    #[must_use]
    pub fn wake_at(&self) -> Duration {
        self.driver.wake_at()
    }

    /// The driver.
    #[must_use]
    pub fn driver(&self) -> &Driver {
        &self.driver
    }
}
