//! A made-up controller on a made-up bus: registers, power-up, compound commands, and every way in which the real ones fail.
//! It shares no code with the driver: it takes and gives the bytes of the makers' tables by itself.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use super::module::{ADDRESS, Module};
use crate::hw::i2c::{I2cBus, I2cError};

/// A DLPC2607's registers.
mod dlpc2607;
/// A DLPC34xx's opcodes.
mod dlpc34xx;
/// What can go wrong.
pub mod faults;
/// The registers in a file that other programs can read.
pub mod stored;

pub use faults::Faults;

/// So many of the latest writes are remembered.
const REMEMBERED: usize = 64;

/// A controller and all that is in it. As JSON it is what `fake:FILE` keeps.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FakeModule {
    /// The family it plays.
    pub module: Module,
    /// The identity it answers with.
    pub id: u8,
    /// Whether any LED is on: for whoever reads the file. Follows from the registers.
    pub lit: bool,
    /// The LED enable bits: 1 red, 2 green, 4 blue.
    pub led_enable: u8,
    /// The LED current codes in force: red, green, blue.
    pub led_current: [u16; 3],
    /// Whether the curtain is drawn.
    pub curtain: bool,
    /// Whether the mirrors are parked.
    pub parked: bool,
    /// The latest writes that it took, oldest first, each as hex bytes.
    pub writes: Vec<String>,
    /// Transactions so far, answered or not.
    pub transactions: u64,
    /// How often it was reset.
    pub resets: u64,
    /// What goes wrong.
    pub faults: Faults,
    /// Everything that was written, by register or write opcode.
    registers: BTreeMap<u8, Vec<u8>>,
    /// What the next read answers.
    pointer: Vec<u8>,
    /// So many polls more does a compound command keep it busy.
    busy: u32,
    /// So many status reads more until it says that it is initialised.
    starting: u32,
    /// So many transactions more are not acknowledged.
    silent: u32,
    /// The last command was refused.
    complains: bool,
}

impl FakeModule {
    /// A controller that has just been switched on: LEDs off.
    #[must_use]
    pub fn new(module: Module, faults: Faults) -> FakeModule {
        let mut fake = FakeModule {
            module,
            id: faults.id.unwrap_or(module.usual_id()),
            lit: false,
            led_enable: 0,
            led_current: [0; 3],
            curtain: false,
            parked: false,
            writes: Vec::new(),
            transactions: 0,
            resets: 0,
            faults,
            registers: BTreeMap::new(),
            pointer: Vec::new(),
            busy: 0,
            starting: 0,
            silent: 0,
            complains: false,
        };
        fake.power_up();
        fake
    }

    fn power_up(&mut self) {
        self.registers.clear();
        self.pointer.clear();
        self.busy = 0;
        self.complains = false;
        self.starting = self.faults.starting_reads;
        self.silent = self.faults.silent_at_start;
        match self.module {
            Module::Dlpc2607 => self.reset_2607(),
            Module::Dlpc34xx => self.reset_34xx(),
        }
        self.follow();
    }

    /// Switches it off and on again.
    pub fn reset(&mut self) {
        self.resets += 1;
        self.power_up();
    }

    /// The fields that follow from the registers.
    fn follow(&mut self) {
        match self.module {
            Module::Dlpc2607 => self.follow_2607(),
            Module::Dlpc34xx => self.follow_34xx(),
        }
        self.lit = self.led_enable != 0;
    }

    /// What every transaction begins with: who does not answer, and why.
    fn begin(&mut self, address: u8) -> Result<(), I2cError> {
        self.transactions += 1;
        if self.faults.reset_at == Some(self.transactions) {
            self.reset();
        }
        if self.faults.gone_at.is_some_and(|at| self.transactions >= at) {
            return Err(I2cError::Gone { bus: "fake".into(), why: "No such device (os error 19)".into() });
        }
        if self.faults.is_stuck(self.transactions) {
            return Err(I2cError::Stuck);
        }
        if self.faults.loses(self.transactions) {
            return Err(I2cError::Arbitration);
        }
        if address != ADDRESS || self.silent > 0 || self.faults.is_silent(self.transactions) {
            self.silent = self.silent.saturating_sub(1);
            return Err(I2cError::Nack { address });
        }
        Ok(())
    }

    /// Takes a write transaction.
    ///
    /// # Errors
    /// As the faults say.
    pub fn write(&mut self, address: u8, bytes: &[u8]) -> Result<(), I2cError> {
        self.begin(address)?;
        let mut heard = bytes.to_vec();
        self.faults.flip(self.transactions, &mut heard);
        match self.module {
            Module::Dlpc2607 => self.write_2607(&heard),
            Module::Dlpc34xx => self.write_34xx(&heard),
        }
        self.follow();
        Ok(())
    }

    /// Answers a read transaction. Bytes that it does not have read as 0xFF: nobody pulls the line down.
    ///
    /// # Errors
    /// As the faults say.
    pub fn read(&mut self, address: u8, buffer: &mut [u8]) -> Result<(), I2cError> {
        self.begin(address)?;
        let answer = match self.module {
            Module::Dlpc2607 => self.read_2607(),
            Module::Dlpc34xx => self.read_34xx(),
        };
        buffer.fill(0xFF);
        let got = if self.faults.is_short(self.transactions) { buffer.len() / 2 } else { buffer.len() };
        for (to, from) in buffer[..got].iter_mut().zip(answer) {
            *to = from;
        }
        if got < buffer.len() {
            return Err(I2cError::Short { wanted: buffer.len(), got });
        }
        self.faults.flip(self.transactions, buffer);
        Ok(())
    }

    /// Remembers a write that changed something.
    fn remember(&mut self, bytes: &[u8]) {
        if self.writes.len() == REMEMBERED {
            self.writes.remove(0);
        }
        self.writes.push(bytes.iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().join(" "));
    }

    /// An LED current code as the controller takes it.
    fn clamped(&self, code: u16) -> u16 {
        let code = code & self.module.largest_code();
        self.faults.clamp.map_or(code, |most| code.min(most))
    }
}

/// A bus with one [`FakeModule`] on it. Clones are the same bus, so that a test can look into the module at any time.
#[derive(Debug, Clone)]
pub struct FakeBus(Arc<Mutex<FakeModule>>);

impl FakeBus {
    /// A bus with this module.
    #[must_use]
    pub fn new(module: FakeModule) -> FakeBus {
        FakeBus(Arc::new(Mutex::new(module)))
    }

    /// The module as it is now.
    #[must_use]
    pub fn look(&self) -> FakeModule {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Does something to the module: sets faults, resets it.
    pub fn change(&self, change: impl FnOnce(&mut FakeModule)) {
        change(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

impl I2cBus for FakeBus {
    fn write(&mut self, address: u8, bytes: &[u8]) -> Result<(), I2cError> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).write(address, bytes)
    }

    fn read(&mut self, address: u8, buffer: &mut [u8]) -> Result<(), I2cError> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).read(address, buffer)
    }

    fn describe(&self) -> String {
        "a made-up bus".into()
    }
}
