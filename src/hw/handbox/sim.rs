//! A hand controller that is not there: key presses -> the bytes that pass on its cable, with the faults of worn keypads and
//! of a wire that carries the display too.

/// Behind a pseudo terminal, which is opened like the tapping adapter.
pub mod serve;
/// What a receiver at the wrong speed reads.
pub mod uart;

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use super::keymap::{Key, KeyMap};
use super::pattern::Pattern;
use super::presses::LONG;
use crate::numerics::streams::Stream;

/// Twitches of a bouncing contact follow one another so.
const TWITCH: Duration = Duration::from_millis(4);
/// A stuck key goes down so often: 25 times a second.
const STUCK_PERIOD: Duration = Duration::from_millis(40);

/// What is wrong with it. Probabilities from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Faults {
    /// A key bounces when it goes down, and when it comes up.
    pub bounce: f64,
    /// A byte of nobody's passes before a key's.
    pub noise: f64,
    /// The bytes of one edge of a key are missing.
    pub missing: f64,
    /// The display's text passes on the same wire: each key changes it.
    pub display: bool,
}

/// Why a key cannot be pressed.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("'{key}' is no key of the key map '{map}': its keys are {keys}")]
pub struct NoSuchKey {
    key: String,
    map: String,
    keys: String,
}

/// A simulated hand controller and its line.
#[derive(Debug, Clone)]
pub struct Handset {
    map: KeyMap,
    faults: Faults,
    stream: Stream,
    /// What will be sent, by time and order.
    to_send: BTreeMap<(Duration, u64), Vec<u8>>,
    order: u64,
    /// Bytes on the line and when each has passed.
    line: VecDeque<(Duration, u8)>,
    busy_until: Duration,
}

impl Handset {
    /// A hand controller with the keys and the line of a map.
    #[must_use]
    pub fn new(map: KeyMap, faults: Faults, seed: u64) -> Handset {
        Handset {
            map,
            faults,
            stream: Stream::seeded(seed),
            to_send: BTreeMap::new(),
            order: 0,
            line: VecDeque::new(),
            busy_until: Duration::ZERO,
        }
    }

    /// Its key map.
    #[must_use]
    pub fn map(&self) -> &KeyMap {
        &self.map
    }

    /// It is switched on: it sends what its map says belongs to no key (the Classic's start-up sequence).
    pub fn switch_on(&mut self, at: Duration) {
        for sequence in self.map.sheet().ignore.clone() {
            let bytes = self.bytes(&sequence);
            self.send(at, bytes);
        }
    }

    /// A key goes down at `at` and comes up after `held`.
    ///
    /// # Errors
    /// It has no such key.
    pub fn press(&mut self, key: &str, at: Duration, held: Duration) -> Result<(), NoSuchKey> {
        let key = self.key(key)?;
        if self.stream.chance(self.faults.noise) {
            let byte = self.stream.byte();
            self.send(at.saturating_sub(Duration::from_millis(60)), vec![byte]);
        }
        self.edge(&key, true, at);
        if let Some(long) = key.long.as_ref().filter(|_| held > LONG) {
            let bytes = self.bytes(long);
            self.send(at + LONG, bytes);
        }
        self.edge(&key, false, at + held);
        if self.faults.display {
            self.show(at + Duration::from_millis(30), "Select Item:", &key.name);
        }
        Ok(())
    }

    /// A key sticks from `at` on: it goes down and up all the time.
    ///
    /// # Errors
    /// It has no such key.
    pub fn stick(&mut self, key: &str, at: Duration, lasting: Duration) -> Result<(), NoSuchKey> {
        let key = self.key(key)?;
        let mut now = at;
        while now < at + lasting.min(Duration::from_secs(3600)) {
            self.clean_edge(&key, true, now);
            self.clean_edge(&key, false, now + STUCK_PERIOD / 2);
            now += STUCK_PERIOD;
        }
        Ok(())
    }

    /// Text for the display passes on the wire, as the LX200 Classic's base sends it.
    pub fn show(&mut self, at: Duration, top: &str, bottom: &str) {
        for (line, text) in [(b'1', top), (b'2', bottom)] {
            let text: Vec<u8> = format!("{text:16}").bytes().take(16).collect();
            self.send(at, [&[0x1B, line], text.as_slice()].concat());
        }
    }

