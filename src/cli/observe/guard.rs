//! The supervisor beside an open line: born when the line is opened, gone before it is opened anew.

use std::time::Duration;

use crate::hw::mount::link::Pump;
use crate::hw::supervisor::{Guard, Supervisor};

/// The supervisor hears of us so often.
const BEAT: Duration = Duration::from_millis(400);

/// The line's supervisor, if it has one.
#[derive(Default)]
pub(super) struct Guarded {
    guard: Option<Guard>,
    /// Whether starting one failed on this opening: it is not tried again, nor told again.
    given_up: bool,
    beaten_at: Duration,
    /// What it heard last.
    moving: bool,
}

impl Guarded {
    /// Starts, feeds or ends the supervisor, as the line needs. Gives the reason, once, why there is none.
    pub(super) fn watch(&mut self, pump: &Pump, alive: bool, now: Duration) -> Option<String> {
        if !pump.is_open() {
            self.leave();
            self.given_up = false;
            return None;
        }
        if self.guard.is_none() && !self.given_up {
            let line = pump.duplicate_line()?;
            match Supervisor::of_this_program().and_then(|supervisor| supervisor.guard(line)) {
                Ok(guard) => (self.guard, self.moving) = (Some(guard), false),
                Err(error) => {
                    self.given_up = true;
                    return Some(error.to_string());
                }
            }
        }
        let belief = pump.driver().belief();
        let moving = belief.slewing_by_order() || belief.moving_by_order || belief.stopping;
        // A motion that begins is told at once: the supervisor must know of it before anything can happen to us.
        if alive && (moving != self.moving || now.saturating_sub(self.beaten_at) >= BEAT) {
            (self.beaten_at, self.moving) = (now, moving);
            if let Some(guard) = &mut self.guard
                && let Err(error) = guard.beat(moving)
            {
                self.guard = None;
                return Some(error.to_string());
            }
        }
        None
    }

    /// Ends the supervisor: the session lives, or has stopped the mount itself.
    pub(super) fn leave(&mut self) {
        if let Some(guard) = self.guard.take() {
            guard.release();
        }
    }
}
