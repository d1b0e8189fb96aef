//! The cable out and in again, under a new name, in the middle of a read, a write, a slew and a stop.
//!
//! Wiring: none. First under a virtual clock, at every moment; then with pseudo terminals that come back under other names, a
//! symbolic link leading to the newest as udev's /dev/serial/by-id does.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs::File;
use std::os::unix::fs::symlink;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use scotopic::hw::fault_line::{Cable, Mischief, Spell, When};
use scotopic::hw::mount::address::MountAddress;
use scotopic::hw::mount::belief::LinkState;
use scotopic::hw::mount::driver::{Ours, Settings as DriverSettings, Timing};
use scotopic::hw::mount::link::{Pump, opener};
use scotopic::hw::mount::order::{Order, Report as Said};
use scotopic::hw::mount::sim::Simulator;
use scotopic::hw::mount::sim::serve::{Listen, Server};
use scotopic::hw::mount::sim::settings::Settings;
use scotopic::sky::coords::Equatorial;
use scotopic::units::Angle;

use super::bench::Bench;
use super::night::virtual_clock;
use super::report::{Outcome, Report, histogram, record};

const PROMISED: Duration = Duration::from_secs(2);

fn target() -> Equatorial<scotopic::sky::coords::OfDate> {
    Equatorial::new(Angle::hours(9.0), Angle::degrees(65.0))
}

/// Connect, slew, stop, with one spell; then the mount is well again, has been ordered one slew, and is at rest.
fn play(spell: Spell) -> (Bench, Vec<String>) {
    let mut bench = Bench::virtually(Settings::default(), Cable::new(1, None, vec![spell]));
    let (mut slewn, mut stopped) = (false, false);
    while bench.now < Duration::from_secs(40) {
        let now = virtual_clock(&bench);
        bench.turn(now);
        if !slewn && now >= Duration::from_secs(3) && bench.belief().link == LinkState::Ready {
            slewn = true;
            bench.order(Order::Goto(target()), now);
        }
        if !stopped && now >= Duration::from_millis(5500) {
            stopped = true;
            bench.order(Order::Stop, now);
        }
        if stopped && now > Duration::from_secs(9) && bench.well() {
            break;
        }
    }
    bench.judge_stops();
    if !bench.well() {
        bench.truth.breaks(bench.now, format!("not well again: {:?}", bench.belief().link));
    }
    if bench.belief().counters.slews > 1 {
        bench.truth.breaks(bench.now, "the slew was ordered again");
    }
    let broken = std::mem::take(&mut bench.truth.broken);
    (bench, broken)
}

/// At every moment of eight seconds, and at every byte of what is said.
pub(crate) fn everywhere(report: &mut Report) {
    let began = Instant::now();
    let out = Duration::from_millis(700);
    let at = |when| Spell { when, ..Spell::at(Duration::ZERO, out, Mischief::Rename) };
    let mut spells: Vec<Spell> = (0..800).map(|step| at(When::At(Duration::from_millis(step * 10)))).collect();
    let from = [0, 2500, 3000, 5000, 5500].map(Duration::from_millis);
    for said in [":GR#", ":GD#", ":Sr09:00:00#", ":Sd+65*00:00#", ":MS#", "#:Q#:Qn#:Qs#:Qe#:Qw#"] {
        for bytes in 1..=said.len() {
            spells.extend(from.map(|from| at(When::Sent(from, said.as_bytes()[..bytes].to_vec()))));
        }
    }
    for bytes in 1..=10 {
        spells.extend(from.map(|from| at(When::Read(from, bytes))));
    }
    let (mut reconnects, mut stops, mut broken) = (histogram(), histogram(), Vec::new());
    let moments = spells.len();
    for spell in spells {
        let (bench, wrong) = play(spell.clone());
        reconnects.add(&bench.reconnects).unwrap();
        stops.add(&bench.stops).unwrap();
        broken.extend(wrong.into_iter().map(|what| format!("{:?}: {what}", spell.when)));
    }
    report.times("unplugged at every moment: port back to mount asked everything", &reconnects);
    report.times("unplugged at every moment: stop ordered to bytes taken", &stops);
    let most = Duration::from_micros(reconnects.max());
    let measured = format!(
        "p50 {:.2} s, p99 {:.2} s, max {:.2} s in {} reconnections, virtual clock",
        reconnects.value_at_quantile(0.5) as f64 / 1e6,
        reconnects.value_at_quantile(0.99) as f64 / 1e6,
        most.as_secs_f64(),
        reconnects.len()
    );
    report.figure("reconnect after replug, once the port is back", "< 2 s", measured, most < PROMISED);
    if most >= PROMISED {
        broken.push(format!("a reconnection took {most:?}"));
    }
    broken.truncate(20);
    let outcome = if broken.is_empty() { Outcome::Passed } else { Outcome::Failed(broken.join("\n")) };
    report.check(
        "mount",
        format!("unplugged at each of {moments} moments and replugged under a new name"),
        outcome,
        began.elapsed(),
    );
}

/// Every reply cut after every number of bytes, and held up there.
pub(crate) fn every_cut(report: &mut Report) {
    let began = Instant::now();
    let mut broken = Vec::new();
    for k in 0..48 {
        for mischief in [Mischief::Truncate(k), Mischief::Stall(k, Duration::from_millis(800))] {
            for from in [0, 1500, 3000, 5000].map(Duration::from_millis) {
                let (_, wrong) = play(Spell::at(from, Duration::from_millis(2500), mischief));
                broken.extend(wrong.into_iter().map(|what| format!("{mischief:?} from {from:?}: {what}")));
            }
        }
    }
    broken.truncate(20);
    let outcome = if broken.is_empty() { Outcome::Passed } else { Outcome::Failed(broken.join("\n")) };
    report.check("mount", "each reply cut, and held up, after each of its bytes", outcome, began.elapsed());
}

