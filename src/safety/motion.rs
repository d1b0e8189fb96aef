//! Must the motion that is seen be stopped? Nobody asked before it began: the hand controller did it, or the sky did.

use super::limits;
use super::sunlight::{BETWEEN_LOOKS, HOUR_S, SUN_DRIFT, Sunlight};
use super::sweep::{AxisAngles, Sweep};
use super::turns::FASTEST_DEG_PER_S;
use super::{Fix, Hazard, Mounting, Rules, Situation, Verdict};
use crate::sky::coords::{Equatorial, OfDate};
use crate::sky::pointing::Motion;
use crate::units::Angle;

/// Measured rates above this are a misread position: a quarter above the fastest slew.
const RATE_MOST_DEG_PER_S: f64 = FASTEST_DEG_PER_S * 1.25;

/// A turning axis slower than this does not show which way round the mount has chosen.
const CHOSEN_DEG_PER_S: f64 = 0.2;

/// With less than this left to its target an axis that turns away from it may only have overshot: near the zenith one step of
/// the mount's right ascension is minutes of azimuth.
const OVERSHOT: Angle = Angle::degrees(15.0);

/// Tracking may lead this far past a limit before it is an alarm: a target taken at the limit is none at once.
const TRACKING_GRACE: Angle = Angle::degrees(1.0);

/// A change of distance from the Sun that is more than the mount's last digit.
const NOTICED: Angle = Angle::arcseconds(10.0);

/// Judges the motion between the two latest positions; the situation's clock shows the time of `latest`. Refused means: stop
/// it now and sound the alarm.
///
/// A slew that nobody here ordered is followed through the reaction time at its measured rates; one that was ordered, to its
/// end. Tracking is followed through the hour, and so is a telescope that stands still while the sky moves past it.
#[must_use]
pub fn judge_motion(situation: &Situation, before: &Fix, latest: &Fix) -> Verdict {
    match judged(situation, before, latest) {
        Ok(warnings) => Verdict::with(warnings),
        Err(hazard) => Verdict::Refused(hazard),
    }
}

fn judged(situation: &Situation, before: &Fix, latest: &Fix) -> Result<Vec<Hazard>, Hazard> {
    // An order that has just gone out is a slew, though the mount may not be seen to move yet: the motion seen before it must
    // not stop the go-to that leads away.
    let motion = if situation.ordered.is_some() { Motion::Slewing } else { situation.motion };
    let situation = &Situation { motion, ..*situation };
    let (utc, site) = match (situation.clock.trusted(), situation.site) {
        (Ok(utc), Some(site)) => (utc, site),
        // It cannot be judged. The person at the hand controller can see the Sun: tell, and let them move.
        (Err(clock), _) => return Ok(unjudged(situation.motion, Hazard::Clock(clock))),
        (_, None) => return Ok(unjudged(situation.motion, Hazard::SiteUnknown)),
    };
    let rules = situation.rules.in_force(situation.acknowledged);
    let light = Sunlight::at(utc, &site);
    let here = situation.mounting.axes(&latest.position, &light, 0.0);
    let ahead = ahead(situation, before, latest, &light, &rules);

    let mut warnings = sun(situation, before, latest, &light, &rules, &ahead)?;
    if situation.motion != Motion::Stopped {
        let grace = if situation.motion == Motion::Tracking { TRACKING_GRACE } else { Angle::ZERO };
        warnings.extend(limits::altitude(&ahead, &here, situation.mounting, &light, &rules, grace)?);
        if situation.mounting == Mounting::AltAzimuth {
            warnings.extend(limits::turns(&situation.turns, ahead.turn(), &rules)?);
        }
    }
    Ok(warnings)
}

fn unjudged(motion: Motion, hazard: Hazard) -> Vec<Hazard> {
    if motion == Motion::Slewing { vec![hazard] } else { Vec::new() }
}

