//! How a subcommand ends without doing what was asked: a sentence, and the exit code that tells scripts whose fault it was.

use std::fmt::Display;
use std::process::ExitCode;

/// Why nothing, or not all, was done. The sentence says what is wrong, the value, and what to do.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Failure {
    /// It was asked rightly and went wrong: exit code 1.
    #[error("{0}")]
    Failed(String),
    /// It was asked wrongly: exit code 2.
    #[error("{0}")]
    Asked(String),
}

impl Failure {
    /// It went wrong: the error's sentence, exit code 1. Made for `map_err`.
    pub fn failed(error: impl Display) -> Failure {
        Failure::Failed(error.to_string())
    }

    /// It was asked wrongly: the error's sentence, exit code 2. Made for `map_err`.
    pub fn asked(error: impl Display) -> Failure {
        Failure::Asked(error.to_string())
    }

    /// 1 for what failed, 2 for what was asked wrongly.
    #[must_use]
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Failure::Failed(_) => ExitCode::from(1),
            Failure::Asked(_) => ExitCode::from(2),
        }
    }
}
