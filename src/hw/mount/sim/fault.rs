//! The faults that can be switched on, by name. Each was seen in the field or on a bench.

mod read;
mod table;

use std::time::Duration;

pub use self::table::{Entry, TABLE};

/// What goes wrong. The default is nothing. Probabilities are 0 to 1; times count from the simulator's start.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Faults {
    /// Chance that a command opens a burst of one to three commands that are answered with NAK.
    pub nak: f64,
    /// From when, and for how long, nothing is answered.
    pub silence: Option<Span>,
    /// Chance, for each byte of a reply, to be lost.
    pub drop: f64,
    /// Chance, for each byte of a reply, of a random byte before it.
    pub insert: f64,
    /// Chance, for each byte of a reply, that one bit is wrong.
    pub flip: f64,
    /// Chance, for each byte of a reply, to come twice.
    pub duplicate: f64,
    /// Chance, for each byte of a command, that the mount hears one bit wrong.
    pub deaf: f64,
    /// Chance that a reply breaks off in its middle.
    pub half: f64,
    /// Every reply ends after so many bytes.
    pub truncate: Option<usize>,
    /// Chance, and time, of a reply that stops in its middle and goes on late.
    pub stall: Option<(f64, Duration)>,
    /// Every reply comes later by this.
    pub delay: Duration,
    /// Chance that a command gets the reply of the one before.
    pub swap: f64,
    /// Chance that a reply waits and goes out together with the next.
    pub glue: f64,
    /// Chance that a reply is followed by text that nobody asked for.
    pub unsolicited: f64,
    /// From when, and how many, bytes without any `#` pour in.
    pub flood: Option<(Duration, usize)>,
    /// What comes over the line looks like the wrong baud rate.
    pub wrong_baud: bool,
    /// From when, and for how long, the line is held low: one NUL and then nothing, in both directions.
    pub line_break: Option<Span>,
    /// The line comes back on itself and there is no mount.
    pub looped: bool,
    /// Each byte comes back before the mount answers.
    pub echo: bool,
    /// Bytes of an old reply wait for each client.
    pub stale: bool,
    /// The reply to a sync is held back until another byte arrives.
    pub hold_sync: bool,
    /// From when, and for how long, the port is gone.
    pub unplug: Option<Span>,
    /// The port goes for two seconds as soon as a command with this beginning is heard; once.
    pub unplug_at: Option<String>,
    /// Nothing is answered after a park.
    pub park_silence: bool,
    /// The clock is 1024 weeks behind.
    pub rollover: bool,
    /// The zone has the wrong sign.
    pub zone_sign: bool,
    /// The longitude has the wrong sign.
    pub longitude_sign: bool,
    /// The clock is fast by so many seconds.
    pub clock_error_s: f64,
    /// When, and by how many seconds, the clock jumps.
    pub clock_jump: Option<(Duration, f64)>,
    /// The date in `:SC` is taken as that of UTC.
    pub utc_date: bool,
    /// Sites are counted from 1 to 4, not from 0 to 3.
    pub sites_from_one: bool,
    /// From when on the coordinates that are told stand still.
    pub frozen: Option<Duration>,
    /// Chance that one coordinate told is wild.
    pub jump: f64,
    /// `:GA#` answers with the declination.
    pub wrong_altitude: bool,
    /// The short format at the start.
    pub short: bool,
    /// When the format changes by itself.
    pub format_switch: Option<Duration>,
    /// The characters of a clone in angles.
    pub degree: Degree,
    /// Who the mount says it is.
    pub product: Option<String>,
    /// Every name the mount tells has terminal escapes in it.
    pub escapes: bool,
    /// How many stop commands are not obeyed.
    pub ignored_stops: u32,
    /// The answer of `:MS#` whatever the target is, if not 0.
    pub refuse: Option<u8>,
    /// The distance bar shows so much too late.
    pub late_bar: Duration,
    /// East and west are exchanged in moves by hand.
    pub reversed: bool,
    /// When somebody holds a key of the hand controller, which way, and how long.
    pub keypad: Option<(Duration, char, Duration)>,
    /// When somebody pushes the tube through its clutches, and by how many degrees of azimuth and altitude.
    pub push: Option<(Duration, f64, f64)>,
    /// When the power fails for a moment.
    pub restart: Option<Duration>,
    /// It starts without an alignment.
    pub unaligned: bool,
    /// It starts without tracking.
    pub not_tracking: bool,
    /// It starts asleep.
    pub asleep: bool,
}

/// A stretch of time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    /// When it begins.
    pub from: Duration,
    /// How long it lasts.
    pub lasts: Duration,
}

