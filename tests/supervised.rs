//! The whole program against the simulated mount, with a relay between them that hears every byte: the session is killed, or
//! stopped dead, in the middle of a slew, and the mount comes to rest short of its target.

#![cfg(unix)]
#![expect(clippy::expect_used, reason = "a test fails by panicking")]

#[path = "common/mount.rs"]
mod mount;

use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::process::Stdio;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use mount::{Ended, mount, scotopic};
use rustix::process::{Pid, Signal, kill_process};
use scotopic::hw::supervisor::vigil::{STOP, STOPS};

/// No step takes so long on the slowest machine that is meant.
const PATIENCE: Duration = Duration::from_secs(90);

/// A relay for one client: its address, and all that the client's side has sent. It ends when no one holds the client's
/// socket any more, the supervisor included.
fn relay(mount: &str) -> (String, Arc<Mutex<Vec<u8>>>, thread::JoinHandle<()>) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("its address").to_string();
    let upstream = TcpStream::connect(mount).expect("the mount");
    let heard = Arc::new(Mutex::new(Vec::new()));
    let sent = Arc::clone(&heard);
    let thread = thread::spawn(move || {
        let (client, _) = listener.accept().expect("the session");
        let (mut down_in, mut down_out) =
            (upstream.try_clone().expect("a duplicate"), client.try_clone().expect("a duplicate"));
        let back = thread::spawn(move || drop(std::io::copy(&mut down_in, &mut down_out)));
        let (mut client, mut up, mut chunk) = (client, upstream, [0; 256]);
        while let Ok(count @ 1..) = client.read(&mut chunk) {
            sent.lock().expect("not poisoned").extend_from_slice(&chunk[..count]);
            if up.write_all(&chunk[..count]).is_err() {
                break;
            }
        }
        let _ = up.shutdown(Shutdown::Both);
        let _ = back.join();
    });
    (address, heard, thread)
}

fn wait_for(what: &str, mut seen: impl FnMut() -> bool) {
    let began = Instant::now();
    while !seen() {
        assert!(began.elapsed() < PATIENCE, "waited in vain for {what}");
        thread::sleep(Duration::from_millis(20));
    }
}

fn holds(heard: &Mutex<Vec<u8>>, from: usize, bytes: &[u8]) -> usize {
    let heard = heard.lock().expect("not poisoned");
    heard[from.min(heard.len())..].windows(bytes.len()).filter(|window| *window == bytes).count()
}

/// Asks the mount one question by a connection of our own.
fn ask(line: &mut TcpStream, question: &str) -> String {
    line.write_all(question.as_bytes()).expect("asked");
    let mut reply = Vec::new();
    while reply.last() != Some(&b'#') {
        let mut byte = [0];
        line.read_exact(&mut byte).expect("an answer");
        reply.push(byte[0]);
    }
    String::from_utf8_lossy(&reply).into_owned()
}

/// Starts a slew across the sky, sends the session a signal in the middle, and asks the mount what became of it.
fn slew_interrupted_by(signal: Signal) {
    let (_mount, address) = mount();
    let (relayed, heard, thread) = relay(&address);
    let session = scotopic(&["observe", "--headless", "--for", "600", "--site", "60.17,24.94,30"])
        .args([
            "--time",
            "2026-11-22T22:00:00Z",
            "--mount",
            &format!("tcp:{relayed}"),
            "--goto",
            "Vega",
            "--goto",
            "Procyon",
        ])
        .stdout(Stdio::null())
        .spawn()
        .expect("a session");
    let session = Ended(session);
    // One of two opposite targets is far from where the mount stands: the second is more than 90 degrees from the first.
    wait_for("the second go-to", || holds(&heard, 0, b":MS#") >= 2);
    thread::sleep(Duration::from_millis(1200));
    let before = heard.lock().expect("not poisoned").len();
    let pid = Pid::from_raw(i32::try_from(session.0.id()).expect("a pid")).expect("a pid");
    kill_process(pid, signal).expect("the signal is sent");
    wait_for("the stops", || holds(&heard, before, STOP) >= STOPS as usize);
    // A session that was stopped dead holds its socket until it is gone.
    drop(session);
    thread.join().expect("the relay ends");

    let mut line = TcpStream::connect(&address).expect("the mount serves the next client");
    line.set_read_timeout(Some(Duration::from_secs(5))).expect("a timeout");
    let position = |line: &mut TcpStream| (ask(line, ":GR#"), ask(line, ":GD#"));
    let first = position(&mut line);
    thread::sleep(Duration::from_millis(1500));
    let second = position(&mut line);
    assert_eq!(first, second, "the mount still moves");
    assert_eq!(ask(&mut line, ":D#"), "#", "the mount still slews");
    // Procyon is at 7h39m +5 degrees: the mount was stopped short of it.
    assert!(!(first.0.starts_with("07:4") || first.0.starts_with("07:39")), "it arrived: {first:?}");
}

#[test]
fn a_session_killed_in_the_middle_of_a_slew_leaves_the_mount_at_rest() {
    slew_interrupted_by(Signal::KILL);
}

#[test]
fn a_session_that_hangs_in_the_middle_of_a_slew_leaves_the_mount_at_rest() {
    slew_interrupted_by(Signal::STOP);
}
