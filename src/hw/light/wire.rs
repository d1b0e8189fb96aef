//! Settings as bytes on the wire, and what must be read back after each.
//!
//! ```text
//! DLPC2607   write [register, 32 bits big-endian]         read back [0x15, register], 4 bytes
//! DLPC34xx   write [opcode, parameters little-endian]     read back [opcode + 1], the parameters
//! ```
//!
//! Source: TI's BSD-licensed libraries (dpp2607.py, dlpc343x_xpr4.py) and the programmer's guides DLPU078A and DLPU035A.

use super::error::Doing;
use super::module::Module;

/// Reads the CAIC settings of a DLPC34xx.
pub(super) const CAIC_READ: u8 = 0x85;
/// Asks a DLPC2607 whether a compound command is still busy.
pub(super) const BUSY_ASK: [u8; 2] = [0x15, 0x3A];
/// Asks for the LED enable bits: of a DLPC2607, of a DLPC34xx.
pub(super) const ENABLE_ASK: [&[u8]; 2] = [&[0x15, 0x16], &[0x53]];
/// Asks for the curtain.
pub(super) const CURTAIN_ASK: [&[u8]; 2] = [&[0x15, 0xA6], &[0x17]];

/// One thing that is set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Setting {
    /// Which LEDs are on: 1 red, 2 green, 4 blue.
    Enable(u8),
    /// The LED current codes: red, green, blue.
    Current([u16; 3]),
    /// A black curtain over the picture.
    Curtain(bool),
    /// The mirrors in their resting place. A DLPC34xx parks by its PROJ_ON line, not over I2C: nothing is sent.
    Parked(bool),
    /// The picture from the parallel input, in the module's own size. Of the DLPC34xx this is for the DLPC3436 only.
    ParallelInput,
    /// The controller of a DLPC34xx chooses the currents by itself.
    AutomaticCurrent(bool),
    /// The three CAIC bytes of a DLPC34xx (content adaptive illumination control).
    Caic([u8; 3]),
}

/// A write, and what a read must give after it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Exchange {
    pub(super) doing: Doing,
    pub(super) write: Vec<u8>,
    pub(super) ask: Vec<u8>,
    pub(super) expect: Vec<u8>,
    /// The bits that count.
    mask: Vec<u8>,
    little_endian: bool,
}

impl Exchange {
    fn register(doing: Doing, register: u8, value: u32, mask: u32) -> Exchange {
        let bytes = value.to_be_bytes();
        let write = [&[register], &bytes[..]].concat();
        let expect = bytes.to_vec();
        Exchange {
            doing,
            write,
            ask: vec![0x15, register],
            expect,
            mask: mask.to_be_bytes().to_vec(),
            little_endian: false,
        }
    }

    fn opcode(doing: Doing, opcode: u8, parameters: &[u8], mask: &[u8]) -> Exchange {
        let write = [&[opcode], parameters].concat();
        let (expect, mask) = (parameters.to_vec(), mask.to_vec());
        Exchange { doing, write, ask: vec![opcode + 1], expect, mask, little_endian: true }
    }

    /// Whether what came back is what was asked, in the bits that count.
    pub(super) fn agrees(&self, got: &[u8]) -> bool {
        self.expect.iter().zip(got).zip(&self.mask).all(|((asked, got), mask)| asked & mask == got & mask)
    }

    /// The bytes as a person reads them: codes for currents, else one number.
    pub(super) fn shown(&self, bytes: &[u8]) -> String {
        let masked: Vec<u8> = bytes.iter().zip(&self.mask).map(|(byte, mask)| byte & mask).collect();
        if self.little_endian && masked.len() == 6 {
            let codes: Vec<String> =
                masked.chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]]).to_string()).collect();
            codes.join(", ")
        } else if self.little_endian {
            masked.iter().map(u8::to_string).collect::<Vec<_>>().join(", ")
        } else {
            masked.iter().fold(0u32, |value, byte| value << 8 | u32::from(*byte)).to_string()
        }
    }
}

/// The writes of a setting, in order.
pub(super) fn exchanges(module: Module, setting: Setting) -> Vec<Exchange> {
    match module {
        Module::Dlpc2607 => exchanges_2607(setting),
        Module::Dlpc34xx => exchanges_34xx(setting),
    }
}

