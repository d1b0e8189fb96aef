//! Ten thousand nights with a bad cable under a virtual clock, and six hours of the same.
//!
//! Wiring: none. Driver, cable and simulated mount are in this process.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use hdrhistogram::Histogram;
use scotopic::hw::fault_line::{Cable, MENU, Mischief, Spell};
use scotopic::hw::mount::order::Order;
use scotopic::hw::mount::sim::settings::Settings;

use super::bench::Bench;
use super::night::{Night, virtual_clock};
use super::report::{Outcome, Report, histogram};

const SECTION: &str = "mount";
/// Nights under the virtual clock; `SCOTOPIC_RIG_NIGHTS` says otherwise.
const NIGHTS: u64 = 10_000;

/// What many nights have come to.
pub(crate) struct Tally {
    pub(crate) failures: Vec<String>,
    pub(crate) nights: u64,
    pub(crate) positions: u64,
    pub(crate) spoilt: u64,
    pub(crate) slowest: Duration,
    pub(crate) stops: Histogram<u64>,
    pub(crate) reconnects: Histogram<u64>,
    pub(crate) counters: BTreeMap<&'static str, u64>,
    pub(crate) struck: [u64; MENU.len()],
    pub(crate) virtual_s: f64,
}

impl Tally {
    pub(crate) fn new() -> Tally {
        Tally {
            failures: Vec::new(),
            nights: 0,
            positions: 0,
            spoilt: 0,
            slowest: Duration::ZERO,
            stops: histogram(),
            reconnects: histogram(),
            counters: BTreeMap::new(),
            struck: [0; MENU.len()],
            virtual_s: 0.0,
        }
    }

    /// Takes in what a bench has measured.
    pub(crate) fn add(&mut self, bench: &Bench) {
        self.nights += 1;
        self.positions += bench.truth.positions;
        self.spoilt += bench.truth.spoilt;
        self.slowest = self.slowest.max(bench.truth.slowest);
        self.stops.add(&bench.stops).unwrap();
        self.reconnects.add(&bench.reconnects).unwrap();
        let counters = bench.belief().counters;
        for (name, count) in [
            ("polls", counters.polls),
            ("retries", counters.retries),
            ("resyncs", counters.resyncs),
            ("reconnects", counters.reconnects),
            ("faults said", counters.faults),
            ("jumps not believed", counters.jumps),
            ("nights in which a flipped bit of a command switched the mount off", u64::from(bench.truth.switched_off)),
        ] {
            *self.counters.entry(name).or_default() += count;
        }
        for (sum, struck) in self.struck.iter_mut().zip(bench.cable.ledger().struck) {
            *sum += struck;
        }
        self.virtual_s += bench.now.as_secs_f64();
    }

    pub(crate) fn fail(&mut self, night: &Night, what: &str) {
        if self.failures.len() < 20 {
            self.failures.push(format!("seed {}: {what}\n  {night:?}", night.seed));
        }
    }

    /// Puts the tally into the report under a name.
    pub(crate) fn tell(&self, report: &mut Report, name: &str) {
        report.times(&format!("{name}: stop ordered to bytes taken by the port"), &self.stops);
        report.times(&format!("{name}: port back to mount asked everything"), &self.reconnects);
        for (counter, count) in &self.counters {
            report.count(&format!("{name}: {counter}"), *count);
        }
        report.count(&format!("{name}: positions believed, each held against the mount's own words"), self.positions);
        report.count(
            &format!("{name}: of these with a digit changed on the way, which no reader can notice"),
            self.spoilt,
        );
        report.count(
            &format!("{name}: slowest position, told to believed, ms"),
            u64::try_from(self.slowest.as_millis()).unwrap(),
        );
        report.count(&format!("{name}: hours of observing"), (self.virtual_s / 3600.0) as u64);
        for ((mischief, _), count) in MENU.iter().zip(self.struck) {
            report.count(&format!("{name}: {mischief} struck"), count);
        }
    }
}

/// Plays one night under the virtual clock; a panic is a failure like any other.
fn play(seed: u64, tally: &Mutex<Tally>) {
    let night = Night::of(seed);
    let played = catch_unwind(AssertUnwindSafe(|| {
        let mut bench = Bench::virtually(night.settings(), night.cable());
        let broken = night.play(&mut bench, virtual_clock);
        (bench, broken)
    }));
    let mut tally = tally.lock().unwrap();
    match played {
        Ok((bench, broken)) => {
            tally.add(&bench);
            if !broken.is_empty() {
                tally.fail(&night, &broken.join("\n  "));
            }
        }
        Err(panic) => {
            let text = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
            tally.fail(&night, &format!("panicked: {}", text.unwrap_or("?")));
        }
    }
}

