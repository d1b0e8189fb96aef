//! The projector's light: each brightness is written, and read back from the module, on a bus that now and then swallows a transaction.
//!
//! Wiring: none. Two made-up modules, a DLPC2607 and a DLPC34xx. A real one is read back with `scotopic projector status`.

use std::time::{Duration, Instant};

use scotopic::hw::i2c::pace::Made;
use scotopic::hw::light::fake::{FakeBus, FakeModule, Faults};
use scotopic::hw::light::lamp::Lamp;
use scotopic::hw::light::{Calibration, Controller, Module};
use scotopic::numerics::streams::Stream;

use super::report::{Outcome, Report, histogram, record};

/// Levels from the dimmest to the brightest that the eyepiece may have.
const LEVELS: u32 = 50;

/// cd/m2 at the eyepiece.
const DIMMEST: f64 = 0.03;
const BRIGHTEST: f64 = 1.8;

fn calibration(module: Module) -> Calibration {
    let (name, id) = match module {
        Module::Dlpc2607 => ("dlpc2607", 0x8A),
        Module::Dlpc34xx => ("dlpc34xx", 6),
    };
    let text = format!(
        "module = \"{name}\"\nid = {id}\n\n[optics]\nmeter = \"eyepiece\"\nfixed_nd = 1e-4\nbeam_splitter = 0.1\n\n"
    );
    // A module that gives light in proportion to its current, measured at sixteen steps.
    let rows =
        (1..=16).map(|step| format!("[[row]]\ncode = {}\ncd_m2 = {}\n", step * 48, BRIGHTEST * f64::from(step) / 16.0));
    Calibration::from_toml(&(text + &rows.collect::<String>())).unwrap()
}

/// Every level on one module: how many were read back as written, and what was wrong.
fn levels(module: Module, seed: u64, latency: &mut hdrhistogram::Histogram<u64>) -> (u32, Vec<String>) {
    let mut stream = Stream::seeded(seed);
    let silent = (1..20_000).filter(|_| stream.chance(0.03)).collect();
    let bus = FakeBus::new(FakeModule::new(module, Faults { silent, ..Faults::default() }));
    let controller = Controller::new(module, Box::new(bus.clone()));
    let mut lamp = Lamp::ready(controller, calibration(module), None, DIMMEST, Box::new(Made::default())).unwrap();
    lamp.on().unwrap();
    let (mut as_written, mut wrong) = (0, Vec::new());
    for level in 0..LEVELS {
        let asked = DIMMEST * (BRIGHTEST / DIMMEST).powf(f64::from(level) / f64::from(LEVELS - 1));
        let began = Instant::now();
        let plan = match lamp.dim(asked) {
            Ok(plan) => plan.clone(),
            Err(error) => {
                wrong.push(format!("{module:?}, {asked:.3} cd/m2: {error}"));
                continue;
            }
        };
        let held = lamp.read_back();
        record(latency, began.elapsed());
        let in_module = bus.look().led_current;
        let near = (plan.predicted_cd_m2 / asked - 1.0).abs() < 0.02;
        if held.as_ref() == Ok(&plan.drive) && in_module == plan.drive.codes && near {
            as_written += 1;
        } else {
            wrong.push(format!(
                "{module:?}, {asked:.3} cd/m2: {:?} was written for {:.3}, {held:?} was read, {in_module:?} is there",
                plan.drive, plan.predicted_cd_m2
            ));
        }
    }
    drop(lamp);
    if bus.look().lit {
        wrong.push(format!("{module:?}: the LEDs are still on"));
    }
    (as_written, wrong)
}

/// A module that takes less current than it is told: it is found out, and dark.
fn clamping() -> Vec<String> {
    let module = Module::Dlpc34xx;
    let bus = FakeBus::new(FakeModule::new(module, Faults { clamp: Some(300), ..Faults::default() }));
    let controller = Controller::new(module, Box::new(bus.clone()));
    let mut lamp = Lamp::ready(controller, calibration(module), None, BRIGHTEST, Box::new(Made::default())).unwrap();
    match lamp.on() {
        Ok(()) => vec!["a module that clamps its current was believed".into()],
        Err(_) if bus.look().lit => vec!["a module that clamps its current was left lit".into()],
        Err(_) => Vec::new(),
    }
}

pub(crate) fn read_back(report: &mut Report) {
    let began = Instant::now();
    let (mut total, mut wrong, mut latency) = (0, clamping(), histogram());
    for (module, seed) in [(Module::Dlpc2607, report.seed), (Module::Dlpc34xx, report.seed + 1)] {
        let (as_written, more) = levels(module, seed, &mut latency);
        total += as_written;
        wrong.extend(more);
    }
    report.times("projector: brightness set and read back (program's share)", &latency);
    report.figure(
        "brightness read back as written, 0.03 to 1.8 cd/m2, two made-up modules",
        "all",
        format!("{total} of {}", 2 * LEVELS),
        total == 2 * LEVELS,
    );
    let outcome = if wrong.is_empty() { Outcome::Passed } else { Outcome::Failed(wrong.join("\n")) };
    report.check("light", "brightness written and read back", outcome, began.elapsed().max(Duration::from_micros(1)));
}
