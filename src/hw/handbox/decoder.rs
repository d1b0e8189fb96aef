//! Bytes of the tapped line -> keys, in every framing of a key map. It never fails, and holds at most a few hundred bytes.

mod escape;

use std::time::Duration;

use self::escape::Escape;
use super::keymap::{KeyMap, Mode};
use super::pattern::Pattern;
use super::presses::Presses;
use super::{Heard, hex};

/// A frame that does not end is looked through after so many bytes.
const LONGEST_FRAME: usize = 256;
/// More bytes of no key in one go are noise.
const MOST_SHOWN: usize = 32;

/// A burst cut where text for the LX200 Classic's display stands in it.
pub(super) fn without_display(burst: &[u8]) -> Vec<Vec<u8>> {
    let mut escape = Escape::default();
    let pieces = burst.split(|byte| escape.swallows(*byte)).filter(|piece| !piece.is_empty());
    pieces.map(<[u8]>::to_vec).collect()
}

/// What a pattern means.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Meaning {
    Press,
    Release,
    Long,
    Ignored,
}

/// A pattern, what it means, and of which key.
#[derive(Debug, Clone)]
struct Sense {
    pattern: Pattern,
    meaning: Meaning,
    key: usize,
}

/// A key of the map as the decoder needs it.
#[derive(Debug, Clone)]
struct Known {
    name: String,
    comes_up: bool,
}

/// Reads keys out of bytes.
#[derive(Debug, Clone)]
pub struct Decoder {
    map: KeyMap,
    senses: Vec<Sense>,
    keys: Vec<Known>,
    presses: Presses,
    /// Bytes of a frame that has not ended.
    frame: Vec<u8>,
    escape: Escape,
    /// When the last byte came.
    last: Option<Duration>,
    now: Duration,
    /// Bytes of no key, not yet told.
    unknown: Vec<u8>,
    /// How many they are, those not kept included.
    unknowns: usize,
}

impl Decoder {
    /// A decoder of a key map. A long press means something for the keys whose map gives it a pattern.
    #[must_use]
    pub fn new(map: KeyMap) -> Decoder {
        let long: Vec<String> =
            map.keys().iter().filter(|key| key.long.is_some()).map(|key| key.name.clone()).collect();
        let mut senses = Vec::new();
        for (index, key) in map.keys().iter().enumerate() {
            let mut sense = |pattern: Pattern, meaning| senses.push(Sense { pattern, meaning, key: index });
            sense(key.press.clone(), Meaning::Press);
            map.releases(key).for_each(|release| sense(release, Meaning::Release));
            key.long.iter().for_each(|long| sense(long.clone(), Meaning::Long));
        }
        let ignored = map.sheet().ignore.iter();
        senses.extend(ignored.map(|pattern| Sense { pattern: pattern.clone(), meaning: Meaning::Ignored, key: 0 }));
        // Where an ignored sequence and a key begin at the same byte, the longer one is meant.
        senses.sort_by_key(|sense| std::cmp::Reverse(sense.pattern.len()));
        let known =
            |key: &super::keymap::Key| Known { name: key.name.clone(), comes_up: map.releases(key).next().is_some() };
        Decoder {
            keys: map.keys().iter().map(known).collect(),
            senses,
            presses: Presses::with_long(long),
            frame: Vec::new(),
            escape: Escape::default(),
            last: None,
            now: Duration::ZERO,
            unknown: Vec::new(),
            unknowns: 0,
            map,
        }
    }

    /// Exactly these keys have a long press that means something; their short press is told when they come up. Keys that
    /// cannot be long ([`KeyMap::can_be_long`]) are told when they go down all the same.
    #[must_use]
    pub fn with_long(mut self, keys: impl IntoIterator<Item = String>) -> Decoder {
        self.presses = Presses::with_long(keys);
        self
    }

    /// Its key map.
    #[must_use]
    pub fn map(&self) -> &KeyMap {
        &self.map
    }

    /// Takes bytes that came at `now`, and says what they meant.
    pub fn feed(&mut self, bytes: &[u8], now: Duration) -> Vec<Heard> {
        let mut heard = self.tick(now);
        for byte in bytes {
            match self.map.framing().mode {
                Mode::Single | Mode::Bit7 => self.one(*byte, &mut heard),
                Mode::Escape => {
                    if !self.escape.swallows(*byte) {
                        self.one(*byte, &mut heard);
                    }
                }
                Mode::Fixed => {
                    self.frame.push(*byte);
                    self.fixed(&mut heard);
                }
                Mode::Gap => {
                    self.frame.push(*byte);
                    if self.sense(|pattern, frame| pattern.is(frame)).is_some() || self.frame.len() >= LONGEST_FRAME {
                        self.look_through(&mut heard);
                    }
                }
            }
        }
        if !bytes.is_empty() {
            self.last = Some(self.now);
        }
        self.tell_unknown(&mut heard);
        heard
    }

