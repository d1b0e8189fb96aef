//! Programs under test, each ended with everything that it started when the test ends, however it ends.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU16, Ordering};
use std::time::Duration;

use rustix::process::{Pid, Signal, kill_process_group};

/// A program in a process group of its own.
pub(crate) struct Program(Child);

impl Program {
    pub(crate) fn start(command: &mut Command) -> Program {
        Program(command.stdin(Stdio::null()).process_group(0).spawn().unwrap())
    }

    fn group(&self) -> Pid {
        Pid::from_child(&self.0)
    }

    /// Asks it to end and says with which code it did.
    pub(crate) fn end(mut self) -> Option<i32> {
        kill_process_group(self.group(), Signal::TERM).unwrap();
        self.0.wait().unwrap().code()
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // Both fail when it has ended already, which is what is wanted.
        let _ = kill_process_group(self.group(), Signal::KILL);
        let _ = self.0.wait();
    }
}

/// Starts the simulated mount; gives it and its endpoint.
pub(crate) fn simulator(listen: &str, record: &Path) -> (Program, String) {
    let mut program = Program::start(
        Command::new(env!("CARGO_BIN_EXE_scotopic"))
            .args(["simulate", "mount", "--listen", listen, "--seed", "7"])
            .args(["--site", "49.26,7.04,230", "--time", "2026-11-22T20:00:00Z", "--record"])
            .arg(record)
            .stdout(Stdio::piped()),
    );
    let mut line = String::new();
    BufReader::new(program.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let answer: serde_json::Value = serde_json::from_str(&line).unwrap();
    (program, answer["endpoint"].as_str().unwrap().to_owned())
}

/// Starts an indiserver with one driver, on a port of its own, with a home of its own.
pub(crate) fn indiserver(driver: &str, home: &Path) -> (Program, u16) {
    let port = free_port();
    std::fs::create_dir_all(home).unwrap();
    let log = std::fs::File::create(home.join("indiserver.log")).unwrap();
    let program = Program::start(
        Command::new("indiserver")
            .args(["-u", &format!("{}/socket", home.display()), "-p", &port.to_string(), driver])
            .env("HOME", home)
            .stdout(Stdio::null())
            .stderr(log),
    );
    (program, port)
}

/// A free port that the system hands to nobody else: below the range from which it chooses ports itself.
fn free_port() -> u16 {
    static NEXT: AtomicU16 = AtomicU16::new(0);
    let first = 20_000 + (std::process::id() % 1000) as u16 * 8;
    loop {
        let port = first + NEXT.fetch_add(1, Ordering::Relaxed);
        if std::net::TcpListener::bind(("127.0.0.1", port)).is_ok() {
            return port;
        }
    }
}

/// Asks the simulator itself, as the only client; what it answers within 300 ms.
pub(crate) fn ask(endpoint: &str, command: &[u8]) -> String {
    let patience = Duration::from_millis(300);
    let mut line: Box<dyn ReadWrite> = match endpoint.strip_prefix("tcp:") {
        Some(address) => {
            let stream = TcpStream::connect(address).unwrap();
            stream.set_read_timeout(Some(patience)).unwrap();
            Box::new(stream)
        }
        None => Box::new(serialport::new(endpoint, 9600).timeout(patience).open_native().unwrap()),
    };
    line.write_all(command).unwrap();
    let mut heard = Vec::new();
    let mut bytes = [0; 100];
    while let Ok(count @ 1..) = line.read(&mut bytes) {
        heard.extend(&bytes[..count]);
    }
    String::from_utf8_lossy(&heard).into_owned()
}

trait ReadWrite: Read + Write {}

impl<T: Read + Write> ReadWrite for T {}

/// Whether a program is on the path.
pub(crate) fn installed(name: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(name).is_file())
}

/// An empty folder for one test.
pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("indi-{name}"));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}
