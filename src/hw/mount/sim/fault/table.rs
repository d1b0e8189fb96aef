//! One table of all faults: name, values, meaning, and what switching it on does.

use super::read::{chance, count, milliseconds, number, seconds, span, switch, words};
use super::{Degree, FaultError, Faults, plain};

/// One fault that can be switched on.
#[derive(Debug)]
pub struct Entry {
    /// Its name.
    pub name: &'static str,
    /// What values it takes, in words.
    pub values: &'static str,
    /// A value that fits.
    pub example: &'static str,
    /// What it does.
    pub meaning: &'static str,
    pub(super) set: fn(&mut Faults, &str) -> Option<()>,
}

impl Entry {
    pub(super) fn refuses(&self, value: &str) -> FaultError {
        FaultError::Value { name: self.name, value: plain(value), values: self.values, example: self.example }
    }
}

const CHANCE: &str = "a chance from 0 to 1";
const SWITCH: &str = "on or off";
const AT: &str = "seconds after the start";
const SPAN: &str = "FROM,SECONDS (from when after the start, for how long)";

macro_rules! faults {
    ($($name:literal, $values:expr, $example:literal, $meaning:literal, |$faults:ident, $text:ident| $set:expr;)*) => {
        /// All faults, those of the line first, then those of the port, of what the mount says, and of what it does.
        pub const TABLE: &[Entry] = &[$(Entry {
            name: $name,
            values: $values,
            example: $example,
            meaning: $meaning,
            set: |$faults, $text| { $set; Some(()) },
        }),*];
    };
}

