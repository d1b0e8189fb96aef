//! What a rig has measured: figures, histograms, what failed, what was not run and why. JSON, JUnit and a printed summary.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::Duration;

use hdrhistogram::Histogram;
use quick_junit::{NonSuccessKind, Report as JUnit, TestCase, TestCaseStatus, TestSuite};
use serde_json::{Value, json};

/// Times in microseconds, one microsecond to ten minutes, three digits.
pub(crate) fn histogram() -> Histogram<u64> {
    Histogram::new_with_bounds(1, 600_000_000, 3).unwrap()
}

/// Records a time.
pub(crate) fn record(into: &mut Histogram<u64>, time: Duration) {
    into.saturating_record(u64::try_from(time.as_micros()).unwrap_or(u64::MAX).max(1));
}

/// One figure: what was asked, what was measured.
#[derive(Debug, Clone)]
pub(crate) struct Figure {
    pub(crate) what: String,
    pub(crate) asked: String,
    pub(crate) measured: String,
    pub(crate) reached: bool,
}

/// How one check went.
#[derive(Debug, Clone)]
pub(crate) enum Outcome {
    Passed,
    Failed(String),
    NotRun(String),
}

#[derive(Debug, Clone)]
struct Check {
    section: &'static str,
    name: String,
    outcome: Outcome,
    took: Duration,
}

/// Everything that a run of the rig says.
#[derive(Debug)]
pub(crate) struct Report {
    pub(crate) seed: u64,
    inventory: BTreeMap<String, Value>,
    checks: Vec<Check>,
    figures: Vec<Figure>,
    times: BTreeMap<String, Histogram<u64>>,
    counts: BTreeMap<String, u64>,
}

impl Report {
    pub(crate) fn new(seed: u64) -> Report {
        Report {
            seed,
            inventory: BTreeMap::new(),
            checks: Vec::new(),
            figures: Vec::new(),
            times: BTreeMap::new(),
            counts: BTreeMap::new(),
        }
    }

    pub(crate) fn inventory(&mut self, key: &str, value: impl Into<Value>) {
        self.inventory.insert(key.into(), value.into());
    }

    pub(crate) fn check(&mut self, section: &'static str, name: impl Into<String>, outcome: Outcome, took: Duration) {
        self.checks.push(Check { section, name: name.into(), outcome, took });
    }

    /// A check that this rig cannot make. It counts neither as passed nor as failed.
    pub(crate) fn not_run(&mut self, section: &'static str, name: &str, why: &str) {
        self.check(section, name, Outcome::NotRun(why.into()), Duration::ZERO);
    }

    /// A figure that a person asked for. One that was not reached is shown so; whether that fails the run is the check's affair.
    pub(crate) fn figure(&mut self, what: &str, asked: &str, measured: impl Into<String>, reached: bool) {
        self.figures.push(Figure { what: what.into(), asked: asked.into(), measured: measured.into(), reached });
    }

    pub(crate) fn times(&mut self, what: &str, histogram: &Histogram<u64>) {
        self.times.entry(what.into()).or_insert_with(self::histogram).add(histogram).unwrap();
    }

    pub(crate) fn count(&mut self, what: &str, more: u64) {
        *self.counts.entry(what.into()).or_default() += more;
    }

    pub(crate) fn failures(&self) -> usize {
        self.checks.iter().filter(|check| matches!(check.outcome, Outcome::Failed(_))).count()
    }

    /// Writes report.json and junit.xml.
    pub(crate) fn write(&self, folder: &Path) {
        fs::create_dir_all(folder).unwrap();
        fs::write(folder.join("report.json"), serde_json::to_string_pretty(&self.json()).unwrap()).unwrap();
        fs::write(folder.join("junit.xml"), self.junit().to_string().unwrap()).unwrap();
    }

