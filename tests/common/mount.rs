//! A simulated mount as a process of its own, for programs that must talk to one from outside.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

/// A process that does not outlive its test.
pub(crate) struct Ended(pub(crate) Child);

impl Drop for Ended {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The program, with this test's own folders in place of the user's.
pub(crate) fn scotopic(arguments: &[&str]) -> Command {
    let home = std::env::temp_dir().join(format!("scotopic-{}-{}", env!("CARGO_CRATE_NAME"), std::process::id()));
    let mut command = Command::new(env!("CARGO_BIN_EXE_scotopic"));
    command.args(arguments).stdin(Stdio::null()).stderr(Stdio::null());
    for folder in ["HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_DATA_HOME", "XDG_DATA_DIRS"] {
        command.env(folder, &home);
    }
    command
}

/// A simulated mount, and its host and port.
pub(crate) fn mount() -> (Ended, String) {
    let mut child = scotopic(&["simulate", "mount", "--listen", "tcp:127.0.0.1:0", "--site", "60.17,24.94,30"])
        .args(["--time", "2026-11-22T22:00:00Z"])
        .stdout(Stdio::piped())
        .spawn()
        .expect("a mount");
    let mut first = String::new();
    BufReader::new(child.stdout.take().expect("its output")).read_line(&mut first).expect("its address");
    let said: serde_json::Value = serde_json::from_str(&first).expect("JSON");
    let endpoint = said["endpoint"].as_str().expect("an endpoint");
    (Ended(child), endpoint.trim_start_matches("tcp:").to_owned())
}
