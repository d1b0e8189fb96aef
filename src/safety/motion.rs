//! Must the motion that is seen be stopped? Nobody asked before it began: the hand controller did it, or the sky did.

use super::{Fix, Situation, Verdict};

/// Judges the motion between the two latest positions: refused means stop it now and sound the alarm.
#[must_use]
pub fn judge_motion(situation: &Situation, before: &Fix, latest: &Fix) -> Verdict {
    let _ = (situation, before, latest);
    Verdict::Allowed
}
