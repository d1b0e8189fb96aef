//! A second process that makes the projector dark if this program is killed: no code of ours runs then.
//!
//! It is this program with `projector off --when-abandoned`: it waits at a pipe that the kernel closes however we die, and has
//! nothing open until then. A lamp that was made dark in order says so through the pipe, and the child ends.

use std::ffi::OsString;
use std::io::{self, Read, Write};
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// What is written when all is dark.
const RELEASE: u8 = b'R';

/// A child that waits for our death.
#[derive(Debug)]
pub struct Guard {
    child: Child,
    pipe: Option<ChildStdin>,
}

impl Guard {
    /// Starts the child: this program, with these arguments.
    ///
    /// # Errors
    /// As the system says.
    pub fn start(arguments: &[OsString]) -> io::Result<Guard> {
        // The link still leads to this program when its file was replaced by an upgrade.
        let link = Path::new("/proc/self/exe");
        let program = if link.exists() { link.to_owned() } else { std::env::current_exe()? };
        let mut child = Command::new(program)
            .arg0("scotopic")
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .process_group(0) // Ctrl-C and a closed terminal are for the program, not for its guard.
            .spawn()?;
        let pipe = child.stdin.take();
        Ok(Guard { child, pipe })
    }

    /// Tells the child that all is dark; it ends.
    pub fn release(mut self) {
        let told = self.pipe.take().is_some_and(|mut pipe| pipe.write_all(&[RELEASE]).is_ok());
        if told {
            // It has nothing to do but to end.
            let _ = self.child.wait();
        }
    }
}

/// The child's whole life but its deed: returns true when the program that started it died without having made it dark.
///
/// # Errors
/// The pipe cannot be read; take that for a death.
pub fn is_abandoned(mut pipe: impl Read) -> io::Result<bool> {
    // A signal to the whole group must not take the guard before its time.
    for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM, signal_hook::consts::SIGHUP] {
        signal_hook::flag::register(signal, Arc::new(AtomicBool::new(false)))?;
    }
    let mut heard = Vec::new();
    pipe.read_to_end(&mut heard)?;
    Ok(!heard.contains(&RELEASE))
}
