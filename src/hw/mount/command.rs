//! What is sent to the mount, and the one place that turns it into bytes.

/// A question from the command table that changes nothing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Question(String);

impl Question {
    /// The command's letters between `:` and `#`.
    #[must_use]
    pub fn letters(&self) -> &str {
        &self.0
    }
}
