//! Clocks: the machine's, or one that runs as fast as the machine can.

use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use crate::safety::suspend::Clocks;
use crate::sky::time::Utc;

/// What time it is.
#[derive(Debug, Clone, Copy)]
pub(super) enum Clock {
    /// The machine's clocks; the wall clock shifted so that the session begins when it was told to.
    Real {
        /// The program's start.
        start: Instant,
        /// Seconds added to the wall clock.
        shift_s: f64,
    },
    /// A clock that is set by the session.
    Virtual {
        /// Since the session began.
        now: Duration,
        /// Wall clock at the beginning.
        wall: Duration,
    },
}

impl Clock {
    /// The machine's clocks, the wall clock beginning at `begin` if that is given.
    pub(super) fn real(begin: Option<Utc>) -> Clock {
        let shift_s = begin.map_or(0.0, |begin| begin.0 - wall().as_secs_f64());
        Clock::Real { start: Instant::now(), shift_s }
    }

    /// A clock that stands still until it is set.
    pub(super) fn made(begin: Option<Utc>) -> Clock {
        let wall = begin.map_or_else(wall, |begin| Duration::try_from_secs_f64(begin.0).unwrap_or_default());
        Clock::Virtual { now: Duration::ZERO, wall }
    }

    /// Whether time passes only when it is told to.
    pub(super) fn is_virtual(&self) -> bool {
        matches!(self, Clock::Virtual { .. })
    }

    /// The program's start on the machine's clock.
    pub(super) fn start(&self) -> Instant {
        match self {
            Clock::Real { start, .. } => *start,
            Clock::Virtual { .. } => Instant::now(),
        }
    }

    /// Since the program started.
    pub(super) fn now(&self) -> Duration {
        match self {
            Clock::Real { start, .. } => start.elapsed(),
            Clock::Virtual { now, .. } => *now,
        }
    }

    /// All clocks, read together.
    pub(super) fn read(&self) -> Clocks {
        match self {
            Clock::Real { shift_s, .. } => {
                let wall = (wall().as_secs_f64() + shift_s).max(0.0);
                Clocks {
                    wall: Duration::try_from_secs_f64(wall).unwrap_or_default(),
                    awake: self.now(),
                    always: boot_time(),
                }
            }
            Clock::Virtual { now, wall } => Clocks { wall: *wall + *now, awake: *now, always: Some(*now) },
        }
    }

    /// UTC when [`Clock::now`] was zero.
    pub(super) fn utc_at_start(&self) -> Utc {
        let clocks = self.read();
        Utc(clocks.wall.as_secs_f64() - clocks.awake.as_secs_f64())
    }

    /// Lets virtual time pass; real time passes by itself.
    pub(super) fn advance(&mut self, by: Duration) {
        if let Clock::Virtual { now, .. } = self {
            *now += by;
        }
    }
}

fn wall() -> Duration {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default()
}

/// `CLOCK_BOOTTIME`, which goes on while the machine sleeps.
fn boot_time() -> Option<Duration> {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::Boottime);
    Some(Duration::new(u64::try_from(time.tv_sec).ok()?, u32::try_from(time.tv_nsec).ok()?))
}