    fn json(&self) -> Value {
        let checks: Vec<Value> = self
            .checks
            .iter()
            .map(|check| {
                let (outcome, why) = match &check.outcome {
                    Outcome::Passed => ("passed", ""),
                    Outcome::Failed(why) => ("failed", why.as_str()),
                    Outcome::NotRun(why) => ("not run", why.as_str()),
                };
                json!({"section": check.section, "name": check.name, "outcome": outcome, "why": why,
                       "seconds": check.took.as_secs_f64()})
            })
            .collect();
        let figures: Vec<Value> = self
            .figures
            .iter()
            .map(|f| json!({"what": f.what, "asked": f.asked, "measured": f.measured, "reached": f.reached}))
            .collect();
        let times: BTreeMap<&String, Value> = self.times.iter().map(|(name, times)| (name, quantiles(times))).collect();
        json!({"seed": self.seed, "inventory": self.inventory, "figures": figures, "times_us": times,
               "counts": self.counts, "checks": checks})
    }

    fn junit(&self) -> JUnit {
        let mut junit = JUnit::new("scotopic rig");
        let mut suites: BTreeMap<&str, TestSuite> = BTreeMap::new();
        for check in &self.checks {
            let status = match &check.outcome {
                Outcome::Passed => TestCaseStatus::success(),
                Outcome::Failed(why) => {
                    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
                    status.set_message(why.as_str());
                    status
                }
                Outcome::NotRun(why) => {
                    let mut status = TestCaseStatus::skipped();
                    status.set_message(why.as_str());
                    status
                }
            };
            let mut case = TestCase::new(check.name.as_str(), status);
            case.set_classname(check.section).set_time(check.took);
            suites.entry(check.section).or_insert_with(|| TestSuite::new(check.section)).add_test_case(case);
        }
        junit.add_test_suites(suites.into_values());
        junit
    }

    /// The summary for people.
    pub(crate) fn summary(&self) -> String {
        let mut text = format!("\nrig report, seed {}\n", self.seed);
        for (key, value) in &self.inventory {
            text += &format!("  {key}: {}\n", value.as_str().map_or_else(|| value.to_string(), str::to_owned));
        }
        text += "figures (asked -> measured)\n";
        for f in &self.figures {
            let mark = if f.reached { "  reached " } else { "  MISSED  " };
            text += &format!("{mark} {}: {} -> {}\n", f.what, f.asked, f.measured);
        }
        text += "times in ms: p50 / p90 / p99 / max (how many)\n";
        for (name, times) in &self.times {
            let ms = |quantile: f64| times.value_at_quantile(quantile) as f64 / 1000.0;
            text += &format!(
                "  {name}: {:.1} / {:.1} / {:.1} / {:.1} ({})\n",
                ms(0.5),
                ms(0.9),
                ms(0.99),
                times.max() as f64 / 1000.0,
                times.len()
            );
        }
        text += "counts\n";
        for (name, count) in &self.counts {
            text += &format!("  {name}: {count}\n");
        }
        let mut told = [Vec::new(), Vec::new(), Vec::new()];
        for check in &self.checks {
            let line = |why: &str| format!("  {}: {}{why}\n", check.section, check.name);
            match &check.outcome {
                Outcome::Passed => {
                    told[0].push(format!("  {}: {} ({:.1} s)\n", check.section, check.name, check.took.as_secs_f64()));
                }
                Outcome::Failed(why) => told[1].push(line(&format!("\n      {}", why.replace('\n', "\n      ")))),
                Outcome::NotRun(why) => told[2].push(line(&format!(": {why}"))),
            }
        }
        for (title, lines) in ["passed", "FAILED", "not run, and why"].iter().zip(told) {
            text += &format!("{title}: {}\n{}", lines.len(), lines.concat());
        }
        text
    }
}

fn quantiles(times: &Histogram<u64>) -> Value {
    json!({"count": times.len(), "p50": times.value_at_quantile(0.5), "p90": times.value_at_quantile(0.9),
           "p99": times.value_at_quantile(0.99), "max": times.max()})
}
