//! The built program in a terminal, or without one, with its home in a folder of its own.

use std::fs::File;
use std::io::{Read, Write};
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::process::{Pid, Signal, kill_process};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, Termios, Winsize, tcgetattr, tcsetattr, tcsetwinsize};

/// No step takes so long on the slowest machine that is meant.
pub(crate) const PATIENCE: Duration = Duration::from_secs(60);

/// The master of a new pty, and the slave's name; raw, as a serial line is.
pub(crate) fn pty() -> (File, String) {
    let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).unwrap();
    grantpt(&master).unwrap();
    unlockpt(&master).unwrap();
    let name = ptsname(&master, Vec::new()).unwrap().to_string_lossy().into_owned();
    (File::from(master), name)
}

/// The same with its slave held open, made raw: nothing that is written before a client comes is lost.
pub(crate) fn raw_pty() -> (File, String, File) {
    let (master, name) = pty();
    let slave = File::options().read(true).write(true).open(&name).unwrap();
    let mut raw = tcgetattr(&slave).unwrap();
    raw.make_raw();
    tcsetattr(&slave, OptionalActions::Now, &raw).unwrap();
    (master, name, slave)
}

/// A folder for one run.
pub(crate) fn home(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("scotopic-hil-{}-{name}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// The program that is checked: the one that cargo has built for the tests, or the one that `SCOTOPIC_RIG_PROGRAM` names (a
/// release build, whose times count).
pub(crate) fn path() -> PathBuf {
    std::env::var_os("SCOTOPIC_RIG_PROGRAM").map_or_else(
        || env!("CARGO_BIN_EXE_scotopic").into(),
        // It is started in folders of its own: a path that is counted from here must be whole.
        |named| std::fs::canonicalize(named).unwrap(),
    )
}

/// The program with its home there.
pub(crate) fn command(home: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(path());
    command.args(arguments).current_dir(home).env_remove("COLORTERM").env("TERM", "xterm-256color");
    for folder in ["HOME", "XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_DATA_HOME"] {
        command.env(folder, home);
    }
    command
}

/// The program in a terminal.
pub(crate) struct Program {
    pub(crate) child: Child,
    keyboard: Option<File>,
    terminal: OwnedFd,
    before: Termios,
    bytes: Arc<Mutex<Vec<u8>>>,
    /// The terminal's window is closed.
    gone: Arc<AtomicBool>,
}

impl Program {
    pub(crate) fn start(home: &Path, environment: &[(&str, &str)], arguments: &[&str]) -> Program {
        let (master, name) = pty();
        let terminal: OwnedFd = File::options().read(true).write(true).open(name).unwrap().into();
        tcsetwinsize(&terminal, Winsize { ws_row: 24, ws_col: 80, ws_xpixel: 0, ws_ypixel: 0 }).unwrap();
        let before = tcgetattr(&terminal).unwrap();
        let end = || Stdio::from(terminal.try_clone().unwrap());
        let mut command = command(home, arguments);
        let child = command.envs(environment.iter().copied()).stdin(end()).stdout(end()).stderr(end()).spawn().unwrap();
        let bytes = Arc::new(Mutex::new(Vec::new()));
        let (mut screen, heard, gone) =
            (master.try_clone().unwrap(), Arc::clone(&bytes), Arc::new(AtomicBool::new(false)));
        let lost = Arc::clone(&gone);
        thread::spawn(move || {
            let mut chunk = [0; 4096];
            while !lost.load(Ordering::Relaxed) {
                let mut files = [PollFd::new(&screen, PollFlags::IN)];
                let _ = poll(&mut files, Some(&Timespec { tv_sec: 0, tv_nsec: 50_000_000 }));
                if files[0].revents().is_empty() {
                    continue;
                }
                let Ok(count @ 1..) = screen.read(&mut chunk) else { return };
                heard.lock().unwrap().extend_from_slice(&chunk[..count]);
            }
        });
        Program { child, keyboard: Some(master), terminal, before, bytes, gone }
    }

    pub(crate) fn press(&mut self, keys: &str) {
        self.keyboard.as_mut().unwrap().write_all(keys.as_bytes()).unwrap();
    }

    /// The window is closed: nobody reads or writes the terminal any more.
    pub(crate) fn lose_terminal(&mut self, _home: &Path) {
        self.gone.store(true, Ordering::Relaxed);
        self.keyboard = None;
    }

    pub(crate) fn signal(&self, signal: Signal) {
        kill_process(Pid::from_child(&self.child), signal).unwrap();
    }

    /// What the screen shows.
    pub(crate) fn screen(&self) -> vt100::Parser {
        let mut parser = vt100::Parser::new(24.try_into().unwrap(), 80.try_into().unwrap(), 0);
        parser.process(&self.bytes.lock().unwrap());
        parser
    }

    pub(crate) fn shows(&self, wanted: &str) -> bool {
        self.screen().screen().contents().contains(wanted)
    }

    pub(crate) fn ended(&mut self) -> Option<ExitStatus> {
        wait_for(|| self.child.try_wait().unwrap().is_some());
        self.child.try_wait().unwrap()
    }

    /// Whether the terminal is as it was: its modes, the screen that was there, the cursor.
    pub(crate) fn given_back(&self) -> bool {
        let same = || {
            let (after, screen) = (tcgetattr(&self.terminal).unwrap(), self.screen());
            after.local_modes == self.before.local_modes
                && after.input_modes == self.before.input_modes
                && after.output_modes == self.before.output_modes
                && !screen.screen().alternate_screen()
                && !screen.screen().hide_cursor()
        };
        // What was written last may still be on its way to the reader.
        wait_at_most(Duration::from_secs(3), same)
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

pub(crate) fn wait_for(seen: impl FnMut() -> bool) -> bool {
    wait_at_most(PATIENCE, seen)
}

pub(crate) fn wait_at_most(most: Duration, mut seen: impl FnMut() -> bool) -> bool {
    let began = Instant::now();
    loop {
        if seen() {
            return true;
        }
        if began.elapsed() > most {
            return false;
        }
        thread::sleep(Duration::from_millis(10));
    }
}
