//! Recorded conversations, one per dialect, replayed strict and tolerant.
//!
//! Wiring: none. `fixtures/loopback/` holds them; `SCOTOPIC_KEEP_TRACES=1` makes them anew from the simulated mount.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use scotopic::hw::mount::belief::LinkState;
use scotopic::hw::mount::driver::{Ours, Settings as DriverSettings, Timing};
use scotopic::hw::mount::link::Pump;
use scotopic::hw::mount::order::{Order, Report as Said};
use scotopic::hw::mount::sim::Simulator;
use scotopic::hw::mount::sim::port::SimulatedMount;
use scotopic::hw::mount::sim::settings::Settings;
use scotopic::hw::port::{Port, PortError};
use scotopic::hw::trace::{Recording, Replay, Tolerant};
use scotopic::sky::coords::Equatorial;
use scotopic::units::Angle;
use serde_json::json;

use super::report::{Outcome, Report};

/// A dialect: the name of its trace, the faults that make the simulated mount speak it, and what the driver takes it for.
const DIALECTS: [(&str, &[&str], &str); 4] = [
    ("lx200gps", &[], "LX2001"),
    ("lx200gps-short", &["short=on"], "LX2001"),
    ("autostar-star", &["product=Autostar", "degree=star", "hold-sync=on"], "Autostar"),
    ("classic", &["product=none", "degree=colon"], "a classic LX200"),
];

fn path(name: &str) -> PathBuf {
    PathBuf::from(format!("fixtures/loopback/{name}.jsonl"))
}

/// Ten seconds: connect, go somewhere, stop on the way, read the display.
fn session(port: Box<dyn Port>, orders: bool) -> (Pump, Vec<Said>) {
    let settings = Settings::default();
    let ours = Ours { utc_at_start: settings.start, site: Some(settings.site) };
    let mut port = Some(port);
    let opener = Box::new(move || port.take().ok_or(PortError::NotThere { name: "the recording".into() }));
    let mut pump = Pump::new(DriverSettings::new(Timing::SERIAL, ours), opener);
    let mut said = Vec::new();
    for turn in 1..=1000u32 {
        let now = Duration::from_millis(10) * turn;
        match turn {
            600 if orders => pump.order(Order::Goto(Equatorial::new(Angle::hours(9.0), Angle::degrees(65.0))), now),
            750 if orders => pump.order(Order::Stop, now),
            _ => {}
        }
        said.extend(pump.step(now).into_iter().flat_map(|update| update.reports));
    }
    (pump, said)
}

fn record(name: &str, faults: &[&str]) {
    let mut settings = Settings { seed: 7, ..Settings::default() };
    faults.iter().for_each(|fault| settings.faults.switch(fault).unwrap());
    let mount = SimulatedMount::new(Simulator::new(settings));
    std::fs::create_dir_all("fixtures/loopback").unwrap();
    let file = std::fs::File::create(path(name)).unwrap();
    let header = json!({"who": "the driver of scotopic against its own simulator, in virtual time: agreement, no proof",
        "dialect": name, "faults": faults, "version": env!("CARGO_PKG_VERSION"), "baud": 9600, "site": "scrubbed"});
    session(Box::new(Recording::scrubbed(mount.open().unwrap(), Box::new(file), &header)), true);
}

/// The checksum of a fixture as the manifest has it: CRC-32 of the file, as `gzip` and `cksum -a crc32b` compute it.
fn crc32(bytes: &[u8]) -> String {
    let mut crc = flate2::Crc::new();
    crc.update(bytes);
    format!("{:08x}", crc.sum())
}

/// The fixtures are those that the manifest describes.
pub(crate) fn checksums(report: &mut Report) {
    let began = Instant::now();
    let manifest: toml::Table = std::fs::read_to_string("fixtures/MANIFEST.toml").unwrap().parse().unwrap();
    let mut wrong = Vec::new();
    for (name, ..) in DIALECTS {
        let listed =
            manifest["file"].as_array().unwrap().iter().find(|entry| {
                entry.get("path").and_then(toml::Value::as_str) == Some(&format!("loopback/{name}.jsonl"))
            });
        let (said, is) = (
            listed.and_then(|entry| entry.get("crc32")).and_then(toml::Value::as_str).unwrap_or("nothing"),
            crc32(&std::fs::read(path(name)).unwrap()),
        );
        if said != is {
            wrong.push(format!("{name}: the manifest says {said}, the file is {is}"));
        }
    }
    report.check("traces", "the fixtures' checksums", verdict(wrong), began.elapsed());
}

pub(crate) fn replay(report: &mut Report) {
    for (name, faults, product) in DIALECTS {
        let began = Instant::now();
        if std::env::var_os("SCOTOPIC_KEEP_TRACES").is_some() {
            record(name, faults);
        }
        let trace = std::fs::read_to_string(path(name)).unwrap();
        let (pump, said) = session(Box::new(Replay::parse(&trace).unwrap()), true);
        let lost = said.iter().find(|said| matches!(said, Said::Lost(_)));
        let mut wrong: Vec<String> = lost.iter().map(|lost| format!("the driver left its recording: {lost}")).collect();
        let is = |pump: &Pump| {
            let belief = pump.driver().belief();
            let named = belief.product.value().map_or(product != "LX2001" && product != "Autostar", |p| p == product);
            belief.link == LinkState::Ready && named && belief.position.confirmed().is_some()
        };
        if !is(&pump) || !said.contains(&Said::Stopping) {
            wrong.push(format!("strict: {:?}", pump.driver().belief()));
        }
        report.check("traces", format!("{name}, strict"), verdict(wrong), began.elapsed());

        let began = Instant::now();
        let table = Tolerant::parse(&trace).unwrap();
        // Asked in another order than it was recorded.
        let mut other = table.clone();
        other.send(b":GD#:GR#").unwrap();
        other.set_now(Duration::from_secs(1));
        let answered = other.receive(&mut [0; 64]).unwrap() > 12;
        let (pump, said) = session(Box::new(table), false);
        let mut wrong = Vec::new();
        if !answered || !is(&pump) {
            wrong.push(format!("tolerant: {answered}, {:?}, {said:?}", pump.driver().belief()));
        }
        report.check("traces", format!("{name}, tolerant"), verdict(wrong), began.elapsed());
    }
}

fn verdict(wrong: Vec<String>) -> Outcome {
    if wrong.is_empty() { Outcome::Passed } else { Outcome::Failed(wrong.join("\n")) }
}
