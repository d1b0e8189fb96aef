//! What the projector's controller answers: any bytes, any refusal, at any moment. Whatever it says, nothing is written before it
//! has said who it is, and a lighting that fails ends with the LEDs told to be off.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use scotopic::hw::i2c::pace::{Made, Pace, Within};
use scotopic::hw::i2c::{I2cBus, I2cError};
use scotopic::hw::light::Module;
use scotopic::hw::light::controller::{Controller, Drive};

use super::assert_harmless;

/// Checks one input: the first byte chooses controller and what is asked of it, the rest is what the bus does.
///
/// # Panics
/// Something does not hold.
pub fn check(data: &[u8]) {
    let Some((choice, answers)) = data.split_first() else { return };
    let module = if choice & 1 == 0 { Module::Dlpc2607 } else { Module::Dlpc34xx };
    let wire = Arc::new(Mutex::new(Wire::new(module, answers.to_vec(), choice & 2 == 0)));
    let mut controller = Controller::new(module, Box::new(Bus(Arc::clone(&wire))));
    let mut pace = Made::default();
    let clock = pace.clone();
    let drive = Drive { leds: 7, codes: [100, 200, 300] };
    for asked in [choice >> 2 & 7, choice >> 5] {
        let began = clock.now();
        let mut within = Within::new(&mut pace, Duration::from_millis(500));
        let done = match asked {
            0 => controller.identify(&mut within).map(|_| ()),
            1 => controller.dark(&mut within),
            2 => controller.change(drive, &mut within),
            3 => controller.leds_off(&mut within),
            4 => controller.read_back(&mut within).map(|_| ()),
            5 => controller.status(&mut within).map(|_| ()),
            _ => controller.light(drive, &mut within),
        };
        assert!(clock.now() - began <= Duration::from_millis(510), "patience of 500 ms took {:?}", clock.now() - began);
        let wire = lock(&wire);
        if let Err(error) = done {
            assert_harmless(&error.to_string());
            assert!(wire.enabled != Some(true) || asked < 6, "lighting failed, and the last word was: on");
        } else if asked >= 6 {
            assert_eq!(wire.enabled, Some(true), "lit, and the LEDs were never told");
        }
    }
}

fn lock(wire: &Arc<Mutex<Wire>>) -> MutexGuard<'_, Wire> {
    wire.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A bus whose every answer is in the input; what is not there any more is answered well, or with zeros.
struct Wire {
    module: Module,
    answers: std::vec::IntoIter<u8>,
    willing: bool,
    /// What was asked for last, and what the registers hold, where they hold anything.
    asked: Vec<u8>,
    held: std::collections::BTreeMap<u8, Vec<u8>>,
    /// Whether the last word about the LEDs, heard or not, was "on".
    enabled: Option<bool>,
    /// Whether an identity of the right family was ever answered.
    known: bool,
}

impl Wire {
    fn new(module: Module, answers: Vec<u8>, willing: bool) -> Wire {
        let (answers, held) = (answers.into_iter(), std::collections::BTreeMap::new());
        Wire { module, answers, willing, asked: Vec::new(), held, enabled: None, known: false }
    }

    /// What the bus itself does next.
    fn refusal(&mut self) -> Result<Option<u8>, I2cError> {
        match self.answers.next() {
            Some(0xE0) => Err(I2cError::Nack { address: 0x1B }),
            Some(0xE1) => Err(I2cError::Stuck),
            Some(0xE2) => Err(I2cError::Arbitration),
            Some(0xE3) => Err(I2cError::Short { wanted: 4, got: 1 }),
            Some(0xE4) => Err(I2cError::Gone { bus: "bus".into(), why: "gone".into() }),
            other => Ok(other),
        }
    }

    /// Whether these bytes change something.
    fn changes(&self, bytes: &[u8]) -> bool {
        match self.module {
            Module::Dlpc2607 => bytes.len() == 5,
            Module::Dlpc34xx => bytes.len() > 1 && bytes[0] != 0xD3,
        }
    }

    /// What a well behaved controller would answer.
    fn right(&self, length: usize) -> Vec<u8> {
        let mut answer = match (self.module, self.asked.as_slice()) {
            (Module::Dlpc2607, [0x15, 0x03]) => vec![0, 0, 0x08, 0x8A],
            (Module::Dlpc2607, [0x15, register]) if *register != 0x3A => {
                self.held.get(register).cloned().unwrap_or_default()
            }
            (Module::Dlpc34xx, [0xD0]) => vec![0x81],
            (Module::Dlpc34xx, [0xD4]) => vec![6],
            (Module::Dlpc34xx, [opcode, ..]) => self.held.get(&opcode.wrapping_sub(1)).cloned().unwrap_or_default(),
            _ => Vec::new(),
        };
        answer.resize(length, 0);
        answer
    }
}

/// The wire as the controller's bus.
struct Bus(Arc<Mutex<Wire>>);

impl I2cBus for Bus {
    fn write(&mut self, _address: u8, bytes: &[u8]) -> Result<(), I2cError> {
        let mut wire = lock(&self.0);
        if wire.changes(bytes) {
            assert!(wire.known, "{bytes:02X?} was written to a controller that nobody knows");
            let enable = match wire.module {
                Module::Dlpc2607 => 0x16,
                Module::Dlpc34xx => 0x52,
            };
            if bytes[0] == enable {
                wire.enabled = Some(bytes.last().is_some_and(|leds| *leds != 0));
            }
            wire.refusal()?;
            let _ = wire.held.insert(bytes[0], bytes[1..].to_vec());
        } else {
            wire.refusal()?;
            wire.asked = bytes.to_vec();
        }
        Ok(())
    }

    fn read(&mut self, _address: u8, buffer: &mut [u8]) -> Result<(), I2cError> {
        let mut wire = lock(&self.0);
        let first = wire.refusal()?;
        let right = wire.right(buffer.len());
        let well = first.map_or(wire.willing, |byte| byte < 0xC0);
        for (place, right) in buffer.iter_mut().zip(right) {
            *place = if well { right } else { wire.answers.next().unwrap_or(0) };
        }
        // Who it is stands in the last byte of the 2607's answer, in the only one of the others'.
        wire.known |= match wire.asked.as_slice() {
            [0x15, 0x03] | [0xD4] => buffer.last().is_some_and(|id| wire.module.chip(*id).is_some()),
            _ => false,
        };
        Ok(())
    }

    fn describe(&self) -> String {
        "a wire of nonsense".into()
    }
}
