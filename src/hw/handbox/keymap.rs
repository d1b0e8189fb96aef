//! Key maps: the line settings of a hand controller's cable, how its bytes are framed, and what each key sends.

mod check;
mod shipped;

use std::fmt;

use serde::{Deserialize, Serialize};

use super::pattern::Pattern;

pub use self::check::KeyMapError;
pub use self::shipped::{SHIPPED, Shipped};

/// A key map as its file has it, unchecked.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Sheet {
    /// What it is called.
    pub name: String,
    /// Where it comes from, what is known of it.
    #[serde(default)]
    pub note: String,
    /// Whether nobody has measured it yet.
    #[serde(default)]
    pub guess: bool,
    /// Sequences that belong to no key and are not worth telling: idle traffic, start-up.
    #[serde(default)]
    pub ignore: Vec<Pattern>,
    /// The serial line.
    #[serde(default)]
    pub line: Line,
    /// How the bytes are framed.
    #[serde(default)]
    pub framing: Framing,
    /// The keys.
    #[serde(rename = "key", default)]
    pub keys: Vec<Key>,
}

/// Settings of the serial line.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Line {
    /// Bits a second.
    pub baud: u32,
    /// Bits of a character, 7 or 8.
    pub data_bits: u8,
    /// The parity bit.
    pub parity: Parity,
    /// Stop bits, 1 or 2.
    pub stop_bits: u8,
    /// A note for people: the line rests low, so that the adapter (or an opto-isolator) must invert it. No program can.
    pub inverted: bool,
}

impl Default for Line {
    fn default() -> Line {
        Line { baud: 9600, data_bits: 8, parity: Parity::None, stop_bits: 1, inverted: false }
    }
}

impl fmt::Display for Line {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parity = match self.parity {
            Parity::None => 'N',
            Parity::Even => 'E',
            Parity::Odd => 'O',
        };
        let inverted = if self.inverted { ", inverted" } else { "" };
        write!(f, "{} {}{parity}{}{inverted}", self.baud, self.data_bits, self.stop_bits)
    }
}

/// The parity bit of a character.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Parity {
    /// There is none.
    #[default]
    None,
    /// The ones are even in number.
    Even,
    /// The ones are odd in number.
    Odd,
}

/// How bytes make frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Framing {
    /// Which way.
    pub mode: Mode,
    /// `fixed`: bytes of a frame, 2 to 32.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub length: Option<usize>,
    /// `fixed`: the first byte of every frame, as two digits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lead: Option<Lead>,
    /// Silence in milliseconds that ends a frame (`gap`), a broken one (`fixed`) or text for the display (`escape`).
    pub gap_ms: u64,
}

impl Default for Framing {
    fn default() -> Framing {
        // A USB adapter hands bytes on every 16 ms, so that shorter silences are not seen.
        Framing { mode: Mode::Single, length: None, lead: None, gap_ms: 25 }
    }
}

/// The ways bytes make frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Mode {
    /// Each byte is a frame.
    #[default]
    Single,
    /// Each byte is a frame, and a key's release is its press with bit 7 set.
    Bit7,
    /// As `bit7`, and `1B ...` is text for the display on the same wire, which is skipped.
    Escape,
    /// Frames of one length with one first byte.
    Fixed,
    /// A frame ends after a silence.
    Gap,
}

impl Mode {
    /// Whether every byte is a frame of its own.
    #[must_use]
    pub fn is_of_bytes(self) -> bool {
        matches!(self, Mode::Single | Mode::Bit7 | Mode::Escape)
    }

    /// Whether bit 7 marks a release.
    #[must_use]
    pub fn has_release_bit(self) -> bool {
        matches!(self, Mode::Bit7 | Mode::Escape)
    }
}

impl fmt::Display for Mode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Mode::Single => "single",
            Mode::Bit7 => "bit7",
            Mode::Escape => "escape",
            Mode::Fixed => "fixed",
            Mode::Gap => "gap",
        })
    }
}

/// The first byte of frames of one length: a pattern of one byte.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Lead(pub u8);

impl TryFrom<String> for Lead {
    type Error = String;

