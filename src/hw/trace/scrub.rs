//! Takes the observer's place out of a recording: a trace may be given to strangers.
//!
//! Latitude, longitude, sidereal time and horizontal coordinates tell where the telescope stands, so their digits become `0`; site
//! names become `x`. Lengths and times stay, so that the recording can be replayed.

/// Commands whose replies tell the place: two letters after the colon.
const TELLING: [&[u8]; 5] = [b"Gt", b"Gg", b"GS", b"GA", b"GZ"];
/// Commands whose replies are names of sites.
const NAMING: [&[u8]; 4] = [b"GM", b"GN", b"GO", b"GP"];
/// Commands whose parameters tell the place, and those whose are names.
const SETTING: [&[u8]; 4] = [b"St", b"Sg", b"Sa", b"Sz"];
const SETTING_NAMES: [&[u8]; 4] = [b"SM", b"SN", b"SO", b"SP"];

/// What becomes of the bytes under way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Rub {
    Nothing,
    Digits,
    Letters,
}

/// Scrubs a conversation as it passes, both ways.
#[derive(Debug, Clone)]
pub struct Scrubber {
    /// The letters of the command under way.
    letters: Vec<u8>,
    in_command: bool,
    /// What is rubbed out of the reply to the last command.
    reply: Rub,
    in_sentence: bool,
}

impl Default for Scrubber {
    fn default() -> Scrubber {
        Scrubber { letters: Vec::new(), in_command: false, reply: Rub::Nothing, in_sentence: false }
    }
}

impl Scrubber {
    /// Bytes to the mount, as they may be written down.
    #[must_use]
    pub fn to_mount(&mut self, bytes: &[u8]) -> Vec<u8> {
        bytes.iter().map(|byte| self.sent(*byte)).collect()
    }

    /// Bytes from the mount, as they may be written down.
    #[must_use]
    pub fn from_mount(&mut self, bytes: &[u8]) -> Vec<u8> {
        bytes.iter().map(|byte| self.came(*byte)).collect()
    }

    fn sent(&mut self, byte: u8) -> u8 {
        match byte {
            b':' if self.letters.len() < 2 || !self.in_command => {
                self.in_command = true;
                self.letters.clear();
                byte
            }
            b'#' | 0x06 => {
                let is = |list: &[&[u8]]| list.contains(&self.letters.as_slice());
                self.reply = match () {
                    () if is(&TELLING) => Rub::Digits,
                    () if is(&NAMING) => Rub::Letters,
                    () => Rub::Nothing,
                };
                self.in_command = false;
                byte
            }
            _ if self.in_command && self.letters.len() < 2 => {
                self.letters.push(byte);
                byte
            }
            _ if self.in_command && SETTING.contains(&self.letters.as_slice()) => rubbed(byte, Rub::Digits),
            _ if self.in_command && SETTING_NAMES.contains(&self.letters.as_slice()) => rubbed(byte, Rub::Letters),
            _ => byte,
        }
    }

    fn came(&mut self, byte: u8) -> u8 {
        // A GPS sentence tells the place by itself.
        match byte {
            b'$' => self.in_sentence = true,
            b'\n' | b'#' => self.in_sentence = false,
            _ => {}
        }
        rubbed(byte, if self.in_sentence { Rub::Digits } else { self.reply })
    }
}

fn rubbed(byte: u8, rub: Rub) -> u8 {
    match rub {
        Rub::Digits if byte.is_ascii_digit() => b'0',
        Rub::Letters if byte.is_ascii_alphanumeric() => b'x',
        _ => byte,
    }
}

/// A header without its site.
#[must_use]
pub(super) fn header(header: &serde_json::Value) -> serde_json::Value {
    let mut header = header.clone();
    if let Some(entries) = header.as_object_mut() {
        for key in ["site", "latitude", "longitude", "place"] {
            if let Some(value) = entries.get_mut(key) {
                *value = "scrubbed".into();
            }
        }
    }
    header
}

#[cfg(test)]
mod tests {
    use super::*;

    fn talk(command: &[u8], reply: &[u8]) -> (Vec<u8>, Vec<u8>) {
        let mut scrubber = Scrubber::default();
        // Byte by byte, as a line brings them.
        let sent = command.iter().flat_map(|byte| scrubber.to_mount(&[*byte])).collect();
        let came = reply.iter().flat_map(|byte| scrubber.from_mount(&[*byte])).collect();
        (sent, came)
    }

    #[test]
    fn nothing_that_tells_the_place_is_left_and_every_length_is() {
        for (command, reply, sent, came) in [
            (&b":Gt#"[..], &b"+52\xDF10:44#"[..], &b":Gt#"[..], &b"+00\xDF00:00#"[..]),
            (b"#:Gg#", b"354\xDF36:54#", b"#:Gg#", b"000\xDF00:00#"),
            (b":GS#", b"17:29:15#", b":GS#", b"00:00:00#"),
            (b":GM#", b"Irvine#", b":GM#", b"xxxxxx#"),
            (b":St+52*10#", b"1", b":St+00*00#", b"1"),
            (b":Sg354*36#", b"1", b":Sg000*00#", b"1"),
            (b":GR#", b"05:29:28#", b":GR#", b"05:29:28#"),
            (b":SL20:01:31#", b"1", b":SL20:01:31#", b"1"),
            (b"\x06", b"A", b"\x06", b"A"),
            (b":GR#", b"05:29:28#$GPGGA,2015,4915.60,N#", b":GR#", b"05:29:28#$GPGGA,0000,0000.00,N#"),
        ] {
            assert_eq!(talk(command, reply), (sent.to_vec(), came.to_vec()), "{}", command.escape_ascii());
        }
    }

    #[test]
    fn the_header_loses_its_site() {
        let scrubbed = header(&serde_json::json!({"who": "x", "site": "49.26,7.04,230"}));
        assert_eq!(scrubbed, serde_json::json!({"who": "x", "site": "scrubbed"}));
    }
}
