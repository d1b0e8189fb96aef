//! Raw mode and the alternate screen, given back on every way out: at the end, on an error, on a panic and on a signal.

use std::io::{self, BufWriter, Stdout, Write};
use std::sync::atomic::{AtomicBool, Ordering};

use ratatui::Terminal;
use ratatui::crossterm::terminal::{disable_raw_mode, enable_raw_mode, size};

use super::backend::{RedBackend, code};
use super::theme::{Depth, Level, Theme};

/// Whether the terminal is ours. The panic hook needs to know from any thread.
static TAKEN: AtomicBool = AtomicBool::new(false);

/// The terminal while it is ours. Dropping it gives the terminal back.
pub struct Taken {
    /// Where frames are drawn.
    pub terminal: Terminal<RedBackend<BufWriter<Stdout>>>,
}

impl Taken {
    /// Takes the terminal: raw mode, alternate screen, black, no cursor. Black is chosen before the screen is switched, so
    /// that a white terminal does not flash.
    ///
    /// # Errors
    /// There is no terminal, or it was closed.
    pub fn take(depth: Depth) -> io::Result<Taken> {
        install_panic_hook();
        enable_raw_mode()?;
        TAKEN.store(true, Ordering::SeqCst);
        let theme = Theme::new(depth, 1);
        let colours = format!("\x1b[{};{}m", code(theme.red(Level::Faint), 30), code(theme.black(), 40));
        let mut out = io::stdout();
        let written = write!(out, "\x1b[?25l{colours}\x1b[?1049h{colours}\x1b[2J\x1b[?25l").and_then(|()| out.flush());
        let terminal = written
            .and_then(|()| Terminal::new(RedBackend::new(BufWriter::with_capacity(1 << 16, io::stdout()), size)));
        match terminal {
            Ok(terminal) => Ok(Taken { terminal }),
            Err(error) => {
                give_back();
                Err(error)
            }
        }
    }
}

impl Drop for Taken {
    fn drop(&mut self) {
        give_back();
    }
}

/// Gives the terminal back as it was. May be called again, from any thread; only the first call does it. Errors are not
/// told: the terminal may be gone, and there is nobody else to tell.
pub fn give_back() {
    if TAKEN.swap(false, Ordering::SeqCst) {
        let mut out = io::stdout();
        // The screen is black when the old one returns; colours are reset after that, and the cursor comes last.
        let _ = out.write_all(b"\x1b[2J\x1b[?1049l\x1b[0m\x1b[?25h").and_then(|()| out.flush());
        let _ = disable_raw_mode();
    }
}

/// A panic gives the terminal back before it is told, so that it can be read.
fn install_panic_hook() {
    let tell = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        give_back();
        tell(panic);
    }));
}
