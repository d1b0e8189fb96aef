//! What can go wrong with a controller and its bus. Transactions are counted from 1.

use serde::{Deserialize, Serialize};

/// The faults of a made-up controller. The default is none.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Faults {
    /// It answers with this identity instead of its own.
    pub id: Option<u8>,
    /// After each power-up so many transactions are not acknowledged.
    pub silent_at_start: u32,
    /// Then so many status reads say "not yet initialised".
    pub starting_reads: u32,
    /// Each compound command keeps it busy for so many polls.
    pub busy_polls: u32,
    /// A compound command never ends.
    pub busy_for_ever: bool,
    /// LED current codes above this one are clamped without a word.
    pub clamp: Option<u16>,
    /// The LED enable register stays as it is, whatever is written.
    pub enable_sticks: bool,
    /// These transactions are not acknowledged.
    pub silent: Vec<u64>,
    /// From this transaction on nothing is acknowledged.
    pub silent_from: Option<u64>,
    /// These reads bring only half of their bytes.
    pub short: Vec<u64>,
    /// In each of these transactions one bit is wrong.
    pub flipped: Vec<u64>,
    /// These transactions lose the bus.
    pub lost: Vec<u64>,
    /// The bus is held low from this transaction on ...
    pub stuck_from: Option<u64>,
    /// ... for so many transactions; none is for ever.
    pub stuck_for: Option<u64>,
    /// At this transaction the module resets itself: LEDs off, registers as after power-up.
    pub reset_at: Option<u64>,
    /// From this transaction on the bus is gone.
    pub gone_at: Option<u64>,
}

impl Faults {
    pub(super) fn is_silent(&self, transaction: u64) -> bool {
        self.silent.contains(&transaction) || self.silent_from.is_some_and(|from| transaction >= from)
    }

    pub(super) fn is_short(&self, transaction: u64) -> bool {
        self.short.contains(&transaction)
    }

    pub(super) fn loses(&self, transaction: u64) -> bool {
        self.lost.contains(&transaction)
    }

    pub(super) fn is_stuck(&self, transaction: u64) -> bool {
        self.stuck_from.is_some_and(|from| {
            transaction >= from && self.stuck_for.is_none_or(|length| transaction < from.saturating_add(length))
        })
    }

    /// Makes one bit wrong, if this transaction is one of those. Which bit depends on the transaction alone.
    pub(super) fn flip(&self, transaction: u64, bytes: &mut [u8]) {
        if !bytes.is_empty() && self.flipped.contains(&transaction) {
            // Fibonacci hashing (Knuth, The Art of Computer Programming 3, 6.4): spreads neighbours over all bits.
            let bit = (transaction.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 32) as usize % (bytes.len() * 8);
            bytes[bit / 8] ^= 1 << (bit % 8);
        }
    }
}
