//! The built program in a real terminal: a pseudo-terminal whose screen is read by vt100. It searches, slews, arrives, stops and
//! quits; and however it ends, the terminal is as it was.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs::File;
use std::io::{Read, Write};
use std::num::NonZero;
use std::os::fd::OwnedFd;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{Termios, Winsize, tcgetattr, tcsetwinsize};

/// No step of the session takes so long on the slowest machine that is meant.
const PATIENCE: Duration = Duration::from_secs(90);

const ROWS: NonZero<u16> = NonZero::new(24).unwrap();
const COLUMNS: NonZero<u16> = NonZero::new(80).unwrap();

/// The program in its terminal.
struct Session {
    child: Child,
    keyboard: File,
    /// Held open so that the settings of the terminal can be read after the program has ended.
    terminal: OwnedFd,
    before: Termios,
    bytes: Arc<Mutex<Vec<u8>>>,
}

impl Session {
    fn start(environment: &[(&str, &str)], arguments: &[&str]) -> Session {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&master).unwrap();
        unlockpt(&master).unwrap();
        let name = ptsname(&master, Vec::new()).unwrap();
        let terminal: OwnedFd = File::options().read(true).write(true).open(name.to_str().unwrap()).unwrap().into();
        tcsetwinsize(&terminal, Winsize { ws_row: 24, ws_col: 80, ws_xpixel: 0, ws_ypixel: 0 }).unwrap();
        let before = tcgetattr(&terminal).unwrap();
        let end = || Stdio::from(terminal.try_clone().unwrap());
        let home = tempdir();
        let child = Command::new(env!("CARGO_BIN_EXE_scotopic"))
            .args(arguments)
            .env_remove("COLORTERM")
            .env("TERM", "xterm-256color")
            .env("XDG_CONFIG_HOME", &home)
            .env("XDG_STATE_HOME", &home)
            .env("XDG_DATA_HOME", &home)
            .env("XDG_DATA_DIRS", &home)
            .env("HOME", &home)
            .envs(environment.iter().copied())
            .stdin(end())
            .stdout(end())
            .stderr(end())
            .spawn()
            .unwrap();
        let bytes = Arc::new(Mutex::new(Vec::new()));
        let mut screen = File::from(master.try_clone().unwrap());
        let heard = Arc::clone(&bytes);
        thread::spawn(move || {
            let mut chunk = [0; 4096];
            while let Ok(count @ 1..) = screen.read(&mut chunk) {
                heard.lock().unwrap().extend_from_slice(&chunk[..count]);
            }
        });
        Session { child, keyboard: File::from(master), terminal, before, bytes }
    }

    fn written(&self) -> Vec<u8> {
        self.bytes.lock().unwrap().clone()
    }

    fn screen(&self) -> vt100::Parser {
        let mut parser = parser();
        parser.process(&self.written());
        parser
    }

    /// Waits until the screen shows what is wanted.
    fn wait_for(&self, wanted: &str) {
        self.wait_until(wanted, |text| text.contains(wanted));
    }

    fn wait_until(&self, what: &str, seen: impl Fn(&str) -> bool) {
        let deadline = Instant::now() + PATIENCE;
        loop {
            let text = self.screen().screen().contents();
            if seen(&text) {
                return;
            }
            assert!(Instant::now() < deadline, "'{what}' did not come; the screen shows:\n{text}");
            thread::sleep(Duration::from_millis(20));
        }
    }

    fn press(&mut self, keys: &str) {
        self.keyboard.write_all(keys.as_bytes()).unwrap();
    }

    fn ended(&mut self) -> ExitStatus {
        let deadline = Instant::now() + PATIENCE;
        loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                return status;
            }
            assert!(Instant::now() < deadline, "the program did not end");
            thread::sleep(Duration::from_millis(20));
        }
    }

    /// The terminal is as it was: its modes, the screen that was there, the cursor, the colours.
    fn assert_given_back(&self) {
        // What was written last may still be on its way to the reader.
        let deadline = Instant::now() + PATIENCE;
        while !self.written().ends_with(b"\x1b[?25h") && self.screen().screen().alternate_screen() {
            assert!(Instant::now() < deadline, "the alternate screen was not left");
            thread::sleep(Duration::from_millis(20));
        }
        let after = tcgetattr(&self.terminal).unwrap();
        assert_eq!(after.local_modes, self.before.local_modes);
        assert_eq!(after.input_modes, self.before.input_modes);
        assert_eq!(after.output_modes, self.before.output_modes);
        assert_eq!(after.control_modes, self.before.control_modes);
        let parser = self.screen();
        assert!(!parser.screen().alternate_screen());
        assert!(!parser.screen().hide_cursor());
        assert_eq!(parser.screen().fgcolor(), vt100::Color::Default);
        assert_eq!(parser.screen().bgcolor(), vt100::Color::Default);
    }

    /// No colour but red was ever asked for while the terminal was taken, and no cell ever held another.
    fn assert_all_red(&self) {
        let bytes = self.written();
        let taken = bytes.windows(6).rposition(|window| window == b"[?1049").unwrap();
        for parameters in colour_changes(&bytes[..taken]) {
            assert!(only_red(&parameters), "the colours {parameters:?} were asked for");
        }
        let mut parser = parser();
        for chunk in bytes[..taken].chunks(512) {
            parser.process(chunk);
            if !parser.screen().alternate_screen() {
                continue;
            }
            for (row, column) in (0..24).flat_map(|row| (0..80).map(move |column| (row, column))) {
                let cell = parser.screen().cell(row, column).unwrap();
                if cell.has_contents() {
                    assert!(red(cell.fgcolor()) && red(cell.bgcolor()), "{cell:?}");
                }
            }
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn parser() -> vt100::Parser {
    vt100::Parser::new(ROWS, COLUMNS, 0)
}

/// A folder of this test process for settings, so that the user's own are not touched.
fn tempdir() -> std::path::PathBuf {
    use std::sync::atomic::{AtomicU32, Ordering};
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let folder = std::env::temp_dir().join(format!("scotopic-terminal-{}-{count}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// The parameters of every `ESC [ ... m`.
fn colour_changes(bytes: &[u8]) -> Vec<String> {
    let text = String::from_utf8_lossy(bytes);
    let parts = text.split("\x1b[").skip(1);
    parts
        .filter_map(|part| {
            let end = part.find(|c: char| !(c.is_ascii_digit() || c == ';'))?;
            part[end..].starts_with('m').then(|| part[..end].to_owned())
        })
        .collect()
}

/// Whether the parameters choose reds and blacks of the 256 colours only, and reset nothing.
fn only_red(parameters: &str) -> bool {
    let numbers: Vec<&str> = parameters.split(';').collect();
    numbers.len().is_multiple_of(3)
        && numbers.chunks(3).all(|colour| {
            matches!(colour[0], "38" | "48")
                && colour[1] == "5"
                && matches!(colour[2], "16" | "52" | "88" | "124" | "160" | "196")
        })
}

fn red(color: vt100::Color) -> bool {
    matches!(color, vt100::Color::Idx(16 | 52 | 88 | 124 | 160 | 196) | vt100::Color::Rgb(_, 0, 0))
}

#[test]
fn a_session_searches_slews_arrives_stops_and_quits_and_the_terminal_is_as_it_was() {
    let mut session = Session::start(&[], &["observe", "--time", "2026-11-22T20:00:00Z"]);
    session.wait_for("SIMULATED");
    session.wait_for("linked to LX2001");
    session.wait_for("tracking");
    session.press("/M31");
    session.wait_for("NGC 224");
    session.press("\r");
    session.wait_for("SLEWING");
    session.wait_for("the telescope moves");
    session.wait_for("RA 00h44m");
    session.wait_for("tracking");
    session.press("l");
    session.wait_for("arrived");
    session.press("s/");
    session.wait_for("go to:");
    session.press("vega");
    session.wait_for("in         Lyr");
    session.press("\r");
    session.wait_for("SLEWING");
    // The stop works while typing, too.
    session.press("/M5");
    session.wait_for("go to: M5");
    session.press("\x18");
    session.wait_until("not SLEWING", |text| !text.contains("SLEWING"));
    session.press("\x1b");
    session.wait_for("in the field");
    session.press("q");
    assert!(session.ended().success());
    session.assert_given_back();
    session.assert_all_red();
}

#[test]
fn after_a_panic_the_terminal_is_as_it_was_and_the_panic_can_be_read() {
    let mut session = Session::start(&[("SCOTOPIC_TEST_PANIC", "0.5")], &["observe"]);
    session.wait_for("SIMULATED");
    assert_eq!(session.ended().code(), Some(101));
    session.wait_for("SCOTOPIC_TEST_PANIC asked for it");
    session.assert_given_back();
    session.assert_all_red();
}

#[test]
fn after_a_signal_the_terminal_is_as_it_was() {
    for signal in [Signal::TERM, Signal::INT, Signal::HUP] {
        let mut session = Session::start(&[], &["observe"]);
        session.wait_for("SIMULATED");
        kill_process(Pid::from_child(&session.child), signal).unwrap();
        assert!(session.ended().success(), "{signal:?}");
        session.assert_given_back();
        session.assert_all_red();
    }
}

#[test]
fn without_a_terminal_the_session_says_why_it_does_not_start() {
    let output = Command::new(env!("CARGO_BIN_EXE_scotopic")).stdin(Stdio::null()).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("no terminal") && said.contains("--headless"), "{said}");
}
