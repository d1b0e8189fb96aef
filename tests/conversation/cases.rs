//! What must come of each fault: how the line ends, and what the observer is told.

use scotopic::hw::mount::advice::Disagreement;
use scotopic::hw::mount::belief::LinkState;
use scotopic::hw::mount::order::{Fault, Order, Report};
use scotopic::hw::mount::sim::settings::Settings;

use super::table::Table;

/// One fault and its outcome after a minute with a go-to, a sync, a comparison of clocks and a stop.
pub(crate) struct Case {
    pub(crate) fault: &'static str,
    /// How the line stands at the end.
    end: End,
    /// What must be said in between.
    says: fn(&Report) -> bool,
    /// Whether a live position may be wrong, because the mount itself tells it wrong or its digits were changed on the way.
    may_be_wrong: bool,
}

/// How the line stands at the end.
#[derive(Clone, Copy, PartialEq)]
enum End {
    /// Conversation, and positions.
    Ready,
    /// No conversation that could be believed, and no live position.
    Dead,
    /// Either, by chance.
    Any,
}

const fn case(fault: &'static str, end: End, says: fn(&Report) -> bool) -> Case {
    Case { fault, end, says, may_be_wrong: false }
}

/// A fault that changes the digits themselves.
const fn wrong(fault: &'static str, end: End, says: fn(&Report) -> bool) -> Case {
    Case { fault, end, says, may_be_wrong: true }
}

fn connected(report: &Report) -> bool {
    matches!(report, Report::Connected { .. })
}

fn arrived(report: &Report) -> bool {
    matches!(report, Report::Arrived { .. })
}

fn fault(report: &Report) -> bool {
    matches!(report, Report::Fault(_) | Report::GotoFailed { .. } | Report::OrderFailed { .. })
}

fn lost(report: &Report) -> bool {
    matches!(report, Report::Lost(_))
}

macro_rules! disagrees {
    ($pattern:pat) => {
        |report| matches!(report, Report::Disagreement($pattern))
    };
}

pub(crate) const CASES: &[Case] = &[
    case("nak=0.2", End::Ready, |report| matches!(report, Report::BusyNak { .. })),
    case("silence=5,10", End::Ready, fault),
    wrong("drop=0.02", End::Any, fault),
    wrong("insert=0.02", End::Any, fault),
    wrong("flip=0.02", End::Any, fault),
    wrong("duplicate=0.02", End::Any, fault),
    wrong("deaf=0.01", End::Any, fault),
    case("half=0.1", End::Any, fault),
    case("truncate=3", End::Dead, fault),
    case("stall=0.1,700", End::Any, fault),
    case("delay=6000", End::Dead, fault),
    wrong("swap=0.1", End::Any, fault),
    case("glue=0.1", End::Any, fault),
    case("unsolicited=0.1", End::Any, fault),
    case("flood=8,1000000", End::Dead, |report| {
        matches!(report, Report::Fault(Fault::Babbling { .. } | Fault::Garbled { .. } | Fault::Silent))
    }),
    case("wrong-baud=on", End::Dead, fault),
    case("break=5,10", End::Ready, fault),
    case("loop=on", End::Dead, |report| matches!(report, Report::Fault(Fault::Looped))),
    case("echo=on", End::Any, fault),
    case("stale=on", End::Ready, arrived),
    case("hold-sync=on", End::Ready, |report| matches!(report, Report::Synced { .. })),
    case("unplug=5,3", End::Ready, lost),
    case("unplug-at=:MS", End::Ready, lost),
    case("park-silence=on", End::Ready, arrived),
    case("rollover=on", End::Ready, disagrees!(Disagreement::GpsRollover { year: 2007 })),
    case("zone-sign=on", End::Ready, disagrees!(Disagreement::ZoneSign { .. })),
    case("longitude-sign=on", End::Ready, disagrees!(Disagreement::LongitudeSign { .. })),
    case("clock-error=3600", End::Ready, disagrees!(Disagreement::Zone { .. })),
    case("clock-error=90", End::Ready, disagrees!(Disagreement::Clock { .. })),
    case("clock-jump=10,-3600", End::Ready, disagrees!(Disagreement::Zone { .. })),
    case("utc-date=on", End::Ready, arrived),
    case("sites-from-one=on", End::Ready, arrived),
    wrong("frozen=5", End::Ready, |report| !matches!(report, Report::Arrived { .. }) && !connected(report)),
    wrong("jump=0.05", End::Ready, |report| matches!(report, Report::Fault(Fault::Jump { .. }))),
    case("wrong-altitude=on", End::Ready, arrived),
    case("short=on", End::Ready, arrived),
    case("format-switch=10", End::Ready, arrived),
    case("degree=star", End::Ready, arrived),
    case("degree=colon", End::Ready, arrived),
    case("degree=e1", End::Dead, fault),
    case("product=Autostar", End::Ready, disagrees!(Disagreement::Clone { .. })),
    case("product=none", End::Ready, connected),
    case("escapes=on", End::Ready, connected),
    case("ignore-stop=3", End::Ready, |report| matches!(report, Report::Stopped)),
    case("ignore-stop=1000000", End::Ready, |report| matches!(report, Report::StopNotObeyed { .. })),
    case("refuse=2", End::Ready, |report| matches!(report, Report::GotoRefused { .. })),
    case("late-bar=3", End::Ready, arrived),
    case("reversed=on", End::Ready, arrived),
    case("keypad=45,e,5", End::Ready, arrived),
    case("push=10,5,-2", End::Ready, arrived),
    case("restart=30", End::Ready, disagrees!(Disagreement::NotAligned { .. })),
    case("unaligned=on", End::Ready, disagrees!(Disagreement::NotAligned { .. })),
    case("not-tracking=on", End::Ready, disagrees!(Disagreement::NotTracking)),
    case("asleep=on", End::Dead, |report| matches!(report, Report::Fault(Fault::Silent))),
];

