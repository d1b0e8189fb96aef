//! A driver, a bad cable and a simulated mount on one bench, under a clock that is handed in.
//!
//! ```text
//! wiring: Pump <-> Witness <-> FaultLine (Cable) <-> SimulatedPort, or a pty with a simulated mount behind it
//! ```

use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use hdrhistogram::Histogram;
use scotopic::hw::fault_line::Cable;
use scotopic::hw::mount::belief::{Belief, LinkState};
use scotopic::hw::mount::driver::{Ours, Settings as DriverSettings, Timing};
use scotopic::hw::mount::link::Pump;
use scotopic::hw::mount::order::{Order, Report};
use scotopic::hw::mount::sim::Simulator;
use scotopic::hw::mount::sim::port::SimulatedMount;
use scotopic::hw::mount::sim::settings::Settings;
use scotopic::hw::port::{Port, PortError};

use super::report;
use super::truth::{STOP_BUDGET, Truth};

/// What a stop begins with on the wire.
const STOP_BEGINS: &[u8] = b"#:Q#";

/// In real time a machine may be busy with something else: what is later than [`STOP_BUDGET`] is counted, and only what is later
/// than this is a broken promise.
const LATE: Duration = Duration::from_secs(1);

/// What a port took, and when it was opened.
#[derive(Debug, Clone)]
pub(crate) enum Seen {
    Opened,
    Took(Vec<u8>),
}

type Log = Arc<Mutex<Vec<(Duration, Seen)>>>;

/// A port that notes what it takes.
struct Witness<P> {
    port: P,
    now: Duration,
    /// The real clock, where there is one.
    real: Option<Instant>,
    log: Log,
}

impl<P: Port> Port for Witness<P> {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        self.port.receive(buffer)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        let count = self.port.send(bytes)?;
        if count > 0 {
            let now = self.real.map_or(self.now, |start| start.elapsed());
            self.log.lock().unwrap().push((now, Seen::Took(bytes[..count].to_vec())));
        }
        Ok(count)
    }

    fn set_now(&mut self, now: Duration) {
        self.now = now;
        self.port.set_now(now);
    }
}

/// A stop that was ordered and is judged when it is known what became of it.
#[derive(Debug)]
struct Ordered {
    at: Duration,
    was_open: bool,
    /// Entries of the log before it.
    from: usize,
    alarmed: bool,
}

pub(crate) struct Bench {
    pub(crate) pump: Pump,
    pub(crate) mount: SimulatedMount,
    pub(crate) cable: Cable,
    pub(crate) now: Duration,
    pub(crate) truth: Truth,
    pub(crate) reports: Vec<(Duration, Report)>,
    pub(crate) stops: Histogram<u64>,
    pub(crate) reconnects: Histogram<u64>,
    /// How far the clock has leapt.
    pub(crate) leapt: Duration,
    /// A stop later than this has broken its promise.
    pub(crate) stop_within: Duration,
    log: Log,
    ordered: Vec<Ordered>,
    ours: Ours,
    /// Since when the port could be opened again.
    back_since: Option<Duration>,
}

impl Bench {
    /// A bench whose far end is the simulator itself, or what `through` makes of its ports.
    pub(crate) fn new(
        settings: Settings,
        cable: Cable,
        real: Option<Instant>,
        mut through: impl FnMut(&SimulatedMount) -> Result<Box<dyn Port>, PortError> + Send + 'static,
    ) -> Bench {
        let ours = Ours { utc_at_start: settings.start, site: Some(settings.site) };
        let mount = SimulatedMount::new(Simulator::new(settings));
        let log = Log::default();
        let (line, noted, far) = (cable.clone(), Arc::clone(&log), mount.clone());
        let opener = Box::new(move || {
            let port = line.open(|_number| through(&far))?;
            noted.lock().unwrap().push((Duration::ZERO, Seen::Opened));
            // The pump says what time it is before it sends.
            Ok(Box::new(Witness { port, now: Duration::ZERO, real, log: Arc::clone(&noted) }) as Box<dyn Port>)
        });
        Bench {
            pump: Pump::new(DriverSettings::new(Timing::SERIAL, ours), opener),
            mount,
            cable,
            now: Duration::ZERO,
            truth: Truth::default(),
            reports: Vec::new(),
            stops: report::histogram(),
            reconnects: report::histogram(),
            leapt: Duration::ZERO,
            stop_within: if real.is_some() { LATE } else { STOP_BUDGET },
            log,
            ordered: Vec::new(),
            ours,
            back_since: None,
        }
    }

    /// The same without anything between.
    pub(crate) fn virtually(settings: Settings, cable: Cable) -> Bench {
        Bench::new(settings, cable, None, |mount| Ok(Box::new(mount.open()?)))
    }

    pub(crate) fn belief(&self) -> &Belief {
        self.pump.driver().belief()
    }

    /// Gives an order whose key was pressed then.
    pub(crate) fn order(&mut self, order: Order, pressed: Duration) {
        if order == Order::Stop {
            let from = self.log.lock().unwrap().len();
            let was_open = self.pump.is_open();
            self.ordered.push(Ordered { at: pressed, was_open, from, alarmed: false });
        }
        self.pump.order(order, self.now);
    }

