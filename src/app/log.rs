//! What has happened, newest last. Bounded, so that a long night costs no memory.

use std::collections::VecDeque;

use crate::sky::time::Utc;

/// So many lines are kept.
pub const KEPT: usize = 500;

/// How much a line matters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weight {
    /// It went as it should.
    Note,
    /// It should be known.
    Warning,
    /// It must be known.
    Alarm,
}

/// A line of the log.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// When, by the session's clock.
    pub utc: Utc,
    /// How much it matters.
    pub weight: Weight,
    /// One sentence, without control characters.
    pub text: String,
    /// How often it was said in a row.
    pub times: u32,
}

/// The log.
#[derive(Debug, Clone, Default)]
pub struct Log {
    lines: VecDeque<Line>,
}

impl Log {
    /// Adds a line. The same sentence again is counted, not repeated.
    pub fn add(&mut self, utc: Utc, weight: Weight, text: impl Into<String>) {
        let text = printable(&text.into());
        match self.lines.back_mut() {
            Some(last) if last.text == text && last.weight == weight => {
                last.times = last.times.saturating_add(1);
                last.utc = utc;
            }
            _ => {
                if self.lines.len() == KEPT {
                    self.lines.pop_front();
                }
                self.lines.push_back(Line { utc, weight, text, times: 1 });
            }
        }
    }

    /// The lines, oldest first.
    pub fn lines(&self) -> impl DoubleEndedIterator<Item = &Line> + ExactSizeIterator {
        self.lines.iter()
    }
}

/// Text from outside without control characters, so that it cannot move a cursor or change a colour; at most 300 characters.
#[must_use]
pub fn printable(text: &str) -> String {
    let clean = text.chars().map(|c| if c.is_whitespace() { ' ' } else { c });
    clean.filter(|c| !c.is_control() && !hidden(*c)).take(300).collect()
}

/// Characters that are not seen and turn the order of those that are: a name could claim to be another.
fn hidden(c: char) -> bool {
    matches!(c, '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_night_of_lines_stays_bounded_and_repeats_are_counted() {
        let mut log = Log::default();
        for i in 0..10_000 {
            log.add(Utc(f64::from(i)), Weight::Note, format!("line {i}"));
            log.add(Utc(f64::from(i)), Weight::Note, format!("line {i}"));
        }
        assert_eq!(log.lines().len(), KEPT);
        assert!(log.lines().all(|line| line.times == 2));
        assert_eq!(log.lines().next_back().map(|line| line.text.as_str()), Some("line 9999"));
    }

    #[test]
    fn escapes_and_turned_text_do_not_get_in() {
        assert_eq!(printable("a\x1b[2Jb\u{202e}c\nd"), "a[2Jbc d");
    }
}
