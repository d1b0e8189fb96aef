//! The command table of the LX200GPS: for each command the shape of its reply, and whether it may be sent.
//!
//! Read from Meade's papers (revision L of 2002, 2010.10), a capture of a real LX200GPS (firmware 4.2l) and the drivers of
//! INDI, ASCOM and INDIGO; `fixtures/reference/lx200_commands.tsv` holds the sources row by row, and a test holds this
//! table against it.

use super::frame::Shape;
use super::frame::Shape::{Date, Fixed, HighPrecision, Nothing, Slew, Text};

/// Whether a command may be sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Policy {
    /// It asks and changes nothing.
    Ask,
    /// It changes something: only for the orders that need it.
    Change,
    /// Never: the reason.
    Never(&'static str),
}
use Policy::{Ask, Change, Never};

/// One command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// Its letters after the colon, without parameters.
    pub letters: &'static str,
    /// Whether parameters follow.
    pub parameters: bool,
    /// The shape of its reply.
    pub shape: Shape,
    /// Whether it may be sent.
    pub policy: Policy,
}

const fn bare(letters: &'static str, shape: Shape, policy: Policy) -> Entry {
    Entry { letters, parameters: false, shape, policy }
}

const fn with(letters: &'static str, shape: Shape, policy: Policy) -> Entry {
    Entry { letters, parameters: true, shape, policy }
}

const ONE: Shape = Fixed { bytes: 1, hash: false };
const ONE_HASH: Shape = Fixed { bytes: 1, hash: true };
const TEXT: Shape = Text { hash_may_lack: false };