faults! {
    "nak", CHANCE, "0.2", "a busy mount: one to three commands in a row are answered with NAK (0x15)",
        |f, v| f.nak = chance(v)?;
    "silence", SPAN, "5,10", "commands are heard and obeyed, nothing is answered",
        |f, v| f.silence = Some(span(v)?);
    "drop", CHANCE, "0.02", "bytes of replies are lost",
        |f, v| f.drop = chance(v)?;
    "insert", CHANCE, "0.02", "random bytes stand between those of replies",
        |f, v| f.insert = chance(v)?;
    "flip", CHANCE, "0.02", "one bit of a reply's byte is wrong",
        |f, v| f.flip = chance(v)?;
    "duplicate", CHANCE, "0.02", "bytes of replies come twice",
        |f, v| f.duplicate = chance(v)?;
    "deaf", CHANCE, "0.01", "the mount hears one bit of a command's byte wrong",
        |f, v| f.deaf = chance(v)?;
    "half", CHANCE, "0.1", "a reply breaks off in its middle and the rest never comes",
        |f, v| f.half = chance(v)?;
    "truncate", "a number of bytes, 0 to 99", "3", "every reply ends after so many bytes",
        |f, v| f.truncate = Some(count(v, 99)?);
    "stall", "CHANCE,MILLISECONDS", "0.1,700", "a reply stops in its middle and its rest comes late",
        |f, v| f.stall = Some(v.split_once(',').and_then(|(p, ms)| Some((chance(p)?, milliseconds(ms)?)))?);
    "delay", "milliseconds", "500", "every reply comes so much later",
        |f, v| f.delay = milliseconds(v)?;
    "swap", CHANCE, "0.1", "a command gets the reply of the command before it",
        |f, v| f.swap = chance(v)?;
    "glue", CHANCE, "0.1", "a reply waits for the next and both come at once",
        |f, v| f.glue = chance(v)?;
    "unsolicited", CHANCE, "0.1", "a reply is followed by a GPS sentence that nobody asked for",
        |f, v| f.unsolicited = chance(v)?;
    "flood", "FROM,BYTES (seconds after the start; at most 10000000)", "5,1000000", "bytes without any # pour in at line speed",
        |f, v| f.flood = Some(v.split_once(',').and_then(|(at, n)| Some((seconds(at)?, count(n, 10_000_000)?)))?);
    "wrong-baud", SWITCH, "on", "all bytes are garbage, both ways, as if one side had another baud rate",
        |f, v| f.wrong_baud = switch(v)?;
    "break", SPAN, "5,10", "the line is held low: one NUL, then nothing, both ways",
        |f, v| f.line_break = Some(span(v)?);
    "loop", SWITCH, "on", "a looped cable: every byte comes back, no mount",
        |f, v| f.looped = switch(v)?;
    "echo", SWITCH, "on", "every byte comes back before the mount answers",
        |f, v| f.echo = switch(v)?;
    "stale", SWITCH, "on", "an old reply waits for each client",
        |f, v| f.stale = switch(v)?;
    "hold-sync", SWITCH, "on", "the reply to a sync (:CM#) waits for another byte, as on older Autostars",
        |f, v| f.hold_sync = switch(v)?;
    "unplug", SPAN, "5,3", "the port disappears and comes back (a pty under another name)",
        |f, v| f.unplug = Some(span(v)?);
    "unplug-at", "the beginning of a command, like :MS", ":MS", "the port disappears for two seconds when that command is heard; once",
        |f, v| f.unplug_at = Some(words(v.trim_start_matches(':'))?);
    "park-silence", SWITCH, "on", "nothing is answered after a park, until the power is cycled",
        |f, v| f.park_silence = switch(v)?;
    "rollover", SWITCH, "on", "the GPS week rollover: the clock is 1024 weeks behind",
        |f, v| f.rollover = switch(v)?;
    "zone-sign", SWITCH, "on", "the time zone has the wrong sign",
        |f, v| f.zone_sign = switch(v)?;
    "longitude-sign", SWITCH, "on", "the site's longitude has the wrong sign",
        |f, v| f.longitude_sign = switch(v)?;
    "clock-error", "seconds", "3600", "the clock is fast by so much",
        |f, v| f.clock_error_s = number(v)?;
    "clock-jump", "AT,SECONDS (when after the start, by how much)", "10,-3600", "the clock jumps once",
        |f, v| f.clock_jump = Some(v.split_once(',').and_then(|(at, by)| Some((seconds(at)?, number(by)?)))?);
    "utc-date", SWITCH, "on", "the date in :SC is taken as that of UTC, as Meade's paper has it",
        |f, v| f.utc_date = switch(v)?;
    "sites-from-one", SWITCH, "on", ":W counts the sites from 1 to 4 (manual of 2010), not from 0 to 3 (2002)",
        |f, v| f.sites_from_one = switch(v)?;
    "frozen", AT, "20", "from then on the coordinates that are told stand still",
        |f, v| f.frozen = Some(seconds(v)?);
    "jump", CHANCE, "0.05", "one coordinate told is wild, the next is right again",
        |f, v| f.jump = chance(v)?;
    "wrong-altitude", SWITCH, "on", ":GA# answers with the declination, as Autostar 44Eg does",
        |f, v| f.wrong_altitude = switch(v)?;
    "short", SWITCH, "on", "coordinates are in the short format at the start",
        |f, v| f.short = switch(v)?;
    "format-switch", AT, "10", "somebody changes the format of coordinates",
        |f, v| f.format_switch = Some(seconds(v)?);
    "degree", "real, star, colon or e1", "star", "the characters of clones in angles: * and ', or : and :, or 0xE1 and :",
        |f, v| f.degree = match v {
            "real" => Degree::Real,
            "star" => Degree::Star,
            "colon" => Degree::Colon,
            "e1" => Degree::E1,
            _ => return None,
        };
    "product", "a name, or `none` for a classic LX200 that has no :GV commands", "Autostar", "who the mount says it is",
        |f, v| f.product = Some(words(v)?);
    "escapes", SWITCH, "on", "names that the mount tells hold terminal escapes",
        |f, v| f.escapes = switch(v)?;
    "ignore-stop", "a number of commands", "3", "so many stop commands are not obeyed",
        |f, v| f.ignored_stops = count(v, 1_000_000)?.try_into().ok()?;
    "refuse", "0 to 4", "2", "what :MS# answers, whatever the target",
        |f, v| f.refuse = Some(count(v, 4)?.try_into().ok()?);
    "late-bar", "seconds", "5", "the distance bar of a go-to shows so much too late",
        |f, v| f.late_bar = seconds(v)?;
    "reversed", SWITCH, "on", "east and west are exchanged in moves by hand",
        |f, v| f.reversed = switch(v)?;
    "keypad", "AT,DIRECTION,SECONDS (n, s, e or w)", "10,e,5", "somebody holds an arrow key of the hand controller at full speed",
        |f, v| f.keypad = Some({
            let parts: Vec<&str> = v.split(',').collect();
            let [at, direction @ ("n" | "s" | "e" | "w"), lasts] = parts[..] else { return None };
            (seconds(at)?, direction.chars().next()?, seconds(lasts)?)
        });
    "push", "AT,AZIMUTH,ALTITUDE (seconds, degrees, degrees)", "10,5,-2", "somebody pushes the tube through its clutches: the mount does not notice",
        |f, v| f.push = Some({
            let parts: Vec<&str> = v.split(',').collect();
            let [at, azimuth, altitude] = parts[..] else { return None };
            let held = |text| number(text).filter(|degrees| degrees.abs() <= 180.0);
            (seconds(at)?, held(azimuth)?, held(altitude)?)
        });
    "restart", AT, "10", "the power fails for a moment: the alignment is lost",
        |f, v| f.restart = Some(seconds(v)?);
    "unaligned", SWITCH, "on", "it starts without an alignment",
        |f, v| f.unaligned = switch(v)?;
    "not-tracking", SWITCH, "on", "it starts without tracking: right ascension grows by a second a second",
        |f, v| f.not_tracking = switch(v)?;
    "asleep", SWITCH, "on", "it starts asleep and answers nothing until :hW#",
        |f, v| f.asleep = switch(v)?;
}
