//! Recorded conversations, replayed in virtual time: what was answered once is answered again, byte for byte and at the same
//! microsecond.

#![expect(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::time::Duration;

use scotopic::hw::mount::sim::Simulator;
use scotopic::hw::mount::sim::fault::Faults;
use scotopic::hw::mount::sim::settings::Settings;
use scotopic::sky::time::Utc;
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
fn the_simulator_answers_indi_as_it_did_when_it_was_recorded() {
    let mut replies = 0;
    let recordings: Vec<_> = recordings().into_iter().filter(|path| path.to_string_lossy().contains("indi_")).collect();
    assert!(recordings.len() >= 4, "recordings of INDI are missing: {recordings:?}");
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
    assert!(replies > 200, "only {replies} replies were held against the recordings");
}
