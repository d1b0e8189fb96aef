//! Our driver against our simulator, with each of its faults in turn. Both were written from one reading of the protocol, so
//! this proves nothing about a real mount: it shows that no fault makes the driver hang, believe a wrong position,
//! or lose a stop.
#![expect(clippy::panic, reason = "a test fails by panicking")]

use std::time::Duration;

use scotopic::hw::mount::belief::{Belief, LinkState};
use scotopic::hw::mount::driver::{Ours, Settings, Timing};
use scotopic::hw::mount::link::Pump;
use scotopic::hw::mount::order::{Order, Report};
use scotopic::hw::mount::sim::Simulator;
use scotopic::hw::mount::sim::fault::TABLE;
use scotopic::hw::mount::sim::port::SimulatedMount;
use scotopic::hw::mount::sim::settings::Settings as Simulated;
use scotopic::hw::port::Port;
use scotopic::sky::coords::Equatorial;
use scotopic::sky::pointing::Motion;
use scotopic::units::Angle;

/// Faults after which what the mount says is no longer where it says it is, or is readable and wrong: a digit's flipped bit
/// is another digit.
const LIES: [&str; 7] = ["flip", "frozen", "swap", "wrong-baud", "insert", "drop", "duplicate"];
/// Faults that leave nothing to talk to, the flood of a megabyte for a quarter of an hour.
const HOPELESS: [&str; 7] = ["flood", "loop", "echo", "wrong-baud", "truncate", "asleep", "restart"];

struct Session {
    mount: SimulatedMount,
    pump: Pump,
    now: Duration,
    reports: Vec<(Duration, Report)>,
    /// Largest distance of a freshly believed position, standing still, from what the mount believes.
    worst: Angle,
}

impl Session {
    fn with(fault: Option<&str>) -> Session {
        let mut settings = Simulated::default();
        if let Some(fault) = fault {
            settings.faults.switch(fault).unwrap_or_else(|error| panic!("{fault}: {error}"));
        }
        let ours = Ours { utc_at_start: settings.start, site: Some(settings.site) };
        let mount = SimulatedMount::new(Simulator::new(settings));
        let lines = mount.clone();
        let opener = Box::new(move || lines.open().map(|port| Box::new(port) as Box<dyn Port>));
        let pump = Pump::new(Settings::new(Timing::SERIAL, ours), opener);
        Session { mount, pump, now: Duration::ZERO, reports: Vec::new(), worst: Angle::ZERO }
    }

    fn belief(&self) -> &Belief {
        self.pump.driver().belief()
    }

    fn run_to(&mut self, seconds: u64) {
        while self.now < Duration::from_secs(seconds) {
            self.now += Duration::from_millis(5);
            self.mount.set_now(self.now);
            let Some(update) = self.pump.step(self.now) else { continue };
            assert!(update.reports.len() < 600);
            let fresh = update.reports.contains(&Report::Position);
            self.reports.extend(update.reports.into_iter().filter(|r| *r != Report::Position).map(|r| (self.now, r)));
            let standing = update.belief.motion.value() != Some(&Motion::Slewing);
            if fresh
                && standing
                && let Some(position) = update.belief.position.value()
            {
                let now = self.now;
                let told = self.mount.look(|simulator| simulator.reported(now));
                self.worst = self.worst.max(position.separation(&told));
            }
        }
    }

    fn count(&self, wanted: impl Fn(&Report) -> bool) -> usize {
        self.reports.iter().filter(|(_, report)| wanted(report)).count()
    }
}

/// Connect, go somewhere, stop on the way, look.
fn session(fault: Option<&str>) -> Session {
    let mut session = Session::with(fault);
    session.run_to(15);
    if let Some(here) = session.belief().position.value().copied() {
        let there = Equatorial::new(here.ra() + Angle::degrees(60.0), here.dec() - Angle::degrees(20.0));
        session.pump.order(Order::Goto(there), session.now);
    }
    session.run_to(19);
    session.pump.order(Order::Stop, session.now);
    session.run_to(70);
    session
}

#[test]
fn without_faults_nothing_is_repeated_and_the_position_is_right_to_its_step() {
    let session = session(None);
    let counters = session.belief().counters;
    assert_eq!((counters.retries, counters.resyncs, counters.reconnects, counters.faults), (0, 0, 0, 0));
    assert_eq!((counters.slews, counters.stray_bytes, counters.jumps), (1, 0, 0));
    assert!(session.worst.to_arcseconds() < 16.0, "{}", session.worst.to_arcseconds());
    assert_eq!(session.count(|r| *r == Report::Stopped), 1, "{:?}", session.reports);
}

#[test]
fn each_fault_leaves_a_driver_that_is_right_or_says_that_it_does_not_know() {
    let mut failures = Vec::new();
    for entry in TABLE {
        let session = session(Some(&format!("{}={}", entry.name, entry.example)));
        let (belief, name) = (session.belief(), entry.name);
        let hopeless = HOPELESS.contains(&name);
        let mut fails = |what: &str| {
            failures.push(format!("{name}: {what}; {:?}", session.reports.iter().rev().take(6).collect::<Vec<_>>()));
        };
        if !hopeless && !matches!(belief.link, LinkState::Ready | LinkState::Mending | LinkState::Connecting) {
            fails(&format!("the link is {:?}", belief.link));
        }
        if !LIES.contains(&name) && session.worst > Angle::arcminutes(3.0) {
            fails(&format!("a position was wrong by {:.1}'", session.worst.to_arcminutes()));
        }
        let stopped = session.count(|r| matches!(r, Report::Stopped | Report::StopNotObeyed { .. }));
        if stopped == 0 {
            fails("the stop was neither obeyed nor missed");
        }
        if hopeless
            && belief.position.value().is_none()
            && session.count(|r| matches!(r, Report::Fault(_) | Report::Lost(_))) == 0
        {
            fails("nothing was said");
        }
    }
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}

#[test]
fn a_cable_that_comes_back_is_spoken_on_again_and_the_slew_is_not_ordered_again() {
    let mut session = Session::with(Some("unplug=20,5"));
    session.run_to(15);
    let here = *session.belief().position.value().unwrap_or_else(|| panic!("no position"));
    let there = Equatorial::new(here.ra() + Angle::degrees(60.0), here.dec() - Angle::degrees(20.0));
    session.pump.order(Order::Goto(there), session.now);
    session.run_to(23);
    assert_eq!(session.belief().link, LinkState::Closed);
    assert!(session.belief().pointing(session.now).is_some_and(|pointing| pointing.stale || !pointing.may_draw()));
    session.run_to(60);
    assert_eq!(session.belief().link, LinkState::Ready);
    assert!(session.belief().counters.reconnects >= 1);
    assert_eq!(session.belief().counters.slews, 1);
    assert_eq!(session.count(|r| matches!(r, Report::Arrived { .. })), 1, "{:?}", session.reports);
}

#[test]
fn each_wrong_setting_of_the_mount_is_named() {
    for (fault, words) in [
        ("rollover=on", "1024 weeks"),
        ("zone-sign=on", "wrong sign"),
        ("longitude-sign=on", "longitude"),
        ("clock-error=3600", "zone or daylight saving"),
        ("unaligned=on", "aligned on 0 stars"),
        ("not-tracking=on", "does not follow the sky"),
        ("product=Autostar", "not an LX200GPS"),
    ] {
        let mut session = Session::with(Some(fault));
        session.run_to(6);
        let said: Vec<String> = session.reports.iter().map(|(_, report)| report.to_string()).collect();
        assert!(said.iter().any(|sentence| sentence.contains(words)), "{fault}: {said:#?}");
    }
}
