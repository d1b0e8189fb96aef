//! The hand controller as an observer meets it: an unknown cable is taught in a terminal, its keys are heard, and nothing is ever
//! sent on it.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read, Write};
use std::os::fd::OwnedFd;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Output, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{LocalModes, tcgetattr};
use scotopic::hw::handbox::tap::{Tap, TapSaid};
use scotopic::hw::handbox::{Decoder, Heard, KeyMap};
use scotopic::hw::port::PortError;

/// How long anything may take.
const PATIENCE: Duration = Duration::from_secs(60);

/// A folder of one test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Folder {
        let path = std::env::temp_dir().join(format!("scotopic-handbox-{name}-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Folder(path)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn scotopic(folder: &Folder, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_scotopic"));
    command
        .args(arguments)
        .env("HOME", &folder.0)
        .env("XDG_DATA_DIRS", &folder.0)
        .env("XDG_CONFIG_HOME", &folder.0)
        .env("XDG_STATE_HOME", &folder.0);
    command
}

fn output(folder: &Folder, arguments: &[&str]) -> Output {
    scotopic(folder, arguments).stdin(Stdio::null()).output().unwrap()
}

/// A program that is ended with the test, and the lines it prints.
struct Running {
    child: Child,
    lines: Receiver<String>,
    input: Option<ChildStdin>,
}

impl Running {
    fn start(mut command: Command) -> Running {
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        let (sender, lines) = channel();
        let output = BufReader::new(child.stdout.take().unwrap());
        thread::spawn(move || output.lines().map_while(Result::ok).try_for_each(|line| sender.send(line)));
        let input = child.stdin.take();
        Running { child, lines, input }
    }

    /// The next line it prints, as JSON.
    fn line(&self) -> serde_json::Value {
        serde_json::from_str(&self.lines.recv_timeout(PATIENCE).unwrap()).unwrap()
    }

    /// The next line about a key that was pressed: its name, and whether it was long.
    fn key(&self) -> (String, bool) {
        loop {
            let line = self.line();
            if line["event"] == "pressed" {
                return (line["key"].as_str().unwrap().to_owned(), line["long"].as_bool().unwrap());
            }
            assert_ne!(line["event"], "unknown", "{line}");
        }
    }

    fn type_line(&mut self, line: &str) {
        writeln!(self.input.as_mut().unwrap(), "{line}").unwrap();
    }

