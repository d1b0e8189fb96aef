//! What becomes of a whole reply, and of single bytes, on a bad line.

use std::time::Duration;

use super::Wire;

/// A sentence as `:gps#` sends it; RMC without a fix.
const GPS_SENTENCE: &[u8] = b"$GPRMC,235959.00,V,,,,,,,010100,,,N*7F\r\n";

impl Wire {
    /// Sends one part of a reply, or what the faults make of it.
    pub(super) fn spoken(&mut self, bytes: Vec<u8>, start: Duration) {
        let mut bytes = self.swapped(bytes);
        if let Some(most) = self.faults.truncate {
            bytes.truncate(most);
        }
        if self.random.chance(self.faults.half) {
            bytes.truncate(bytes.len() / 2);
        }
        if self.random.chance(self.faults.glue) && self.glued.len() < 256 {
            self.glued.extend(bytes);
            return;
        }
        let mut whole = std::mem::take(&mut self.glued);
        whole.extend(bytes);
        if self.random.chance(self.faults.unsolicited) {
            whole.extend(GPS_SENTENCE);
        }
        match self.faults.stall {
            Some((chance, pause)) if self.random.chance(chance) => {
                let (first, rest) = whole.split_at(whole.len() / 2);
                self.send(first, start);
                self.send(rest, start + pause);
            }
            _ => self.send(&whole, start),
        }
    }

    /// The reply to the command before in place of this one's.
    fn swapped(&mut self, bytes: Vec<u8>) -> Vec<u8> {
        if self.faults.swap == 0.0 {
            return bytes;
        }
        let previous = std::mem::replace(&mut self.previous, bytes.clone());
        if !previous.is_empty() && self.random.chance(self.faults.swap) { previous } else { bytes }
    }

    /// A byte of a reply as the computer reads it.
    pub(super) fn misread(&mut self, byte: u8) -> u8 {
        let chance = self.faults.flip;
        self.disturbed(byte, chance)
    }

    /// A byte of a command as the mount hears it.
    pub(super) fn misheard(&mut self, byte: u8) -> u8 {
        let chance = self.faults.deaf;
        self.disturbed(byte, chance)
    }

    fn disturbed(&mut self, byte: u8, chance: f64) -> u8 {
        if self.faults.wrong_baud {
            return self.random.byte() | 0x80;
        }
        if self.random.chance(chance) { byte ^ (1 << (self.random.byte() % 8)) } else { byte }
    }
}
