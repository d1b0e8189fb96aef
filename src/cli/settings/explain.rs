//! What is wrong in a TOML file, in words: the line, and for a misspelt key the nearest right one.

use crate::cli::printable;

/// One thing that is wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wrong {
    /// The line, counted from 1, if it can be told.
    pub line: Option<usize>,
    /// What is wrong, and what to do. Without control characters.
    pub what: String,
}

/// Explains what the TOML reader says of `text`.
///
/// serde words an unknown key as "unknown field `x`, expected one of `a`, `b`"; should it ever word it otherwise, its words
/// are passed on as they are and only the suggestion is lost.
#[must_use]
pub fn wrong(error: &toml::de::Error, text: &str) -> Wrong {
    let line = error
        .span()
        .map(|span| text.as_bytes()[..span.start.min(text.len())].iter().filter(|b| **b == b'\n').count() + 1);
    let message = printable(error.message()).replace('\n', " ");
    let what = unknown_key(&message).unwrap_or(message);
    Wrong { line, what }
}

fn unknown_key(message: &str) -> Option<String> {
    let rest = message.strip_prefix("unknown field `")?;
    let (key, rest) = rest.split_once('`')?;
    let known: Vec<&str> = rest.split('`').skip(1).step_by(2).collect();
    let near = known.iter().map(|name| (distance(key, name), *name)).min()?;
    Some(if near.0 <= (key.len() / 2).max(2) {
        format!("'{key}' is not a setting: did you mean '{}'?", near.1)
    } else {
        format!("'{key}' is not a setting: here go {}", known.join(", "))
    })
}

/// How many letters must be put in, left out or changed to make one word of the other.
///
/// Source: Wagner and Fischer (1974), J. ACM 21, 168; two rows of the table.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut corner = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let changed = corner + usize::from(x != *y);
            corner = row[j + 1];
            row[j + 1] = changed.min(corner + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kitten_becomes_sitting_in_three_steps() {
        assert_eq!(distance("kitten", "sitting"), 3);
        assert_eq!(distance("", "abc"), 3);
        assert_eq!(distance("grün", "gruen"), 2);
    }
}
