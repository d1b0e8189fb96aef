//! Time for those who wait on a bus: now, and waiting. The real one, and a made-up one for tests.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// A clock that can be waited on.
pub trait Pace: Send {
    /// Time since some beginning. Never runs backwards.
    fn now(&self) -> Duration;
    /// Returns after that time.
    fn wait(&mut self, time: Duration);
}

/// This machine's time.
#[derive(Debug, Clone, Copy)]
pub struct Wall(Instant);

impl Wall {
    /// A clock that begins now.
    #[must_use]
    pub fn begun() -> Wall {
        Wall(Instant::now())
    }
}

impl Pace for Wall {
    fn now(&self) -> Duration {
        self.0.elapsed()
    }

    fn wait(&mut self, time: Duration) {
        std::thread::sleep(time);
    }
}

/// Made-up time: it passes only by waiting. Clones show the same time.
#[derive(Debug, Clone, Default)]
pub struct Made(Arc<AtomicU64>);

impl Made {
    /// Lets time pass.
    pub fn pass(&self, time: Duration) {
        self.0.fetch_add(u64::try_from(time.as_nanos()).unwrap_or(u64::MAX / 2), Ordering::Relaxed);
    }
}

impl Pace for Made {
    fn now(&self) -> Duration {
        Duration::from_nanos(self.0.load(Ordering::Relaxed))
    }

    fn wait(&mut self, time: Duration) {
        self.pass(time);
    }
}

/// A clock with the moment at which patience ends: handed to everything that may have to try again.
pub struct Within<'a> {
    pace: &'a mut dyn Pace,
    until: Duration,
}

impl<'a> Within<'a> {
    /// So much time from now.
    pub fn new(pace: &'a mut dyn Pace, time: Duration) -> Within<'a> {
        let until = pace.now() + time;
        Within { pace, until }
    }

    /// Whether the time is over.
    #[must_use]
    pub fn is_over(&self) -> bool {
        self.pace.now() >= self.until
    }

    /// Waits, but not beyond the end. False if the time is over.
    pub fn wait(&mut self, time: Duration) -> bool {
        let left = self.until.saturating_sub(self.pace.now());
        if !left.is_zero() {
            self.pace.wait(time.min(left));
        }
        !self.is_over()
    }

    /// The same patience less some time at its end, but at least half of what is left.
    pub fn sparing(&mut self, time: Duration) -> Within<'_> {
        let left = self.until.saturating_sub(self.pace.now());
        self.at_most(left.saturating_sub(time).max(left / 2))
    }

    /// A shorter patience inside this one.
    pub fn at_most(&mut self, time: Duration) -> Within<'_> {
        let until = self.until.min(self.pace.now() + time);
        Within { pace: &mut *self.pace, until }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn waiting_never_goes_beyond_the_end() {
        let mut made = Made::default();
        let clock = made.clone();
        let mut within = Within::new(&mut made, Duration::from_millis(10));
        assert!(within.wait(Duration::from_millis(4)));
        assert!(within.at_most(Duration::from_millis(3)).wait(Duration::from_millis(2)));
        assert!(!within.wait(Duration::from_secs(9)));
        assert_eq!(clock.now(), Duration::from_millis(10));
    }
}