    /// Bytes of any kind pass.
    pub fn send(&mut self, at: Duration, bytes: Vec<u8>) {
        self.order += 1;
        self.to_send.insert((at, self.order), bytes);
    }

    /// The bytes that have passed by now, at the line's own speed.
    pub fn drain(&mut self, now: Duration) -> Vec<u8> {
        let line = self.map.line();
        let bits = 1 + u32::from(line.data_bits) + u32::from(line.stop_bits);
        let character = Duration::from_secs(1) * bits / line.baud.max(1);
        while let Some(entry) = self.to_send.first_entry().filter(|entry| entry.key().0 <= now) {
            let (at, _) = *entry.key();
            let mut done = self.busy_until.max(at);
            for byte in entry.remove() {
                done += character;
                self.line.push_back((done, byte));
            }
            self.busy_until = done;
        }
        let passed = self.line.iter().take_while(|(done, _)| *done <= now).count();
        self.line.drain(..passed).map(|(_, byte)| byte).collect()
    }

    /// Whether a character is on the line.
    #[must_use]
    pub fn is_sending(&self) -> bool {
        !self.line.is_empty()
    }

    /// When the next byte will have passed.
    #[must_use]
    pub fn wake_at(&self) -> Option<Duration> {
        let next = self.to_send.first_key_value().map(|((at, _), _)| *at);
        self.line.front().map(|(done, _)| *done).into_iter().chain(next).min()
    }

    fn key(&self, name: &str) -> Result<Key, NoSuchKey> {
        let keys = self.map.keys();
        keys.iter().find(|key| key.name == name).cloned().ok_or_else(|| NoSuchKey {
            key: name.chars().filter(|c| !c.is_control()).take(40).collect(),
            map: self.map.name().to_owned(),
            keys: keys.iter().map(|key| key.name.as_str()).collect::<Vec<_>>().join(" "),
        })
    }

    /// A key goes down or up, as a worn one does.
    fn edge(&mut self, key: &Key, down: bool, at: Duration) {
        if self.stream.chance(self.faults.missing) {
            return;
        }
        self.clean_edge(key, down, at);
        if self.stream.chance(self.faults.bounce) {
            self.clean_edge(key, !down, at + TWITCH);
            self.clean_edge(key, down, at + 2 * TWITCH);
        }
    }

    fn clean_edge(&mut self, key: &Key, down: bool, at: Duration) {
        let pattern = if down { Some(key.press.clone()) } else { self.map.releases(key).next() };
        if let Some(pattern) = pattern {
            let bytes = self.bytes(&pattern);
            self.send(at, bytes);
        }
    }

    /// A pattern with something in the place of its wildcards.
    fn bytes(&mut self, pattern: &Pattern) -> Vec<u8> {
        pattern.places().iter().map(|place| place.unwrap_or_else(|| self.stream.byte())).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(ms: u64) -> Duration {
        Duration::from_millis(ms)
    }

    #[test]
    fn a_key_sends_its_published_codes_at_the_speed_of_the_line() {
        let mut handset = Handset::new(KeyMap::shipped("lx200-classic").unwrap(), Faults::default(), 1);
        handset.press("ENTER", ms(10), ms(100)).unwrap();
        assert_eq!(handset.drain(ms(11)), [0; 0], "a character takes 1.04 ms at 9600 bits a second");
        assert_eq!(handset.drain(ms(12)), [0x0D]);
        assert_eq!(handset.wake_at(), Some(ms(110)));
        assert_eq!(handset.drain(ms(200)), [0x8D]);
        assert!(handset.press("?", ms(0), ms(1)).unwrap_err().to_string().contains("ENTER MODE"));
    }

    #[test]
    fn switched_on_it_sends_the_start_up_sequence() {
        let mut handset = Handset::new(KeyMap::shipped("lx200-classic").unwrap(), Faults::default(), 1);
        handset.switch_on(ms(0));
        assert_eq!(handset.drain(ms(100)), [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x2A]);
    }
}
