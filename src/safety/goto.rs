//! May the telescope go there?

use super::{Hazard, Situation, Verdict};
use crate::sky::coords::{Equatorial, OfDate};

/// Judges a go-to before it is ordered.
#[must_use]
pub fn judge_goto(situation: &Situation, target: &Equatorial<OfDate>) -> Verdict {
    match judged(situation, target) {
        Ok(warnings) => Verdict::with(warnings),
        Err(hazard) => Verdict::Refused(hazard),
    }
}

fn judged(situation: &Situation, target: &Equatorial<OfDate>) -> Result<Vec<Hazard>, Hazard> {
    let _utc = situation.clock.trusted()?;
    let _site = situation.site.ok_or(Hazard::SiteUnknown)?;
    if !(target.ra().is_finite() && target.dec().is_finite()) {
        return Err(Hazard::TargetNotANumber);
    }
    let _here = situation.position.ok_or(Hazard::PositionUnknown)?;
    Ok(Vec::new())
}
