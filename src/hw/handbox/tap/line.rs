//! The settings of a tapped line, and the marks that the system puts before characters that are not well formed.

use std::fs::File;

use rustix::termios::{ControlModes, InputModes, OptionalActions, tcgetattr, tcsetattr};

use super::Received;
use crate::hw::handbox::keymap::{Line, Parity};

/// Sets speed and form. Nothing that the system could send by itself is left on: no echo, no XON or XOFF.
pub(super) fn set(port: &File, line: &Line) -> rustix::io::Result<()> {
    let mut modes = tcgetattr(port)?;
    modes.make_raw();
    modes.input_modes &=
        !(InputModes::IXOFF | InputModes::IXON | InputModes::IXANY | InputModes::IGNPAR | InputModes::IGNBRK);
    modes.input_modes |= InputModes::PARMRK | InputModes::INPCK;
    let form = ControlModes::CSIZE
        | ControlModes::CSTOPB
        | ControlModes::PARENB
        | ControlModes::PARODD
        | ControlModes::CRTSCTS;
    modes.control_modes &= !(form | ControlModes::HUPCL);
    modes.control_modes |= ControlModes::CREAD | ControlModes::CLOCAL;
    modes.control_modes |= if line.data_bits == 7 { ControlModes::CS7 } else { ControlModes::CS8 };
    if line.stop_bits == 2 {
        modes.control_modes |= ControlModes::CSTOPB;
    }
    modes.control_modes |= match line.parity {
        Parity::None => ControlModes::empty(),
        Parity::Even => ControlModes::PARENB,
        Parity::Odd => ControlModes::PARENB | ControlModes::PARODD,
    };
    modes.set_speed(line.baud)?;
    // What came at the old settings is noise.
    tcsetattr(port, OptionalActions::Flush, &modes)
}

/// Where in a mark we are: `FF 00 x` is a character that was not well formed (`x` as it came), `FF FF` a true `FF`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Marks {
    #[default]
    Outside,
    Marked,
    Malformed,
}

impl Marks {
    /// Takes the marks out.
    pub(super) fn read(&mut self, raw: &[u8]) -> Received {
        let mut read = Received::default();
        for byte in raw {
            *self = match (*self, byte) {
                (Marks::Outside, 0xFF) => Marks::Marked,
                (Marks::Outside, byte) | (Marks::Marked, byte @ 0xFF) => {
                    read.bytes.push(*byte);
                    Marks::Outside
                }
                (Marks::Marked, 0) => Marks::Malformed,
                // No mark after all: a driver that does not mark.
                (Marks::Marked, byte) => {
                    read.bytes.extend([0xFF, *byte]);
                    Marks::Outside
                }
                (Marks::Malformed, _) => {
                    read.malformed += 1;
                    Marks::Outside
                }
            };
        }
        read
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_taken_out_wherever_they_are_cut() {
        let raw = [0x3F, 0xFF, 0xFF, 0xFF, 0x00, 0x80, 0xBF, 0xFF, 0x00, 0xFF, 0xFF, 0xFF];
        for cut in 0..=raw.len() {
            let mut marks = Marks::default();
            let (first, second) = (marks.read(&raw[..cut]), marks.read(&raw[cut..]));
            assert_eq!([first.bytes, second.bytes].concat(), [0x3F, 0xFF, 0xBF, 0xFF], "cut at {cut}");
            assert_eq!(first.malformed + second.malformed, 2);
        }
    }
}
