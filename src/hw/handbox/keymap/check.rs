//! What is wrong with a key map, in one sentence. A map with anything wrong is not used at all.

use super::{Framing, Key, KeyMap, Mode, Sheet};
use crate::hw::handbox::pattern::Pattern;

/// Larger files are no key maps.
pub(super) const LARGEST_BYTES: usize = 64 * 1024;
/// More keys has no hand controller.
const MOST_KEYS: usize = 64;
/// More sequences that are passed over.
const MOST_IGNORED: usize = 64;
/// Longer names fit no screen.
const LONGEST_NAME: usize = 24;
/// Speeds in bits a second that serial ports have.
const SPEEDS: std::ops::RangeInclusive<u32> = 300..=1_000_000;

/// Why a key map is refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum KeyMapError {
    /// The text is not the TOML of a key map.
    #[error("{}{what}", line.map(|line| format!("line {line}: ")).unwrap_or_default())]
    Toml {
        /// The line, from 1.
        line: Option<usize>,
        /// The reader's words, without control characters.
        what: String,
        /// The reader's error.
        error: Box<toml::de::Error>,
    },
    /// The file is too large.
    #[error("a key map of {0} bytes is too large: at most {LARGEST_BYTES}; is this the right file?")]
    Large(usize),
    /// No keys.
    #[error(
        "the key map '{0}' has no keys: add [[key]] with name and press, or teach it with `scotopic handbox learn`"
    )]
    Empty(String),
    /// Too many keys or ignored sequences.
    #[error("{count} {what} are too many: at most {most}")]
    Many {
        /// Of what.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// A name that cannot be shown or typed.
    #[error(
        "'{0}' is no name: 1 to {LONGEST_NAME} letters, digits or signs, no spaces, and no ~ (which means a long press)"
    )]
    Name(String),
    /// A name twice.
    #[error("two keys are called '{0}': give one of them another name, or take it out")]
    Twice(String),
    /// A line that no port has.
    #[error("the line cannot be set to {what} = {value}: {right}")]
    Line {
        /// Which setting.
        what: &'static str,
        /// Its value.
        value: u64,
        /// What is right.
        right: &'static str,
    },
    /// Framing that lacks something, or has too much.
    #[error("framing '{mode}' {why}")]
    Framing {
        /// The mode.
        mode: Mode,
        /// What is wrong, and what to do.
        why: String,
    },
    /// A pattern that does not go with the framing.
    #[error("the {which} of key '{key}', {pattern}, does not go with framing '{mode}': {why}")]
    Pattern {
        /// The key's name.
        key: String,
        /// `press`, `release` or `long`.
        which: &'static str,
        /// The pattern.
        pattern: Pattern,
        /// The mode.
        mode: Mode,
        /// Why not, and what to do.
        why: String,
    },
    /// Bytes that could be two things.
    #[error(
        "{first} and {second} overlap ({first_pattern} and {second_pattern}): the same bytes could be either, so nothing of \
         this map is used; make one of them longer or with fewer wildcards, or take one out"
    )]
    Overlap {
        /// What the one is, like "the press of key '?'".
        first: String,
        /// Its pattern.
        first_pattern: Pattern,
        /// What the other is.
        second: String,
        /// Its pattern.
        second_pattern: Pattern,
    },
}

impl KeyMapError {
    /// The error of the TOML reader, with its line.
    pub(super) fn toml(error: toml::de::Error, text: &str) -> KeyMapError {
        let line = error.span().map(|span| {
            text.as_bytes()[..span.start.min(text.len())].iter().filter(|byte| **byte == b'\n').count() + 1
        });
        let what = error.message().chars().map(|c| if c.is_control() { ' ' } else { c }).take(400).collect();
        KeyMapError::Toml { line, what, error: Box::new(error) }
    }
}

/// Checks all of a key map.
pub(super) fn sheet(sheet: &Sheet) -> Result<(), KeyMapError> {
    name(&sheet.name)?;
    line(sheet)?;
    framing(sheet.framing)?;
    if sheet.keys.is_empty() {
        return Err(KeyMapError::Empty(sheet.name.clone()));
    }
    at_most("keys", sheet.keys.len(), MOST_KEYS)?;
    at_most("ignored sequences", sheet.ignore.len(), MOST_IGNORED)?;
    for (index, key) in sheet.keys.iter().enumerate() {
        name(&key.name)?;
        if sheet.keys[..index].iter().any(|other| other.name == key.name) {
            return Err(KeyMapError::Twice(key.name.clone()));
        }
        patterns(key, sheet.framing)?;
    }
    overlaps(sheet)
}