    fn end(mut self) -> Option<i32> {
        kill_process(Pid::from_child(&self.child), Signal::TERM).unwrap();
        self.child.wait().unwrap().code()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The far end of a tapped line, its name, and the near end held open, so that it does not hang up.
fn line() -> (File, String) {
    let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&master).unwrap();
    unlockpt(&master).unwrap();
    let name = ptsname(&master, Vec::new()).unwrap().to_str().unwrap().to_owned();
    (File::from(master), name)
}

/// What a program has written to a terminal so far.
type Screen = Arc<Mutex<Vec<u8>>>;

/// Starts a program in a terminal of its own: the keyboard, and what it writes.
fn in_a_terminal(mut command: Command) -> (Child, File, Screen) {
    let (master, name) = line();
    let terminal: OwnedFd = File::options().read(true).write(true).open(name).unwrap().into();
    let end = || Stdio::from(terminal.try_clone().unwrap());
    let child = command.stdin(end()).stdout(end()).stderr(end()).spawn().unwrap();
    let written = Screen::default();
    let (mut screen, heard) = (master.try_clone().unwrap(), Arc::clone(&written));
    thread::spawn(move || {
        let mut chunk = [0; 4096];
        while let Ok(count @ 1..) = screen.read(&mut chunk) {
            heard.lock().unwrap().extend_from_slice(&chunk[..count]);
        }
        drop(terminal);
    });
    (child, master, written)
}

#[test]
fn an_unknown_controller_at_an_unknown_speed_is_taught_in_the_dark_and_then_heard() {
    let folder = Folder::new("learn");
    let keys = "name = \"unknown\"\n[framing]\nmode = \"bit7\"\n[[key]]\nname = \"?\"\npress = \"21\"\n\
                [[key]]\nname = \"MODE\"\npress = \"46\"\n";
    fs::write(folder.path("unknown.toml"), keys).unwrap();
    let unknown = folder.path("unknown.toml");
    let arguments = ["simulate", "handbox", "--baud", "4800", "--bounce", "0.2", "--map", unknown.to_str().unwrap()];
    let mut controller = Running::start(scotopic(&folder, &arguments));
    let port = controller.line()["endpoint"].as_str().unwrap().to_owned();
    let (learned, lesson) = (folder.path("mine.toml"), folder.path("lesson.jsonl"));
    let arguments = ["handbox", "learn", "--port", &port, "--keys", "?,MODE", "--idle", "0.5"];
    let mut command = scotopic(&folder, &arguments);
    command.arg("--map").arg(&learned).arg("--record").arg(&lesson);
    let (mut child, mut keyboard, screen) = in_a_terminal(command);
    // The person at the telescope does as the prompts say.
    let (mut pressed, mut agreed, deadline) = (0, 0, Instant::now() + PATIENCE);
    let status = loop {
        let text = String::from_utf8_lossy(&screen.lock().unwrap()).into_owned();
        assert!(Instant::now() < deadline, "{text}");
        let prompts: Vec<&str> =
            text.split("Press ").skip(1).filter_map(|rest| rest.split_once(" and let go (")).map(|p| p.0).collect();
        if let Some(key) = prompts.get(pressed) {
            controller.type_line(key);
            pressed += 1;
        }
        if text.matches("[Y/n]").count() > agreed {
            keyboard.write_all(b"y\n").unwrap();
            agreed += 1;
        }
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        thread::sleep(Duration::from_millis(10));
    };
    let written = screen.lock().unwrap().clone();
    let text = String::from_utf8_lossy(&written).into_owned();
    assert!(status.success(), "{text}");
    assert!(text.contains("The line runs at 4800") && text.contains("sends 21, let go A1"), "{text}");
    let colours: Vec<&str> = text.split("\x1b[").skip(1).filter_map(|rest| rest.split_once('m')).map(|c| c.0).collect();
    assert_eq!(colours, ["0;31;40", "0"], "red from the first word, and given back at the end");
    let map = KeyMap::from_toml(&fs::read_to_string(&learned).unwrap()).unwrap();
    assert_eq!((map.line().baud, map.keys().len()), (4800, 2));

    // The recorded lesson teaches the same again.
    let again = folder.path("again.toml");
    let replayed =
        output(&folder, &["handbox", "learn", "--replay", lesson.to_str().unwrap(), "--map", again.to_str().unwrap()]);
    assert!(replayed.status.success(), "{}", String::from_utf8_lossy(&replayed.stderr));
    assert_eq!(fs::read_to_string(&again).unwrap(), fs::read_to_string(&learned).unwrap());

    // And the keys are heard with the learned map, and again from the recording.
    let night = folder.path("night.jsonl");
    let mut command = scotopic(&folder, &["handbox", "listen", "--json", "--port", &port]);
    command.arg("--map").arg(&learned).arg("--record").arg(&night);
    let listener = Running::start(command);
    thread::sleep(Duration::from_millis(500));
    for line in ["?", "MODE", "?~"] {
        controller.type_line(line);
    }
    let heard: Vec<(String, bool)> = (0..3).map(|_| listener.key()).collect();
    assert_eq!(heard, [("?".into(), false), ("MODE".into(), false), ("?".into(), true)]);
    assert_eq!(listener.end(), Some(0));
    let replayed = output(
        &folder,
        &["handbox", "listen", "--replay", night.to_str().unwrap(), "--map", learned.to_str().unwrap()],
    );
    let words = String::from_utf8_lossy(&replayed.stdout).into_owned();
    let keys: Vec<&str> = words.lines().filter_map(|line| line.split_once("s  ")).map(|(_, key)| key).collect();
    assert_eq!(keys, ["?", "MODE", "? long"]);
    assert_eq!(controller.end(), Some(0));
}

#[test]
fn the_listener_never_sends_and_passes_every_byte() {
    let folder = Folder::new("listen");
    let (mut far, port) = line();
    let listener =
        Running::start(scotopic(&folder, &["handbox", "listen", "--json", "--port", &port, "--map", "lx200-classic"]));
    rustix::fs::fcntl_setfl(&far, rustix::fs::OFlags::NONBLOCK).unwrap();
    // A new terminal echoes what it hears; the listener turns that off.
    let deadline = Instant::now() + PATIENCE;
    while tcgetattr(&far).unwrap().local_modes.contains(LocalModes::ECHO) {
        assert!(Instant::now() < deadline, "the listener did not open the line");
        thread::sleep(Duration::from_millis(10));
    }
    // All bytes of the start-up sequence came through the system's marks: none is unknown.
    far.write_all(b"\xFF\xFF\xFF\xFF\xFF\x2A\x0D").unwrap();
    thread::sleep(Duration::from_millis(100));
    far.write_all(b"\x8D").unwrap();
    assert_eq!(listener.key(), ("ENTER".into(), false));
    let mut sent = [0; 64];
    let read = far.read(&mut sent);
    assert!(read.is_err(), "{:?} was sent on the tapped line", &sent[..read.unwrap_or(0)]);
    assert_eq!(listener.end(), Some(0));
}

#[test]
fn a_tap_that_is_unplugged_comes_back_under_another_device() {
    let folder = Folder::new("replug");
    let name = folder.path("by-id");
    let (first, port) = line();
    symlink(&port, &name).unwrap();
    let (said, hears) = channel();
    let stop = Arc::new(AtomicBool::new(false));
    let ended = Arc::clone(&stop);
    let path = name.to_str().unwrap().to_owned();
    let listener = thread::spawn(move || {
        let decoder = Decoder::new(KeyMap::shipped("autostar2-guess").unwrap());
        Tap::run(&path, decoder, Instant::now(), &ended, |what| {
            matches!(what, TapSaid::Alive) || said.send(what).is_ok()
        });
    });
    let next = || hears.recv_timeout(PATIENCE).unwrap();
    assert_eq!(next(), TapSaid::Opened);
    drop(first);
    assert!(matches!(next(), TapSaid::Lost { why: PortError::Unplugged { .. } }));
    let (mut second, port) = line();
    fs::remove_file(&name).unwrap();
    symlink(&port, &name).unwrap();
    while next() != TapSaid::Opened {}
    second.write_all(b"\x3F").unwrap();
    assert!(matches!(next(), TapSaid::Bytes { bytes, malformed: 0, .. } if bytes == b"\x3F"));
    assert!(matches!(next(), TapSaid::Heard(Heard::Pressed(pressed)) if pressed.key == "?"));
    stop.store(true, Ordering::Relaxed);
    listener.join().unwrap();
}

#[test]
fn a_tapped_line_is_held_so_that_nobody_else_reads_or_writes_it() {
    let (_far, port) = line();
    let map = KeyMap::shipped("ascii").unwrap();
    let tap = Tap::open(&port, &map.line()).unwrap();
    assert!(matches!(Tap::open(&port, &map.line()), Err(PortError::Held { .. })));
    assert!(matches!(scotopic::hw::serial::SerialLine::open(&port, 9600), Err(PortError::Held { .. })));
    drop(tap);
    assert!(Tap::open(&port, &map.line()).is_ok());
    assert!(matches!(Tap::open("/dev/no-such-tty", &map.line()), Err(PortError::NotThere { .. })));
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml");
    assert!(matches!(Tap::open(file, &map.line()), Err(PortError::Unusable { .. })));
}

/// Asked wrongly: exit code 2, one sentence with these words, nothing on standard output.
fn refused(output: &Output, words: &[&str]) {
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(output.stdout.is_empty());
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(words.iter().all(|word| said.contains(word)), "{said}");
}

#[test]
fn the_mounts_own_port_is_refused_under_every_name() {
    let folder = Folder::new("mount");
    let (_far, port) = line();
    let by_id: &Path = &folder.path("usb-FTDI_mount");
    symlink(&port, by_id).unwrap();
    let mount = format!("serial:{port}");
    for tap in [port.as_str(), by_id.to_str().unwrap()] {
        for action in ["listen", "learn"] {
            let output = output(&folder, &["handbox", action, "--port", tap, "--mount", &mount]);
            refused(&output, &["the mount's own command port", tap, "adapter of its own"]);
        }
    }
    // The settings' mount counts as well.
    fs::create_dir_all(folder.path("scotopic")).unwrap();
    fs::write(folder.path("scotopic/settings.toml"), format!("mount = \"{mount}\"\n")).unwrap();
    refused(&output(&folder, &["handbox", "listen", "--port", &port]), &["the mount's own command port"]);
}

#[test]
fn a_bad_key_map_is_refused_with_a_sentence_and_nothing_is_opened() {
    let folder = Folder::new("bad");
    let (_far, port) = line();
    let listen = |text: &str| {
        let path = folder.path("bad.toml");
        fs::write(&path, text).unwrap();
        output(&folder, &["handbox", "listen", "--port", &port, "--map", path.to_str().unwrap()])
    };
    let key = |name: &str, press: &str| format!("[[key]]\nname = \"{name}\"\npress = \"{press}\"\n");
    let overlap = format!("name = \"a\"\n{}{}", key("?", "3F"), key("MODE", "3F"));
    refused(&listen(&overlap), &["key '?'", "key 'MODE'", "overlap"]);
    refused(
        &listen(&format!("name = \"a\"\n[line]\nbuad = 9600\n{}", key("?", "3F"))),
        &["line 3", "did you mean 'baud'"],
    );
    refused(&listen(&format!("name = \"a\"\n{}", key("?", "3Z"))), &["line 4", "3Z"]);
    refused(&output(&folder, &["handbox", "listen", "--port", &port, "--map", "no-such"]), &["lx200-classic", "learn"]);
    refused(&output(&folder, &["handbox", "profiles", "--map", "no-such"]), &["lx200-classic"]);
}

#[test]
fn the_shipped_maps_can_be_listed_and_written_out() {
    let folder = Folder::new("profiles");
    let listed = output(&folder, &["handbox", "profiles"]);
    let text = String::from_utf8_lossy(&listed.stdout).into_owned();
    assert!(
        listed.status.success() && text.contains("lx200-classic") && text.contains("A GUESS, never measured"),
        "{text}"
    );
    let written = output(&folder, &["handbox", "profiles", "--map", "autostar2-guess"]);
    let map = KeyMap::from_toml(&String::from_utf8(written.stdout).unwrap()).unwrap();
    assert_eq!(Some(map), KeyMap::shipped("autostar2-guess"));
    let json: serde_json::Value =
        serde_json::from_slice(&output(&folder, &["handbox", "profiles", "--json"]).stdout).unwrap();
    assert_eq!(json[0]["name"], "lx200-classic");
}
