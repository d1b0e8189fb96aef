//! The simulator as a port inside the program: no system, no clock of its own.

use std::collections::VecDeque;
use std::time::Duration;

use super::Simulator;
use crate::hw::port::{Port, PortError};

/// A line to a simulator in the same process. Time is what [`Port::set_now`] says.
#[derive(Debug)]
pub struct SimulatedPort {
    simulator: Simulator,
    now: Duration,
    /// What has arrived and was not yet asked for.
    waiting: VecDeque<u8>,
}

impl SimulatedPort {
    /// Opens a line to this simulator.
    #[must_use]
    pub fn new(mut simulator: Simulator) -> SimulatedPort {
        simulator.client_came(Duration::ZERO);
        SimulatedPort { simulator, now: Duration::ZERO, waiting: VecDeque::new() }
    }

    /// The simulator behind the line.
    pub fn simulator(&mut self) -> &mut Simulator {
        &mut self.simulator
    }

    fn unplugged(&self) -> PortError {
        PortError::Unplugged { name: "the simulated mount".into(), why: "the fault `unplug` is on".into() }
    }
}

impl Port for SimulatedPort {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        if !self.simulator.plugged(self.now) {
            return Err(self.unplugged());
        }
        self.waiting.extend(self.simulator.drain(self.now));
        let count = buffer.len().min(self.waiting.len());
        for (place, byte) in buffer.iter_mut().zip(self.waiting.drain(..count)) {
            *place = byte;
        }
        Ok(count)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        if !self.simulator.plugged(self.now) {
            return Err(self.unplugged());
        }
        let count = bytes.len().min(self.simulator.room());
        self.simulator.feed(&bytes[..count], self.now);
        Ok(count)
    }

    fn set_now(&mut self, now: Duration) {
        self.now = self.now.max(now);
    }
}