fn exchanges_2607(setting: Setting) -> Vec<Exchange> {
    match setting {
        Setting::Enable(leds) => vec![Exchange::register(Doing::Enable, 0x16, u32::from(leds & 7), 7)],
        Setting::Current(codes) => [0x12, 0x13, 0x14]
            .iter()
            .zip(codes)
            .map(|(register, code)| Exchange::register(Doing::Current, *register, u32::from(code & 0x7FF), 0x7FF))
            .collect(),
        Setting::Curtain(drawn) => vec![Exchange::register(Doing::Curtain, 0xA6, u32::from(drawn), 0xFF)],
        Setting::Parked(parked) => vec![Exchange::register(Doing::Park, 0x2D, u32::from(parked), 1)],
        // nHD landscape, then the parallel port as source (a working Raspberry Pi configuration: tregota/rpi4-dlpdlcr2000evm).
        Setting::ParallelInput => {
            vec![Exchange::register(Doing::Input, 0x0C, 0x1B, 0x1F), Exchange::register(Doing::Input, 0x0B, 0, 7)]
        }
        Setting::AutomaticCurrent(_) | Setting::Caic(_) => Vec::new(),
    }
}

fn exchanges_34xx(setting: Setting) -> Vec<Exchange> {
    match setting {
        Setting::Enable(leds) => vec![Exchange::opcode(Doing::Enable, 0x52, &[leds & 7], &[7])],
        Setting::Current(codes) => {
            let bytes: Vec<u8> = codes.iter().flat_map(|code| (code & 0x3FF).to_le_bytes()).collect();
            vec![Exchange::opcode(Doing::Current, 0x54, &bytes, &[0xFF, 3, 0xFF, 3, 0xFF, 3])]
        }
        Setting::Curtain(drawn) => vec![Exchange::opcode(Doing::Curtain, 0x16, &[u8::from(drawn)], &[0x0F])],
        Setting::Parked(_) => Vec::new(),
        // TI's init_parallel_mode.py for the DLPDLCR230NP: source, 1920 x 1080, actuator, RGB666, sync.
        Setting::ParallelInput => vec![
            Exchange::opcode(Doing::Input, 0x05, &[1, 0], &[7, 1]),
            Exchange::opcode(Doing::Input, 0x60, &[0x80, 0x07, 0x38, 0x04], &[0xFF; 4]),
            Exchange::opcode(Doing::Input, 0xAE, &[1], &[1]),
            Exchange::opcode(Doing::Input, 0x6D, &[2], &[0x0F]),
            Exchange::opcode(Doing::Input, 0x6B, &[0x02], &[0x0F]),
        ],
        Setting::AutomaticCurrent(on) => vec![Exchange::opcode(Doing::Automatic, 0x50, &[u8::from(on)], &[1])],
        Setting::Caic(bytes) => vec![Exchange::opcode(Doing::Automatic, 0x84, &bytes, &[0xCF, 0xFF, 0xFF])],
    }
}

/// What makes currents written to a DLPC2607 count: compound command 0xD3 with argument 1.
pub(super) fn propagation(module: Module, setting: Setting) -> Vec<[u8; 5]> {
    match (module, setting) {
        (Module::Dlpc2607, Setting::Current(_)) => {
            vec![[0x39, 0, 0, 0, 1], [0x3A, 0, 0, 0, 1], [0x38, 0, 0, 0, 0xD3]]
        }
        _ => Vec::new(),
    }
}

/// The CAIC bytes with modulation, gain and its display off, and all else as it was.
pub(super) fn caic_off(now: [u8; 3]) -> [u8; 3] {
    [now[0] & 0x07, now[1], now[2]]
}

/// The status register 0x03 of a DLPC2607.
pub(super) fn complaints_2607(status: u32) -> Vec<String> {
    named(status, &[(10, "the flash memory is busy"), (12, "an LED timed out")])
}

/// The short and the long status of a DLPC34xx.
pub(super) fn complaints_34xx(short: u8, long: [u8; 4]) -> Vec<String> {
    let mut words = named(
        u32::from(short),
        &[
            (1, "a command was not understood"),
            (3, "a system error"),
            (4, "the flash memory is busy"),
            (5, "a flash error"),
        ],
    );
    words.extend(named(
        u32::from_le_bytes(long),
        &[
            (0, "an error of the mirror device"),
            (1, "an error of the mirrors' interface"),
            (2, "the mirrors' interface was not trained"),
            (11, "the red LED failed"),
            (12, "the green LED failed"),
            (13, "the blue LED failed"),
            (16, "the sequence was aborted"),
            (17, "a sequence error"),
            (28, "a configuration error"),
            (29, "its watchdog barked"),
        ],
    ));
    words
}

fn named(bits: u32, names: &[(u32, &str)]) -> Vec<String> {
    names.iter().filter(|(bit, _)| bits >> bit & 1 == 1).map(|(_, name)| (*name).into()).collect()
}
