//! May the telescope move there? The judgement stands in front of every order, and beside every motion that nobody ordered.
//!
//! Pure: a `Situation` goes in, a `Verdict` comes out. Nothing here moves or stops anything; the session does.
//!
//! ```text
//! situation (position, site, clock, turns, rules) + target -> verdict (allowed, warned, refused: why, and what to do)
//! ```
//!
//! `docs/safety.md` tells each rule to the observer.

/// Which clock to believe, and whether it can be believed at all.
pub mod clock;
/// What was found: each hazard with its numbers, its reason in words, and what to do.
pub mod hazard;
/// The rules and their limits, as the settings file has them.
pub mod rules;
/// All that a judgement needs to know.
pub mod situation;
/// Whether the machine slept: then nothing that was believed is still known.
pub mod suspend;
/// The turns of the azimuth axis, counted since the cable was last unwound.
pub mod turns;

mod axes;
mod goto;
mod limits;
mod motion;
mod sunlight;
mod sweep;

pub use clock::Clock;
pub use goto::judge_goto;
pub use hazard::{Hazard, Verdict};
pub use motion::judge_motion;
pub use rules::{Acknowledgement, Rules};
pub use situation::{Fix, Mounting, Situation};
pub use turns::TurnCounter;
