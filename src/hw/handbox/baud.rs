//! The speed of an unknown line: one key is pressed five times at each speed, and the speed at which the presses agree is chosen.
//!
//! Too fast a receiver sees every bit many times over: its bytes end in high bits (or are badly formed) and begin with zeros, the
//! rest of the start bit. Too slow a one sees the line at rest in the high bits of the last byte. So the right speed is the
//! fastest with odd bytes and with bytes below 80, at which five presses agree and characters are well formed.

use std::collections::BTreeSet;

/// The speeds to try, the likely first.
pub const SPEEDS: [u32; 8] = [9600, 4800, 19_200, 38_400, 57_600, 115_200, 2400, 1200];

/// What was read at one speed.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Trial {
    /// Bits a second.
    pub baud: u32,
    /// All bytes of each press of the key, its release included.
    pub presses: Vec<Vec<u8>>,
    /// How many characters were badly formed.
    pub malformed: usize,
}

/// How right a speed looks. The fields stand in the order of their weight; more is better in each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Score {
    /// Whether anything was read at all.
    heard: bool,
    /// Presses with the same set of bytes as most others, less the badly formed characters.
    agree: isize,
    /// A press and its release that differ in bit 7 alone, and nothing else (bounces aside).
    pair: bool,
    /// Whether bit 7 is ever clear: neither too slow nor too fast.
    low: bool,
    /// Whether bit 0 is ever set: not too fast.
    odd: bool,
    /// The speed itself.
    baud: u32,
}

/// How right a speed looks.
#[must_use]
pub fn score(trial: &Trial) -> Score {
    let sets: Vec<BTreeSet<u8>> = trial.presses.iter().map(|press| press.iter().copied().collect()).collect();
    let alike = |set: &BTreeSet<u8>| sets.iter().filter(|other| *other == set).count();
    let commonest = sets.iter().filter(|set| !set.is_empty()).max_by_key(|set| alike(set));
    let all: BTreeSet<u8> = sets.iter().flatten().copied().collect();
    let small = |count: usize| isize::try_from(count).unwrap_or(isize::MAX / 2);
    Score {
        heard: !all.is_empty(),
        agree: small(commonest.map_or(0, alike)) - small(trial.malformed),
        pair: is_pair(&all) && trial.presses.iter().map(Vec::len).min() == Some(2),
        low: all.iter().any(|byte| byte & 0x80 == 0),
        odd: all.iter().any(|byte| byte & 1 == 1),
        baud: trial.baud,
    }
}

/// Whether no other speed need be tried: at least five presses, all alike, none badly formed, a press and a release that differ
/// in bit 7 alone.
#[must_use]
pub fn is_certain(trial: &Trial) -> bool {
    let score = score(trial);
    trial.presses.len() >= 5 && score.agree >= 0 && score.agree.unsigned_abs() == trial.presses.len() && score.pair
}

/// The speed that looks most right. `None` where nothing was read at any.
#[must_use]
pub fn choose(trials: &[Trial]) -> Option<u32> {
    let best = trials.iter().map(score).max()?;
    best.heard.then_some(best.baud)
}

/// A press and its release that differ in bit 7 alone. 00 and 80 are what too fast a receiver makes of anything.
fn is_pair(bytes: &BTreeSet<u8>) -> bool {
    let mut bytes = bytes.iter();
    matches!((bytes.next(), bytes.next(), bytes.next()), (Some(a @ 1..), Some(b), None) if a ^ b == 0x80)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hw::handbox::sim::uart::misread;
    use crate::numerics::streams::Stream;

    /// Five presses of a key as a receiver at `read` bits a second has them; `told`: whether it tells of badly formed characters.
    fn trial(press: &[u8], release: &[u8], sent: u32, read: u32, told: bool) -> Trial {
        let mut stream = Stream::seeded(u64::from(sent) + u64::from(read));
        let mut trial = Trial { baud: read, ..Trial::default() };
        for _ in 0..5 {
            let mut bytes = Vec::new();
            for edge in [press, release] {
                for (byte, formed) in misread(edge, sent, read, stream.uniform()) {
                    if formed || !told {
                        bytes.push(byte);
                    } else {
                        trial.malformed += 1;
                    }
                }
            }
            trial.presses.push(bytes);
        }
        trial
    }

    /// What is chosen when speeds are tried until one is certain.
    fn found(press: &[u8], release: &[u8], sent: u32, told: bool) -> Option<u32> {
        let mut trials = Vec::new();
        for read in SPEEDS {
            trials.push(trial(press, release, sent, read, told));
            if trials.last().is_some_and(is_certain) {
                return Some(read);
            }
        }
        choose(&trials)
    }

    #[test]
    fn every_key_of_the_shipped_maps_gives_the_speed_away() {
        for code in [0x3F, 0x09, 0x0D, 0x18, 0x55, 0x44, 0x4D, 0x47, 0x2E, 0x4E, 0x53, 0x45, 0x57, 0x30, 0x35, 0x39] {
            for sent in SPEEDS {
                for told in [true, false] {
                    assert_eq!(found(&[code], &[code | 0x80], sent, told), Some(sent), "{code:02X} at {sent}, {told}");
                }
            }
        }
    }

    #[test]
    fn codes_without_a_release_and_longer_ones_give_it_away_too() {
        for sent in SPEEDS {
            assert_eq!(found(&[0x02, 0x17, 0x3F, 0x03], &[0x02, 0x17, 0x40, 0x03], sent, true), Some(sent));
            assert_eq!(found(&[0x35], &[], sent, true), Some(sent), "one byte at {sent}");
        }
    }

    #[test]
    fn silence_at_every_speed_gives_no_speed() {
        let silent = |baud| Trial { baud, presses: vec![vec![]; 5], malformed: 0 };
        assert_eq!(choose(&SPEEDS.map(silent)), None);
        assert_eq!(choose(&[]), None);
    }
}
