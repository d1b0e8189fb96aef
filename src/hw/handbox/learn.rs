//! What the keys of an unknown cable send: idle noise first, then five presses of each wanted key. Pure; `cli::handbox` holds the
//! dialogue.
//!
//! ```text
//! what is heard when idle is cut out of every press (and text for the display with it)
//! press   = the shortest sequence that is in all five presses of the key, once, and in no other key's
//! release = the shortest such sequence after it
//! ```
//!
//! Where the line has frames (bursts with silence between), the whole frame around the sequence is kept, with wildcards where it
//! differed from press to press: a longer pattern is less easily taken for something else.

mod frames;
/// Lessons recorded and repeated.
pub mod replay;
mod sequence;

use std::collections::BTreeSet;
use std::time::Duration;

use self::frames::Frames;
use self::sequence::{Found, find};
use super::capture::Event;
use super::decoder::without_display;
use super::hex;
use super::keymap::{Framing, Key, KeyMap, KeyMapError, Line, Mode, Sheet};
use super::pattern::Pattern;

/// Presses of each key.
pub const TAKES: usize = 5;
/// A longer silence separates bursts: longer than a USB adapter holds bytes back.
pub const GAP: Duration = Duration::from_millis(25);
/// More bytes of one press are not kept.
const LONGEST_TAKE: usize = 256;
/// More sequences of idle traffic are not kept: then it never says the same twice.
const MOST_IDLE: usize = 16;

/// Bytes with silence between them.
pub type Bursts = Vec<Vec<u8>>;

/// Why a key could not be learned.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum LearnError {
    /// Nothing but what passes anyway.
    #[error(
        "key '{0}' sent nothing that does not pass on the line anyway: is it this key's cable, and the wire from the keys?"
    )]
    Silent(String),
    /// The presses have nothing in common.
    #[error(
        "the presses of key '{key}' have no bytes in common ({heard}): press it firmly, one press at a time; if it stays so, the \
         speed or the inversion of the line is wrong"
    )]
    Disagree {
        /// The key.
        key: String,
        /// What was heard, press by press.
        heard: String,
    },
    /// Another key sends the same.
    #[error("key '{key}' sends nothing that key '{other}' does not send too: was it the same key?")]
    Same {
        /// The key.
        key: String,
        /// The other one.
        other: String,
    },
    /// A long press of a key that is not known.
    #[error("'{0}~' is the long press of a key that was not learned before: teach '{0}' first")]
    NoSuchKey(String),
    /// No keys, or a name or line that no map can have.
    #[error(transparent)]
    Map(#[from] KeyMapError),
}

/// A key that was pressed, `~` after its name for a long press.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Asked {
    name: String,
    /// The bursts of each press, idle traffic cut out.
    takes: Vec<Bursts>,
}

/// All that was heard.
#[derive(Debug, Clone, Default)]
pub struct Lesson {
    idle: BTreeSet<Vec<u8>>,
    keys: Vec<Asked>,
    /// Whether text for a display was seen.
    display: bool,
}

/// Bytes with their times as bursts.
#[must_use]
pub fn bursts(events: &[Event]) -> Bursts {
    let mut bursts: Bursts = Vec::new();
    let mut last: Option<Duration> = None;
    for event in events.iter().filter(|event| !event.bytes.is_empty()) {
        let goes_on = last.is_some_and(|last| event.at.saturating_sub(last) < GAP);
        last = Some(event.at);
        match bursts.last_mut().filter(|_| goes_on) {
            Some(burst) => burst.extend(&event.bytes),
            None => bursts.push(event.bytes.clone()),
        }
    }
    bursts
}

impl Lesson {
    /// A lesson that begins with what passes while nobody touches a key.
    #[must_use]
    pub fn new(idle: &[Event]) -> Lesson {
        let mut lesson = Lesson::default();
        let kept: BTreeSet<Vec<u8>> = bursts(idle)
            .into_iter()
            .flat_map(|burst| lesson.shown_nothing(&burst))
            .map(|mut burst| {
                burst.truncate(super::pattern::LONGEST);
                burst
            })
            .collect();
        lesson.idle = kept.into_iter().take(MOST_IDLE).collect();
        lesson
    }

