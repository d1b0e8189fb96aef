//! `scotopic simulate mount` as other programs meet it: its first line, its clients, its end.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Output, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};

/// How long anything may take.
const PATIENCE: Duration = Duration::from_secs(20);

fn scotopic(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_scotopic"));
    command.args(["simulate", "mount"]).args(arguments).stdin(Stdio::null());
    command
}

fn output(arguments: &[&str]) -> Output {
    scotopic(arguments).output().unwrap()
}

/// A simulator that is ended with the test.
struct Simulator {
    child: Child,
    lines: Receiver<String>,
}

impl Simulator {
    fn start(arguments: &[&str]) -> (Simulator, String) {
        let mut child = scotopic(arguments).stdout(Stdio::piped()).spawn().unwrap();
        let (sender, lines) = channel();
        let output = BufReader::new(child.stdout.take().unwrap());
        std::thread::spawn(move || output.lines().map_while(Result::ok).try_for_each(|line| sender.send(line)));
        let simulator = Simulator { child, lines };
        let endpoint = simulator.endpoint();
        (simulator, endpoint)
    }

    /// The next line of its standard output.
    fn endpoint(&self) -> String {
        let line = self.lines.recv_timeout(PATIENCE).unwrap();
        let answer: serde_json::Value = serde_json::from_str(&line).unwrap();
        answer["endpoint"].as_str().unwrap().to_owned()
    }

    fn end(mut self, signal: Signal) -> Option<i32> {
        kill_process(Pid::from_child(&self.child), signal).unwrap();
        self.child.wait().unwrap().code()
    }
}

impl Drop for Simulator {
    fn drop(&mut self) {
        // It has ended already where the test went well.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends, and reads until the reply ends as it should.
fn ask(line: &mut (impl Read + Write), command: &[u8], ends: &[u8]) -> Vec<u8> {
    line.write_all(command).unwrap();
    let (deadline, mut heard, mut bytes) = (Instant::now() + PATIENCE, Vec::new(), [0; 64]);
    while !heard.ends_with(ends) {
        assert!(Instant::now() < deadline, "{} was answered with {}", command.escape_ascii(), heard.escape_ascii());
        let count = line.read(&mut bytes).unwrap_or(0);
        heard.extend(&bytes[..count]);
    }
    heard
}

fn tcp(endpoint: &str) -> TcpStream {
    let stream = TcpStream::connect(endpoint.strip_prefix("tcp:").unwrap()).unwrap();
    stream.set_read_timeout(Some(Duration::from_millis(100))).unwrap();
    stream
}

fn serial(endpoint: &str) -> serialport::TTYPort {
    serialport::new(endpoint, 9600).timeout(Duration::from_millis(100)).open_native().unwrap()
}

#[test]
fn it_serves_client_after_client_over_tcp_and_ends_cleanly() {
    let arguments = ["--listen", "tcp:127.0.0.1:0", "--site", "-24.6,-70.4,2635", "--time", "2026-11-22T03:00:00Z"];
    let (simulator, endpoint) = Simulator::start(&arguments);
    assert!(endpoint.starts_with("tcp:127.0.0.1:") && !endpoint.ends_with(":0"), "{endpoint}");
    for client in 0..3 {
        let mut line = tcp(&endpoint);
        assert_eq!(ask(&mut line, b"\x06", b"A"), b"A");
        assert_eq!(ask(&mut line, b":Gt#", b"#"), b"-24\xDF36:00#");
        if client == 0 {
            line.write_all(b":U#").unwrap();
            assert_eq!(ask(&mut line, b":GR#", b"#").len(), 8);
            line.write_all(b":U#").unwrap();
        }
        assert_eq!(ask(&mut line, b":GW#", b"2"), b"AT2");
    }
    // Where ERFA (pyerfa 2.0: gst06a, ae2hd) has azimuth 150, altitude 45 degrees then and there: 5.204088 h, -58.336545 deg.
    let mut line = tcp(&endpoint);
    assert_eq!(ask(&mut line, b":GR#", b"#"), b"05:12:15#");
    assert_eq!(ask(&mut line, b":GD#", b"#"), b"-58\xDF20:12#");
    assert_eq!(simulator.end(Signal::TERM), Some(0));
}

#[test]
fn a_pty_lives_through_its_clients_and_keeps_the_mount_as_it_was() {
    let (simulator, endpoint) = Simulator::start(&["--listen", "pty"]);
    assert!(endpoint.starts_with("/dev/pts/"), "{endpoint}");
    for length in [8, 9, 8] {
        let mut line = serial(&endpoint);
        line.write_all(b":U#").unwrap();
        assert_eq!(ask(&mut line, b":GR#", b"#").len(), length, "the format stays between clients");
    }
    assert_eq!(simulator.end(Signal::INT), Some(0));
}

#[test]
fn an_unplugged_pty_comes_back_under_another_name_and_says_so() {
    let (simulator, endpoint) = Simulator::start(&["--listen", "pty", "--fault", "unplug=1,0.5"]);
    let renamed = simulator.endpoint();
    assert_ne!(renamed, endpoint);
    assert_eq!(ask(&mut serial(&renamed), b":GVP#", b"#"), b"LX2001#");
}

#[test]
fn a_recording_has_a_header_and_every_byte() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("simulate-record.jsonl");
    let (simulator, endpoint) = Simulator::start(&["--listen", "tcp:127.0.0.1:0", "--record", path.to_str().unwrap()]);
    ask(&mut tcp(&endpoint), b":GVP#", b"#");
    assert_eq!(simulator.end(Signal::TERM), Some(0));
    let text = std::fs::read_to_string(path).unwrap();
    let lines: Vec<serde_json::Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines[0]["seed"], 1);
    let bytes = |way: &str| -> String {
        lines.iter().filter(|line| line["dir"] == way).filter_map(|line| line["hex"].as_str()).collect()
    };
    assert_eq!((bytes("to-mount").as_str(), bytes("from-mount").as_str()), ("3a47565023", "4c583230303123"));
}

