//! What the rays of a frame did.

/// What the rays of a frame did.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Work {
    /// Samples taken.
    pub samples: u64,
    /// Samples that the same rays would take with no dust passed over and no ray ended early.
    pub everything: u64,
    /// Rays through the box.
    pub rays: u64,
    /// Rays ended early.
    pub ended: u64,
    /// The largest share that still came through where a ray was ended.
    pub hidden: f32,
}

impl Work {
    pub(in super::super) fn with(self, other: Work) -> Work {
        Work {
            samples: self.samples + other.samples,
            everything: self.everything + other.everything,
            rays: self.rays + other.rays,
            ended: self.ended + other.ended,
            hidden: self.hidden.max(other.hidden),
        }
    }
}
