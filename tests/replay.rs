//! Recorded conversations, replayed in virtual time: what was answered once is answered again, byte for byte and at the same
//! microsecond.

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::time::Duration;

use scotopic::hw::mount::driver::{Ours, Settings as DriverSettings, Timing};
use scotopic::hw::mount::link::Pump;
use scotopic::hw::mount::order::{Order, Report};
use scotopic::hw::mount::sim::Simulator;
use scotopic::hw::mount::sim::fault::Faults;
use scotopic::hw::mount::sim::port::SimulatedMount;
use scotopic::hw::mount::sim::settings::Settings;
use scotopic::hw::port::{Port, PortError};
use scotopic::hw::trace::{Recording, Replay};
use scotopic::sky::coords::Equatorial;
use scotopic::sky::time::Utc;
use scotopic::units::Angle;
use serde_json::Value;

/// The recordings whose header says they were made with our simulator.
fn recordings() -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> =
        std::fs::read_dir("fixtures/traces").unwrap().map(|entry| entry.unwrap().path()).collect();
    found.retain(|path| path.extension().is_some_and(|extension| extension == "jsonl"));
    found.sort();
    found
}

fn lines(path: &Path) -> Vec<Value> {
    std::fs::read_to_string(path).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// The settings that a header tells.
fn settings(header: &Value) -> Settings {
    let text = |key: &str| header[key].as_str().unwrap_or_else(|| panic!("the header lacks {key}"));
    let mut faults = Faults::default();
    for fault in header["faults"].as_array().unwrap() {
        faults.switch(fault.as_str().unwrap()).unwrap();
    }
    let start = Utc::from_rfc3339(text("time")).unwrap();
    let seed = header["seed"].as_u64().unwrap();
    Settings { seed, faults, ..Settings::at(text("site").parse().unwrap(), start) }
}

fn bytes(entry: &Value) -> Vec<u8> {
    let hex = entry["hex"].as_str().unwrap();
    (0..hex.len()).step_by(2).map(|at| u8::from_str_radix(&hex[at..at + 2], 16).unwrap()).collect()
}

#[test]
fn the_simulator_answers_as_it_did_when_it_was_recorded() {
    let (mut replies, recordings) = (0, recordings());
    let indi = recordings.iter().filter(|path| path.to_string_lossy().contains("indi_")).count();
    assert_eq!((indi, recordings.len()), (4, 5), "recordings are missing: {recordings:?}");
    for path in recordings {
        let lines = lines(&path);
        let mut simulator = Simulator::new(settings(&lines[0]));
        for (number, entry) in lines.iter().enumerate().skip(1) {
            let now = Duration::from_micros(entry["t_us"].as_u64().unwrap());
            match (entry["dir"].as_str().unwrap(), entry["note"].as_str().unwrap()) {
                ("to-mount", _) => simulator.feed(&bytes(entry), now),
                ("from-mount", _) => {
                    let said = simulator.drain(now);
                    assert_eq!(
                        said.escape_ascii().to_string(),
                        bytes(entry).escape_ascii().to_string(),
                        "line {} of {}",
                        number + 1,
                        path.display()
                    );
                    replies += 1;
                }
                ("none", "client came") => simulator.client_came(now),
                ("none", "client left") => simulator.client_left(now),
                other => panic!("line {} of {} is {other:?}", number + 1, path.display()),
            }
        }
    }
    assert!(replies > 300, "only {replies} replies were held against the recordings");
}

/// The recording of our own driver.
const OURS: &str = "fixtures/traces/scotopic-driver.jsonl";

/// What the simulator of that recording was told: the header's settings.
fn our_header() -> Value {
    serde_json::json!({
        "who": "the driver of scotopic against its own simulator, in virtual time",
        "version": env!("CARGO_PKG_VERSION"),
        "date": "2026-11-22T20:00:00Z",
        "seed": 7,
        "site": "49.26,7.04,230",
        "time": "2026-11-22T20:00:00Z",
        "faults": [],
    })
}

/// Twelve seconds: connect, go 10 degrees, arrive, sync, go on, stop.
fn our_session(header: &Value, port: Box<dyn Port>) -> (Vec<Report>, Option<PortError>) {
    let settings = settings(header);
    let ours = Ours { utc_at_start: settings.start, site: Some(settings.site) };
    let mut port = Some(port);
    let opener = Box::new(move || port.take().ok_or(PortError::NotThere { name: "the recording".into() }));
    let mut pump = Pump::new(DriverSettings::new(Timing::SERIAL, ours), opener);
    let mut reports = Vec::new();
    let place = |hours: f64, degrees: f64| Equatorial::new(Angle::hours(hours), Angle::degrees(degrees));
    for turn in 1..=600u32 {
        let now = Duration::from_millis(20) * turn;
        match turn {
            150 => pump.order(Order::Goto(place(7.5, 65.0)), now),
            400 => pump.order(Order::Sync(place(7.51, 65.1)), now),
            450 => pump.order(Order::Goto(place(9.0, 60.0)), now),
            500 => pump.order(Order::Stop, now),
            _ => {}
        }
        reports.extend(pump.step(now).into_iter().flat_map(|update| update.reports));
    }
    let lost = reports.iter().find_map(|report| match report {
        Report::Lost(why) => Some(why.clone()),
        _ => None,
    });
    (reports, lost)
}

/// With `SCOTOPIC_KEEP_TRACES=1` the recording is made anew first.
#[test]
fn the_driver_says_what_it_said_when_it_was_recorded() {
    let header = our_header();
    if std::env::var_os("SCOTOPIC_KEEP_TRACES").is_some() {
        let mount = SimulatedMount::new(Simulator::new(settings(&header)));
        let file = std::fs::File::create(OURS).unwrap();
        let port = Recording::new(mount.open().unwrap(), Box::new(file), &header);
        our_session(&header, Box::new(port));
    }
    let trace = std::fs::read_to_string(OURS).unwrap();
    let (reports, lost) = our_session(&header, Box::new(Replay::parse(&trace).unwrap()));
    assert_eq!(
        lost, None,
        "the driver left its recording: if that is meant, record it anew with SCOTOPIC_KEEP_TRACES=1"
    );
    for (what, holds) in [
        ("connected", reports.iter().any(|report| matches!(report, Report::Connected { .. }))),
        ("arrived", reports.iter().any(|report| matches!(report, Report::Arrived { .. }))),
        ("synchronised", reports.iter().any(|report| matches!(report, Report::Synced { .. }))),
        ("stopping", reports.iter().any(|report| matches!(report, Report::Stopping))),
    ] {
        assert!(holds, "it was never {what}: {reports:?}");
    }
    assert!(!reports.iter().any(|report| matches!(report, Report::Fault(_))), "{reports:?}");
}