fn at_most(what: &'static str, count: usize, most: usize) -> Result<(), KeyMapError> {
    if count > most { Err(KeyMapError::Many { what, count, most }) } else { Ok(()) }
}

fn name(name: &str) -> Result<(), KeyMapError> {
    let right = |c: char| !c.is_control() && !c.is_whitespace() && c != '~';
    if (1..=LONGEST_NAME).contains(&name.chars().count()) && name.chars().all(right) {
        return Ok(());
    }
    Err(KeyMapError::Name(name.chars().filter(|c| !c.is_control()).take(40).collect()))
}

fn line(sheet: &Sheet) -> Result<(), KeyMapError> {
    let line = &sheet.line;
    let wrong = |what, value, right| Err(KeyMapError::Line { what, value, right });
    match (line.baud, line.data_bits, line.stop_bits) {
        (baud, ..) if !SPEEDS.contains(&baud) => wrong("baud", baud.into(), "300 to 1000000 bits a second"),
        (_, bits, _) if !matches!(bits, 7 | 8) => wrong("data_bits", bits.into(), "7 or 8"),
        (_, _, bits) if !matches!(bits, 1 | 2) => wrong("stop_bits", bits.into(), "1 or 2"),
        _ => Ok(()),
    }
}

fn framing(framing: Framing) -> Result<(), KeyMapError> {
    let wrong = |why: String| Err(KeyMapError::Framing { mode: framing.mode, why });
    if !(1..=1000).contains(&framing.gap_ms) {
        return wrong(format!(
            "cannot have gap_ms = {}: 1 to 1000, and 20 at least over a USB adapter",
            framing.gap_ms
        ));
    }
    match (framing.mode, framing.length, framing.lead) {
        (Mode::Fixed, Some(2..=32), Some(_)) => Ok(()),
        (Mode::Fixed, Some(2..=32), None) => wrong("needs the first byte of every frame: add lead = \"02\"".into()),
        (Mode::Fixed, length, _) => {
            let length = length.map_or_else(|| "none".into(), |length| length.to_string());
            wrong(format!("needs the bytes of a frame, 2 to 32, and has {length}: add length = 4"))
        }
        (_, None, None) => Ok(()),
        _ => wrong("has neither length nor lead: take them out, or write mode = \"fixed\"".into()),
    }
}

fn patterns(key: &Key, framing: Framing) -> Result<(), KeyMapError> {
    let given = [("press", Some(&key.press)), ("release", key.release.as_ref()), ("long", key.long.as_ref())];
    for (which, pattern) in given {
        let Some(pattern) = pattern else { continue };
        let wrong = |why: String| {
            let (key, pattern) = (key.name.clone(), pattern.clone());
            Err(KeyMapError::Pattern { key, which, pattern, mode: framing.mode, why })
        };
        let places = pattern.places();
        if framing.mode.is_of_bytes() && places.len() != 1 {
            return wrong("every byte is a frame there; write one byte, or mode = \"gap\"".into());
        }
        if framing.mode.has_release_bit() && which != "release" && places[0].is_some_and(|byte| byte & 0x80 != 0) {
            return wrong("bit 7 marks a release there; write a byte below 80, or mode = \"single\"".into());
        }
        if let (Mode::Fixed, Some(length), Some(lead)) = (framing.mode, framing.length, framing.lead) {
            if places.len() != length {
                return wrong(format!("a frame has {length} bytes there; write as many, with ?? for those that vary"));
            }
            if places[0] != Some(lead.0) {
                return wrong(format!("a frame begins with {:02X} there", lead.0));
            }
        }
    }
    Ok(())
}

