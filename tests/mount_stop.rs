//! `scotopic mount stop` against the simulated mount: a slew that a dead session has left behind comes to rest.

#![cfg(unix)]
#![expect(clippy::expect_used, reason = "a test fails by panicking")]

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

/// A process that does not outlive its test.
struct Ended(Child);

impl Drop for Ended {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn scotopic(arguments: &[&str]) -> Command {
    let home = std::env::temp_dir().join(format!("scotopic-mount-stop-{}", std::process::id()));
    let mut command = Command::new(env!("CARGO_BIN_EXE_scotopic"));
    command.args(arguments).stdin(Stdio::null());
    for folder in ["HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_DATA_HOME"] {
        command.env(folder, &home);
    }
    command
}

fn stop(mount: &str) -> Output {
    scotopic(&["mount", "stop", "--mount", mount, "--json"]).output().expect("the program")
}

/// A simulated mount, and its address.
fn mount() -> (Ended, String) {
    let mut child = scotopic(&["simulate", "mount", "--listen", "tcp:127.0.0.1:0", "--site", "60.17,24.94,30"])
        .args(["--time", "2026-11-22T22:00:00Z"])
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .expect("a mount");
    let mut first = String::new();
    BufReader::new(child.stdout.take().expect("its output")).read_line(&mut first).expect("its address");
    let said: serde_json::Value = serde_json::from_str(&first).expect("JSON");
    (Ended(child), said["endpoint"].as_str().expect("an endpoint").to_owned())
}

/// Asks the mount over a connection of our own; the answer has `length` bytes, or ends with `#`.
fn ask(line: &mut TcpStream, question: &str, length: usize) -> String {
    line.write_all(question.as_bytes()).expect("asked");
    let mut reply = Vec::new();
    while reply.len() < length && reply.last() != Some(&b'#') {
        let mut byte = [0];
        line.read_exact(&mut byte).expect("an answer");
        reply.push(byte[0]);
    }
    String::from_utf8_lossy(&reply).into_owned()
}

#[test]
fn a_slew_that_was_left_behind_is_stopped_and_the_mount_is_seen_to_stand_still() {
    let (_mount, address) = mount();
    let open = || {
        let line = TcpStream::connect(address.trim_start_matches("tcp:")).expect("the mount serves one client");
        line.set_read_timeout(Some(Duration::from_secs(10))).expect("a timeout");
        line
    };
    let mut line = open();
    // Of two places on opposite sides of the sky the mount is far from one.
    for (ra, dec) in [(":Sr18:36:56#", ":Sd+38:47:01#"), (":Sr07:39:18#", ":Sd+05:13:30#")] {
        assert_eq!(ask(&mut line, ra, 1) + &ask(&mut line, dec, 1) + &ask(&mut line, ":MS#", 1), "110");
    }
    std::thread::sleep(Duration::from_millis(1500));
    assert_ne!(ask(&mut line, ":D#", 99), "#", "no slew is under way");
    drop(line);

    let output = stop(&address);
    assert!(output.status.success(), "{output:?}");
    let said: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((said["stopped"].as_bool(), said["mount"].as_str()), (Some(true), Some(address.as_str())));

    let mut line = open();
    let first = (ask(&mut line, ":D#", 99), ask(&mut line, ":GR#", 99), ask(&mut line, ":GD#", 99));
    std::thread::sleep(Duration::from_millis(1200));
    let second = (ask(&mut line, ":D#", 99), ask(&mut line, ":GR#", 99), ask(&mut line, ":GD#", 99));
    assert_eq!(first, second, "the mount still moves");
    assert_eq!(first.0, "#", "the mount still slews");
    assert!(!first.1.starts_with("07:39"), "it had arrived before it was stopped: {first:?}");
}

#[test]
fn a_mount_that_does_not_answer_is_a_failure_that_says_what_to_do() {
    let nobody = TcpListener::bind("127.0.0.1:0").and_then(|listener| listener.local_addr()).expect("a free port");
    let output = stop(&format!("tcp:{nobody}"));
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.contains("cut its power"), "{said}");
}

#[test]
fn a_simulated_mount_has_nothing_to_stop() {
    assert!(stop("sim").status.success());
}
