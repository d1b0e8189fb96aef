//! The program as a script calls it.

use std::process::{Command, Output};

use serde_json::Value;

/// Runs it to its end, without the profile of the person who runs the tests.
pub(crate) fn scotopic(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_scotopic"))
        .args(arguments)
        .env("XDG_CONFIG_HOME", std::env::temp_dir().join("scotopic-no-such-profile"))
        .env("XDG_DATA_DIRS", std::env::temp_dir().join("scotopic-no-such-data"))
        .env("HOME", std::env::temp_dir().join("scotopic-no-such-home"))
        .output()
        .unwrap()
}

/// Its answer, where it must succeed.
pub(crate) fn json(arguments: &[&str]) -> Value {
    let output = scotopic(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}
