//! Where a reply ends: bytes in, one whole reply out, by the shape that the command's reply has.

/// The shape of a reply.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// No reply at all.
    Nothing,
    /// So many bytes without a `#`; `hash` when some firmware sends one nevertheless.
    Fixed {
        /// How many bytes.
        bytes: usize,
        /// Whether a `#` may follow.
        hash: bool,
    },
    /// Text up to `#`; some firmware may leave the `#` out.
    Text {
        /// Whether silence also ends the text.
        hash_may_lack: bool,
    },
    /// `:MS#`: a bare `0`, or a digit and text up to `#`.
    Slew,
    /// `:SC`: a bare `0`, or `1`, text, `#`, any number of blanks, `#`.
    Date,
    /// `:P#`: `HIGH PRECISION` or `LOW  PRECISION`, 14 bytes, no `#`.
    HighPrecision,
}

/// "Busy", in place of any reply.
pub const NAK: u8 = 0x15;

/// The longest reply: the help text of `:ED#` has about 1 kB.
pub const LONGEST: usize = 2048;

/// What one more byte made of a reply.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// Not yet whole.
    More,
    /// Whole: [`Framer::reply`] has it.
    Whole,
    /// The mount is busy and will not answer.
    Nak,
    /// Longer than any reply.
    TooLong,
}

/// Collects one reply. Holds at most [`LONGEST`] bytes.
#[derive(Debug, Clone)]
pub struct Framer {
    shape: Shape,
    bytes: Vec<u8>,
}

impl Framer {
    /// For a reply of this shape.
    #[must_use]
    pub fn new(shape: Shape) -> Framer {
        Framer { shape, bytes: Vec::new() }
    }

    /// Takes the next byte.
    pub fn push(&mut self, byte: u8) -> Step {
        if byte == NAK && self.bytes.is_empty() {
            return Step::Nak;
        }
        if self.bytes.len() >= LONGEST {
            return Step::TooLong;
        }
        self.bytes.push(byte);
        let whole = match self.shape {
            Shape::Nothing => true,
            Shape::Fixed { bytes, .. } => self.bytes.len() == bytes,
            Shape::Text { .. } => byte == b'#',
            Shape::Slew => byte == b'#' || self.bytes == b"0",
            Shape::Date => self.bytes[0] != b'1' || self.bytes.iter().filter(|b| **b == b'#').count() == 2,
            Shape::HighPrecision => self.bytes.len() == 14,
        };
        if whole { Step::Whole } else { Step::More }
    }

    /// Whether any byte has come.
    #[must_use]
    pub fn begun(&self) -> bool {
        !self.bytes.is_empty()
    }

    /// Whether silence may end the reply as it stands: text without its `#`, the lone `1` of an Autostar 494 to `:MS#`.
    #[must_use]
    pub fn silence_ends_it(&self) -> bool {
        match self.shape {
            Shape::Text { hash_may_lack } => hash_may_lack && self.begun(),
            Shape::Slew => self.bytes.len() == 1,
            Shape::HighPrecision => self.bytes == b"LOW PRECISION",
            _ => false,
        }
    }

    /// The bytes so far, with their `#` if it came.
    #[must_use]
    pub fn reply(&self) -> &[u8] {
        &self.bytes
    }
}

/// Bytes as text that a terminal can be shown: 0xDF is a degree sign, what cannot be shown is a dot, at most 80 characters.
#[must_use]
pub fn printable(bytes: &[u8]) -> String {
    bytes.iter().take(80).map(|byte| character(*byte)).collect()
}

/// A byte as a character that a terminal can be shown.
#[must_use]
pub fn character(byte: u8) -> char {
    match byte {
        0xDF => '°',
        0x20..=0x7E => char::from(byte),
        _ => '.',
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(shape: Shape, bytes: &[u8]) -> Option<(usize, Vec<u8>)> {
        let mut framer = Framer::new(shape);
        for (index, byte) in bytes.iter().enumerate() {
            if framer.push(*byte) == Step::Whole {
                return Some((index + 1, framer.reply().to_vec()));
            }
        }
        None
    }

    #[test]
    fn the_declination_of_a_real_mount_ends_at_its_hash() {
        // Stellarium issue 818: hex dump of a real LX200GPS.
        let bytes = [0x2B, 0x35, 0x31, 0xDF, 0x31, 0x34, 0x3A, 0x32, 0x30, 0x23];
        assert_eq!(frame(Shape::Text { hash_may_lack: false }, &bytes), Some((10, bytes.to_vec())));
    }

    #[test]
    fn a_zero_to_ms_ends_without_a_hash_and_a_refusal_with_one() {
        assert_eq!(frame(Shape::Slew, b"0"), Some((1, b"0".to_vec())));
        assert_eq!(frame(Shape::Slew, b"1Object Below Horizon #"), Some((23, b"1Object Below Horizon #".to_vec())));
        let mut lone = Framer::new(Shape::Slew);
        assert_eq!(lone.push(b'1'), Step::More);
        assert!(lone.silence_ends_it());
    }

    #[test]
    fn a_date_is_two_strings_however_many_blanks_are_in_the_second() {
        for blanks in [0, 18, 23, 24, 32, 43] {
            let reply = format!("1Updating Planetary Data#{}#", " ".repeat(blanks));
            assert_eq!(frame(Shape::Date, reply.as_bytes()).unwrap().0, reply.len());
        }
        assert_eq!(frame(Shape::Date, b"0").unwrap().0, 1);
    }

    #[test]
    fn the_status_is_three_bytes_and_high_precision_fourteen() {
        assert_eq!(frame(Shape::Fixed { bytes: 3, hash: true }, b"ANP"), Some((3, b"ANP".to_vec())));
        assert_eq!(frame(Shape::HighPrecision, b"LOW  PRECISION").unwrap().0, 14);
        assert_eq!(frame(Shape::HighPrecision, b"HIGH PRECISION").unwrap().0, 14);
    }

    #[test]
    fn a_nak_replaces_a_reply_only_as_its_first_byte() {
        let mut framer = Framer::new(Shape::Text { hash_may_lack: false });
        assert_eq!(framer.push(NAK), Step::Nak);
        assert_eq!(framer.push(b'A'), Step::More);
        assert_eq!(framer.push(NAK), Step::More);
    }

    #[test]
    fn a_flood_without_a_hash_is_cut_off() {
        let mut framer = Framer::new(Shape::Text { hash_may_lack: false });
        let steps: Vec<_> = (0..LONGEST + 10).map(|_| framer.push(b'U')).collect();
        assert_eq!(steps[LONGEST], Step::TooLong);
        assert_eq!(framer.reply().len(), LONGEST);
    }

    #[test]
    fn escapes_never_reach_a_terminal() {
        assert_eq!(printable(b"\x1b[2J+51\xDF14\x9b\x07"), ".[2J+51°14..");
    }
}
