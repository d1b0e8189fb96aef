//! The shortest sequence of bytes that is in all presses of a key and in no other key's.

use super::Bursts;
use crate::hw::handbox::pattern::{LONGEST, Pattern};

/// What was found of a key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Found {
    /// The sequence that tells the press.
    pub(super) sequence: Vec<u8>,
    /// The same as a pattern.
    pub(super) press: Pattern,
    /// The sequence that tells the release, if there is one.
    pub(super) release: Option<Pattern>,
    /// Whether single bytes tell all: one for the press, at most one more for the release.
    pub(super) is_of_bytes: bool,
    /// The presses that it was found in.
    pub(super) takes: Vec<Bursts>,
}

/// Finds the sequences of a key; `elsewhere` says which belong to others.
pub(super) fn find(takes: &[Bursts], elsewhere: &dyn Fn(&[u8]) -> bool) -> Option<Found> {
    let first = takes.first()?;
    let press = shortest(takes, 0, elsewhere)?;
    let after = first.iter().position(|burst| has(burst, &press)).unwrap_or(0) + 1;
    let stable: Vec<u8> = (0..=u8::MAX).filter(|byte| takes.iter().all(|take| is_in(&[*byte], take))).collect();
    let is_of_bytes = press.len() == 1 && stable.len() <= 2;
    let other = stable.into_iter().find(|byte| press != [*byte] && !elsewhere(&[*byte]));
    let release = if is_of_bytes {
        other.map(|byte| vec![byte])
    } else {
        shortest(takes, after, elsewhere).filter(|release| !has(release, &press))
    };
    Some(Found {
        press: Pattern::exactly(&press).ok()?,
        release: release.and_then(|release| Pattern::exactly(&release).ok()),
        sequence: press,
        is_of_bytes,
        takes: Vec::new(),
    })
}

/// The shortest sequence of the bursts from `from` on, of equally long ones the earliest. One that is in most presses only once
/// is preferred: it does not belong to the release too.
fn shortest(takes: &[Bursts], from: usize, elsewhere: &dyn Fn(&[u8]) -> bool) -> Option<Vec<u8>> {
    let bursts: &[Vec<u8>] = takes.first()?.get(from..)?;
    let fits = |sequence: &&[u8]| takes.iter().all(|take| is_in(sequence, take)) && !elsewhere(sequence);
    let once = |sequence: &&[u8]| {
        let single = takes.iter().filter(|take| count(sequence, take) == 1).count();
        2 * single > takes.len()
    };
    let longest = bursts.iter().map(Vec::len).max().unwrap_or(0).min(LONGEST);
    let all = || (1..=longest).flat_map(move |length| bursts.iter().flat_map(move |burst| burst.windows(length)));
    all().filter(once).find(fits).or_else(|| all().find(fits)).map(<[u8]>::to_vec)
}

/// Whether a sequence is in any press of a key.
pub(super) fn is_in_any(sequence: &[u8], takes: &[Bursts]) -> bool {
    takes.iter().any(|take| is_in(sequence, take))
}

fn is_in(sequence: &[u8], take: &Bursts) -> bool {
    take.iter().any(|burst| has(burst, sequence))
}

/// Whether a sequence stands in a burst.
pub(super) fn has(burst: &[u8], sequence: &[u8]) -> bool {
    !sequence.is_empty() && burst.windows(sequence.len()).any(|window| window == sequence)
}

fn count(sequence: &[u8], take: &Bursts) -> usize {
    take.iter().map(|burst| burst.windows(sequence.len()).filter(|window| *window == sequence).count()).sum()
}
