//! The simulator as a port inside the program: no system, no clock of its own.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::Simulator;
use crate::hw::port::{Port, PortError};

/// A simulated mount that ports are opened to, one after the other: it goes on while none is open.
#[derive(Debug, Clone)]
pub struct SimulatedMount(Arc<Mutex<Shared>>);

#[derive(Debug)]
struct Shared {
    simulator: Simulator,
    now: Duration,
}

impl SimulatedMount {
    /// Takes a simulator in.
    #[must_use]
    pub fn new(simulator: Simulator) -> SimulatedMount {
        SimulatedMount(Arc::new(Mutex::new(Shared { simulator, now: Duration::ZERO })))
    }

    /// Opens a line to it.
    ///
    /// # Errors
    /// The fault `unplug` has the cable out.
    pub fn open(&self) -> Result<SimulatedPort, PortError> {
        let mut shared = self.lock();
        let now = shared.now;
        if !shared.simulator.plugged(now) {
            return Err(PortError::NotThere { name: "the simulated mount".into() });
        }
        shared.simulator.client_came(now);
        Ok(SimulatedPort { mount: self.clone(), waiting: VecDeque::new() })
    }

    /// Says what time it is (since the program started); open ports do that too.
    pub fn set_now(&self, now: Duration) {
        let mut shared = self.lock();
        shared.now = shared.now.max(now);
    }

    /// Looks at the simulator behind the lines.
    pub fn look<T>(&self, look: impl FnOnce(&mut Simulator) -> T) -> T {
        look(&mut self.lock().simulator)
    }

    fn lock(&self) -> MutexGuard<'_, Shared> {
        // Whoever panicked with the lock in hand has left a mount that is as good as any.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A line to a simulator in the same process. Time is what [`Port::set_now`] says.
#[derive(Debug)]
pub struct SimulatedPort {
    mount: SimulatedMount,
    /// What has arrived and was not yet asked for.
    waiting: VecDeque<u8>,
}

impl Port for SimulatedPort {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        let mut shared = self.mount.lock();
        let now = shared.now;
        if !shared.simulator.plugged(now) {
            return Err(unplugged());
        }
        if self.waiting.is_empty() {
            self.waiting.extend(shared.simulator.drain(now));
        }
        let count = buffer.len().min(self.waiting.len());
        for (place, byte) in buffer.iter_mut().zip(self.waiting.drain(..count)) {
            *place = byte;
        }
        Ok(count)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        let mut shared = self.mount.lock();
        let now = shared.now;
        if !shared.simulator.plugged(now) {
            return Err(unplugged());
        }
        let count = bytes.len().min(shared.simulator.room());
        shared.simulator.feed(&bytes[..count], now);
        Ok(count)
    }

    fn set_now(&mut self, now: Duration) {
        self.mount.set_now(now);
    }
}

impl Drop for SimulatedPort {
    fn drop(&mut self) {
        let mut shared = self.mount.lock();
        let now = shared.now;
        shared.simulator.client_left(now);
    }
}

fn unplugged() -> PortError {
    PortError::Unplugged { name: "the simulated mount".into(), why: "the fault `unplug` is on".into() }
}
