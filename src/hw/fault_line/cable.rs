//! What outlives a port: the cable, its spells, what they have done, and under which name it can be opened.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::FaultLine;
use super::mischief::{MENU, Mischief, Side, Spell, When};
use crate::hw::port::{Port, PortError};
use crate::numerics::streams::Stream;

/// A cable with a will of its own. Its ports are opened one after the other; clones are the same cable.
#[derive(Debug, Clone)]
pub struct Cable(Arc<Mutex<Inside>>);

#[derive(Debug)]
struct Inside {
    spells: Vec<(Spell, Option<Duration>)>,
    random: Stream,
    baud: Option<u32>,
    now: Duration,
    ledger: Ledger,
}

/// What a cable has done.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Ledger {
    /// How often each of [`MENU`] struck.
    pub struck: [u64; MENU.len()],
    /// When a byte was last changed into another that may have a meaning of its own, which no reader can notice.
    pub altered: Option<Duration>,
    /// How often a port was opened.
    pub opened: u64,
}

/// A mischief under way: what, which way, since when.
pub(super) type Active = (Mischief, Side, Duration);

impl Cable {
    /// A cable with these spells. `baud` paces the bytes (10 bits each) both ways; `None` where the far end does that itself.
    #[must_use]
    pub fn new(seed: u64, baud: Option<u32>, spells: Vec<Spell>) -> Cable {
        let spells = spells
            .into_iter()
            .map(|spell| {
                let begins = if let When::At(at) = spell.when { Some(at) } else { None };
                (spell, begins)
            })
            .collect();
        let random = Stream::seeded(seed ^ 0x6361_626c_6500);
        let ledger = Ledger::default();
        Cable(Arc::new(Mutex::new(Inside { spells, random, baud, now: Duration::ZERO, ledger })))
    }

    /// Opens a line through the cable. `open` gets the number of the name under which the port now is: 0, and one more after
    /// each [`Mischief::Rename`].
    ///
    /// # Errors
    /// The cable is out, or the port not to be had; what `open` says.
    pub fn open<P: Port>(&self, open: impl FnOnce(u32) -> Result<P, PortError>) -> Result<FaultLine<P>, PortError> {
        let (now, number) = {
            let inside = self.lock();
            let number = inside.number();
            if let Some((mischief, ..)) = inside.active().into_iter().find(|(m, ..)| m.takes_the_port()) {
                let name = format!("the cable's port {number}");
                return Err(match mischief {
                    Mischief::Forbid => PortError::Permission { name },
                    Mischief::Hold => PortError::Held { name },
                    _ => PortError::NotThere { name },
                });
            }
            (inside.now, number)
        };
        let port = open(number)?;
        self.lock().ledger.opened += 1;
        Ok(FaultLine::new(self.clone(), port, now))
    }

    /// Says what time it is; open lines do that too.
    pub fn set_now(&self, now: Duration) {
        let mut inside = self.lock();
        inside.now = inside.now.max(now);
    }

    /// What it has done so far.
    #[must_use]
    pub fn ledger(&self) -> Ledger {
        self.lock().ledger.clone()
    }

    /// Whether the port cannot be opened now.
    #[must_use]
    pub fn is_out(&self) -> bool {
        self.active().iter().any(|(mischief, ..)| mischief.takes_the_port())
    }

    /// When the last of its spells is over; `None` while one waits for its moment.
    #[must_use]
    pub fn calm_from(&self) -> Option<Duration> {
        let inside = self.lock();
        inside
            .spells
            .iter()
            .map(|(spell, begins)| begins.map(|at| at + spell.lasts))
            .try_fold(Duration::ZERO, |a, b| b.map(|b| a.max(b)))
    }

    /// Lets every spell that still waits for its moment go.
    pub fn relent(&self) {
        self.lock().spells.retain(|(_, begins)| begins.is_some());
    }

    pub(super) fn baud(&self) -> Option<u32> {
        self.lock().baud
    }

    /// What is under way now.
    pub(super) fn active(&self) -> Vec<Active> {
        self.lock().active()
    }

    /// Whether a spell begins because `sent` has just gone out, or so many bytes of a reply have come.
    pub(super) fn provoked(&self, sent: &[u8], read: usize) -> bool {
        let mut inside = self.lock();
        let now = inside.now;
        let mut provoked = false;
        for (spell, begins) in inside.spells.iter_mut().filter(|(_, begins)| begins.is_none()) {
            let strikes = match &spell.when {
                When::At(_) => false,
                When::Sent(from, ending) => now >= *from && !sent.is_empty() && sent.ends_with(ending),
                When::Read(from, bytes) => now >= *from && read >= *bytes && read > 0,
            };
            if strikes {
                *begins = Some(now);
                provoked |= spell.mischief.takes_the_port();
            }
        }
        provoked
    }

    pub(super) fn strike(&self, mischief: Mischief) {
        self.lock().ledger.struck[mischief.index()] += 1;
    }

    pub(super) fn altered(&self, at: Duration) {
        self.lock().ledger.altered = Some(at);
    }

    pub(super) fn chance(&self, probability: f64) -> bool {
        self.lock().random.chance(probability)
    }

    pub(super) fn byte(&self) -> u8 {
        self.lock().random.byte()
    }

    fn lock(&self) -> MutexGuard<'_, Inside> {
        // Whoever panicked with the lock in hand has left a cable that is as good as any.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Inside {
    fn active(&self) -> Vec<Active> {
        let holds = |begins: Duration, lasts: Duration| begins <= self.now && self.now < begins + lasts;
        self.spells
            .iter()
            .filter_map(|(spell, begins)| {
                begins.filter(|at| holds(*at, spell.lasts)).map(|at| (spell.mischief, spell.side, at))
            })
            .collect()
    }

    fn number(&self) -> u32 {
        let renamed = self.spells.iter().filter(|(spell, begins)| {
            spell.mischief == Mischief::Rename && begins.is_some_and(|at| at + spell.lasts <= self.now)
        });
        u32::try_from(renamed.count()).unwrap_or(u32::MAX)
    }
}
