//! Time, and the lack of it: after a suspend or a standstill everything believed is forgotten and the projector is dark.

use std::time::Duration;

use crate::app::effect::Effect;
use crate::app::log::Weight;
use crate::app::model::{Model, Projector};
use crate::hw::mount::belief::{Belief, Source};
use crate::safety::Clock;
use crate::safety::suspend::{Clocks, Gap, between};
use crate::sky::time::Utc;

/// The session looks at its clocks several times a second. A longer pause means that the program was stopped or starved.
const STANDSTILL: Duration = Duration::from_secs(5);

/// The clocks were read.
pub(super) fn passed(model: &mut Model, clocks: Clocks) -> Vec<Effect> {
    let before = model.time.clocks.replace(clocks);
    model.time.now = clocks.awake;
    model.time.ours = Some(Utc(clocks.wall.as_secs_f64()));
    choose_clock(model);
    if model.menu.as_ref().is_some_and(|menu| menu.until <= clocks.awake) {
        model.menu = None;
    }
    let Some(before) = before else { return Vec::new() };
    model.eye.pass(clocks.awake.saturating_sub(before.awake));
    // An animation stands still while nothing is drawn: the mount moves.
    if model.drawn.is_some() && model.playing().is_some() {
        model.played += clocks.awake.saturating_sub(before.awake);
    }
    match between(&before, &clocks) {
        Gap::Suspended { slept } => forget(model, &format!("the computer slept for {:.0} s", slept.as_secs_f64())),
        _ if clocks.awake.saturating_sub(before.awake) >= STANDSTILL => {
            let stood = clocks.awake.saturating_sub(before.awake).as_secs_f64();
            forget(model, &format!("the program stood still for {stood:.0} s"))
        }
        Gap::ClockSet { by_s } => {
            model.say(Weight::Warning, &format!("this computer's clock was set by {by_s:+.0} s"), "");
            vec![Effect::Order(crate::hw::mount::order::Order::Compare)]
        }
        Gap::Nothing => Vec::new(),
    }
}

/// The mount's clock unless it is unknown or disagrees, else ours.
pub(super) fn choose_clock(model: &mut Model) {
    let Some(ours) = model.time.ours else { return };
    let ahead = match &model.belief.decision {
        Some(decision) if decision.clock == Source::Mount => decision.clock_ahead_s,
        _ => 0.0,
    };
    let utc = ours.plus_seconds(ahead);
    model.time.used = if model.opening.time_stated { Clock::Stated(utc) } else { Clock::Measured(utc) };
}

/// Nothing that was believed is still known.
fn forget(model: &mut Model, why: &str) -> Vec<Effect> {
    model.counts.gaps += 1;
    model.belief = Belief { counters: model.belief.counters, ..Belief::default() };
    model.fix = None;
    model.here = None;
    model.turns.lose_sight();
    model.drawn = None;
    model.picture = None;
    model.eye.light = None;
    model.field.clear();
    model.projector = Projector::Dark("everything is being asked anew");
    model.say(
        Weight::Warning,
        why,
        "nothing is believed of the mount until it has been asked again; look where the tube points",
    );
    vec![Effect::Dark, Effect::Forget]
}
