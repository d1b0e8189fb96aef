//! May the telescope go there? Judged before the order: the target, every way to it, and the hour after it.

use super::limits;
use super::sunlight::{HOUR_S, SUN_DRIFT, Sunlight};
use super::sweep::{AxisAngles, Sweep};
use super::{Hazard, Mounting, Rules, Situation, Verdict};
use crate::sky::coords::{Equatorial, OfDate};
use crate::units::Angle;

/// No slew takes longer: half a turn at 0.3 degrees a second.
const SLEW_S: f64 = 600.0;

/// Two ways of computing one angle agree within this: 0.002 arcsecond.
const ROUNDING: Angle = Angle::radians(1e-8);

/// Closer to the zenith than this an alt-azimuth mount turns its azimuth 20 times faster than the sky.
const NEAR_ZENITH: Angle = Angle::degrees(3.0);

/// Judges a go-to before it is ordered.
///
/// Refused if the clock, the site or the position is unknown; if the target lies in the Sun's cone while the Sun counts
/// now or within the hour; if any way of the two axes passes the cone (both orders, both together, and both ways round,
/// since the mount chooses); if it leads outside the altitude limits; if it winds the cable too far. A way that only leads
/// out of the cone, or back inside the limits, is allowed.
#[must_use]
pub fn judge_goto(situation: &Situation, target: &Equatorial<OfDate>) -> Verdict {
    match judged(situation, target) {
        Ok(warnings) => Verdict::with(warnings),
        Err(hazard) => Verdict::Refused(hazard),
    }
}

fn judged(situation: &Situation, target: &Equatorial<OfDate>) -> Result<Vec<Hazard>, Hazard> {
    let utc = situation.clock.trusted()?;
    let site = situation.site.ok_or(Hazard::SiteUnknown)?;
    if !(target.ra().is_finite() && target.dec().is_finite()) {
        return Err(Hazard::TargetNotANumber);
    }
    let finite = |position: &Equatorial<OfDate>| position.ra().is_finite() && position.dec().is_finite();
    let here = situation.position.filter(finite).ok_or(Hazard::PositionUnknown)?;

    let rules = situation.rules.in_force(situation.acknowledged);
    let mounting = situation.mounting;
    let light = Sunlight::at(utc, &site);
    let from = mounting.axes(&here, &light, 0.0);
    let to = mounting.axes(target, &light, 0.0);
    let shorter = Sweep::shorter(&from, &to);

    // The Sun: at the target now and through the hour, then on the way.
    sun_at_target(target, &light, &rules)?;
    let mut warnings = Vec::new();
    warnings.extend(sun_on_path(&from, &to, &light, &rules, mounting)?);

    // The limits, on the shorter way: the longer one is watched while it happens.
    warnings.extend(limits::altitude(&shorter, &from, mounting, &light, &rules, Angle::ZERO)?);
    if mounting == Mounting::AltAzimuth {
        warnings.extend(limits::turns(&situation.turns, shorter.turn(), &rules)?);
        warnings.extend((!situation.turns.is_certain()).then_some(Hazard::TurnsUncertain));
    }
    warnings.extend(hour_of_tracking(target, &light, &rules, mounting));
    Ok(warnings)
}

/// The target keeps its distance from the Sun while it is tracked (within [`SUN_DRIFT`]), so the hour asks only whether the
/// Sun counts in it.
fn sun_at_target(target: &Equatorial<OfDate>, light: &Sunlight, rules: &Rules) -> Result<(), Hazard> {
    let (separation, cone) = (target.separation(light.sun()), rules.sun_cone());
    if separation >= cone + SUN_DRIFT {
        return Ok(());
    }
    match light.counts_within(HOUR_S, Angle::degrees(rules.sun_counts_above_deg)) {
        None => Ok(()),
        Some(0.0) => Err(Hazard::SunAtTarget { separation, cone }),
        Some(after_s) => Err(Hazard::SunRises { minutes: after_s / 60.0, separation, cone }),
    }
}

/// The way may not come closer to the Sun than the cone and its slack, unless one of its ends lies closer already: then no
/// closer than that end. The target has been judged before, so a closer end is where the telescope stands: it leaves.
fn sun_on_path(
    from: &AxisAngles,
    to: &AxisAngles,
    light: &Sunlight,
    rules: &Rules,
    mounting: Mounting,
) -> Result<Option<Hazard>, Hazard> {
    if light.counts_within(SLEW_S, Angle::degrees(rules.sun_counts_above_deg)).is_none() {
        return Ok(None);
    }
    let sun = mounting.axes(light.sun(), light, 0.0);
    let cone = rules.sun_cone();
    let keep = cone + Angle::degrees(rules.path_slack_deg);
    let (separation, least) = (from.separation(&sun), keep.min(to.separation(&sun)));
    let closest = Sweep::shorter(from, to).closest(&sun);
    if closest < least.min(separation) - ROUNDING {
        return Err(Hazard::SunOnPath { closest, keep, longer_way: false });
    }
    if separation < keep {
        // Staying is worse than leaving, and the longer way, should the mount take it, is stopped when it is seen.
        return Ok((separation < cone).then_some(Hazard::LeavingSun { separation, cone }));
    }
    let closest = Sweep::longer(from, to).closest(&sun);
    if rules.either_way_round && closest < least - ROUNDING {
        return Err(Hazard::SunOnPath { closest, keep, longer_way: true });
    }
    Ok(None)
}

/// What the observer should know of the hour after arrival.
fn hour_of_tracking(
    target: &Equatorial<OfDate>,
    light: &Sunlight,
    rules: &Rules,
    mounting: Mounting,
) -> impl Iterator<Item = Hazard> {
    let altitudes: Vec<(f64, Angle)> =
        light.looks(HOUR_S).map(|(after_s, horizon)| (after_s / 60.0, horizon.airless(target).altitude())).collect();
    let first = |outside: &dyn Fn(Angle) -> bool| {
        altitudes.iter().find(|(minutes, altitude)| *minutes > 0.0 && outside(*altitude)).map(|(minutes, _)| *minutes)
    };
    let (floor, ceiling) = (rules.altitude_floor(), rules.altitude_ceiling());
    let sets = first(&|altitude| altitude < floor).map(|minutes| Hazard::Sets { minutes, floor });
    let climbs = first(&|altitude| altitude > ceiling).map(|minutes| Hazard::Climbs { minutes, ceiling });
    let distance = altitudes.iter().map(|(_, altitude)| Angle::degrees(90.0) - *altitude).fold(NEAR_ZENITH, Angle::min);
    let zenith =
        (mounting == Mounting::AltAzimuth && distance < NEAR_ZENITH).then_some(Hazard::NearZenith { distance });
    sets.into_iter().chain(climbs).chain(zenith)
}
