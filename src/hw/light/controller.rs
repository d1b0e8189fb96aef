//! The controller of a module's LEDs: who it is, and every setting written, read back and compared.
//!
//! Nothing is written before the controller's identity was read and is of the family that was named. Whatever goes wrong in the
//! bus is tried again until the time that was handed in is over.

use std::time::Duration;

use super::error::{Doing, LightError};
use super::module::{ADDRESS, Module};
use super::wire::{self, Exchange, Setting};
use crate::hw::i2c::pace::Within;
use crate::hw::i2c::{I2cBus, I2cError};

/// What a controller says of itself.
mod status;

pub use status::Status;

/// The first pause before a transaction is tried again; doubled each time.
const FIRST_PAUSE: Duration = Duration::from_millis(1);
/// The longest pause.
const LONGEST_PAUSE: Duration = Duration::from_millis(20);
/// TI's libraries give a compound command this long.
const COMPOUND_PATIENCE: Duration = Duration::from_secs(2);
/// A setting that reads back wrong is written so often in all: a single wrong bit on the bus is no fault of the module.
const TRIES: u32 = 3;
/// Of the time for lighting, this much is kept for switching off again if lighting fails.
const RESCUE: Duration = Duration::from_millis(100);

/// Who answered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Identity {
    /// The identity as read.
    pub id: u8,
    /// The chip's name.
    pub chip: &'static str,
}

/// What the LEDs shall do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Drive {
    /// Which LEDs: 1 red, 2 green, 4 blue.
    pub leds: u8,
    /// Their current codes: red, green, blue.
    pub codes: [u16; 3],
}

/// A controller on a bus.
pub struct Controller {
    module: Module,
    bus: Box<dyn I2cBus>,
    identity: Option<Identity>,
}

impl Controller {
    /// A controller of this family on this bus. Nothing is sent yet.
    #[must_use]
    pub fn new(module: Module, bus: Box<dyn I2cBus>) -> Controller {
        Controller { module, bus, identity: None }
    }

    /// The family it was said to be.
    #[must_use]
    pub fn module(&self) -> Module {
        self.module
    }

    /// What it is, in words.
    #[must_use]
    pub fn describe(&self) -> String {
        let chip = self.identity.map_or_else(|| self.module.to_string(), |identity| identity.chip.into());
        format!("{chip} on {}", self.bus.describe())
    }

    /// Asks who it is and waits until it is ready. Only reads.
    ///
    /// # Errors
    /// Nobody answers in time, it never becomes ready, or it is not of this family: then nothing is ever written to it.
    pub fn identify(&mut self, within: &mut Within<'_>) -> Result<Identity, LightError> {
        let mut wrong = 0;
        loop {
            let (id, ready) = self.presence(within)?;
            match self.module.chip(id) {
                // One wrong bit on the bus makes another identity: believed only when it is read again.
                None if wrong + 1 < TRIES => wrong += 1,
                None => return Err(LightError::WrongId { module: self.module, id }),
                Some(chip) if ready => {
                    let identity = Identity { id, chip };
                    self.identity = Some(identity);
                    return Ok(identity);
                }
                Some(chip) if !within.wait(LONGEST_PAUSE) => return Err(LightError::NotReady { chip }),
                Some(_) => {}
            }
        }
    }

    /// Writes a setting, reads it back and compares.
    ///
    /// # Errors
    /// The identity is not right, the bus fails, or the module keeps another value than it was asked to.
    pub fn set(&mut self, setting: Setting, within: &mut Within<'_>) -> Result<(), LightError> {
        if self.identity.is_none() {
            self.identify(within)?;
        }
        for exchange in wire::exchanges(self.module, setting) {
            self.exchange(&exchange, within)?;
        }
        let propagation = wire::propagation(self.module, setting);
        if propagation.is_empty() {
            return Ok(());
        }
        // Whether it was understood cannot be read back. Said twice, one wrong bit on the bus does not leave the old currents
        // in force.
        for _ in 0..2 {
            for bytes in &propagation {
                self.write(Doing::Propagating, bytes, within)?;
            }
            self.await_compound(within)?;
        }
        Ok(())
    }

    /// Lights the LEDs: off first, automatic brightness off, currents, mirrors and curtain, and at last the LEDs. If anything
    /// fails they are off again.
    ///
    /// # Errors
    /// As [`Controller::set`].
    pub fn light(&mut self, drive: Drive, within: &mut Within<'_>) -> Result<(), LightError> {
        let done = self.light_step_by_step(drive, &mut within.sparing(RESCUE));
        self.or_off(done, within)
    }

    fn light_step_by_step(&mut self, drive: Drive, within: &mut Within<'_>) -> Result<(), LightError> {
        self.set(Setting::Enable(0), within)?;
        self.manual(within)?;
        self.set(Setting::Current(drive.codes), within)?;
        self.set(Setting::Parked(false), within)?;
        self.set(Setting::Curtain(false), within)?;
        self.set(Setting::Enable(drive.leds), within)
    }

    /// Changes the currents of LEDs that are lit. If that fails they are off.
    ///
    /// # Errors
    /// As [`Controller::set`].
    pub fn change(&mut self, drive: Drive, within: &mut Within<'_>) -> Result<(), LightError> {
        let done = self.set(Setting::Current(drive.codes), &mut within.sparing(RESCUE));
        self.or_off(done, within)
    }

