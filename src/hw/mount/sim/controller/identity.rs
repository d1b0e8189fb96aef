//! Who the mount is, and in which state.

use super::Controller;
use super::power::Power;
use crate::hw::mount::sim::answer::Answer;

impl Controller {
    /// ACK: one letter, no `#`.
    pub(super) fn ack(&self) -> Answer {
        match self.power {
            Power::Awake | Power::Parking | Power::Asking => Answer::bytes([self.mounting]),
            Power::Parked if !self.faults.park_silence => Answer::bytes([self.mounting]),
            Power::Downloader => Answer::bytes(*b"D"),
            _ => Answer::silent(),
        }
    }

    /// `:GV.#` and `:GW#`.
    pub(super) fn identity(&self, body: &[u8]) -> Option<Answer> {
        if body == b"GW" {
            let tracking = if self.tube.tracking() { b'T' } else { b'N' };
            return Some(Answer::bytes([self.mounting, tracking, self.aligned]));
        }
        if body.len() != 3 || !body.starts_with(b"GV") {
            return None;
        }
        let product = self.faults.product.as_deref().unwrap_or("LX2001");
        if product == "none" {
            return Some(Answer::silent());
        }
        let product = self.name(product);
        match body[2] {
            b'P' => Some(Answer::text(&product)),
            b'N' => Some(Answer::text("4.2l")),
            b'D' => Some(Answer::text("Oct 05 2010")),
            b'T' => Some(Answer::text("14:25:33")),
            b'F' => Some(Answer::text(&format!("{product}|A|4.2l|Oct 05 2010@14:25:33"))),
            _ => None,
        }
    }

    /// A name as it is told: the fault `escapes` puts terminal escapes into it.
    pub(super) fn name(&self, name: &str) -> String {
        if self.faults.escapes { format!("\x1b]0;{name}\x07\x1b[2J\x1b[32m{name}\u{9b}31m") } else { name.to_owned() }
    }
}