/// Every command with a colon. The two bare bytes, ACK (0x06) and EOT (0x04), are [`entry`]'s own.
pub const TABLE: &[Entry] = &[
    // Who are you?
    bare("GVP", TEXT, Ask),
    bare("GVN", TEXT, Ask),
    bare("GVD", TEXT, Ask),
    bare("GVT", TEXT, Ask),
    bare("GVF", TEXT, Ask),
    bare("GW", Fixed { bytes: 3, hash: true }, Ask),
    bare("G0", TEXT, Ask),
    bare("G1", TEXT, Ask),
    bare("G2", TEXT, Ask),
    // Where are you?
    bare("GR", TEXT, Ask),
    bare("GD", TEXT, Ask),
    bare("GA", TEXT, Ask),
    bare("GZ", TEXT, Ask),
    bare("Gr", TEXT, Ask),
    bare("Gd", TEXT, Ask),
    bare("D", TEXT, Ask),
    bare("Gm", TEXT, Ask),
    // Clock, site, limits, rate
    bare("GC", TEXT, Ask),
    bare("GL", TEXT, Ask),
    bare("Ga", TEXT, Ask),
    bare("GS", TEXT, Ask),
    bare("Gc", TEXT, Ask),
    bare("GG", TEXT, Ask),
    bare("GH", ONE_HASH, Ask),
    bare("Gt", TEXT, Ask),
    bare("Gg", TEXT, Ask),
    bare("GM", TEXT, Ask),
    bare("GN", TEXT, Ask),
    bare("GO", TEXT, Ask),
    bare("GP", TEXT, Ask),
    bare("Gh", Text { hash_may_lack: true }, Ask),
    bare("Go", TEXT, Ask),
    bare("GT", TEXT, Ask),
    with("SL", ONE, Change),
    with("SC", Date, Change),
    with("SG", ONE, Change),
    with("SH", ONE, Change),
    with("St", ONE, Change),
    with("Sg", ONE, Change),
    with("SS", ONE, Never("it shifts every later go-to")),
    with("SM", ONE, Change),
    with("SN", ONE, Change),
    with("SO", ONE, Change),
    with("SP", ONE, Change),
    with("W", Nothing, Change),
    with("hI", ONE, Change),
    bare("H", Nothing, Change),
    // Go there, stop, move
    with("Sr", ONE, Change),
    with("Sd", ONE, Change),
    with("Sa", ONE, Change),
    with("Sz", ONE, Change),
    bare("MS", Slew, Change),
    bare("MA", ONE, Change),
    bare("CM", TEXT, Change),
    bare("CL", Nothing, Change),
    bare("Me", Nothing, Change),
    bare("Mw", Nothing, Change),
    bare("Mn", Nothing, Change),
    bare("Ms", Nothing, Change),
    bare("Q", Nothing, Change),
    bare("Qe", Nothing, Change),
    bare("Qw", Nothing, Change),
    bare("Qn", Nothing, Change),
    bare("Qs", Nothing, Change),
    with("Mgn", Nothing, Change),
    with("Mgs", Nothing, Change),
    with("Mge", Nothing, Change),
    with("Mgw", Nothing, Change),
    bare("RG", Nothing, Change),
    bare("RC", Nothing, Change),
    bare("RM", Nothing, Change),
    bare("RS", Nothing, Change),
    with("R", Nothing, Change),
    with("RA", Nothing, Change),
    with("RE", Nothing, Change),
    with("Rg", Nothing, Change),
    with("Sw", ONE, Change),
    bare("U", Nothing, Change),
    bare("P", HighPrecision, Change),
    bare("TQ", Nothing, Change),
    bare("TL", Nothing, Change),
    bare("TS", Nothing, Change),
    bare("TM", Nothing, Change),
    bare("T+", Nothing, Change),
    bare("T-", Nothing, Change),
    with("ST", ONE, Change),
    // Alignment, home, sleep
    bare("AA", Nothing, Change),
    bare("AP", Nothing, Never("polar mode on a fork without a wedge ruins every go-to")),
    bare("AL", Nothing, Change),
    bare("Aa", ONE, Never("it slews unattended for minutes and replaces the alignment")),
    bare("hS", Nothing, Never("it replaces the stored home or park position, depending on the firmware")),
    bare("hF", Nothing, Never("it replaces the alignment")),
    bare("hC", Nothing, Never("it replaces the stored home position")),
    bare("hP", Nothing, Never("a parked mount is silent until its power is cycled")),
    bare("hN", Nothing, Never("a sleeping mount looks dead until a key is pressed")),
    bare("hW", Nothing, Change),
    bare("h?", ONE_HASH, Ask),
    bare("I", ONE, Never("it restarts the mount and loses the alignment")),
    // The hand controller
    bare("ED", TEXT, Ask),
    with("EK", Nothing, Change),
    with("EQ", TEXT, Ask),
    with("ES", Nothing, Change),
    // Reticle, focuser, accessories
    bare("B+", Nothing, Change),
    bare("B-", Nothing, Change),
    with("B", Nothing, Change),
    with("BD", Nothing, Change),
    bare("F+", Nothing, Change),
    bare("F-", Nothing, Change),
    bare("FQ", Nothing, Change),
    bare("FF", Nothing, Change),
    bare("FS", Nothing, Change),
    with("F", Nothing, Change),
    with("FP", Nothing, Change),
    bare("f+", Nothing, Change),
    bare("f-", Nothing, Never("it cuts the accessories' power")),
    bare("fT", TEXT, Ask),
    bare("r+", Nothing, Change),
    bare("r-", Nothing, Change),
    bare("g+", Nothing, Change),
    bare("g-", Nothing, Change),
    bare("gps", TEXT, Never("it may start a stream of unasked bytes")),
    bare("gT", ONE, Never("it blocks the hand controller for minutes and may set a wrong date")),
    // Periodic error, backlash, line speed
    bare("$Q", Nothing, Change),
    bare("$QA+", Nothing, Change),
    bare("$QA-", Nothing, Change),
    bare("$QZ+", Nothing, Change),
    bare("$QZ-", Nothing, Change),
    with("$BA", Nothing, Change),
    with("$BZ", Nothing, Change),
    with("VD", TEXT, Ask),
    with("VR", TEXT, Ask),
    with("SB", ONE, Never("on some firmware the line is dead until the power is cycled")),
    // The mount's own library
    bare("LI", TEXT, Ask),
    bare("Lf", TEXT, Ask),
    with("LM", Nothing, Change),
    with("LC", Nothing, Change),
    with("LS", Nothing, Change),
    with("Lo", ONE, Change),
    with("Ls", ONE, Change),
    bare("LB", Nothing, Change),
    bare("LN", Nothing, Change),
    bare("LF", Nothing, Change),
    bare("GF", TEXT, Ask),
    with("SF", ONE, Change),
    bare("Gb", TEXT, Ask),
    bare("Gf", TEXT, Ask),
    bare("Gl", TEXT, Ask),
    bare("Gs", TEXT, Ask),
    bare("Gq", TEXT, Ask),
    bare("Gy", TEXT, Ask),
    with("Sb", ONE, Change),
    with("Sf", ONE, Change),
    with("Sl", ONE, Change),
    with("Ss", ONE, Change),
    bare("Sq", Nothing, Change),
    with("Sy", ONE, Change),
    with("Sh", ONE, Change),
    with("So", ONE, Change),
    bare("??", TEXT, Ask),
    bare("?+", TEXT, Ask),
    bare("?-", TEXT, Ask),
];

