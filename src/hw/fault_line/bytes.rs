//! What becomes of a single byte on the way.

use std::time::Duration;

use super::cable::{Active, Cable};
use super::mischief::{Mischief, Side};

/// The bytes that arrive for one that was sent: none, itself, or others.
pub(super) fn disturbed(byte: u8, active: &[Active], way: Side, cable: &Cable, now: Duration) -> Vec<u8> {
    let mut out = Vec::with_capacity(2);
    let mut sent = byte;
    for (mischief, ..) in active.iter().filter(|(_, side, _)| *side == way || *side == Side::Both) {
        let strikes = |chance: f64| {
            let struck = cable.chance(chance);
            if struck {
                cable.strike(*mischief);
            }
            struck
        };
        match *mischief {
            Mischief::Drop(chance) if strikes(chance) => {
                note_alteration(way, byte, None, cable, now);
                return out;
            }
            Mischief::Insert(chance) if strikes(chance) => out.push(if cable.chance(0.5) { 0xFF } else { 0 }),
            Mischief::Crosstalk(chance) if strikes(chance) => out.extend(b"\x1b1Select Item:    "),
            Mischief::Flip(chance) if strikes(chance) => {
                let flipped = sent ^ (1 << (cable.byte() % 8));
                note_alteration(way, sent, Some(flipped), cable, now);
                sent = flipped;
            }
            Mischief::Duplicate(chance) if strikes(chance) => {
                note_alteration(way, byte, None, cable, now);
                out.push(sent);
            }
            _ => {}
        }
    }
    if active.iter().any(|(mischief, ..)| *mischief == Mischief::WrongBaud) {
        cable.strike(Mischief::WrongBaud);
        // At another rate the stop bit falls among the data: framing errors, and mostly high bits.
        sent = cable.byte() | 0x80;
    }
    out.push(sent);
    out
}

/// Notes a change that no reader of this protocol can notice: one digit, sign or bar for another in a reply; any change of a
/// command, which may then be another command.
fn note_alteration(way: Side, from: u8, to: Option<u8>, cable: &Cable, now: Duration) {
    let plain = |byte: u8| byte.is_ascii_graphic() || byte == b' ';
    let unnoticed = match (way, to) {
        (Side::Replies, Some(to)) => plain(from) && plain(to),
        (Side::Replies, None) => from.is_ascii_digit(),
        _ => true,
    };
    if unnoticed {
        cable.altered(now);
    }
}