    /// What only the passing of time decides: the end of a frame, a long press, a key that is no longer stuck.
    pub fn tick(&mut self, now: Duration) -> Vec<Heard> {
        // A clock that runs backwards would make frames and presses without end.
        self.now = self.now.max(now);
        let mut heard = Vec::new();
        if self.gap_at().is_some_and(|at| at <= self.now) {
            self.escape = Escape::default();
            self.look_through(&mut heard);
            self.tell_unknown(&mut heard);
        }
        self.presses.tick(self.now, &mut heard);
        heard
    }

    /// When [`Decoder::tick`] has something to do.
    #[must_use]
    pub fn wake_at(&self) -> Option<Duration> {
        [self.gap_at(), self.presses.wake_at()].into_iter().flatten().min()
    }

    /// Forgets half frames and held keys: the line was lost.
    pub fn reset(&mut self) {
        self.presses.reset();
        self.frame.clear();
        self.escape = Escape::default();
        self.last = None;
    }

    /// When the silence after the last byte will have ended what is open.
    fn gap_at(&self) -> Option<Duration> {
        let open = !self.frame.is_empty() || self.escape.is_open();
        self.last.filter(|_| open).map(|last| last.saturating_add(Duration::from_millis(self.map.framing().gap_ms)))
    }

    /// A byte that is a frame of its own.
    fn one(&mut self, byte: u8, heard: &mut Vec<Heard>) {
        let found = self.senses.iter().position(|sense| sense.meaning != Meaning::Ignored && sense.pattern.is(&[byte]));
        if let Some(index) = found {
            return self.act(index, heard);
        }
        let ignored = |sense: &Sense| sense.meaning == Meaning::Ignored && sense.pattern.places().contains(&Some(byte));
        if !self.senses.iter().any(ignored) {
            self.not_known(byte);
        }
    }

    /// Frames of one length. A frame that is no key's may be two halves: then its first byte was no lead.
    fn fixed(&mut self, heard: &mut Vec<Heard>) {
        let framing = self.map.framing();
        let (Some(length), Some(lead)) = (framing.length, framing.lead) else { return self.frame.clear() };
        loop {
            let skipped = self.frame.iter().position(|byte| *byte == lead.0).unwrap_or(self.frame.len());
            for byte in self.frame.drain(..skipped).collect::<Vec<_>>() {
                self.not_known(byte);
            }
            if self.frame.len() < length {
                return;
            }
            match self.sense(Pattern::begins) {
                Some(index) => {
                    let taken = self.senses[index].pattern.len();
                    self.frame.drain(..taken);
                    self.act(index, heard);
                }
                None => {
                    let first = self.frame.remove(0);
                    self.not_known(first);
                }
            }
        }
    }

    /// A frame that has ended: patterns in it from left to right.
    fn look_through(&mut self, heard: &mut Vec<Heard>) {
        let frame = std::mem::take(&mut self.frame);
        let mut rest = frame.as_slice();
        while let Some(first) = rest.first() {
            let found = self.senses.iter().position(|sense| sense.pattern.begins(rest));
            match found {
                Some(index) => {
                    rest = &rest[self.senses[index].pattern.len()..];
                    self.act(index, heard);
                }
                None => {
                    self.not_known(*first);
                    rest = &rest[1..];
                }
            }
        }
    }

    fn sense(&self, fits: impl Fn(&Pattern, &[u8]) -> bool) -> Option<usize> {
        self.senses.iter().position(|sense| fits(&sense.pattern, &self.frame))
    }

    fn act(&mut self, sense: usize, heard: &mut Vec<Heard>) {
        self.tell_unknown(heard);
        let Some((sense, key)) = self.senses.get(sense).and_then(|s| Some((s, self.keys.get(s.key)?))) else { return };
        match sense.meaning {
            Meaning::Press => self.presses.press(&key.name, key.comes_up, self.now, heard),
            Meaning::Release => self.presses.release(&key.name, self.now, heard),
            Meaning::Long => self.presses.long(&key.name, self.now, heard),
            Meaning::Ignored => {}
        }
    }

    fn not_known(&mut self, byte: u8) {
        self.unknowns += 1;
        if self.unknown.len() < MOST_SHOWN {
            self.unknown.push(byte);
        }
    }

    fn tell_unknown(&mut self, heard: &mut Vec<Heard>) {
        let (bytes, at) = (std::mem::take(&mut self.unknowns), self.now);
        let shown = std::mem::take(&mut self.unknown);
        match bytes {
            0 => {}
            1..=MOST_SHOWN => heard.push(Heard::Unknown { hex: hex(&shown), at }),
            _ => heard.push(Heard::Noise { bytes, at }),
        }
    }
}

#[cfg(test)]
mod tests;
