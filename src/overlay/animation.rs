//! Moving pictures of an object: what can be played, and which frame is due.

use std::time::Duration;

/// An animation that can be played.
#[derive(Debug, Clone, PartialEq)]
pub struct Playable {
    /// The object's name as the catalogue has it.
    pub object: String,
    /// How many frames it has.
    pub frames: usize,
    /// How fast they follow each other.
    pub frames_per_second: f64,
}

impl Playable {
    /// The frame that is due after it has been played for so long; round and round.
    #[must_use]
    pub fn frame_at(&self, played: Duration) -> usize {
        let frame = (played.as_secs_f64() * self.frames_per_second).floor().max(0.0);
        (frame as u64 % self.frames.max(1) as u64) as usize
    }

    /// How long the frame that is due is still seen.
    #[must_use]
    pub fn until_next(&self, played: Duration) -> Duration {
        let frames = played.as_secs_f64() * self.frames_per_second;
        let rest = (frames.floor() + 1.0 - frames) / self.frames_per_second;
        Duration::try_from_secs_f64(rest.max(1e-3)).unwrap_or(Duration::from_secs(1))
    }
}
