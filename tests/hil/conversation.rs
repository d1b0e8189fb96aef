//! The mount asked everything that it is asked at night, each command timed, and the conversation recorded.
//!
//! Wiring: computer's serial adapter - #507 cable - the LX200GPS' RS-232 socket next to the handbox port. Motors off: nothing is
//! sent that moves. On a null-modem rig: near adapter - null-modem cable - far adapter, where a simulated mount speaks. On the
//! loopback rig a pty stands for the cable, with a simulated mount that takes 1.04 ms for a byte.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use hdrhistogram::Histogram;
use scotopic::cli::rig::Rig;
use scotopic::hw::mount::belief::LinkState;
use scotopic::hw::mount::command::Question;
use scotopic::hw::mount::driver::{Ours, Settings as DriverSettings, Timing};
use scotopic::hw::mount::link::Pump;
use scotopic::hw::mount::order::{Order, Report as Said};
use scotopic::hw::mount::sim::Simulator;
use scotopic::hw::mount::sim::serve::{Listen, Server};
use scotopic::hw::mount::sim::settings::Settings;
use scotopic::hw::port::{Port, PortError};
use scotopic::hw::serial::{SerialLine, stable_name};
use scotopic::hw::trace::Recording;
use serde_json::json;

use super::report::{Outcome, Report, histogram, record};

/// How long the mount is listened to.
const LASTS: Duration = Duration::from_secs(12);

type Times = Arc<Mutex<BTreeMap<String, Histogram<u64>>>>;

/// A port with a stopwatch: from the bytes of a command to the last byte of its reply.
struct Timed<P> {
    port: P,
    asked: Option<(String, Instant)>,
    last: Option<Instant>,
    times: Times,
}

impl<P> Timed<P> {
    fn close(&mut self) {
        if let (Some((command, asked)), Some(last)) = (self.asked.take(), self.last.take()) {
            let mut times = self.times.lock().unwrap();
            record(times.entry(command).or_insert_with(histogram), last - asked);
        }
    }
}

impl<P: Port> Port for Timed<P> {
    fn receive(&mut self, buffer: &mut [u8]) -> Result<usize, PortError> {
        let count = self.port.receive(buffer)?;
        if count > 0 {
            self.last = Some(Instant::now());
        }
        Ok(count)
    }

    fn send(&mut self, bytes: &[u8]) -> Result<usize, PortError> {
        self.close();
        let count = self.port.send(bytes)?;
        let name = match bytes {
            [0x06] => "ACK".to_owned(),
            _ => String::from_utf8_lossy(bytes).chars().take_while(|c| !c.is_ascii_digit() && *c != '#').collect(),
        };
        self.asked = Some((name, Instant::now()));
        Ok(count)
    }

    fn set_now(&mut self, now: Duration) {
        self.port.set_now(now);
    }
}

/// A simulated mount at the far end of a cable, until it is over.
fn speak_at(path: &str, baud: u32, settings: Settings, over: &AtomicBool) {
    let mut line = SerialLine::open(path, baud).unwrap();
    let (mut simulator, start) = (Simulator::new(settings), Instant::now());
    let (mut heard, mut waiting) = ([0; 256], Vec::new());
    while !over.load(Ordering::Relaxed) {
        let count = line.receive(&mut heard).unwrap();
        let now = start.elapsed();
        simulator.feed(&heard[..count], now);
        waiting.extend(simulator.drain(now));
        let sent = line.send(&waiting).unwrap();
        waiting.drain(..sent);
    }
}

