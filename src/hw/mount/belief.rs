//! What we believe of the mount, and how sure we are: each value is unknown, assumed or confirmed, with its age.

use std::time::Duration;

/// A value that some device holds, with where our belief in it comes from. Times are since the program started.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Known<T> {
    /// Nothing is believed: never asked, or forgotten after a lost link, a suspend or a contradiction.
    #[default]
    Unknown,
    /// We told the device so and it has not yet been read back.
    Assumed {
        /// What we sent.
        value: T,
        /// When we sent it.
        at: Duration,
    },
    /// The device said so itself.
    Confirmed {
        /// What it said.
        value: T,
        /// When its answer was complete.
        at: Duration,
    },
}

impl<T> Known<T> {
    /// The value, however it is known.
    pub fn value(&self) -> Option<&T> {
        match self {
            Known::Unknown => None,
            Known::Assumed { value, .. } | Known::Confirmed { value, .. } => Some(value),
        }
    }

    /// The value, if the device itself said it.
    pub fn confirmed(&self) -> Option<&T> {
        match self {
            Known::Confirmed { value, .. } => Some(value),
            _ => None,
        }
    }

    /// How old the belief is.
    pub fn age(&self, now: Duration) -> Option<Duration> {
        match self {
            Known::Unknown => None,
            Known::Assumed { at, .. } | Known::Confirmed { at, .. } => Some(now.saturating_sub(*at)),
        }
    }
}
