//! The rig: every hardware path, on loopback lines here and on real cables at the telescope.
//!
//! ```text
//! cargo test --test hil                                        the loopback rig: pseudo terminals and fakes
//! SCOTOPIC_RIG=hil/rigs/NAME.toml cargo test --test hil        a real one; `hil/README.md` says what to wire
//! cargo test --test hil -- nights replug                       only these sections
//! ```
//!
//! Each section has its wiring at the top of its file. What was not run is named with its reason, and never counted as passed.
//! The report is in `target/hil/`: report.json, junit.xml, and the summary as it is printed. A harness of its own, because the
//! sections share one report, measure time, and must not run beside each other.

#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "hil/bench.rs"]
mod bench;
#[path = "hil/conversation.rs"]
mod conversation;
#[path = "hil/exits.rs"]
mod exits;
#[path = "hil/faults.rs"]
mod faults;
#[path = "hil/field.rs"]
mod field;
#[path = "hil/inventory.rs"]
mod inventory;
#[path = "hil/light.rs"]
mod light;
#[path = "hil/night.rs"]
mod night;
#[path = "hil/program.rs"]
mod program;
#[path = "hil/realtime.rs"]
mod realtime;
#[path = "hil/replug.rs"]
mod replug;
#[path = "hil/report.rs"]
mod report;
#[path = "hil/tap.rs"]
mod tap;
#[path = "hil/traces.rs"]
mod traces;
#[path = "hil/truth.rs"]
mod truth;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use scotopic::cli::rig::Rig;

use report::{Outcome, Report};

/// A section: its name, and what it does.
type Section = (&'static str, fn(&Rig, &mut Report));

/// In the order in which they run.
const SECTIONS: &[Section] = &[
    ("traces", |_, report| {
        traces::replay(report);
        traces::checksums(report);
    }),
    ("refusals", |_, report| tap::refusals(report)),
    ("conversation", conversation::hold),
    ("cuts", |_, report| replug::every_cut(report)),
    ("replug", |_, report| {
        replug::everywhere(report);
        replug::with_ptys(report);
    }),
    ("nights", |_, report| faults::nights(report)),
    ("tap", |rig, report| {
        tap::nights(report);
        tap::pty(report);
        tap::real(rig, report);
    }),
    ("real-nights", |_, report| realtime::nights(report)),
    ("six-hours", |_, report| faults::six_hours(report)),
    ("program", |rig, report| {
        field::by_hand_controller(rig, report);
        field::stop_key(rig, report);
    }),
    ("light", |_, report| light::read_back(report)),
    ("exits", |_, report| exits::every_way(report)),
];

/// The seed of the day, unless `SCOTOPIC_RIG_SEED` says another: the same everywhere, so that CI can be repeated at a desk.
const SEED: u64 = 20_261_122;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let wanted: Vec<&String> = arguments.iter().filter(|argument| !argument.starts_with('-')).collect();
    let sections: Vec<&Section> = SECTIONS
        .iter()
        .filter(|(name, _)| wanted.is_empty() || wanted.iter().any(|word| name.contains(word.as_str())))
        .collect();
    if arguments.iter().any(|argument| argument == "--list") {
        sections.iter().for_each(|(name, _)| println!("{name}: test"));
        return ExitCode::SUCCESS;
    }
    let rig = match std::env::var_os("SCOTOPIC_RIG").map(PathBuf::from) {
        None => Rig::loopback(),
        Some(path) => match Rig::read(&path) {
            Ok(rig) => rig,
            Err(error) => {
                eprintln!("{error}. Nothing was opened.");
                return ExitCode::from(2);
            }
        },
    };
    let seed = std::env::var("SCOTOPIC_RIG_SEED").ok().and_then(|seed| seed.parse().ok()).unwrap_or(SEED);
    let mut report = Report::new(seed);
    inventory::take(&rig, &mut report);
    for (name, section) in sections {
        let began = Instant::now();
        println!("hil: {name} ...");
        let before = report.failures();
        if let Err(panic) = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| section(&rig, &mut report))) {
            let text =
                panic.downcast_ref::<String>().cloned().or(panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
            let why = format!("the section panicked: {}", text.unwrap_or_default());
            report.check("rig", *name, Outcome::Failed(why), began.elapsed());
        }
        let verdict = if report.failures() == before { "ok" } else { "FAILED" };
        println!("hil: {name} ... {verdict} ({:.1} s)", began.elapsed().as_secs_f64());
    }
    if !wanted.is_empty() {
        let skipped = SECTIONS.iter().filter(|(name, _)| !wanted.iter().any(|word| name.contains(word.as_str())));
        skipped.for_each(|(name, _)| report.not_run("rig", name, "not asked for on this command line"));
    }
    inventory::name_what_is_missing(&rig, &mut report);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/hil");
    report.write(&folder);
    let summary = report.summary();
    std::fs::write(folder.join("summary.txt"), &summary).unwrap();
    println!("{summary}\nthe report is in {}", folder.display());
    if report.failures() == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
