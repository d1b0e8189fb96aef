//! Everything that is opened before the session begins: site, time, mount, projector, instrument.

use super::Arguments;
use super::clock::Clock;
use super::projection::Projection;
use crate::app::model::Opening;
use crate::cli::Failure;
use crate::hw::mount::address::MountAddress;
use crate::hw::mount::driver::{Ours, Settings, Timing};
use crate::hw::mount::link::{self, Opener, Pump};
use crate::hw::mount::sim::Simulator;
use crate::hw::mount::sim::port::SimulatedMount;
use crate::hw::mount::sim::settings::Settings as Simulated;
use crate::hw::port::Port;
use crate::hw::projector;
use crate::safety::{Rules, TurnCounter};
use crate::sky::optics::Instrument;
use crate::sky::site::Site;
use crate::sky::sun;
use crate::sky::time::Utc;

/// What the session needs.
pub(super) struct Opened {
    pub(super) opening: Opening,
    pub(super) clock: Clock,
    pub(super) ours: Ours,
    pub(super) pump: Pump,
    pub(super) projection: Projection,
}

/// Opens everything.
pub(super) fn open(arguments: &Arguments) -> Result<Opened, Failure> {
    let mount = arguments.mount.clone().unwrap_or(MountAddress::Sim);
    let simulated = mount == MountAddress::Sim;
    if arguments.fast && !simulated {
        return Err(Failure::asked(
            "--fast makes time pass, which a real telescope cannot: leave it out, or use --mount sim",
        ));
    }
    let site = arguments.site.or_else(|| simulated.then(|| Simulated::default().site));
    let begin = begin(arguments, simulated, site);
    let clock = if arguments.fast { Clock::made(begin) } else { Clock::real(begin) };
    let ours = Ours { utc_at_start: clock.utc_at_start(), site };
    let timing = if matches!(mount, MountAddress::Tcp { .. }) { Timing::TCP } else { Timing::SERIAL };
    let opener = opener(&mount, site, ours.utc_at_start)?;
    let address = arguments.projector.clone().unwrap_or_default();
    let projector = projector::open(&address, projector::Flip::default()).map_err(Failure::failed)?;
    let opening = Opening {
        instrument: Instrument::default(),
        site,
        simulated,
        time_stated: begin.is_some(),
        rules: Rules::default(),
        turns: TurnCounter::unwound(),
        mount: mount.to_string(),
        projector: address.to_string(),
    };
    let pump = Pump::new(Settings::new(timing, ours), opener);
    Ok(Opened { opening, clock, ours, pump, projection: Projection::new(projector) })
}

/// When the session begins: as stated; with a simulated telescope in the middle of the coming night, so that a newcomer at
/// noon finds a dark sky; else now.
fn begin(arguments: &Arguments, simulated: bool, site: Option<Site>) -> Option<Utc> {
    let now = Clock::real(None).utc_at_start();
    arguments.time.or_else(|| site.filter(|_| simulated).map(|site| sun::next_midnight(now, &site)))
}

fn opener(mount: &MountAddress, site: Option<Site>, start: Utc) -> Result<Opener, Failure> {
    match mount {
        MountAddress::Sim => {
            let site = site.unwrap_or(Simulated::default().site);
            let mount = SimulatedMount::new(Simulator::new(Simulated::at(site, start)));
            Ok(Box::new(move || Ok(Box::new(mount.open()?) as Box<dyn Port>)))
        }
        real => link::opener(real).ok_or_else(|| Failure::failed("this mount has no line")),
    }
}
