//! The values of faults, read from text. `None` is a value that does not fit.

use std::time::Duration;

use super::Span;

/// The longest time that makes sense: a week.
const LONGEST_S: f64 = 7.0 * 86_400.0;

pub(super) fn number(text: &str) -> Option<f64> {
    text.trim().parse::<f64>().ok().filter(|value| value.is_finite())
}

pub(super) fn chance(text: &str) -> Option<f64> {
    number(text).filter(|value| (0.0..=1.0).contains(value))
}

pub(super) fn seconds(text: &str) -> Option<Duration> {
    number(text).filter(|value| (0.0..=LONGEST_S).contains(value)).map(Duration::from_secs_f64)
}

pub(super) fn milliseconds(text: &str) -> Option<Duration> {
    number(text).and_then(|value| seconds(&(value / 1000.0).to_string()))
}

pub(super) fn count(text: &str, most: usize) -> Option<usize> {
    text.trim().parse().ok().filter(|value| *value <= most)
}

pub(super) fn switch(text: &str) -> Option<bool> {
    match text.trim() {
        "on" | "yes" | "true" | "1" => Some(true),
        "off" | "no" | "false" | "0" => Some(false),
        _ => None,
    }
}

pub(super) fn span(text: &str) -> Option<Span> {
    let (from, lasts) = text.split_once(',')?;
    Some(Span { from: seconds(from)?, lasts: seconds(lasts)? })
}

/// Text that the mount will send: anything but the `#` that would end it.
pub(super) fn words(text: &str) -> Option<String> {
    (!text.is_empty() && text.len() <= 60 && !text.contains('#')).then(|| text.to_owned())
}