impl Span {
    /// Whether the stretch holds this time.
    #[must_use]
    pub fn holds(&self, now: Duration) -> bool {
        now >= self.from && now < self.end()
    }

    /// When it is over.
    #[must_use]
    pub fn end(&self) -> Duration {
        self.from.saturating_add(self.lasts)
    }
}

/// The characters that stand for degrees and minutes in replies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Degree {
    /// 0xDF and `:`, as a real LX200GPS has them.
    #[default]
    Real,
    /// `*` and `'`, as Meade's paper prints them and clones send them.
    Star,
    /// `:` and `:`.
    Colon,
    /// 0xE1 and `:`.
    E1,
}

/// Why a fault could not be switched on.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FaultError {
    /// Not of the form NAME=VALUE.
    #[error("a fault is NAME=VALUE, like nak=0.1; this is '{0}' (`--fault list` shows all names)")]
    Form(String),
    /// No such name.
    #[error("there is no fault '{name}'{}; `--fault list` shows all names", near_words(near))]
    Unknown {
        /// What was asked for.
        name: String,
        /// Names that look like it.
        near: Vec<&'static str>,
    },
    /// The value does not fit the name.
    #[error("fault {name} takes {values}; '{value}' is not that (for example {name}={example})")]
    Value {
        /// The fault.
        name: &'static str,
        /// What was given.
        value: String,
        /// What it takes, in words.
        values: &'static str,
        /// A value that would do.
        example: &'static str,
    },
}

fn near_words(near: &[&str]) -> String {
    if near.is_empty() { String::new() } else { format!(" (did you mean {}?)", near.join(" or ")) }
}

impl Faults {
    /// Switches one fault on, from `NAME=VALUE`.
    ///
    /// # Errors
    /// An unknown name, with the names near it; a value that does not fit, with one that would.
    pub fn switch(&mut self, text: &str) -> Result<(), FaultError> {
        let Some((name, value)) = text.split_once('=') else {
            return match TABLE.iter().find(|entry| entry.name == text) {
                Some(entry) => Err(entry.refuses("")),
                None if near(text).is_empty() => Err(FaultError::Form(plain(text))),
                None => Err(FaultError::Unknown { name: plain(text), near: near(text) }),
            };
        };
        let entry = TABLE
            .iter()
            .find(|entry| entry.name == name)
            .ok_or_else(|| FaultError::Unknown { name: plain(name), near: near(name) })?;
        (entry.set)(self, value).ok_or_else(|| entry.refuses(value))
    }
}

/// What a user typed, fit to be shown: no control characters, not endless.
fn plain(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(60).collect()
}

/// Names that differ from this by few letters, or that begin with it; nearest first, at most three.
fn near(name: &str) -> Vec<&'static str> {
    let mut ranked: Vec<(usize, &'static str)> = TABLE
        .iter()
        .map(|entry| {
            let begins = !name.is_empty() && (entry.name.starts_with(name) || name.starts_with(entry.name));
            (if begins { 1 } else { distance(name, entry.name) }, entry.name)
        })
        .filter(|(distance, candidate)| *distance <= 1 + candidate.len() / 4)
        .collect();
    ranked.sort_unstable();
    ranked.into_iter().take(3).map(|(_, name)| name).collect()
}

/// Letters to add, take away or change to make one word of the other (Levenshtein 1966).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.chars().take(60).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, other) in b.iter().enumerate() {
            let change = diagonal + usize::from(letter != *other);
            diagonal = row[j + 1];
            row[j + 1] = change.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_takes_its_own_example_and_changes_something() {
        for entry in TABLE {
            let mut faults = Faults::default();
            faults.switch(&format!("{}={}", entry.name, entry.example)).unwrap();
            assert_ne!(faults, Faults::default(), "{}", entry.name);
        }
    }

    #[test]
    fn an_unknown_name_offers_the_names_near_it() {
        let error = Faults::default().switch("nack=0.1").unwrap_err();
        assert!(matches!(&error, FaultError::Unknown { near, .. } if near.contains(&"nak")), "{error}");
        let error = Faults::default().switch("unplugg=1,2").unwrap_err();
        assert!(error.to_string().contains("unplug"), "{error}");
    }

    #[test]
    fn a_value_that_does_not_fit_is_refused_with_one_that_would() {
        for text in ["nak=2", "nak=-0.1", "nak=NaN", "nak=often", "silence=5", "silence=5,-1", "refuse=9", "nak="] {
            let error = Faults::default().switch(text).unwrap_err();
            assert!(matches!(error, FaultError::Value { .. }), "{text}: {error}");
        }
    }
}
