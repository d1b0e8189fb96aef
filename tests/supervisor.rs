//! The supervisor as a process: a session is killed, stopped or let go, and the bytes on the mount's line are read.
//!
//! The session is this test program itself, started again to run the one ignored test below.

#![expect(clippy::expect_used, reason = "a test fails by panicking")]

use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::os::fd::{AsFd, OwnedFd};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use scotopic::hw::supervisor::vigil::{STOP, STOPS};
use scotopic::hw::supervisor::{Supervisor, SupervisorError};

const PROGRAM: &str = env!("CARGO_BIN_EXE_scotopic");
const LINE: &str = "SCOTOPIC_TEST_LINE";
const MOVING: &str = "SCOTOPIC_TEST_MOVING";

/// A pty in raw mode: the mount's side, and the name of ours.
fn line() -> (OwnedFd, String) {
    let mount = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).expect("a pty");
    grantpt(&mount).expect("granted");
    unlockpt(&mount).expect("unlocked");
    let mut settings = rustix::termios::tcgetattr(&mount).expect("its settings");
    settings.make_raw();
    rustix::termios::tcsetattr(&mount, rustix::termios::OptionalActions::Now, &settings).expect("raw");
    let name = ptsname(&mount, Vec::new()).expect("its name").to_string_lossy().into_owned();
    (mount, name)
}

fn open(name: &str) -> OwnedFd {
    let flags = rustix::fs::OFlags::RDWR | rustix::fs::OFlags::NOCTTY | rustix::fs::OFlags::CLOEXEC;
    rustix::fs::open(name, flags, rustix::fs::Mode::empty()).expect("the line opens")
}

/// The session's side of the tests: opens the line, beats for ever, or until its standard input ends.
#[test]
#[ignore = "run by the other tests, as the session that dies"]
fn session() {
    let Ok(name) = std::env::var(LINE) else { return };
    let moving = std::env::var(MOVING).expect("run by another test") == "yes";
    let port = open(&name);
    rustix::termios::tcgetattr(&port).expect("a terminal");
    let supervisor = Supervisor::of_program(Path::new(PROGRAM));
    let mut guard = supervisor.guard(port.try_clone().expect("a duplicate")).expect("a supervisor");
    let mut announced = false;
    loop {
        guard.beat(moving).expect("a supervisor that lives");
        if !announced {
            eprintln!("beating");
            announced = true;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
}

fn start_session(name: &str, moving: bool) -> Child {
    let mut child = Command::new(std::env::current_exe().expect("this program"))
        .args(["--exact", "session", "--ignored", "--nocapture"])
        .env(LINE, name)
        .env(MOVING, if moving { "yes" } else { "no" })
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("a session");
    let mut errors = BufReader::new(child.stderr.take().expect("its messages")).lines();
    let said = errors.find_map(|text| text.ok().filter(|text| text.contains("beating")));
    assert!(said.is_some(), "the session did not start");
    // Let the beat reach the supervisor.
    std::thread::sleep(Duration::from_millis(200));
    child
}

fn signal(child: &Child, signal: Signal) {
    let pid = Pid::from_raw(i32::try_from(child.id()).expect("a pid")).expect("a pid");
    kill_process(pid, signal).expect("the signal is sent");
}

/// All that comes to the mount until the line has no other end any more, or ten seconds have passed.
fn read_all(mount: OwnedFd) -> Vec<u8> {
    let (sender, receiver) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        let mut file = File::from(mount);
        let mut bytes = [0; 256];
        // A pty whose last other end is closed says EIO.
        while let Ok(count) = file.read(&mut bytes) {
            if count == 0 || sender.send(bytes[..count].to_vec()).is_err() {
                break;
            }
        }
    });
    let (began, mut all) = (Instant::now(), Vec::new());
    while began.elapsed() < Duration::from_secs(10) {
        match receiver.recv_timeout(Duration::from_millis(200)) {
            Ok(bytes) => all.extend(bytes),
            Err(std::sync::mpsc::RecvTimeoutError::Timeout) => {}
            Err(std::sync::mpsc::RecvTimeoutError::Disconnected) => break,
        }
    }
    all
}

#[test]
fn a_session_killed_while_moving_is_followed_by_stops_and_the_supervisor_ends() {
    let (mount, name) = line();
    let mut session = start_session(&name, true);
    signal(&session, Signal::KILL);
    session.wait().expect("it is dead");
    let bytes = read_all(mount);
    assert_eq!(bytes, STOP.repeat(STOPS as usize), "{}", String::from_utf8_lossy(&bytes));
}

#[test]
fn a_session_that_hangs_while_moving_is_followed_by_stops() {
    let (mount, name) = line();
    let mut session = start_session(&name, true);
    signal(&session, Signal::STOP);
    let mut file = File::from(mount.as_fd().try_clone_to_owned().expect("a duplicate"));
    let mut first = vec![0; STOP.len()];
    file.read_exact(&mut first).expect("the stop comes while the session hangs");
    assert_eq!(first, STOP);
    signal(&session, Signal::KILL);
    session.wait().expect("it is dead");
    let rest = read_all(mount);
    assert_eq!(rest, STOP.repeat(STOPS as usize - 1));
}

#[test]
fn a_session_killed_at_rest_is_followed_by_nothing() {
    let (mount, name) = line();
    let mut session = start_session(&name, false);
    signal(&session, Signal::KILL);
    session.wait().expect("it is dead");
    assert_eq!(read_all(mount), b"");
}

#[test]
fn a_released_line_is_free_at_once_even_while_moving_and_a_new_guard_watches_the_new_opening() {
    let (mount, name) = line();
    let supervisor = Supervisor::of_program(Path::new(PROGRAM));
    for _ in 0..3 {
        let port = open(&name);
        // Held as a serial port is held: by a lock that belongs to the open file, duplicates and all.
        rustix::fs::flock(&port, rustix::fs::FlockOperation::NonBlockingLockExclusive).expect("nobody holds the line");
        let mut guard = supervisor.guard(port.try_clone().expect("a duplicate")).expect("a supervisor");
        guard.beat(true).expect("it lives");
        guard.release();
    }
    let last = open(&name);
    drop(last);
    assert_eq!(read_all(mount), b"", "a released supervisor sends nothing");
}

#[test]
fn a_guard_dropped_while_moving_stops_the_mount() {
    let (mount, name) = line();
    let port = open(&name);
    let mut guard = Supervisor::of_program(Path::new(PROGRAM)).guard(port).expect("a supervisor");
    guard.beat(true).expect("it lives");
    drop(guard);
    assert_eq!(read_all(mount), STOP.repeat(STOPS as usize));
}

#[test]
fn a_supervisor_that_was_killed_is_noticed_at_a_beat() {
    let (_mount, name) = line();
    let mut guard = Supervisor::of_program(Path::new("/bin/true")).guard(open(&name)).expect("a process");
    let noticed = (0..100).find_map(|_| {
        std::thread::sleep(Duration::from_millis(20));
        guard.beat(true).err()
    });
    assert!(matches!(noticed, Some(SupervisorError::Ended { .. })), "{noticed:?}");
}

#[test]
fn a_program_that_is_not_there_is_told_with_what_to_do() {
    let (_mount, name) = line();
    let error = Supervisor::of_program(Path::new("/nowhere/scotopic")).guard(open(&name)).expect_err("nothing there");
    assert!(error.to_string().contains("cut the mount's power"), "{error}");
}
