//! What the mount says to a command: nothing, or bytes in one or more parts, each after its own time.

use std::time::Duration;

/// The parts of a reply; an empty list is silence.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Answer {
    /// Time after the part before (the first: after the ordinary delay), and the bytes.
    pub(super) parts: Vec<(Duration, Vec<u8>)>,
    /// The last part goes out only when another byte arrives.
    pub(super) held: bool,
}

impl Answer {
    /// No reply.
    pub(super) fn silent() -> Answer {
        Answer::default()
    }

    /// These bytes as they are.
    pub(super) fn bytes(bytes: impl Into<Vec<u8>>) -> Answer {
        Answer { parts: vec![(Duration::ZERO, bytes.into())], held: false }
    }

    /// A text and the `#` that ends it.
    pub(super) fn text(text: &str) -> Answer {
        Answer::bytes(format!("{text}#"))
    }

    /// `1` for accepted, `0` for refused.
    pub(super) fn accepted(yes: bool) -> Answer {
        Answer::bytes(if yes { *b"1" } else { *b"0" })
    }

    /// One more part, some time after.
    pub(super) fn then(mut self, after: Duration, bytes: impl Into<Vec<u8>>) -> Answer {
        self.parts.push((after, bytes.into()));
        self
    }
}
