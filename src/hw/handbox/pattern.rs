//! Patterns of bytes with wildcards: `3F`, `02 ?? 3F`.

use std::fmt;

use serde::{Deserialize, Serialize};

/// The longest pattern in bytes.
pub const LONGEST: usize = 32;

/// One or more bytes, each given or left open (`??`). At least one is given.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Pattern(Vec<Option<u8>>);

/// Why a text is no pattern.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PatternError {
    /// Something that is neither two digits nor `??`.
    #[error(
        "'{0}' in a pattern is neither a byte nor a wildcard: write two hexadecimal digits like 3F, or ?? for any byte"
    )]
    Byte(String),
    /// No byte is given.
    #[error("the pattern '{0}' fits everything: give at least one byte, like 3F")]
    Open(String),
    /// Too long.
    #[error("a pattern of {0} bytes is too long: at most {LONGEST}")]
    Long(usize),
}

impl Pattern {
    /// A pattern of bytes (`Some`) and wildcards (`None`).
    ///
    /// # Errors
    /// No byte is given, or there are more than [`LONGEST`].
    pub fn new(places: Vec<Option<u8>>) -> Result<Pattern, PatternError> {
        if places.len() > LONGEST {
            return Err(PatternError::Long(places.len()));
        }
        if places.iter().all(Option::is_none) {
            return Err(PatternError::Open(written(&places)));
        }
        Ok(Pattern(places))
    }

    /// The pattern of exactly these bytes.
    ///
    /// # Errors
    /// As [`Pattern::new`].
    pub fn exactly(bytes: &[u8]) -> Result<Pattern, PatternError> {
        Pattern::new(bytes.iter().copied().map(Some).collect())
    }

    /// Its length in bytes, never 0.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a pattern is never empty")]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Its bytes and wildcards.
    #[must_use]
    pub fn places(&self) -> &[Option<u8>] {
        &self.0
    }

    /// Whether these bytes are it.
    #[must_use]
    pub fn is(&self, bytes: &[u8]) -> bool {
        bytes.len() == self.len() && self.begins(bytes)
    }

    /// Whether the bytes begin with it.
    #[must_use]
    pub fn begins(&self, bytes: &[u8]) -> bool {
        bytes.len() >= self.len() && self.0.iter().zip(bytes).all(|(place, byte)| place.is_none_or(|b| b == *byte))
    }

    /// Whether some bytes could be both, or whether the shorter one stands inside the longer one. A wildcard of the longer one
    /// does not count as holding the shorter one: where both begin, the longer is meant.
    #[must_use]
    pub fn overlaps(&self, other: &Pattern) -> bool {
        let (short, long) = if self.len() <= other.len() { (self, other) } else { (other, self) };
        let open = short.len() == long.len();
        long.0.windows(short.len()).any(|window| {
            window.iter().zip(&short.0).all(|(long, short)| match (long, short) {
                (Some(long), Some(short)) => long == short,
                (Some(_), None) => true,
                (None, _) => open,
            })
        })
    }
}

/// Two digits a byte, `??` a wildcard.
fn written(places: &[Option<u8>]) -> String {
    let word = |place: &Option<u8>| place.map_or_else(|| "??".into(), |byte| format!("{byte:02X}"));
    places.iter().map(word).collect::<Vec<_>>().join(" ")
}

impl fmt::Display for Pattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&written(&self.0))
    }
}

impl From<Pattern> for String {
    fn from(pattern: Pattern) -> String {
        pattern.to_string()
    }
}

impl TryFrom<String> for Pattern {
    type Error = PatternError;

    fn try_from(text: String) -> Result<Pattern, PatternError> {
        text.parse()
    }
}

impl std::str::FromStr for Pattern {
    type Err = PatternError;

    /// Reads `3F BF`, `3FBF` or `3f ??`.
    fn from_str(text: &str) -> Result<Pattern, PatternError> {
        let signs: Vec<char> = text.chars().filter(|c| !c.is_whitespace()).take(2 * LONGEST + 2).collect();
        let places = signs.chunks(2).map(place).collect::<Result<Vec<_>, _>>()?;
        Pattern::new(places)
    }
}

/// Two signs as a byte or a wildcard.
fn place(signs: &[char]) -> Result<Option<u8>, PatternError> {
    let digit = |sign: &char| sign.to_digit(16).and_then(|digit| u8::try_from(digit).ok());
    match signs {
        ['?', '?'] => Ok(None),
        [high, low] if let (Some(high), Some(low)) = (digit(high), digit(low)) => Ok(Some(high << 4 | low)),
        _ => Err(PatternError::Byte(signs.iter().filter(|c| !c.is_control()).collect())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pattern(text: &str) -> Pattern {
        text.parse().unwrap()
    }

    #[test]
    fn a_pattern_is_written_as_it_is_read() {
        assert_eq!(pattern("3f").to_string(), "3F");
        assert_eq!(pattern("02??3F 0a").to_string(), "02 ?? 3F 0A");
        for text in ["", "??", "?? ??", "3", "3G", "?3", "0x3F", "é3"] {
            assert!(text.parse::<Pattern>().is_err(), "{text}");
        }
        assert_eq!("00".repeat(33).parse::<Pattern>(), Err(PatternError::Long(33)));
    }

    #[test]
    fn a_wildcard_fits_any_byte_and_no_other_number_of_bytes() {
        assert!(pattern("02 ?? 03").is(&[2, 0xFF, 3]));
        assert!(!pattern("02 ?? 03").is(&[2, 3]));
        assert!(pattern("02 ??").begins(&[2, 3, 4]));
        assert!(!pattern("02 ??").begins(&[2]));
    }

    #[test]
    fn patterns_overlap_where_some_bytes_could_be_both() {
        assert!(pattern("3F").overlaps(&pattern("3F")));
        assert!(pattern("02 ?? 03").overlaps(&pattern("02 41 ??")));
        assert!(pattern("3F").overlaps(&pattern("02 3F 03")), "one inside the other");
        assert!(!pattern("02 ?? 03").overlaps(&pattern("3F")), "the longer one is meant");
        assert!(!pattern("02 41 03").overlaps(&pattern("02 42 ??")));
    }
}
