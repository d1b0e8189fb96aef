//! The registers of a DLPC2607, from the tables of TI's BSD-licensed libraries (dpp2607.py; bqUAB/dlpc2607).
//!
//! ```text
//! write      [register, b3, b2, b1, b0]        32 bits, big-endian
//! read       [0x15, register], stop, then 4 bytes, big-endian
//! compound   0x39 = argument, 0x3A = 1, 0x38 = opcode; busy until the last byte of 0x3A is 0
//! ```

use super::FakeModule;

const STATUS: u8 = 0x03;
const RED_CURRENT: u8 = 0x12;
const BLUE_CURRENT: u8 = 0x14;
const READ: u8 = 0x15;
const ENABLE: u8 = 0x16;
const RESET: u8 = 0x1F;
const PARK: u8 = 0x2D;
const COMPOUND: u8 = 0x38;
const BUSY: u8 = 0x3A;
const CURTAIN: u8 = 0xA6;
const PROPAGATE: u8 = 0xD3;

impl FakeModule {
    pub(super) fn reset_2607(&mut self) {
        self.led_current = [0; 3];
        // Reset values of the tables: splash as source, 24-bit pixels.
        self.store_2607(0x0B, 2);
        self.store_2607(0x0C, 1);
        self.store_2607(0x0D, 2);
    }

    pub(super) fn follow_2607(&mut self) {
        self.led_enable = (self.load_2607(ENABLE) & 7) as u8;
        self.curtain = self.load_2607(CURTAIN) & 0xF == 1;
        self.parked = self.load_2607(PARK) & 1 == 1;
    }

    pub(super) fn write_2607(&mut self, bytes: &[u8]) {
        match *bytes {
            [READ, register] => self.pointer = vec![register],
            [register, a, b, c, d] => {
                self.remember(bytes);
                self.set_2607(register, u32::from_be_bytes([a, b, c, d]));
            }
            // Any other length is no command of this controller.
            _ => self.complains = true,
        }
    }

    fn set_2607(&mut self, register: u8, value: u32) {
        match register {
            // Read only: the identity, and the prefix of reads.
            STATUS | READ => self.complains = true,
            RED_CURRENT..=BLUE_CURRENT => {
                let code = self.clamped((value & 0x7FF) as u16);
                self.store_2607(register, u32::from(code));
            }
            ENABLE if self.faults.enable_sticks => {}
            ENABLE => self.store_2607(register, value & 7),
            RESET if value & 1 == 1 => self.reset(),
            COMPOUND => {
                self.store_2607(register, value);
                self.busy = self.faults.busy_polls;
                if value & 0xFF == u32::from(PROPAGATE) && !self.faults.busy_for_ever {
                    let codes = [RED_CURRENT, RED_CURRENT + 1, BLUE_CURRENT].map(|at| self.load_2607(at) as u16);
                    self.led_current = codes;
                }
            }
            _ => self.store_2607(register, value),
        }
    }

    pub(super) fn read_2607(&mut self) -> Vec<u8> {
        let value = match self.pointer.first().copied() {
            Some(STATUS) => {
                let done = self.starting == 0;
                self.starting = self.starting.saturating_sub(1);
                u32::from(self.id) | u32::from(done) << 11
            }
            Some(BUSY) => {
                let busy = self.busy > 0 || (self.faults.busy_for_ever && self.load_2607(COMPOUND) != 0);
                self.busy = self.busy.saturating_sub(1);
                u32::from(busy)
            }
            Some(register) => self.load_2607(register),
            None => u32::MAX,
        };
        value.to_be_bytes().to_vec()
    }

    fn store_2607(&mut self, register: u8, value: u32) {
        self.registers.insert(register, value.to_be_bytes().to_vec());
    }

    fn load_2607(&self, register: u8) -> u32 {
        let bytes = self.registers.get(&register).and_then(|bytes| <[u8; 4]>::try_from(bytes.as_slice()).ok());
        bytes.map_or(0, u32::from_be_bytes)
    }
}