impl Case {
    /// Plays the minute; what was wrong, if anything.
    pub(crate) fn try_it(&self) -> Option<String> {
        let mut settings = Settings { seed: 11, ..Settings::default() };
        settings.faults.switch(self.fault).unwrap();
        let mut table = Table::new(settings);
        table.run(7.0);
        let target = table.above(40.0, -10.0);
        table.order(Order::Goto(target));
        table.run(23.0);
        table.order(Order::Sync(target));
        table.run(5.0);
        table.order(Order::Compare);
        table.run(9.0);
        table.order(Order::Goto(table.above(120.0, 0.0)));
        table.run(3.0);
        table.order(Order::Stop);
        table.run(33.0);
        self.judge(&table).map(|wrong| format!("{}: {wrong}\n    {:?}", self.fault, interesting(&table.reports)))
    }

    fn judge(&self, table: &Table) -> Option<String> {
        let belief = table.belief();
        let live = belief.pointing(table.now).is_some_and(|pointing| !pointing.stale);
        match self.end {
            End::Ready if belief.link != LinkState::Ready || !live => {
                return Some(format!("it ends {:?}, position live: {live}", belief.link));
            }
            End::Dead if live => return Some("a position is shown as live".into()),
            _ => {}
        }
        if !table.said(self.says) {
            return Some("what had to be said was not".into());
        }
        if !self.may_be_wrong && table.worst_live_deg > 0.1 {
            return Some(format!("a live position was {} degrees off while all was calm", table.worst_live_deg));
        }
        let unprintable = table.reports.iter().map(ToString::to_string).find(|text| text.chars().any(char::is_control));
        unprintable.map(|text| format!("a report carries control characters: {text:?}"))
    }
}

/// The reports without the positions, the last forty.
fn interesting(reports: &[Report]) -> Vec<String> {
    let mut told: Vec<String> =
        reports.iter().filter(|report| !matches!(report, Report::Position)).map(ToString::to_string).collect();
    told.drain(..told.len().saturating_sub(40));
    told
}