    /// The machine slept, or its clock was set: everything is asked anew.
    pub(crate) fn forget(&mut self) {
        self.pump.forget(self.ours, self.now);
    }

    /// One turn of the loop at `now`.
    pub(crate) fn turn(&mut self, now: Duration) {
        self.now = now;
        self.mount.set_now(now);
        self.cable.set_now(now);
        let was_open = self.pump.is_open();
        if let Some(update) = self.pump.step(now) {
            self.truth.said(&update.reports, now);
            for report in update.reports {
                self.heard(&report);
                if report == Report::Position {
                    let (belief, ledger) = (self.pump.driver().belief(), self.cable.ledger());
                    let truth = &mut self.truth;
                    self.mount.look(|simulator| truth.position_believed(belief, simulator.told(), &ledger, now));
                } else if self.reports.len() < 2000 {
                    self.reports.push((now, report));
                }
            }
        }
        if was_open && !self.pump.is_open() {
            self.back_since = None;
        }
        if !self.pump.is_open() && self.back_since.is_none() && !self.cable.is_out() {
            self.back_since = Some(now);
        }
        let truth = &mut self.truth;
        truth.shown(self.pump.driver().belief(), now);
        if self.ordered.is_empty() {
            self.log.lock().unwrap().clear();
        }
    }

    fn heard(&mut self, report: &Report) {
        match report {
            Report::StopNotObeyed { .. } => {
                let (now, within) = (self.now, self.stop_within);
                self.ordered.iter_mut().filter(|o| now.saturating_sub(o.at) <= within).for_each(|o| o.alarmed = true);
            }
            Report::Connected { .. } => {
                if let Some(since) = self.back_since.take() {
                    report::record(&mut self.reconnects, self.now.saturating_sub(since));
                }
            }
            _ => {}
        }
    }

    /// Whether all is well again: the mount answers, its position is live, no stop is owed, nothing moves.
    pub(crate) fn well(&self) -> bool {
        let belief = self.belief();
        let (azimuth, altitude) = self.mount.look(|simulator| simulator.axis_speeds_deg_s(self.now));
        belief.link == LinkState::Ready
            && !belief.stopping
            && belief.pointing(self.now).is_some_and(|pointing| !pointing.stale)
            && azimuth.abs().max(altitude.abs()) < 0.5
    }

    /// What was said within a second after a moment.
    fn around(&self, moment: Duration) -> Vec<String> {
        let near = |at: Duration| at >= moment && at <= moment + Duration::from_secs(1);
        self.reports
            .iter()
            .filter(|(at, _)| near(*at))
            .map(|(at, said)| format!("{:.3} {said}", at.as_secs_f64()))
            .collect()
    }

    /// The clock leaps by so much: what was ordered was ordered as long ago as before.
    pub(crate) fn leap(&mut self, by: Duration) {
        self.leapt += by;
        self.ordered.iter_mut().for_each(|ordered| ordered.at += by);
    }

    /// Whether a command that was changed on the way has switched the mount off.
    pub(crate) fn switched_off(&self) -> bool {
        self.cable.ledger().altered.is_some() && !self.mount.look(|simulator| simulator.answers())
    }

    /// Judges every stop: on the wire in time, or first after reopening with the alarm at once.
    pub(crate) fn judge_stops(&mut self) {
        let log = self.log.lock().unwrap().clone();
        for ordered in std::mem::take(&mut self.ordered) {
            let mut sent: Vec<u8> = Vec::new();
            let mut first_at = None;
            let mut opened_after = false;
            let mut first_after_opening: Option<Vec<u8>> = None;
            for (at, seen) in &log[ordered.from..] {
                match seen {
                    Seen::Opened => {
                        opened_after = true;
                        sent.clear();
                        if first_after_opening.as_ref().is_none_or(|first| first.len() < 4) {
                            first_after_opening = Some(Vec::new());
                        }
                    }
                    Seen::Took(bytes) => {
                        sent.extend(bytes);
                        if let Some(first) = first_after_opening.as_mut().filter(|first| first.len() < 4) {
                            first.extend(bytes);
                        }
                        if sent.windows(STOP_BEGINS.len()).any(|window| window == STOP_BEGINS) {
                            first_at = Some(*at);
                            break;
                        }
                    }
                }
            }
            match first_at {
                Some(at) if !opened_after && at.saturating_sub(ordered.at) <= self.stop_within => {
                    report::record(&mut self.stops, at.saturating_sub(ordered.at));
                }
                _ if !ordered.alarmed => {
                    let what = format!(
                        "the stop ordered at {:.3} s (port open: {}) went out at {first_at:?} and no alarm was shown at once; {:?}",
                        ordered.at.as_secs_f64(),
                        ordered.was_open,
                        self.around(ordered.at)
                    );
                    self.truth.breaks(self.now, what);
                }
                Some(_) if opened_after => {
                    let first = first_after_opening.unwrap_or_default();
                    if !first.starts_with(STOP_BEGINS) {
                        let what =
                            format!("after reopening the first bytes were {}, not the stop", first.escape_ascii());
                        self.truth.breaks(self.now, what);
                    }
                }
                other => {
                    let what = format!(
                        "a stop ordered at {:?} was alarmed, and then sent {other:?} without reopening",
                        ordered.at
                    );
                    self.truth.breaks(self.now, what);
                }
            }
        }
    }
}
