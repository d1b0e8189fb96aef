//! Everything that is opened before the session begins: settings, site, time, mount, projector, instrument.

use std::path::PathBuf;

use super::Arguments;
use super::clock::Clock;
use super::handbox::{self, Handbox};
use super::projection::Projection;
use super::record::{self, Complaint};
use crate::app::adapting::Observer;
use crate::app::model::Opening;
use crate::cli::photographs::album::{Album, Sources};
use crate::cli::projector::light;
use crate::cli::settings::Settings;
use crate::cli::settings::disk::Files;
use crate::cli::settings::state::{self, State};
use crate::cli::{Failure, animations, coordinates, overlay, photographs};
use crate::hw::mount::address::MountAddress;
use crate::hw::mount::driver::{self, Ours};
use crate::hw::mount::link::{self, Opener, Pump};
use crate::hw::mount::sim::Simulator;
use crate::hw::mount::sim::port::SimulatedMount;
use crate::hw::mount::sim::settings::Settings as Simulated;
use crate::hw::port::{Port, PortError};
use crate::hw::projector;
use crate::overlay::style::Eye;
use crate::sky::field::Nudge;
use crate::sky::site::Site;
use crate::sky::sun;
use crate::sky::time::Utc;
use crate::units::SurfaceBrightness;

/// What the session needs.
pub(super) struct Opened {
    pub(super) opening: Opening,
    pub(super) clock: Clock,
    pub(super) ours: Ours,
    pub(super) pump: Pump,
    pub(super) projection: Projection,
    /// Where turns and nudge are kept over restarts; nowhere for a simulated telescope, which begins anew.
    pub(super) state_path: Option<PathBuf>,
    /// The hand controller, to be listened to.
    pub(super) handbox: Handbox,
    /// What a recording complains of.
    pub(super) recording: Option<Complaint>,
    /// What should be told once the session runs.
    pub(super) notices: Vec<String>,
}

/// Opens everything.
pub(super) fn open(arguments: &Arguments) -> Result<Opened, Failure> {
    let settings = Settings::load(arguments.config.as_deref())?;
    if let Some(missing) = arguments.config.as_ref().filter(|path| !path.exists()) {
        return Err(Failure::Asked(format!("{} is not there: check the name of the settings file", missing.display())));
    }
    let not_placed = coordinates::take(settings.coordinates.as_deref())?;
    let mount = arguments.mount.clone().or(settings.mount).unwrap_or(MountAddress::Sim);
    let simulated = mount == MountAddress::Sim;
    if arguments.fast && !simulated {
        return Err(Failure::asked(
            "--fast makes time pass, which a real telescope cannot: leave it out, or use --mount sim",
        ));
    }
    let mut handbox =
        handbox::prepare(arguments.handbox.as_ref(), arguments.handbox_map.as_deref(), &settings.handbox, &mount)?;
    let site = arguments.site.or(settings.site).or_else(|| simulated.then(|| Simulated::default().site));
    let begin = begin(arguments, simulated, site);
    let clock = if arguments.fast { Clock::made(begin) } else { Clock::real(begin) };
    let ours = Ours { utc_at_start: clock.utc_at_start(), site };
    let instrument = overlay::instrument(settings.instrument.as_deref(), None)?;
    // Nobody sits before a service, which may be started before the adapter is plugged in and the bridge has power.
    let patient = arguments.headless && arguments.seconds.is_none();
    let mut opener = opener(&mount, site, ours.utc_at_start, patient)?;
    let mut recording = None;
    if let Some(path) = &arguments.record {
        let complaint = Complaint::default();
        opener = record::recorded(opener, path, &mount.to_string(), &complaint)?;
        recording = Some(complaint);
    }
    let address = arguments.projector.clone().or(settings.projector).unwrap_or_default();
    let placement = settings.placement.mirrored(instrument.projector.must_mirror());
    let projector = projector::open(&address, placement).map_err(Failure::failed)?;
    let projector = light::lit(projector, &settings.light)?;
    let display = light::display(&settings.light)?;
    let eye = Eye { sky: SurfaceBrightness(settings.sky_brightness_mag_arcsec2), pupil_mm: settings.pupil_mm };

    let state_path = if simulated { None } else { state::default_path() };
    let (state, notice) = state_path.as_ref().map_or((State::default(), None), |path| State::load(path, &mut Files));
    let (mut animations, mut notices) = (Vec::new(), Vec::new());
    if let Some(folder) = arguments.photographs.as_ref().or(settings.photographs.as_ref()) {
        let (moving, notes) = animations::read_folder(folder)?;
        animations = moving;
        notices.extend(notes);
    }
    let mut album = Album::open(Sources {
        folder: arguments.photographs.as_deref().or(settings.photographs.as_deref()),
        stellarium: arguments.stellarium.as_deref().or(settings.stellarium.as_deref()),
        soften_stars: settings.soften_stars,
    })?;
    notices.append(&mut album.notes);
    notices.extend(not_placed);
    let mut maps = Vec::new();
    if let Some(folder) = settings.maps.as_deref() {
        let (read, notes) = photographs::read_maps(folder)?;
        maps = read;
        notices.extend(notes);
    }
    notices.extend(notice);
    notices.extend(std::mem::take(&mut handbox.notices));
    let (east, north) = state.nudge.angles();
    let opening = Opening {
        instrument,
        site,
        simulated,
        time_stated: begin.is_some(),
        rules: settings.rules,
        turns: state.turns,
        nudge: Nudge { east, north },
        mount: mount.to_string(),
        projector: address.to_string(),
        bindings: handbox.bindings.clone(),
        animations: animations.iter().map(|animation| animation.playable.clone()).collect(),
        observer: Observer {
            eye,
            facts: settings.facts.clone(),
            display,
            tone: settings.tone,
            lamps_dim: settings.light.module.is_some(),
            white: !album.is_empty() || !animations.is_empty(),
        },
    };
    let pump = Pump::new(driver::Settings::new(link::timing(&mount), ours), opener);
    let projection = Projection::new(projector, album, eye)
        .with_animations(animations)
        .with_facts(settings.facts)
        .with_display(display)
        .with_maps(maps);
    Ok(Opened { opening, clock, ours, pump, projection, state_path, handbox, recording, notices })
}

/// When the session begins: as stated; with a simulated telescope in the middle of the coming night, so that a newcomer at
/// noon finds a dark sky; else now.
fn begin(arguments: &Arguments, simulated: bool, site: Option<Site>) -> Option<Utc> {
    let now = Clock::real(None).utc_at_start();
    arguments.time.or_else(|| site.filter(|_| simulated).map(|site| sun::next_midnight(now, &site)))
}

/// Opens the line. The first opening happens here, so that a wrong name is told before the screen is taken; from then on a
/// lost line is opened again for ever. The patient wait for one that is not there yet.
fn opener(mount: &MountAddress, site: Option<Site>, start: Utc, patient: bool) -> Result<Opener, Failure> {
    let Some(mut again) = link::opener(mount) else {
        let settings = Simulated::at(site.unwrap_or(Simulated::default().site), start);
        let mount = SimulatedMount::new(Simulator::new(settings));
        return Ok(Box::new(move || Ok(Box::new(mount.open()?) as Box<dyn Port>)));
    };
    let mut first = match again() {
        Ok(port) => Some(port),
        Err(PortError::NotThere { .. } | PortError::NoConnection { .. }) if patient => None,
        Err(error) => return Err(Failure::failed(error)),
    };
    Ok(Box::new(move || first.take().map_or_else(&mut again, Ok)))
}
