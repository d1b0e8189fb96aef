//! Where a command begins and ends: `:` to `#`. Outside of that only ACK and EOT mean something; inside, everything is data,
//! another `:` too.

/// The longest command that is kept; the firmware's own buffer is not known. What is longer is forgotten up to its `#`.
const LONGEST: usize = 64;

/// Bytes that are collected to a command.
#[derive(Debug, Default)]
pub(super) struct Framing {
    /// The command so far, without its `:`; `None` outside of a command.
    body: Option<Vec<u8>>,
}

/// What one more byte completed.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Heard {
    /// Nothing yet.
    Nothing,
    /// ACK (0x06) or EOT (0x04) outside of a command.
    Control(u8),
    /// A command, without its `:` and `#`.
    Command(Vec<u8>),
}

impl Framing {
    /// Takes one byte.
    pub(super) fn push(&mut self, byte: u8) -> Heard {
        match (&mut self.body, byte) {
            (Some(_), b'#') => match self.body.take() {
                Some(body) if body.len() <= LONGEST => Heard::Command(body),
                _ => Heard::Nothing,
            },
            (Some(body), byte) => {
                if body.len() <= LONGEST {
                    body.push(byte);
                }
                Heard::Nothing
            }
            (None, b':') => {
                self.body = Some(Vec::new());
                Heard::Nothing
            }
            (None, 0x06 | 0x04) => Heard::Control(byte),
            (None, _) => Heard::Nothing,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heard(bytes: &[u8]) -> Vec<Heard> {
        let mut framing = Framing::default();
        bytes.iter().map(|byte| framing.push(*byte)).filter(|heard| *heard != Heard::Nothing).collect()
    }

    #[test]
    fn stray_bytes_and_a_leading_hash_are_ignored() {
        assert_eq!(heard(b"x##:GR#\r\n"), [Heard::Command(b"GR".to_vec())]);
    }

    #[test]
    fn a_colon_inside_a_command_is_data() {
        assert_eq!(heard(b":Sr12:34:56#"), [Heard::Command(b"Sr12:34:56".to_vec())]);
        assert_eq!(heard(b":GR:GD#"), [Heard::Command(b"GR:GD".to_vec())]);
    }

    #[test]
    fn ack_counts_only_outside_of_a_command() {
        assert_eq!(heard(b"\x06:G\x06#"), [Heard::Control(6), Heard::Command(b"G\x06".to_vec())]);
    }

    #[test]
    fn an_endless_command_takes_no_memory_and_is_forgotten() {
        let mut bytes = vec![b'A'; 100_000];
        bytes[0] = b':';
        bytes.extend(b"#:GR#");
        assert_eq!(heard(&bytes), [Heard::Command(b"GR".to_vec())]);
    }
}