/// Where the axes may be before a stop takes hold: to the end of an ordered slew, else as far as the measured rates carry
/// them within the reaction time.
fn ahead(situation: &Situation, before: &Fix, latest: &Fix, light: &Sunlight, rules: &Rules) -> Sweep {
    let mounting = situation.mounting;
    let elapsed_s = latest.at.saturating_sub(before.at).as_secs_f64();
    let then = mounting.axes(&before.position, light, -elapsed_s);
    let now = mounting.axes(&latest.position, light, 0.0);
    let rate = |change: Angle| {
        let rate_deg_per_s = if elapsed_s > 0.0 { change.to_degrees() / elapsed_s } else { 0.0 };
        rate_deg_per_s.clamp(-RATE_MOST_DEG_PER_S, RATE_MOST_DEG_PER_S)
    };
    let turning = rate((now.turning - then.turning).wrapped_signed());
    let tilting = rate(now.tilting - then.tilting);
    let at_measured_rates = || {
        let quarter = Angle::degrees(90.0);
        let tilt = now.tilting + Angle::degrees(tilting * rules.reaction_s);
        Sweep::new(&now, Angle::degrees(turning * rules.reaction_s), tilt.min(quarter).max(-quarter))
    };
    match situation.ordered {
        Some(target) if situation.motion == Motion::Slewing => {
            to_its_end(&now, &mounting.axes(&target, light, 0.0), turning).unwrap_or_else(at_measured_rates)
        }
        _ => at_measured_rates(),
    }
}

/// The rest of an ordered slew, the way round that the mount has visibly chosen; `None` when that cannot be told.
fn to_its_end(now: &AxisAngles, target: &AxisAngles, turning_deg_per_s: f64) -> Option<Sweep> {
    let shorter = Sweep::shorter(now, target);
    let same_way = shorter.turn().to_degrees() * turning_deg_per_s >= 0.0;
    if same_way || turning_deg_per_s.abs() < CHOSEN_DEG_PER_S {
        Some(shorter)
    } else if shorter.turn().abs() < OVERSHOT {
        None
    } else {
        Some(Sweep::longer(now, target))
    }
}

/// The Sun, for a telescope that slews, tracks or stands.
fn sun(
    situation: &Situation,
    before: &Fix,
    latest: &Fix,
    light: &Sunlight,
    rules: &Rules,
    ahead: &Sweep,
) -> Result<Vec<Hazard>, Hazard> {
    let cone = rules.sun_cone();
    let separation = latest.position.separation(light.sun());
    let Some(counts_s) = light.counts_within(HOUR_S, Angle::degrees(rules.sun_counts_above_deg)) else {
        return Ok(Vec::new());
    };
    let counts_now = counts_s <= rules.reaction_s;
    match situation.motion {
        Motion::Slewing if counts_now => {
            let closest = ahead.closest(&situation.mounting.axes(light.sun(), light, 0.0));
            // An ordered slew that has not got going yet leaves already if its way only leads out.
            let grew = separation > before.position.separation(light.sun()) + NOTICED;
            let leaves = grew || (situation.ordered.is_some() && closest > separation - NOTICED);
            if separation < cone && leaves {
                Ok(vec![Hazard::LeavingSun { separation, cone }])
            } else if separation < cone {
                Err(Hazard::SunInField { separation, cone })
            } else if closest < cone {
                Err(Hazard::SunAhead { separation, closest, seconds: rules.reaction_s, cone })
            } else {
                Ok(Vec::new())
            }
        }
        Motion::Slewing => Ok(Vec::new()),
        Motion::Tracking if separation < cone && counts_now => Err(Hazard::SunInField { separation, cone }),
        Motion::Tracking if separation < cone + SUN_DRIFT => {
            Ok(vec![Hazard::SunRises { minutes: counts_s / 60.0, separation, cone }])
        }
        Motion::Tracking => Ok(Vec::new()),
        Motion::Stopped if separation < cone && counts_now => Err(Hazard::SunInField { separation, cone }),
        Motion::Stopped => Ok(drifts_in(&latest.position, light, rules).into_iter().collect()),
    }
}

/// When the Sun comes to a telescope that stands still, within the hour.
fn drifts_in(position: &Equatorial<OfDate>, light: &Sunlight, rules: &Rules) -> Option<Hazard> {
    let (cone, above) = (rules.sun_cone(), Angle::degrees(rules.sun_counts_above_deg));
    let tube = light.seen(position, 0.0);
    light
        .looks(HOUR_S)
        .find(|(_, horizon)| {
            let sun = horizon.airless(light.sun());
            sun.altitude() + BETWEEN_LOOKS > above && sun.separation(&tube) < cone + BETWEEN_LOOKS
        })
        .map(|(after_s, _)| Hazard::SunDriftsIn { minutes: after_s / 60.0, cone })
}
