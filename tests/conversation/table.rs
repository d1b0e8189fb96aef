//! A driver and a simulated mount on one table, with a cable between them and a clock that the test turns.

use std::time::Duration;

use scotopic::hw::mount::belief::Belief;
use scotopic::hw::mount::driver::{Ours, Settings as DriverSettings, Timing};
use scotopic::hw::mount::link::Pump;
use scotopic::hw::mount::order::{Order, Report};
use scotopic::hw::mount::sim::Simulator;
use scotopic::hw::mount::sim::port::SimulatedMount;
use scotopic::hw::mount::sim::settings::Settings;
use scotopic::hw::port::Port;
use scotopic::sky::coords::{Equatorial, OfDate};
use scotopic::sky::pointing::Motion;
use scotopic::units::Angle;

/// How long one turn of the session's loop takes.
const TURN: Duration = Duration::from_millis(5);
/// The mount has stood or tracked for so long: what is believed must have caught up.
const CALM: Duration = Duration::from_secs(4);

pub(crate) struct Table {
    pump: Pump,
    mount: SimulatedMount,
    pub(crate) now: Duration,
    pub(crate) reports: Vec<Report>,
    moved_at: Duration,
    /// The most that a position shown as live was off while all was calm.
    pub(crate) worst_live_deg: f64,
}

impl Table {
    pub(crate) fn new(settings: Settings) -> Table {
        let ours = Ours { utc_at_start: settings.start, site: Some(settings.site) };
        let mount = SimulatedMount::new(Simulator::new(settings));
        let line = mount.clone();
        let opener = Box::new(move || Ok(Box::new(line.open()?) as Box<dyn Port>));
        Table {
            pump: Pump::new(DriverSettings::new(Timing::SERIAL, ours), opener),
            mount,
            now: Duration::ZERO,
            reports: Vec::new(),
            moved_at: Duration::ZERO,
            worst_live_deg: 0.0,
        }
    }

    /// Connected, everything read, nothing said so far.
    pub(crate) fn ready(settings: Settings) -> Table {
        let mut table = Table::new(settings);
        table.run(6.0);
        table.reports.clear();
        table
    }

    /// Gives an order; it may move the position, at once even, so that nothing is calm for a while.
    pub(crate) fn order(&mut self, order: Order) {
        self.moved_at = self.now;
        self.pump.order(order, self.now);
    }

    pub(crate) fn run(&mut self, seconds: f64) {
        let end = self.now + Duration::from_secs_f64(seconds);
        while self.now < end {
            self.now += TURN;
            self.mount.set_now(self.now);
            if let Some(update) = self.pump.step(self.now) {
                self.reports.extend(update.reports);
            }
            self.watch();
        }
    }

    /// A position that is shown as live is the mount's own, and it is not shown when it is old.
    fn watch(&mut self) {
        if self.fastest_axis() > 0.02 {
            self.moved_at = self.now;
        }
        let Some(pointing) = self.belief().pointing(self.now) else { return };
        let age = self.belief().position.age(self.now).unwrap();
        assert!(pointing.stale || age < Duration::from_secs(4), "a position {age:?} old is shown as live");
        if !pointing.stale && pointing.motion != Motion::Slewing && self.now > self.moved_at + CALM {
            let off = pointing.position.separation(&self.reported()).to_degrees();
            self.worst_live_deg = self.worst_live_deg.max(off);
        }
    }

    pub(crate) fn belief(&self) -> &Belief {
        self.pump.driver().belief()
    }

    pub(crate) fn said(&self, what: impl Fn(&Report) -> bool) -> bool {
        self.reports.iter().any(what)
    }

    /// Where the simulated mount believes it points.
    pub(crate) fn reported(&self) -> Equatorial<OfDate> {
        self.mount.look(|simulator| simulator.reported(self.now))
    }

    /// How far what is believed is from that.
    pub(crate) fn off_by_arcsec(&self) -> f64 {
        let believed = self.belief().position.confirmed().copied();
        believed.map_or(f64::INFINITY, |position| position.separation(&self.reported()).to_arcseconds())
    }

    /// The speed of the faster axis in degrees a second.
    pub(crate) fn fastest_axis(&self) -> f64 {
        let (azimuth, altitude) = self.mount.look(|simulator| simulator.axis_speeds_deg_s(self.now));
        azimuth.abs().max(altitude.abs())
    }

    /// A place so many degrees of right ascension and declination from here, well above the horizon from the default site.
    pub(crate) fn above(&self, ra_deg: f64, dec_deg: f64) -> Equatorial<OfDate> {
        let here = self.reported();
        let dec = (here.dec() + Angle::degrees(dec_deg)).min(Angle::degrees(85.0)).max(Angle::degrees(60.0));
        Equatorial::new(here.ra() + Angle::degrees(ra_deg), dec)
    }
}