    /// What passes while nobody touches a key, as people read it.
    #[must_use]
    pub fn idle(&self) -> Vec<String> {
        self.idle.iter().map(|sequence| hex(sequence)).collect()
    }

    /// What of a press is not idle traffic or text for the display.
    #[must_use]
    pub fn heard(&self, take: &[Event]) -> Bursts {
        let (mut left, mut kept) = (LONGEST_TAKE, Vec::new());
        for burst in bursts(take) {
            for piece in without_display(&burst) {
                for mut piece in self.without_idle(&piece) {
                    piece.truncate(left);
                    left -= piece.len();
                    if !piece.is_empty() {
                        kept.push(piece);
                    }
                }
            }
        }
        kept
    }

    /// Takes the presses of a key (`NAME~`: long presses of NAME), and says what it sends.
    ///
    /// # Errors
    /// They do not agree, or say nothing of their own. Then the key is not learned; ask again.
    pub fn learn(&mut self, name: &str, takes: &[Vec<Event>]) -> Result<Key, LearnError> {
        self.display |= takes.iter().any(|take| bursts(take).iter().any(|burst| shows(burst)));
        let takes: Vec<Bursts> = takes.iter().map(|take| self.heard(take)).collect();
        let mut with = self.clone();
        with.keys.retain(|asked| asked.name != name);
        let asked = Asked { name: name.to_owned(), takes };
        with.found(&asked)?;
        with.keys.push(asked);
        let map = with.map("lesson", Line::default())?;
        let plain = name.strip_suffix('~').unwrap_or(name);
        let key = map.keys().iter().find(|key| key.name == plain).cloned();
        self.keys = with.keys;
        key.ok_or_else(|| LearnError::NoSuchKey(plain.to_owned()))
    }

    /// The key map of all keys learned.
    ///
    /// # Errors
    /// None was learned, or two of them cannot be told apart.
    pub fn map(&self, name: &str, line: Line) -> Result<KeyMap, LearnError> {
        let found = self.keys.iter().map(|asked| self.found(asked)).collect::<Result<Vec<_>, _>>()?;
        let sheet = |framing: Framing, keys: Vec<Key>| Sheet {
            name: name.to_owned(),
            note: "learned by pressing the keys".into(),
            guess: false,
            ignore: Vec::new(),
            line,
            framing,
            keys,
        };
        let framing = |mode| Framing { mode, ..Framing::default() };
        let bare = |found: &Found| (found.press.clone(), found.release.clone());
        if found.iter().all(|found| found.is_of_bytes) {
            let keys = self.keys_of(&found, bare)?;
            let lifts = keys.iter().all(lifts_bit7);
            let mode = match (lifts, self.display) {
                (true, true) => Mode::Escape,
                (true, false) => Mode::Bit7,
                (false, _) => Mode::Single,
            };
            return Ok(KeyMap::new(self.ignoring(sheet(framing(mode), keys)))?);
        }
        let frames = Frames::of(self.keys.iter().flat_map(|asked| &asked.takes));
        let whole = self
            .keys_of(&found, |found| frames.around(found))
            .and_then(|keys| Ok(KeyMap::new(self.ignoring(sheet(frames.framing(), keys)))?));
        match whole {
            Ok(map) => Ok(map),
            Err(_overlap) => Ok(KeyMap::new(self.ignoring(sheet(framing(Mode::Gap), self.keys_of(&found, bare)?)))?),
        }
    }

    /// The sequences of one key.
    fn found(&self, asked: &Asked) -> Result<Found, LearnError> {
        if asked.takes.iter().all(Vec::is_empty) {
            return Err(LearnError::Silent(asked.name.clone()));
        }
        let plain = |name: &str| name.trim_end_matches('~').to_owned();
        // What a key sends when it is held begins as what it sends when it is tapped.
        let is_other = |other: &&Asked| plain(&other.name) != plain(&asked.name);
        let shorter = |other: &&Asked| asked.name.ends_with('~') && other.name == plain(&asked.name);
        let others: Vec<&Asked> = self.keys.iter().filter(|other| is_other(other) || shorter(other)).collect();
        let elsewhere = |sequence: &[u8]| others.iter().any(|other| sequence::is_in_any(sequence, &other.takes));
        if let Some(found) = find(&asked.takes, &elsewhere) {
            return Ok(Found { takes: asked.takes.clone(), ..found });
        }
        let common = find(&asked.takes, &|_| false).map(|found| found.sequence);
        let other =
            common.and_then(|sequence| others.iter().find(|other| sequence::is_in_any(&sequence, &other.takes)));
        Err(match other {
            Some(other) => LearnError::Same { key: asked.name.clone(), other: other.name.clone() },
            None => LearnError::Disagree {
                key: asked.name.clone(),
                heard: asked.takes.iter().map(|take| hex(&take.concat())).collect::<Vec<_>>().join(" | "),
            },
        })
    }

