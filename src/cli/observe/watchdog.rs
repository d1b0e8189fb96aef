//! The service manager (systemd), if there is one: it is told when the session is ready, and fed from the control loop only
//! while all of the session lives.

use std::time::Duration;

use sd_notify::NotifyState;

/// Who started us and wants to hear of us; nobody, mostly.
pub(super) struct Watchdog {
    /// The manager ends us after twice so long a silence.
    every: Option<Duration>,
    fed_at: Option<Duration>,
    told: String,
}

impl Watchdog {
    /// As the environment says (`WATCHDOG_USEC`, `NOTIFY_SOCKET`).
    pub(super) fn new() -> Watchdog {
        Watchdog { every: sd_notify::watchdog_enabled().map(|limit| limit / 2), fed_at: None, told: String::new() }
    }

    /// The session runs: the loop turns, the mount's line and the projector are in their threads.
    pub(super) fn ready(&mut self, now: Duration) {
        // Nobody to tell is the rule.
        let _ = sd_notify::notify(&[NotifyState::Ready]);
        self.fed_at = Some(now);
    }

    /// Called each time the loop turns. When something has died, silence: the manager then ends and starts us anew.
    pub(super) fn turned(&mut self, alive: bool, now: Duration) {
        let Some(every) = self.every else { return };
        if alive && self.fed_at.is_none_or(|at| now.saturating_sub(at) >= every) {
            self.fed_at = Some(now);
            let _ = sd_notify::notify(&[NotifyState::Watchdog]);
        }
    }

    /// When it wants to be fed again.
    pub(super) fn wake_at(&self) -> Option<Duration> {
        Some(self.fed_at? + self.every?)
    }

    /// One line for `systemctl status`, when it has changed.
    pub(super) fn status(&mut self, text: &str) {
        if self.told != text {
            self.told = text.to_owned();
            let _ = sd_notify::notify(&[NotifyState::Status(text)]);
        }
    }

    /// The session ends.
    pub(super) fn stopping(&self) {
        let _ = sd_notify::notify(&[NotifyState::Stopping]);
    }
}