/// Ten thousand nights on two threads.
pub(crate) fn nights(report: &mut Report) {
    let began = Instant::now();
    let wanted = std::env::var("SCOTOPIC_RIG_NIGHTS").ok().and_then(|n| n.parse().ok()).unwrap_or(NIGHTS);
    let (next, tally, seed) = (AtomicU64::new(0), Mutex::new(Tally::new()), report.seed);
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= wanted {
                        break;
                    }
                    play(seed.wrapping_add(number), &tally);
                }
            });
        }
    });
    let tally = tally.into_inner().unwrap();
    tally.tell(report, "virtual nights");
    let never: Vec<&str> = MENU.iter().zip(tally.struck).filter(|(_, n)| *n == 0).map(|((name, _), _)| *name).collect();
    let mut failures = tally.failures.clone();
    if wanted >= 1000 && !never.is_empty() {
        failures.push(format!("these faults never struck: {never:?}"));
    }
    let measured = format!("{} nights, {} broken", tally.nights, tally.failures.len());
    report.figure(
        "seeded fault runs on a virtual clock",
        "10,000 without a broken invariant",
        measured,
        failures.is_empty() && wanted >= NIGHTS,
    );
    let outcome = if failures.is_empty() { Outcome::Passed } else { Outcome::Failed(failures.join("\n")) };
    report.check(SECTION, format!("{wanted} nights with a bad cable, virtual clock"), outcome, began.elapsed());
}

/// Six hours with a fault every minute: memory, threads and descriptors stay.
pub(crate) fn six_hours(report: &mut Report) {
    let began = Instant::now();
    let hours = 6;
    let all: [Mischief; 12] = [
        Mischief::Drop(0.05),
        Mischief::Insert(0.05),
        Mischief::Truncate(3),
        Mischief::Stall(4, Duration::from_millis(700)),
        Mischief::Rename,
        Mischief::Swap(0.3),
        Mischief::Glue(0.3),
        Mischief::Flood(100_000),
        Mischief::Break,
        Mischief::Hold,
        Mischief::Slow(0),
        Mischief::Reset,
    ];
    let spells = (0..hours * 60).map(|minute| {
        Spell::at(Duration::from_secs(60 * minute as u64 + 30), Duration::from_secs(5), all[minute % all.len()])
    });
    let settings = Settings { seed: report.seed, ..Settings::default() };
    let mut bench = Bench::virtually(settings, Cable::new(report.seed, None, spells.collect()));
    let mut kept = Vec::new();
    for hour in 1..=hours as u64 {
        let end = Duration::from_secs(hour * 3600);
        while bench.now < end {
            let now = virtual_clock(&bench);
            bench.turn(now);
            // A stop in every tenth minute, in the middle of a spell.
            if now.as_millis() % 600_000 < 20 && now.as_secs() > 60 {
                bench.order(Order::Stop, now);
            }
        }
        bench.judge_stops();
        bench.reports.clear();
        bench.reports.shrink_to_fit();
        kept.push((resident_kib(), count("/proc/self/task"), count("/proc/self/fd")));
    }
    let mut tally = Tally::new();
    tally.add(&bench);
    tally.tell(report, "six hours");
    let mut broken = std::mem::take(&mut bench.truth.broken);
    let ((first_kib, threads, files), (last_kib, last_threads, last_files)) = (kept[0], kept[kept.len() - 1]);
    let grown = last_kib.saturating_sub(first_kib);
    let flat = grown <= 1024 && threads == last_threads && files == last_files;
    let measured = format!(
        "memory after 1 h {first_kib} KiB, after 6 h {last_kib} KiB; threads {threads} -> {last_threads}, descriptors {files} -> {last_files}"
    );
    report.figure(
        "six simulated hours, a fault every minute",
        "memory flat, no thread or descriptor leaked",
        measured.clone(),
        flat,
    );
    if !flat {
        broken.push(measured);
    }
    let outcome = if broken.is_empty() { Outcome::Passed } else { Outcome::Failed(broken.join("\n")) };
    report.check(SECTION, "six hours with a fault every minute", outcome, began.elapsed());
}

/// Memory that is resident, in KiB.
pub(crate) fn resident_kib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).unwrap_or_default();
    line.split_whitespace().nth(1).and_then(|kib| kib.parse().ok()).unwrap_or_default()
}

/// How many entries a folder has.
pub(crate) fn count(folder: &str) -> usize {
    std::fs::read_dir(folder).map(Iterator::count).unwrap_or_default()
}
