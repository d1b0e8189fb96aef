//! `scotopic mount stop` against the simulated mount: a slew that a dead session has left behind comes to rest.

#![cfg(unix)]
#![expect(clippy::expect_used, reason = "a test fails by panicking")]

#[path = "common/mount.rs"]
mod mount;

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Output, Stdio};
use std::time::Duration;

use mount::{mount, scotopic};

fn stop(mount: &str) -> Output {
    scotopic(&["mount", "stop", "--mount", mount, "--json"]).stderr(Stdio::piped()).output().expect("the program")
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
    let (_mount, host) = mount();
    let address = format!("tcp:{host}");
    let open = || {
        let line = TcpStream::connect(&host).expect("the mount serves one client");
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