/// With pseudo terminals, in real time: when the plug is pulled, and how often each.
pub(crate) fn with_ptys(report: &mut Report) {
    let began = Instant::now();
    let moments = [
        "unplug=1.2,1",
        "unplug-at=:GR",
        "unplug-at=:GD",
        "unplug-at=:Sr",
        "unplug-at=:MS",
        "unplug=4.5,1",
        "unplug-at=:Q",
    ];
    let times = Mutex::new((histogram(), Vec::new(), BTreeMap::<&str, Duration>::new()));
    std::thread::scope(|scope| {
        for (number, moment) in moments.iter().cycle().take(3 * moments.len()).enumerate() {
            let times = &times;
            scope.spawn(move || {
                let outcome = one(number, moment);
                let mut times = times.lock().unwrap();
                match outcome {
                    Ok(took) => {
                        record(&mut times.0, took);
                        let longest = times.2.entry(moment).or_default();
                        *longest = took.max(*longest);
                    }
                    Err(what) => times.1.push(format!("{moment}: {what}")),
                }
            });
        }
    });
    let (times, broken, longest) = times.into_inner().unwrap();
    report.times("replugged pty under a new name: port back to mount asked everything", &times);
    let most = Duration::from_micros(times.max());
    for (moment, took) in longest {
        report.count(&format!("replugged pty, {moment}: longest, ms"), u64::try_from(took.as_millis()).unwrap());
    }
    let measured = format!("max {:.2} s in {} replugs of ptys, real time", most.as_secs_f64(), times.len());
    report.figure("reconnect after replug under a new name", "< 2 s", measured, most < PROMISED && broken.is_empty());
    let outcome = if broken.is_empty() { Outcome::Passed } else { Outcome::Failed(broken.join("\n")) };
    report.check(
        "mount",
        "ptys unplugged during read, write, slew and stop, back under new names",
        outcome,
        began.elapsed(),
    );
}

/// One replug; how long it took from the new name to a mount that has been asked everything.
fn one(number: usize, moment: &str) -> Result<Duration, String> {
    let folder = std::env::temp_dir().join(format!("scotopic-replug-{}-{number}", std::process::id()));
    std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    let link: PathBuf = folder.join("mount");
    let mut settings = Settings::default();
    settings.faults.switch(moment).map_err(|error| error.to_string())?;
    let ours = Ours { utc_at_start: settings.start, site: Some(settings.site) };
    let over = Arc::new(AtomicBool::new(false));
    let back: Arc<Mutex<Option<Instant>>> = Arc::default();
    let (ended, came, place) = (Arc::clone(&over), Arc::clone(&back), link.clone());
    let (told, name) = std::sync::mpsc::channel();
    let far = std::thread::spawn(move || {
        let mut server = Server::open(Simulator::new(settings), Listen::Pty).unwrap();
        // A slave that is kept open keeps its number: no other pty of this run comes under the name that has gone.
        let kept = RefCell::new(Vec::new());
        let lead = |endpoint: &str| {
            kept.borrow_mut().push(File::options().read(true).write(true).open(endpoint).unwrap());
            let new = place.with_extension("new");
            symlink(endpoint, &new).unwrap();
            std::fs::rename(&new, &place).unwrap();
        };
        lead(&server.endpoint());
        told.send(()).unwrap();
        server
            .serve(&|| ended.load(Ordering::Relaxed), &mut |endpoint| {
                lead(endpoint);
                *came.lock().unwrap() = Some(Instant::now());
            })
            .unwrap();
    });
    name.recv().map_err(|error| error.to_string())?;
    let address = MountAddress::Serial { path: link.to_string_lossy().into_owned(), baud: 9600 };
    let mut pump = Pump::new(DriverSettings::new(Timing::SERIAL, ours), opener(&address).unwrap());
    let start = Instant::now();
    let (mut slewn, mut stopped, mut took) = (false, false, None);
    while start.elapsed() < Duration::from_secs(25) {
        let now = start.elapsed();
        for report in pump.step(now).into_iter().flat_map(|update| update.reports) {
            if matches!(report, Said::Connected { .. })
                && let Some(back) = *back.lock().unwrap()
            {
                took = took.or(Some(back.elapsed()));
            }
        }
        if !slewn && now > Duration::from_secs(3) && pump.driver().belief().link == LinkState::Ready {
            slewn = true;
            pump.order(Order::Goto(target()), now);
        }
        if slewn && !stopped && now > Duration::from_millis(6500) {
            stopped = true;
            pump.order(Order::Stop, now);
        }
        let well = pump.driver().belief().link == LinkState::Ready && !pump.driver().belief().stopping;
        if took.is_some() && stopped && well {
            break;
        }
        if !pump.is_open() {
            std::thread::sleep(Duration::from_millis(5));
        }
    }
    drop(pump);
    over.store(true, Ordering::Relaxed);
    far.join().map_err(|_panicked| "the far end panicked".to_owned())?;
    let _ = std::fs::remove_dir_all(&folder);
    took.ok_or_else(|| "the mount was not found again within 25 s".into())
}