    /// The keys of a map; long presses go to their key.
    fn keys_of(
        &self,
        found: &[Found],
        patterns: impl Fn(&Found) -> (Pattern, Option<Pattern>),
    ) -> Result<Vec<Key>, LearnError> {
        let mut keys: Vec<Key> = Vec::new();
        for (asked, found) in self.keys.iter().zip(found) {
            let (press, release) = patterns(found);
            match asked.name.strip_suffix('~') {
                None => {
                    let release = release.filter(|release| !release.overlaps(&press));
                    keys.push(Key { name: asked.name.clone(), press, release, long: None });
                }
                Some(plain) => {
                    let key = keys.iter_mut().find(|key| key.name == plain);
                    let key = key.ok_or_else(|| LearnError::NoSuchKey(plain.to_owned()))?;
                    key.long = Some(press);
                }
            }
        }
        Ok(keys)
    }

    /// The same map, with the idle traffic ignored that is not mistaken for a key, and what all keys send alike.
    fn ignoring(&self, mut sheet: Sheet) -> Sheet {
        let alike =
            |byte: &u8| self.keys.iter().all(|asked| asked.takes.iter().all(|take| take.concat().contains(byte)));
        let first = self.keys.first().and_then(|asked| asked.takes.first());
        let common: BTreeSet<Vec<u8>> =
            first.into_iter().flatten().flatten().filter(|byte| alike(byte)).map(|byte| vec![*byte]).collect();
        let bytes = sheet.framing.mode.is_of_bytes();
        for sequence in self.idle.iter().chain(common.iter().filter(|_| bytes)) {
            let Ok(pattern) = Pattern::exactly(sequence) else { continue };
            sheet.ignore.push(pattern);
            if KeyMap::new(sheet.clone()).is_err() {
                sheet.ignore.pop();
            }
        }
        sheet
    }

    /// Idle traffic without text for the display.
    fn shown_nothing(&mut self, burst: &[u8]) -> Bursts {
        self.display |= shows(burst);
        without_display(burst)
    }

    /// A burst cut where idle traffic stands in it, the longest sequences first.
    fn without_idle(&self, burst: &[u8]) -> Bursts {
        let mut idle: Vec<&Vec<u8>> = self.idle.iter().collect();
        idle.sort_by_key(|sequence| std::cmp::Reverse(sequence.len()));
        let (mut pieces, mut piece, mut rest) = (Vec::new(), Vec::new(), burst);
        while let Some((first, after)) = rest.split_first() {
            match idle.iter().find(|sequence| rest.starts_with(sequence)) {
                Some(sequence) => {
                    rest = &rest[sequence.len()..];
                    pieces.push(std::mem::take(&mut piece));
                }
                None => {
                    piece.push(*first);
                    rest = after;
                }
            }
        }
        pieces.push(piece);
        pieces.retain(|piece| !piece.is_empty());
        pieces
    }
}

/// Whether text for the LX200 Classic's display is in a burst.
fn shows(burst: &[u8]) -> bool {
    burst.windows(2).any(|pair| matches!(pair, [0x1B, b'1' | b'2']))
}

/// Whether a key's release is its press with bit 7 set.
fn lifts_bit7(key: &Key) -> bool {
    let byte = |pattern: &Pattern| pattern.places().first().copied().flatten();
    let long_is_low = key.long.as_ref().and_then(byte).is_none_or(|byte| byte & 0x80 == 0);
    match (byte(&key.press), key.release.as_ref().and_then(byte)) {
        (Some(press), Some(release)) => press & 0x80 == 0 && release == press | 0x80 && long_is_low,
        _ => false,
    }
}

#[cfg(test)]
mod tests;
