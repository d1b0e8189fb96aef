//! How far something is, on standard error: a bar in a terminal, a line for each tenth elsewhere.

use std::io::{IsTerminal, Write};

/// Letters of the bar.
const LENGTH: usize = 40;

/// The bar.
pub struct Bar {
    what: &'static str,
    terminal: bool,
    shown: Option<usize>,
}

impl Bar {
    /// A bar for something.
    #[must_use]
    pub fn new(what: &'static str) -> Bar {
        Bar { what, terminal: std::io::stderr().is_terminal(), shown: None }
    }

    /// Shows a share of 0 to 1, if it looks different from what was shown last.
    pub fn show(&mut self, share: f64) {
        let steps = if self.terminal { LENGTH } else { 10 };
        // A cast from float to integer saturates.
        let now = ((share * steps as f64) as usize).min(steps);
        if self.shown == Some(now) {
            return;
        }
        self.shown = Some(now);
        let percent = (share * 100.0).clamp(0.0, 100.0);
        let mut err = std::io::stderr().lock();
        // A terminal that does not take it is no reason to stop.
        let _ = if self.terminal {
            write!(err, "\r{:<LENGTH$} {percent:>3.0} % of {}", "#".repeat(now), self.what)
        } else {
            writeln!(err, "{percent:.0} % of {}", self.what)
        };
        let _ = err.flush();
    }

    /// Ends the line.
    pub fn end(self) {
        if self.terminal && self.shown.is_some() {
            let _ = writeln!(std::io::stderr());
        }
    }
}
