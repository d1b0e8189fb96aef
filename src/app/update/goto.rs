//! Go-to, sync and stop. No go-to leaves here unjudged.

use crate::app::effect::Effect;
use crate::app::log::Weight;
use crate::app::model::{Model, Screen};
use crate::hw::mount::belief::{LinkState, Mounting as Stand};
use crate::hw::mount::order::Order;
use crate::safety::{self, Mounting, Situation, Verdict};
use crate::sky::pointing::Motion;
use crate::units::Angle;

/// A sync further than this from where the mount says it points is a mistake sooner than a bad alignment.
const SYNC_REACH: Angle = Angle::degrees(10.0);

/// All that a judgement needs to know. Safety judges the tube, so the nudge is left out.
pub(super) fn situation(model: &Model) -> Situation {
    let pointing = model.belief.pointing(model.time.now).filter(|pointing| !pointing.stale);
    Situation {
        position: pointing.map(|pointing| pointing.position),
        motion: model.belief.motion.value().copied().unwrap_or(Motion::Slewing),
        ordered: model.belief.slewing_to,
        site: model.site(),
        clock: model.time.used,
        mounting: match model.belief.alignment.value().map(|alignment| alignment.mounting) {
            Some(Stand::Polar | Stand::German) => Mounting::Equatorial,
            _ => Mounting::AltAzimuth,
        },
        turns: model.turns,
        rules: model.opening.rules,
        acknowledged: model.acknowledged,
    }
}

/// Go to the target.
pub(super) fn go(model: &mut Model) -> Vec<Effect> {
    let Some(name) = model.target.as_ref().map(|target| target.name.clone()) else {
        model.say(Weight::Note, "there is no target", "press / and type a name");
        return Vec::new();
    };
    if model.belief.link != LinkState::Ready {
        model.counts.refused += 1;
        model.say(Weight::Warning, "the mount does not answer, so it cannot be sent anywhere", "see its screen (m)");
        return Vec::new();
    }
    let Some(place) = model.target_of_date() else {
        model.counts.refused += 1;
        let hazard = safety::Hazard::from(safety::clock::ClockError::Unknown);
        model.say(Weight::Warning, &format!("not going to {name}: {hazard}"), &hazard.advice());
        return Vec::new();
    };
    match safety::judge_goto(&situation(model), &place) {
        Verdict::Refused(hazard) => {
            model.counts.refused += 1;
            model.say(Weight::Warning, &format!("not going to {name}: {hazard}"), &hazard.advice());
            return Vec::new();
        }
        Verdict::Warned(hazards) => {
            for hazard in &hazards {
                model.say(Weight::Warning, &format!("going to {name}, but {hazard}"), &hazard.advice());
            }
        }
        Verdict::Allowed => {
            model.banner = None;
            model.note(format!("going to {name}"));
        }
    }
    model.view.screen = Screen::Sky;
    vec![Effect::Order(Order::Goto(place))]
}

/// Tell the mount where it points: where the picture was pushed to, else at the target.
pub(super) fn sync(model: &mut Model) -> Vec<Effect> {
    let Some(reported) = model.belief.pointing(model.time.now).filter(|pointing| pointing.may_draw()) else {
        model.say(Weight::Warning, "no sync while the mount moves or is silent", "wait until it stands on the object");
        return Vec::new();
    };
    let place = if model.nudged() { Some(model.nudge.applied(&reported.position)) } else { model.target_of_date() };
    let Some(place) = place else {
        model.say(
            Weight::Note,
            "nothing to sync on",
            "choose a target (/) and centre it, or push the picture onto the object",
        );
        return Vec::new();
    };
    let off = place.separation(&reported.position);
    if off > SYNC_REACH {
        let text =
            format!("the target is {:.0}° from where the mount says it points: not synchronised", off.to_degrees());
        model.say(Weight::Warning, &text, "align the mount anew, or choose the object that is in the eyepiece");
        return Vec::new();
    }
    vec![Effect::Order(Order::Sync(place))]
}

/// Stop, whatever is under way, without a question.
pub(super) fn stop(model: &mut Model) -> Vec<Effect> {
    model.note("stop");
    vec![Effect::Order(Order::Stop)]
}

/// The end: what moves by our order is stopped first.
pub(super) fn quit(model: &mut Model) -> Vec<Effect> {
    let moving = model.belief.slewing_by_order() || model.belief.moving_by_order;
    let mut effects = vec![Effect::Dark];
    if moving {
        effects.extend(stop(model));
    }
    effects.push(Effect::Keep(model.turns, model.nudge));
    effects.push(Effect::Quit);
    effects
}
