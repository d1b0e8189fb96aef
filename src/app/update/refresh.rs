//! Where the telescope points, and whether the picture is drawn anew. Dark while the mount slews or its position is stale.

use crate::app::effect::Effect;
use crate::app::facts;
use crate::app::log::Weight;
use crate::app::model::{Here, Model, Projector};
use crate::app::scene::Scene;
use crate::overlay::style::Mode;
use crate::sky::catalogue::Catalogue;
use crate::sky::ephemeris::Almanac;
use crate::sky::horizon::Horizon;
use crate::sky::optics::Mounting;
use crate::sky::pointing::Motion;
use crate::sky::time::Moment;
use crate::units::{Angle, Magnitude};

/// A picture that was pushed onto its object is right to so much: the mount's right ascension comes in steps of 15 arcseconds.
const AFTER_NUDGE: Angle = Angle::arcseconds(15.0);

/// Stars fainter than this are not listed.
const FAINTEST: Magnitude = Magnitude(11.0);

/// Looks where the telescope points now and asks for a new picture when the eye could tell it from the one that is shown.
pub(super) fn refreshed(model: &mut Model) -> Vec<Effect> {
    let moment = model.moment();
    let pointing = model.belief.pointing(model.time.now).map(|mut pointing| {
        pointing.position = model.nudge.applied(&pointing.position);
        if model.nudged() {
            pointing.uncertainty = pointing.uncertainty.min(AFTER_NUDGE);
        }
        pointing
    });
    let horizon = moment.zip(model.site()).map(|(moment, site)| Horizon::at(&moment, &site));
    model.here = pointing.map(|pointing| Here {
        pointing,
        horizontal: horizon.as_ref().map(|horizon| horizon.airless(&pointing.position)),
    });
    if let Some(horizon) = &horizon {
        tell_of_turning(model, horizon);
    }
    match scene(model, moment, horizon.as_ref()) {
        Err(why) => darkened(model, why),
        Ok(scene) => {
            if model.drawn.as_ref().is_some_and(|drawn| !scene.differs(drawn)) {
                return Vec::new();
            }
            model.field = listed(&scene, &mut model.almanac);
            model.projector = Projector::Drawing;
            model.drawn = Some(scene.clone());
            vec![Effect::Draw(Box::new(scene))]
        }
    }
}

/// Near the zenith the field of an alt-azimuth mount turns faster than it can be followed: a degree in these many seconds is told.
const FAST_TURN_S: f64 = 10.0;

/// Says once, on coming so near to the zenith, that the picture's turn is not to be trusted there. It is drawn anew for every
/// change that the eye could tell, so it is never late; but an error of the pointing is there an error of the turn.
fn tell_of_turning(model: &mut Model, horizon: &Horizon) {
    let Some(here) = model.here.filter(|_| model.instrument.telescope.mounting == Mounting::AltAz) else { return };
    let fast = horizon.field_rotation(&here.pointing.position).to_degrees().abs() > FAST_TURN_S.recip();
    let tracking = here.pointing.motion == Motion::Tracking;
    if fast && tracking && !model.turning_told {
        let from_zenith = here.horizontal.map_or(0.0, |seen| 90.0 - seen.altitude().to_degrees());
        let turn = (here.pointing.uncertainty.to_degrees() / from_zenith.max(1e-6)).atan().to_degrees();
        let text = format!(
            "{from_zenith:.1}° from the zenith the field turns faster than 6° a minute, and the picture's turn is unsure by {turn:.0}°"
        );
        model.say(Weight::Note, &text, "wait until the object has passed the zenith");
    }
    if tracking {
        model.turning_told = fast;
    }
}

/// What is to be drawn, or why nothing is.
fn scene(model: &Model, moment: Option<Moment>, horizon: Option<&Horizon>) -> Result<Scene, &'static str> {
    let here = model.here.ok_or("no position yet")?;
    if here.pointing.stale {
        return Err("the position is too old");
    }
    if here.pointing.motion == Motion::Slewing || model.belief.slewing_by_order() {
        return Err("the telescope moves");
    }
    if model.overlay.mode == Mode::Off && model.menu.is_none() {
        return Err("switched off");
    }
    let moment = moment.ok_or("date and time are unknown")?;
    Ok(Scene {
        pointing: here.pointing,
        instrument: model.instrument.clone(),
        moment,
        site: model.site(),
        rotation: horizon.map_or(Angle::ZERO, |horizon| horizon.parallactic_angle(&here.pointing.position)),
        mode: model.overlay.mode,
        brightness: f32::from(model.overlay.brightness) / 10.0,
        tone: model.overlay.tone,
        target: model.target.clone(),
        photographs: model.overlay.photographs,
        facts: model.overlay.facts,
        animation: model.playing(),
        menu: model.menu.as_ref().map(|menu| menu.drawn(model)),
    })
}

fn darkened(model: &mut Model, why: &'static str) -> Vec<Effect> {
    if model.projector == Projector::Dark(why) {
        return Vec::new();
    }
    if model.overlay.mode != Mode::Off {
        model.field.clear();
    }
    let lit = !matches!(model.projector, Projector::Dark(_));
    model.projector = Projector::Dark(why);
    model.drawn = None;
    model.picture = None;
    model.eye.light = None;
    if lit { vec![Effect::Dark] } else { Vec::new() }
}

fn listed(scene: &Scene, almanac: &mut Almanac) -> Vec<facts::Listed> {
    let catalogue = Catalogue::embedded();
    let centre = crate::sky::astrometry::j2000(&scene.pointing.position, &scene.moment);
    let radius = scene.instrument.true_field() / 2.0;
    let mut found = catalogue.within(&centre, radius, FAINTEST);
    found.bodies = almanac.within(&scene.moment, scene.site.as_ref(), &centre, radius);
    // A planet at the edge has moons beyond it.
    for body in &mut found.bodies {
        body.moons.retain(|(_, position)| position.separation(&centre) <= radius);
    }
    facts::listed(&found, &centre, catalogue)
}
