//! A lesson as it was recorded: the notes between the bytes say what was asked for. So an observer's recording can be learned from
//! again, by whoever mends the learner.

use std::collections::BTreeMap;

use super::{LearnError, Lesson};
use crate::hw::handbox::capture::Event;

/// What is asked of the person at the telescope, as the recording notes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Note {
    /// The line is now read at this speed.
    Speed(u32),
    /// This speed was chosen; what was read at others counts no more.
    Chosen(u32),
    /// Nobody touches a key.
    Idle,
    /// One press of a key; the first begins anew.
    Take {
        /// The key's name.
        key: String,
        /// The number of the press, from 1.
        number: usize,
    },
}

impl std::fmt::Display for Note {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Note::Speed(baud) => write!(f, "speed {baud}"),
            Note::Chosen(baud) => write!(f, "chosen {baud}"),
            Note::Idle => f.write_str("idle"),
            Note::Take { key, number } => write!(f, "take {number} {key}"),
        }
    }
}

impl Note {
    /// Reads a note; `None` for remarks of other kinds.
    #[must_use]
    pub fn read(text: &str) -> Option<Note> {
        let (what, rest) = text.split_once(' ').unwrap_or((text, ""));
        match what {
            "speed" => rest.parse().ok().map(Note::Speed),
            "chosen" => rest.parse().ok().map(Note::Chosen),
            "idle" => Some(Note::Idle),
            "take" => {
                let (number, key) = rest.split_once(' ')?;
                Some(Note::Take { key: key.to_owned(), number: number.parse().ok()? })
            }
            _ => None,
        }
    }
}

/// What was read at one speed.
#[derive(Debug, Clone, Default)]
struct Heard {
    idle: Vec<Event>,
    keys: Vec<(String, Vec<Vec<Event>>)>,
}

/// Learns from a recording again: the lesson, and the speed of the line.
///
/// # Errors
/// A key that cannot be learned from it.
pub fn repeat(events: &[Event]) -> Result<(Lesson, u32), LearnError> {
    let (mut heard, mut speed): (BTreeMap<u32, Heard>, u32) = (BTreeMap::new(), 9600);
    let mut into_idle = true;
    for event in events {
        match Note::read(&event.note) {
            Some(Note::Speed(baud) | Note::Chosen(baud)) => speed = baud,
            Some(Note::Idle) => {
                heard.entry(speed).or_default().idle.clear();
                into_idle = true;
            }
            Some(Note::Take { key, number }) => {
                let keys = &mut heard.entry(speed).or_default().keys;
                if number <= 1 {
                    keys.retain(|(name, _)| *name != key);
                    keys.push((key.clone(), Vec::new()));
                }
                if let Some((_, takes)) = keys.iter_mut().find(|(name, _)| *name == key) {
                    takes.push(Vec::new());
                }
                into_idle = false;
            }
            None => {}
        }
        if event.bytes.is_empty() {
            continue;
        }
        let at_speed = heard.entry(speed).or_default();
        let take = at_speed.keys.last_mut().and_then(|(_, takes)| takes.last_mut());
        match take.filter(|_| !into_idle) {
            Some(take) => take.push(event.clone()),
            None => at_speed.idle.push(event.clone()),
        }
    }
    let heard = heard.remove(&speed).unwrap_or_default();
    let mut lesson = Lesson::new(&heard.idle);
    for (key, takes) in &heard.keys {
        lesson.learn(key, takes)?;
    }
    Ok((lesson, speed))
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;
    use crate::hw::handbox::keymap::Line;

    #[test]
    fn a_recorded_lesson_gives_the_same_keys_again() {
        let mut notes: Vec<(String, Vec<u8>)> = Vec::new();
        let takes = |notes: &mut Vec<(String, Vec<u8>)>, key: &str, press: u8| {
            for number in 1..=5 {
                notes.push((Note::Take { key: key.into(), number }.to_string(), vec![]));
                notes.push((String::new(), vec![press]));
                notes.push(("a remark".into(), vec![press | 0x80]));
            }
        };
        takes(&mut notes, "?", 0x7E);
        notes.push((Note::Speed(19_200).to_string(), vec![]));
        notes.push((Note::Idle.to_string(), vec![]));
        notes.push((String::new(), vec![0xAA]));
        takes(&mut notes, "?", 0x3F);
        takes(&mut notes, "MODE", 0x09);
        let at = |n: usize| Duration::from_millis(100 * n as u64);
        let events: Vec<Event> =
            notes.into_iter().enumerate().map(|(n, (note, bytes))| Event { at: at(n), bytes, note }).collect();
        let (lesson, speed) = repeat(&events).unwrap();
        let map = lesson.map("again", Line { baud: speed, ..Line::default() }).unwrap();
        assert_eq!((speed, lesson.idle()), (19_200, vec!["AA".to_owned()]));
        let keys: Vec<_> = map.keys().iter().map(|key| (key.name.as_str(), key.press.to_string())).collect();
        assert_eq!(keys, [("?", "3F".to_owned()), ("MODE", "09".to_owned())]);
    }
}
