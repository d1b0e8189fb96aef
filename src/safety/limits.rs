//! Altitude limits and the turns of the azimuth axis, held against a sweep. Both know directions: what leads back inside is
//! allowed (a guard that only looked at the altitude has aborted every go-to of a mount that started below it).

use super::sunlight::Sunlight;
use super::sweep::{AxisAngles, Sweep};
use super::{Hazard, Mounting, Rules, TurnCounter};
use crate::units::Angle;

/// Smaller differences are rounding, or the last digit of the mount: one arcsecond.
const ROUNDING: Angle = Angle::arcseconds(1.0);

/// A sweep held against the floor and the ceiling; `grace` is how far beyond them it may lead. Gives a warning when the
/// telescope is outside and comes back.
pub(super) fn altitude(
    sweep: &Sweep,
    here: &AxisAngles,
    mounting: Mounting,
    light: &Sunlight,
    rules: &Rules,
    grace: Angle,
) -> Result<Option<Hazard>, Hazard> {
    let quarter = Angle::degrees(90.0);
    let (zenith, nadir) = (mounting.zenith(light), mounting.nadir(light));
    let altitude = quarter - here.separation(&zenith);
    let (lowest, highest) = (sweep.closest(&nadir) - quarter, quarter - sweep.closest(&zenith));
    let (floor, ceiling) = (rules.altitude_floor(), rules.altitude_ceiling());
    if lowest < (floor - grace).min(altitude) - ROUNDING {
        return Err(Hazard::TooLow { altitude: lowest, floor });
    }
    if highest > (ceiling + grace).max(altitude) + ROUNDING {
        return Err(Hazard::TooHigh { altitude: highest, ceiling });
    }
    let outside = altitude < floor - ROUNDING || altitude > ceiling + ROUNDING;
    Ok(outside.then_some(Hazard::Returning { altitude, floor, ceiling }))
}

/// A turn of the azimuth axis held against the count: refused beyond the limit, warned before it, free when unwinding.
pub(super) fn turns(turns: &TurnCounter, turn: Angle, rules: &Rules) -> Result<Option<Hazard>, Hazard> {
    let (turned, after) = (turns.turned(), turns.turned() + turn);
    let (warn, limit) = (Angle::degrees(rules.turns_warn_deg), Angle::degrees(rules.turns_refuse_deg));
    let winds = after.abs() > turned.abs() + ROUNDING;
    if winds && after.abs() >= limit {
        let back = Angle::degrees(if turn > Angle::ZERO { -360.0 } else { 360.0 });
        return Err(Hazard::Wound { turned, after, other_way: after + back, limit });
    }
    Ok((after.abs() >= warn).then_some(Hazard::WindingUp { after, limit }))
}