    fn or_off(&mut self, done: Result<(), LightError>, within: &mut Within<'_>) -> Result<(), LightError> {
        if done.is_err() {
            // The first error is the one to tell.
            let _ = self.leds_off(within);
        }
        done
    }

    /// Turns the module to its parallel input, behind the curtain and with the LEDs off: after power-up a DLPC2607 shows its
    /// maker's picture. The curtain opens with the next [`Controller::light`].
    ///
    /// # Errors
    /// As [`Controller::set`]; or how this chip is turned is not known.
    pub fn take_parallel_input(&mut self, within: &mut Within<'_>) -> Result<(), LightError> {
        let Identity { id, chip } = self.identify(within)?;
        if self.module == Module::Dlpc34xx && id != Module::Dlpc34xx.usual_id() {
            return Err(LightError::NoInput { chip });
        }
        self.set(Setting::Enable(0), within)?;
        self.set(Setting::Curtain(true), within)?;
        self.set(Setting::ParallelInput, within)?;
        if self.module == Module::Dlpc34xx {
            // TI's script waits a second before it opens the curtain.
            within.wait(Duration::from_secs(1));
        }
        Ok(())
    }

    /// Switches the LEDs off and nothing else: the quick way to darkness.
    ///
    /// # Errors
    /// As [`Controller::set`]; the LEDs may then be on.
    pub fn leds_off(&mut self, within: &mut Within<'_>) -> Result<(), LightError> {
        self.set(Setting::Enable(0), within)
    }

    /// Makes it dark for good: LEDs off, currents to 0, curtain black, mirrors parked, in this order. Each step is tried even
    /// if one before it failed.
    ///
    /// # Errors
    /// The first that occurred.
    pub fn dark(&mut self, within: &mut Within<'_>) -> Result<(), LightError> {
        let steps = [Setting::Enable(0), Setting::Current([0; 3]), Setting::Curtain(true), Setting::Parked(true)];
        let mut first = Ok(());
        for step in steps {
            let done = self.set(step, within);
            if let Err(LightError::WrongId { .. } | LightError::NotReady { .. }) = done {
                return first.and(done);
            }
            first = first.and(done);
        }
        first
    }

    /// The module must not choose the LED currents by the picture's content.
    fn manual(&mut self, within: &mut Within<'_>) -> Result<(), LightError> {
        if self.module == Module::Dlpc2607 {
            return Ok(());
        }
        self.set(Setting::AutomaticCurrent(false), within)?;
        let mut now = [0; 3];
        self.ask(Doing::Reading, &[wire::CAIC_READ], &mut now, within)?;
        self.set(Setting::Caic(wire::caic_off(now)), within)
    }

    /// One write, read back; up to [`TRIES`] times.
    fn exchange(&mut self, exchange: &Exchange, within: &mut Within<'_>) -> Result<(), LightError> {
        let mut got = vec![0; exchange.expect.len()];
        for _ in 0..TRIES {
            self.write(exchange.doing, &exchange.write, within)?;
            // A value that reads wrong once and right once was read wrongly.
            for _ in 0..2 {
                self.ask(exchange.doing, &exchange.ask, &mut got, within)?;
                if exchange.agrees(&got) {
                    return Ok(());
                }
            }
        }
        Err(LightError::Mismatch {
            what: exchange.doing,
            asked: exchange.shown(&exchange.expect),
            got: exchange.shown(&got),
        })
    }

    fn await_compound(&mut self, within: &mut Within<'_>) -> Result<(), LightError> {
        let mut within = within.at_most(COMPOUND_PATIENCE);
        let mut pause = FIRST_PAUSE;
        loop {
            let mut busy = [0; 4];
            self.ask(Doing::Propagating, &wire::BUSY_ASK, &mut busy, &mut within)?;
            if busy[3] == 0 {
                return Ok(());
            }
            if !within.wait(pause) {
                return Err(LightError::Busy { doing: Doing::Propagating });
            }
            pause = (pause * 2).min(LONGEST_PAUSE);
        }
    }

    /// A write, tried again while the bus says that it may pass.
    fn write(&mut self, doing: Doing, bytes: &[u8], within: &mut Within<'_>) -> Result<(), LightError> {
        let bus = &mut self.bus;
        again(doing, within, || bus.write(ADDRESS, bytes))
    }

    /// A question and its answer, tried again while the bus says that it may pass.
    fn ask(
        &mut self,
        doing: Doing,
        question: &[u8],
        answer: &mut [u8],
        within: &mut Within<'_>,
    ) -> Result<(), LightError> {
        let bus = &mut self.bus;
        again(doing, within, || bus.write_read(ADDRESS, question, answer))
    }
}

fn again(
    doing: Doing,
    within: &mut Within<'_>,
    mut what: impl FnMut() -> Result<(), I2cError>,
) -> Result<(), LightError> {
    let mut pause = FIRST_PAUSE;
    loop {
        match what() {
            Ok(()) => return Ok(()),
            Err(why) if !why.may_pass() || !within.wait(pause) => return Err(LightError::Bus { doing, why }),
            Err(_) => pause = (pause * 2).min(LONGEST_PAUSE),
        }
    }
}

#[cfg(test)]
mod tests;
