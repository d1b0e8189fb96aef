//! The message at the top: what is wrong, and what to do.

use super::log::{Weight, printable};

/// A message that stays until it is put away, or until a weightier one comes.
#[derive(Debug, Clone, PartialEq)]
pub struct Banner {
    /// How much it matters.
    pub weight: Weight,
    /// What is wrong.
    pub text: String,
    /// What to do, or nothing.
    pub advice: String,
}

impl Banner {
    /// A message; control characters are taken out.
    #[must_use]
    pub fn new(weight: Weight, text: &str, advice: &str) -> Banner {
        Banner { weight, text: printable(text), advice: printable(advice) }
    }

    /// The message as one sentence.
    #[must_use]
    pub fn sentence(&self) -> String {
        if self.advice.is_empty() { self.text.clone() } else { format!("{}: {}", self.text, self.advice) }
    }
}