/// No two patterns may be the same bytes, whatever they stand for.
fn overlaps(sheet: &Sheet) -> Result<(), KeyMapError> {
    let map = KeyMap(sheet.clone());
    let mut all: Vec<(String, Pattern)> = Vec::new();
    for key in &sheet.keys {
        all.push((format!("the press of key '{}'", key.name), key.press.clone()));
        all.extend(map.releases(key).map(|release| (format!("the release of key '{}'", key.name), release)));
        all.extend(key.long.iter().map(|long| (format!("the long press of key '{}'", key.name), long.clone())));
    }
    let keys = all.len();
    all.extend(sheet.ignore.iter().map(|ignored| ("an ignored sequence".into(), ignored.clone())));
    for (index, (first, first_pattern)) in all.iter().take(keys).enumerate() {
        for (second, second_pattern) in &all[index + 1..] {
            if first_pattern.overlaps(second_pattern) {
                return Err(KeyMapError::Overlap {
                    first: first.clone(),
                    first_pattern: first_pattern.clone(),
                    second: second.clone(),
                    second_pattern: second_pattern.clone(),
                });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        KeyMap::from_toml(text).map(|map| format!("{map:?}")).unwrap_err().to_string()
    }

    #[test]
    fn overlapping_patterns_are_refused_with_the_names_of_both_keys() {
        let said =
            refused("name = \"a\"\n[[key]]\nname = \"?\"\npress = \"3F\"\n[[key]]\nname = \"MODE\"\npress = \"3F\"");
        assert!(said.contains("key '?'") && said.contains("key 'MODE'") && said.contains("overlap"), "{said}");
        let gap =
            "name = \"a\"\n[framing]\nmode = \"gap\"\n[[key]]\nname = \"UP\"\npress = \"02 ?? 03\"\nrelease = \"05\"\n";
        assert!(refused(&format!("{gap}[[key]]\nname = \"DOWN\"\npress = \"02 41 ??\"")).contains("key 'DOWN'"));
        let press = format!("{gap}[[key]]\nname = \"DOWN\"\npress = \"07\"\nrelease = \"05\"");
        assert!(refused(&press).contains("release of key 'UP'"), "a release that another key sends too");
        let bit7 = "name = \"a\"\n[framing]\nmode = \"bit7\"\n[[key]]\nname = \"A\"\npress = \"0D\"\n\
                    [[key]]\nname = \"B\"\npress = \"0E\"\nrelease = \"8D\"";
        assert!(refused(bit7).contains("8D"), "a release that is only implied");
        let ignored = "name = \"a\"\nignore = [\"05 3F\"]\n[[key]]\nname = \"?\"\npress = \"3F\"";
        assert!(refused(ignored).contains("an ignored sequence"));
    }

    #[test]
    fn each_thing_that_can_be_wrong_has_its_sentence() {
        let map = |rest: &str| refused(&format!("name = \"a\"\n{rest}"));
        let key = "[[key]]\nname = \"?\"\npress = \"3F\"\n";
        assert!(map("").contains("no keys"));
        assert!(map("bawd = 1").contains("line 2"), "{}", map("bawd = 1"));
        assert!(map("[[key]]\nname = \"?\"\npress = \"3Z\"").contains("3Z"));
        assert!(map("[[key]]\nname = \"a~\"\npress = \"3F\"").contains('~'));
        assert!(map("[[key]]\nname = \"\\u001b[31m\"\npress = \"3F\"").contains("'[31m'"), "no escapes in the error");
        assert!(map(&format!("{key}{key}")).contains("two keys"));
        assert!(map(&format!("[line]\nbaud = 9\n{key}")).contains("baud = 9"));
        assert!(map(&format!("[line]\ndata_bits = 9\n{key}")).contains("7 or 8"));
        assert!(map(&format!("[line]\nstop_bits = 3\n{key}")).contains("1 or 2"));
        assert!(map(&format!("[framing]\nmode = \"fixed\"\n{key}")).contains("length"));
        assert!(map(&format!("[framing]\nmode = \"fixed\"\nlength = 3\n{key}")).contains("lead"));
        assert!(map(&format!("[framing]\nmode = \"fixed\"\nlength = 3\nlead = \"02\"\n{key}")).contains("3 bytes"));
        assert!(map(&format!("[framing]\nlength = 3\n{key}")).contains("neither"));
        assert!(map(&format!("[framing]\ngap_ms = 0\n{key}")).contains("gap_ms = 0"));
        assert!(map("[[key]]\nname = \"?\"\npress = \"3F 40\"").contains("every byte is a frame"));
        assert!(map("[framing]\nmode = \"bit7\"\n[[key]]\nname = \"?\"\npress = \"BF\"").contains("bit 7"));
        assert!(refused(&format!("name = \"{}\"", "x".repeat(70_000))).contains("too large"));
        let many: String = (0..65).map(|n| format!("[[key]]\nname = \"k{n}\"\npress = \"{n:02X}\"\n")).collect();
        assert!(map(&many).contains("65 keys"));
    }
}