    fn try_from(text: String) -> Result<Lead, String> {
        match text.parse::<Pattern>().map_err(|error| error.to_string())?.places() {
            [Some(byte)] => Ok(Lead(*byte)),
            _ => Err("the lead is one byte: write two hexadecimal digits like 02".into()),
        }
    }
}

impl From<Lead> for String {
    fn from(lead: Lead) -> String {
        format!("{:02X}", lead.0)
    }
}

/// A key and what it sends.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Key {
    /// What it is called: `?`, `ENTER`, `MODE`.
    pub name: String,
    /// What it sends when it goes down.
    pub press: Pattern,
    /// What it sends when it comes up, if anything. With framing `bit7` or `escape` it need not be given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub release: Option<Pattern>,
    /// What it sends when it is held down long, if that is something else.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub long: Option<Pattern>,
}

/// A checked key map: no two patterns of it can be the same bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyMap(Sheet);

impl KeyMap {
    /// Checks what was read or learned.
    ///
    /// # Errors
    /// What is wrong with it, and what to do.
    pub fn new(sheet: Sheet) -> Result<KeyMap, KeyMapError> {
        check::sheet(&sheet)?;
        Ok(KeyMap(sheet))
    }

    /// Reads a key map from its TOML text.
    ///
    /// # Errors
    /// The line that is not understood, or what is wrong with the map.
    pub fn from_toml(text: &str) -> Result<KeyMap, KeyMapError> {
        if text.len() > check::LARGEST_BYTES {
            return Err(KeyMapError::Large(text.len()));
        }
        KeyMap::new(toml::from_str(text).map_err(|error| KeyMapError::toml(error, text))?)
    }

    /// Its TOML text, as [`KeyMap::from_toml`] reads it.
    ///
    /// # Errors
    /// None that is known: every key map can be written.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        let sheet = toml::to_string(&self.0)?;
        Ok(format!(
            "# A key map of scotopic. Each key of this file is explained in docs/hardware/hand-controller.md.\n{sheet}"
        ))
    }

    /// One of the key maps that are built in: `lx200-classic`, `autostar2-guess` or `ascii`.
    #[must_use]
    pub fn shipped(name: &str) -> Option<KeyMap> {
        SHIPPED.iter().find(|shipped| shipped.name == name).and_then(|shipped| KeyMap::from_toml(shipped.text).ok())
    }

    /// All that its file says.
    #[must_use]
    pub fn sheet(&self) -> &Sheet {
        &self.0
    }

    /// What it is called.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// Whether nobody has measured it yet.
    #[must_use]
    pub fn is_guess(&self) -> bool {
        self.0.guess
    }

    /// The serial line.
    #[must_use]
    pub fn line(&self) -> Line {
        self.0.line
    }

    /// How the bytes are framed.
    #[must_use]
    pub fn framing(&self) -> Framing {
        self.0.framing
    }

    /// Its keys.
    #[must_use]
    pub fn keys(&self) -> &[Key] {
        &self.0.keys
    }

    /// The same keys over another line.
    #[must_use]
    pub fn over(mut self, line: Line) -> KeyMap {
        self.0.line = line;
        self
    }

    /// Whether a key can be told to be held down: it says when it is let go, or sends something else when it is held.
    #[must_use]
    pub fn can_be_long(&self, name: &str) -> bool {
        let key = self.0.keys.iter().find(|key| key.name == name);
        key.is_some_and(|key| key.long.is_some() || self.releases(key).next().is_some())
    }

    /// What a key may send when it is let go.
    pub fn releases<'a>(&self, key: &'a Key) -> impl Iterator<Item = Pattern> + use<'a> {
        let bit7 = self.0.framing.mode.has_release_bit();
        let lifted = |pattern: &Pattern| match pattern.places() {
            [Some(byte)] if bit7 => Pattern::exactly(&[byte | 0x80]).ok(),
            _ => None,
        };
        let given = key.release.clone().or_else(|| lifted(&key.press));
        let after_long = key.long.as_ref().and_then(lifted).filter(|release| Some(release) != given.as_ref());
        given.into_iter().chain(after_long)
    }
}
