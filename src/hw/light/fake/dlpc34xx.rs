//! The opcodes of a DLPC34xx, from the tables of TI's BSD-licensed libraries (dlpc343x_xpr4.py) and programmer's guides.
//!
//! ```text
//! write      [opcode, parameters...]           lengths fixed by the opcode, numbers little-endian
//! read       [opcode (, selector)], stop, then the bytes
//! ```

use super::FakeModule;

const CURTAIN: u8 = 0x16;
const METHOD: u8 = 0x50;
const ENABLE: u8 = 0x52;
const CURRENT: u8 = 0x54;
const MOST: u8 = 0x5C;
const CAIC: u8 = 0x84;

/// Write opcode, the read opcode that answers it, and the bytes after the opcode.
const OPCODES: [(u8, u8, usize); 15] = [
    (0x05, 0x06, 2),
    (0x0D, 0x0E, 1),
    (0x14, 0x15, 1),
    (CURTAIN, 0x17, 1),
    (0x1A, 0x1B, 1),
    (METHOD, 0x51, 1),
    (ENABLE, 0x53, 1),
    (CURRENT, 0x55, 6),
    (MOST, 0x5D, 6),
    (0x60, 0x61, 4),
    (0x6B, 0x6C, 1),
    (0x6D, 0x6E, 1),
    (CAIC, 0x85, 3),
    (0xAE, 0xAF, 1),
    (0x39, 0x3A, 1),
];

impl FakeModule {
    pub(super) fn reset_34xx(&mut self) {
        for (opcode, _, length) in OPCODES {
            self.registers.insert(opcode, vec![0; length]);
        }
        // As TI's EVM firmware starts: automatic light control, CAIC on, some current, LEDs off here.
        self.registers.insert(METHOD, vec![1]);
        self.registers.insert(CAIC, vec![0x48, 30, 60]);
        self.registers.insert(MOST, vec![0xFF, 3, 0xFF, 3, 0xFF, 3]);
    }

    pub(super) fn follow_34xx(&mut self) {
        self.led_enable = self.first(ENABLE) & 7;
        self.curtain = self.first(CURTAIN) & 1 == 1;
        let bytes = self.registers.get(&CURRENT).cloned().unwrap_or_default();
        for (code, pair) in self.led_current.iter_mut().zip(bytes.chunks_exact(2)) {
            *code = u16::from_le_bytes([pair[0], pair[1]]);
        }
    }

    pub(super) fn write_34xx(&mut self, bytes: &[u8]) {
        let Some((opcode, parameters)) = bytes.split_first() else { return };
        match OPCODES.iter().find(|(write, ..)| write == opcode) {
            Some((_, _, length)) if *length == parameters.len() => {
                self.remember(bytes);
                self.set_34xx(*opcode, parameters);
                self.complains = false;
            }
            // A wrong count of parameters: the command is not done, and the status says so.
            Some(_) => self.complains = true,
            // All other opcodes read; parameters beyond the opcode select.
            None => self.pointer = bytes.to_vec(),
        }
    }

    fn set_34xx(&mut self, opcode: u8, parameters: &[u8]) {
        let stored = match opcode {
            ENABLE if self.faults.enable_sticks => return,
            ENABLE => vec![parameters[0] & 7],
            CURRENT => {
                let codes = parameters.chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]]));
                codes.flat_map(|code| self.clamped(code).to_le_bytes()).collect()
            }
            _ => parameters.to_vec(),
        };
        self.registers.insert(opcode, stored);
    }

    pub(super) fn read_34xx(&mut self) -> Vec<u8> {
        let status = |fake: &mut FakeModule| {
            let done = fake.starting == 0;
            fake.starting = fake.starting.saturating_sub(1);
            0x80 | u8::from(done) | u8::from(fake.complains) << 1
        };
        match self.pointer.first().copied() {
            Some(0xD0) => vec![status(self)],
            Some(0xD1) => vec![0, self.led_enable, 0, 0],
            Some(0xD2) => vec![3, 0, 2, 8],
            Some(0xD3) => vec![0, 0, 0, 0, u8::from(self.complains) << 5, 0],
            Some(0xD4) => vec![self.id],
            Some(opcode) => OPCODES
                .iter()
                .find(|(_, read, _)| *read == opcode)
                .and_then(|(write, ..)| self.registers.get(write).cloned())
                .unwrap_or_default(),
            None => Vec::new(),
        }
    }

    fn first(&self, opcode: u8) -> u8 {
        self.registers.get(&opcode).and_then(|bytes| bytes.first()).copied().unwrap_or(0)
    }
}
