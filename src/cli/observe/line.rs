//! The line to the mount: a thread of its own that waits for bytes, or, under a virtual clock, stepped by the session.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

use super::clock::Clock;
use super::guard::Guarded;
use crate::hw::mount::driver::Ours;
use crate::hw::mount::link::{Pump, Update};
use crate::hw::mount::order::Order;

/// The thread looks for bytes at least so often.
const LOOK: Duration = Duration::from_millis(10);

/// What the session says to the mount.
pub(super) enum Word {
    /// An order.
    Order(Order),
    /// Forget all that is believed.
    Forget(Ours),
}

/// The line to the mount.
pub(super) enum Line {
    /// A thread turns the pump, and shows when it did last.
    Thread(Sender<Word>, Alive),
    /// The session turns it.
    Stepped(Box<Pump>),
}

impl Line {
    /// Turns the pump in a thread of its own; `told` is called with every update.
    ///
    /// # Errors
    /// The system has no more threads.
    pub(super) fn threaded(
        pump: Pump,
        clock: Clock,
        alive: Alive,
        told: impl FnMut(Said) -> bool + Send + 'static,
    ) -> std::io::Result<Line> {
        let (words, heard) = channel();
        let turned = Alive::default();
        turned.now(clock.now());
        let shows = turned.clone();
        thread::Builder::new().name("mount".into()).spawn(move || turn(pump, clock, (&alive, &shows), &heard, told))?;
        Ok(Line::Thread(words, turned))
    }

    /// Whether the thread turns. Opening a port may take it seconds.
    pub(super) fn alive(&self, now: Duration) -> bool {
        match self {
            Line::Thread(_, turned) => turned.within(Duration::from_secs(10), now),
            Line::Stepped(_) => true,
        }
    }

    /// Gives an order.
    pub(super) fn order(&mut self, order: Order, now: Duration) {
        match self {
            // A thread that has ended has told so: the session is ending.
            Line::Thread(words, _) => drop(words.send(Word::Order(order))),
            Line::Stepped(pump) => pump.order(order, now),
        }
    }

    /// Forgets all that is believed and asks anew.
    pub(super) fn forget(&mut self, ours: Ours, now: Duration) {
        match self {
            Line::Thread(words, _) => drop(words.send(Word::Forget(ours))),
            Line::Stepped(pump) => pump.forget(ours, now),
        }
    }
}

/// When a loop turned last. The session's life is what the supervisor must know of, not this thread's.
#[derive(Debug, Clone, Default)]
pub(super) struct Alive(Arc<AtomicU64>);

impl Alive {
    /// The loop has turned.
    pub(super) fn now(&self, now: Duration) {
        self.0.store(u64::try_from(now.as_millis()).unwrap_or(u64::MAX), Ordering::Relaxed);
    }

    /// Whether the loop turned within the last second.
    fn is(&self, now: Duration) -> bool {
        self.within(Duration::from_secs(1), now)
    }

    /// Whether it turned within so long.
    fn within(&self, patience: Duration, now: Duration) -> bool {
        now.saturating_sub(Duration::from_millis(self.0.load(Ordering::Relaxed))) < patience
    }
}

/// What the thread says to the session.
pub(super) enum Said {
    /// The mount told something.
    Update(Box<Update>),
    /// There is no supervisor, and why.
    Unguarded(String),
}

fn turn(
    mut pump: Pump,
    clock: Clock,
    (alive, turned): (&Alive, &Alive),
    heard: &Receiver<Word>,
    mut told: impl FnMut(Said) -> bool,
) {
    let mut guarded = Guarded::default();
    loop {
        let now = clock.now();
        turned.now(now);
        let update = pump.step(now);
        let unguarded = guarded.watch(&pump, alive.is(now), now);
        let said =
            update.map(|update| Said::Update(Box::new(update))).into_iter().chain(unguarded.map(Said::Unguarded));
        if !said.into_iter().all(&mut told) {
            break;
        }
        let wait = pump.wake_at().saturating_sub(clock.now()).clamp(Duration::from_millis(1), LOOK);
        match heard.recv_timeout(wait) {
            Ok(Word::Order(order)) => pump.order(order, clock.now()),
            Ok(Word::Forget(ours)) => pump.forget(ours, clock.now()),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => break,
        }
    }
    pump.farewell();
    guarded.leave();
}
