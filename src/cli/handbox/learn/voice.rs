//! Prompts in red on standard error, answers from standard input. The red stays on while an answer is typed, and is given back on
//! every way out.

use std::io::{self, BufRead, IsTerminal, Read, Write};
use std::os::unix::net::UnixStream;

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};

use crate::cli::{Failure, printable};

/// Red and nothing but red, on black.
const RED: &str = "\x1b[0;31;40m";
/// As the terminal was.
const GIVEN_BACK: &str = "\x1b[0m";

/// What speaks to the person at the telescope.
pub(super) struct Voice {
    red: bool,
}

impl Voice {
    /// Takes the terminal's colours, if there is a terminal.
    pub(super) fn new() -> Result<Voice, Failure> {
        let voice = Voice { red: io::stderr().is_terminal() };
        if voice.red {
            give_back_on_signals().map_err(Failure::failed)?;
            write(RED);
        }
        Ok(voice)
    }

    /// A line.
    pub(super) fn say(&self, text: &str) {
        write(&format!("{}\n", printable(text)));
    }

    /// A question; Enter and y are yes.
    pub(super) fn agrees(&self, question: &str) -> Result<bool, Failure> {
        write(&format!("{} [Y/n] ", printable(question)));
        let mut answer = String::new();
        let read = io::stdin().lock().take(1000).read_line(&mut answer).map_err(Failure::failed)?;
        if read == 0 {
            return Err(Failure::Failed("nobody answers any more: nothing was saved".into()));
        }
        Ok(matches!(answer.trim().to_lowercase().as_str(), "" | "y" | "yes"))
    }
}

impl Drop for Voice {
    fn drop(&mut self) {
        if self.red {
            write(GIVEN_BACK);
        }
    }
}

fn write(text: &str) {
    // Nothing can be done about a terminal that does not take it.
    let mut out = io::stderr().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

/// A signal ends the dialogue at once; nothing has been saved.
fn give_back_on_signals() -> io::Result<()> {
    let (mut heard, said) = UnixStream::pair()?;
    for signal in [SIGTERM, SIGINT, SIGHUP] {
        signal_hook::low_level::pipe::register(signal, said.try_clone()?)?;
    }
    std::thread::Builder::new().name("signals".into()).spawn(move || {
        if heard.read_exact(&mut [0]).is_ok() {
            write(&format!("{GIVEN_BACK}\nended: nothing was saved\n"));
            std::process::exit(1);
        }
    })?;
    Ok(())
}