const ACK: Entry = bare("\x06", ONE, Ask);
const EOT: Entry = bare("\x04", Nothing, Never("it opens the firmware loader"));

/// The entry of a command as sent: `:GR#`, or a bare ACK or EOT. The longest letters that fit decide.
#[must_use]
pub fn entry(command: &[u8]) -> Option<&'static Entry> {
    match command {
        [0x06] => return Some(&ACK),
        [0x04] => return Some(&EOT),
        _ => {}
    }
    let inner = command.strip_prefix(b":")?.strip_suffix(b"#")?;
    TABLE
        .iter()
        .filter(|entry| {
            inner.strip_prefix(entry.letters.as_bytes()).is_some_and(|rest| entry.parameters != rest.is_empty())
        })
        .max_by_key(|entry| entry.letters.len())
}

/// Why these bytes must not be sent, if they must not: on the list of commands never to send, or in no table.
#[must_use]
pub fn forbidden(command: &[u8]) -> Option<&'static str> {
    match entry(command) {
        None => Some("it is in no command table"),
        Some(Entry { policy: Never(why), .. }) => Some(why),
        Some(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Vec<(String, String)> {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/reference/lx200_commands.tsv");
        let rows: Vec<_> = std::fs::read_to_string(path)
            .unwrap()
            .lines()
            .skip(1)
            .map(|line| line.split('\t').map(str::to_owned).collect::<Vec<_>>())
            .map(|fields| (fields[0].clone(), fields[2].clone()))
            .collect();
        assert_eq!(rows.len(), 184);
        rows
    }

    fn bytes(written: &str) -> Vec<u8> {
        match written {
            "\\x06" => vec![6],
            "\\x04" => vec![4],
            text => text.as_bytes().to_vec(),
        }
    }

    fn shape(written: &str) -> Shape {
        let may = written.contains("(opt #)");
        match written.split_whitespace().next().unwrap() {
            "none" => Nothing,
            "term" => Text { hash_may_lack: may },
            "slew" => Slew,
            "date" => Date,
            "oneof" => HighPrecision,
            fixed => Fixed { bytes: fixed.strip_prefix("fixed").unwrap().parse().unwrap(), hash: may },
        }
    }

    #[test]
    fn every_row_of_the_published_table_is_known_with_its_reply_shape() {
        for (command, reply) in rows().into_iter().filter(|(command, _)| !command.starts_with('(')) {
            let entry = entry(&bytes(&command)).unwrap_or_else(|| panic!("{command} is not in the table"));
            assert_eq!(entry.shape, shape(&reply), "{command}");
        }
    }

    #[test]
    fn every_entry_of_ours_is_in_the_published_table() {
        let published: Vec<_> = rows().iter().filter_map(|(command, _)| entry(&bytes(command))).collect();
        let named_in_a_quirk = ["SN", "SO", "SP"];
        for ours in TABLE.iter().filter(|entry| !named_in_a_quirk.contains(&entry.letters)) {
            assert!(published.contains(&ours), "{} is published nowhere", ours.letters);
        }
    }

    #[test]
    fn the_commands_never_to_send_are_refused_with_a_reason() {
        let never: [&[u8]; 15] = [
            b":hP#",
            b":hN#",
            b":I#",
            b":SB1#",
            b":SB6#",
            b":SS12:00:00#",
            b":AP#",
            b":Aa#",
            b":hF#",
            b":hC#",
            b":hS#",
            b":gps#",
            b":gT#",
            b":f-#",
            b"\x04",
        ];
        for command in never {
            assert!(forbidden(command).is_some(), "{}", String::from_utf8_lossy(command));
        }
        assert_eq!(forbidden(b":ZZ#"), Some("it is in no command table"));
    }

    #[test]
    fn what_a_session_needs_is_not_refused() {
        for command in [&b":GR#"[..], b":MS#", b":Q#", b":Sr05:35:17#", b":Sd-05*23:28#", b":U#", b":R3#", b"\x06"] {
            assert_eq!(forbidden(command), None, "{}", String::from_utf8_lossy(command));
        }
    }
}