#[test]
fn faults_are_listed_with_values_and_meaning() {
    let list = output(&["--fault", "list"]);
    assert!(list.status.success());
    let text = String::from_utf8(list.stdout).unwrap();
    for name in ["nak=", "unplug=", "rollover=", "hold-sync=", "frozen=", "wrong-altitude="] {
        assert!(text.lines().any(|line| line.starts_with(name)), "{name} is not in the list:\n{text}");
    }
    let json: serde_json::Value = serde_json::from_slice(&output(&["--fault", "list", "--json"]).stdout).unwrap();
    assert!(
        json.as_array().unwrap().iter().all(|fault| fault["meaning"].as_str().is_some_and(|text| !text.is_empty()))
    );
}

#[test]
fn what_is_asked_wrongly_ends_with_2_and_a_sentence() {
    for (arguments, sentence) in [
        (&["--fault", "unplugg=1,2"][..], "did you mean unplug"),
        (&["--fault", "nak=lots"], "a chance from 0 to 1"),
        (&["--listen", "tcp:0.0.0.0:0"], "other machines"),
        (&["--listen", "udp"], "pty, or tcp:127.0.0.1:PORT"),
        (&["--site", "91,0,0"], "latitude 91"),
        (&["--time", "yesterday"], "is not a time"),
        (&["--periodic-error", "-1"], "from 0 to 10000"),
    ] {
        let answer = output(arguments);
        let said = String::from_utf8_lossy(&answer.stderr).into_owned();
        assert_eq!(answer.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(sentence), "{arguments:?}: {said}");
        assert!(answer.stdout.is_empty());
    }
}

#[test]
fn a_port_that_is_taken_ends_with_1_and_says_which() {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let place = format!("tcp:{}", taken.local_addr().unwrap());
    let answer = output(&["--listen", &place]);
    assert_eq!(answer.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&answer.stderr).contains(&place));
}
