//! What the mount tells: beliefs, reports, and motion that nobody ordered, which is judged as well.

use super::{goto, time};
use crate::app::effect::Effect;
use crate::app::log::Weight;
use crate::app::model::Model;
use crate::hw::mount::belief::{Belief, Known, LinkState};
use crate::hw::mount::order::{Order, Report};
use crate::safety::{Fix, Verdict, judge_motion};
use crate::sky::horizon;

/// The mount told something.
pub(super) fn told(model: &mut Model, belief: Belief, reports: Vec<Report>) -> Vec<Effect> {
    let was = std::mem::replace(&mut model.belief, belief);
    time::choose_clock(model);
    if was.link == LinkState::Ready && model.belief.link != LinkState::Ready {
        model.turns.lose_sight();
        model.fix = None;
    }
    let mut effects = Vec::new();
    for report in reports {
        match report {
            Report::Position => effects.extend(position(model)),
            Report::Synced { .. } => {
                model.nudge = Default::default();
                model.note(report.to_string());
                effects.push(Effect::Keep(model.turns, model.nudge));
            }
            other => heard(model, &other),
        }
    }
    effects
}

/// A new position was believed: the turns are counted and the motion is judged.
fn position(model: &mut Model) -> Vec<Effect> {
    let Known::Confirmed { value: position, at } = model.belief.position else { return Vec::new() };
    let latest = Fix { at, position };
    if let (Some(moment), Some(site)) = (model.moment(), model.site()) {
        let before = model.turns.turned().to_degrees();
        model.turns.observe(horizon::airless(&position, &moment, &site).azimuth(), at);
        let keep = (model.turns.turned().to_degrees() / 30.0).floor() != (before / 30.0).floor();
        let mut effects = if keep { vec![Effect::Keep(model.turns, model.nudge)] } else { Vec::new() };
        if let Some(before) = model.fix.replace(latest) {
            effects.extend(judged(model, &before, &latest));
        }
        return effects;
    }
    model.fix = Some(latest);
    Vec::new()
}

/// Motion is judged whoever ordered it; what is refused is stopped, and stopped again until it is.
fn judged(model: &mut Model, before: &Fix, latest: &Fix) -> Vec<Effect> {
    match judge_motion(&goto::situation(model), before, latest) {
        Verdict::Refused(hazard) => {
            model.say(Weight::Alarm, &format!("STOPPED: {hazard}"), &hazard.advice());
            if model.belief.stopping {
                return Vec::new();
            }
            model.counts.stopped += 1;
            vec![Effect::Order(Order::Stop)]
        }
        Verdict::Warned(hazards) => {
            for hazard in hazards {
                let fresh = model.banner.as_ref().is_none_or(|banner| banner.weight == Weight::Note);
                if fresh {
                    model.say(Weight::Warning, &hazard.to_string(), &hazard.advice());
                }
            }
            Vec::new()
        }
        Verdict::Allowed => Vec::new(),
    }
}

/// Every report is told in words; some are told at the top.
fn heard(model: &mut Model, report: &Report) {
    let text = report.to_string();
    match report {
        Report::StopNotObeyed { .. } => model.say(Weight::Alarm, &text, ""),
        Report::Lost(_) | Report::GotoRefused { .. } | Report::GotoFailed { .. } | Report::OrderFailed { .. } => {
            model.say(Weight::Warning, &text, "");
        }
        Report::EndedShort { .. } | Report::Disagreement(_) => model.say(Weight::Warning, &text, ""),
        Report::StillLost { .. } | Report::Fault(_) | Report::BusyNak { .. } | Report::Resynchronised => {
            let utc = model.utc();
            model.log.add(utc, Weight::Warning, text);
        }
        Report::Connected { .. } => {
            if model.banner.is_some() {
                model.say(Weight::Note, &text, "");
            } else {
                model.note(text);
            }
        }
        // Read several times a second where its keys are watched.
        Report::Display => {}
        _ => model.note(text),
    }
}