/// The conversation with the rig's mount, or with a simulated one over a null modem or a pty.
pub(crate) fn hold(rig: &Rig, report: &mut Report) {
    let began = Instant::now();
    let over = Arc::new(AtomicBool::new(false));
    let settings = Settings::default();
    let ours = Ours { utc_at_start: settings.start, site: Some(settings.site) };
    let (path, baud, far) = match (&rig.mount, &rig.null_modem) {
        (Some(mount), _) => (stable_name(&mount.port), mount.baud, None),
        (None, Some(modem)) => {
            let (path, baud, ended) = (stable_name(&modem.far), modem.baud, Arc::clone(&over));
            let far = std::thread::spawn(move || speak_at(&path, baud, settings, &ended));
            (stable_name(&modem.near), modem.baud, Some(far))
        }
        (None, None) => {
            let (told, name) = std::sync::mpsc::channel();
            let ended = Arc::clone(&over);
            let far = std::thread::spawn(move || {
                let mut server = Server::open(Simulator::new(settings), Listen::Pty).unwrap();
                told.send(server.endpoint()).unwrap();
                server.serve(&|| ended.load(Ordering::Relaxed), &mut |_| {}).unwrap();
            });
            (name.recv().unwrap(), 9600, Some(far))
        }
    };
    let times = Times::default();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/hil");
    std::fs::create_dir_all(&folder).unwrap();
    let trace = folder.join("conversation.jsonl");
    let kernel = std::fs::read_to_string("/proc/sys/kernel/osrelease").unwrap_or_default();
    let header = json!({"who": "cargo test --test hil", "rig": rig.name, "version": env!("CARGO_PKG_VERSION"),
                        "baud": baud, "host": format!("Linux {}", kernel.trim())});
    let stopwatch = Arc::clone(&times);
    let opener = Box::new(move || {
        let port = SerialLine::open(&path, baud)?;
        let timed = Timed { port, asked: None, last: None, times: Arc::clone(&stopwatch) };
        let file = File::create(&trace)
            .map_err(|error| PortError::Unusable { name: "the trace".into(), why: error.to_string() })?;
        Ok(Box::new(Recording::scrubbed(timed, Box::new(file), &header)) as Box<dyn Port>)
    });
    let mut pump = Pump::new(DriverSettings::new(Timing::SERIAL, ours), opener);
    let start = Instant::now();
    let mut next = Duration::from_secs(2);
    let mut said = Vec::new();
    while start.elapsed() < LASTS {
        let now = start.elapsed();
        said.extend(pump.step(now).into_iter().flat_map(|update| update.reports).filter(|r| *r != Said::Position));
        if now >= next {
            next += Duration::from_secs(2);
            for order in [Order::ReadDisplay, Order::Ask(Question::new("GT").unwrap()), Order::Compare] {
                pump.order(order, now);
            }
        }
        if !pump.is_open() {
            std::thread::sleep(Duration::from_millis(5));
        }
    }
    let belief = pump.driver().belief().clone();
    drop(pump);
    over.store(true, Ordering::Relaxed);
    if let Some(far) = far {
        far.join().unwrap();
    }
    for (command, times) in times.lock().unwrap().iter() {
        report.times(&format!("command {command}"), times);
    }
    let counters = belief.counters;
    for (name, count) in [
        ("timeouts and garbled replies", counters.faults),
        ("retries", counters.retries),
        ("resyncs", counters.resyncs),
    ] {
        report.count(&format!("conversation: {name}"), count);
    }
    let product = belief.product.value().cloned().unwrap_or_else(|| "unknown".into());
    let firmware = belief.firmware.value().cloned().unwrap_or_else(|| "unknown".into());
    report.inventory(
        "mount",
        format!("{product}, firmware {firmware}{}", if rig.mount.is_none() { ", SIMULATED" } else { "" }),
    );
    let mut wrong = Vec::new();
    if belief.link != LinkState::Ready {
        wrong.push(format!("the link is {:?}: {said:?}", belief.link));
    }
    let dialect = rig.mount.as_ref().and_then(|mount| mount.dialect.clone());
    if let Some(dialect) = dialect.filter(|dialect| *dialect != product) {
        wrong.push(format!("the rig file expects {dialect}; the mount says {product}"));
    }
    if rig.mount.is_none() && counters.faults + counters.resyncs > 0 {
        wrong.push(format!("faults on a good line: {counters:?}"));
    }
    let outcome = if wrong.is_empty() { Outcome::Passed } else { Outcome::Failed(wrong.join("\n")) };
    let name = match (&rig.mount, &rig.null_modem) {
        (Some(_), _) => "real mount, motors off: asked everything",
        (None, Some(_)) => "simulated mount over a null modem: asked everything",
        (None, None) => "simulated mount over a pty: asked everything",
    };
    report.check("mount", name, outcome, began.elapsed());
}
