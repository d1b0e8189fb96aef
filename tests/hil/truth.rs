//! The invariants, held against what the simulated mount knows that it said.

use std::time::Duration;

use scotopic::hw::fault_line::Ledger;
use scotopic::hw::mount::belief::Belief;
use scotopic::hw::mount::order::Report;
use scotopic::hw::mount::sim::Told;

/// A position is believed this long after the mount told it, at most: the two questions of a poll and the patience with each.
const MOST_TRANSIT: Duration = Duration::from_millis(2500);
/// A position is shown as live this long after it was believed, at most.
const STALE: Duration = Duration::from_secs(3);
/// A stop must be on its way in this time.
pub(crate) const STOP_BUDGET: Duration = Duration::from_millis(50);
/// A change of a byte into another with a meaning of its own spoils what is believed for so long.
const SPOILT: Duration = Duration::from_secs(3);

/// What a run has broken, and what it has measured.
#[derive(Debug, Default)]
pub(crate) struct Truth {
    pub(crate) broken: Vec<String>,
    /// Positions believed, and those of them that no reader could have known to be wrong.
    pub(crate) positions: u64,
    pub(crate) spoilt: u64,
    /// A command that was changed on the way has switched the mount off.
    pub(crate) switched_off: bool,
    /// The longest way of a position, from the mount's telling it to its being believed.
    pub(crate) slowest: Duration,
}

impl Truth {
    pub(crate) fn breaks(&mut self, now: Duration, what: impl Into<String>) {
        if self.broken.len() < 8 {
            self.broken.push(format!("at {:.3} s: {}", now.as_secs_f64(), what.into()));
        }
    }

    /// A position was just believed: the mount told it, to this very question, and not long ago; or it is known that a digit was
    /// changed on the way, against which the protocol has no defence.
    pub(crate) fn position_believed<'a>(
        &mut self,
        belief: &Belief,
        told: impl DoubleEndedIterator<Item = &'a Told> + Clone,
        ledger: &Ledger,
        now: Duration,
    ) {
        self.positions += 1;
        let Some(position) = belief.position.confirmed() else {
            return self.breaks(now, "a position was reported and none is confirmed");
        };
        let ra = (position.ra().to_hours() * 36_000.0).round() as i64;
        let dec = (position.dec().to_arcseconds()).round() as i64;
        let recent = told.rev().take_while(|told| now.saturating_sub(told.at) <= MOST_TRANSIT);
        let at = |command: &[u8], wanted: i64, read: fn(&[u8]) -> Option<i64>| {
            recent.clone().find(|told| told.command == command && read(&told.reply) == Some(wanted)).map(|told| told.at)
        };
        match (at(b"GR", ra % 864_000, tenths_of_seconds), at(b"GD", dec, arcseconds)) {
            (Some(ra_at), Some(dec_at)) => {
                self.slowest = self.slowest.max(now.saturating_sub(ra_at.min(dec_at)));
            }
            _ if ledger.altered.is_some_and(|at| now.saturating_sub(at) <= SPOILT) => self.spoilt += 1,
            (ra_at, dec_at) => {
                let last: Vec<String> = recent
                    .clone()
                    .take(6)
                    .map(|told| {
                        format!(
                            "{:.3} {} {}",
                            told.at.as_secs_f64(),
                            told.command.escape_ascii(),
                            told.reply.escape_ascii()
                        )
                    })
                    .collect();
                self.breaks(
                    now,
                    format!(
                        "the mount never told RA {} s (told: {ra_at:?}), dec {dec}\" (told: {dec_at:?}); it told {last:?}",
                        ra as f64 / 10.0
                    ),
                );
            }
        }
    }

    /// What is shown as live now is not old.
    pub(crate) fn shown(&mut self, belief: &Belief, now: Duration) {
        let live = belief.pointing(now).is_some_and(|pointing| !pointing.stale);
        let age = belief.position.age(now);
        if live && age.is_none_or(|age| age > STALE) {
            self.breaks(now, format!("a position {age:?} old is shown as live"));
        }
    }

    /// What is said to the observer can be shown to him.
    pub(crate) fn said(&mut self, reports: &[Report], now: Duration) {
        if reports.len() > 512 {
            self.breaks(now, format!("{} reports in one step", reports.len()));
        }
        for report in reports.iter().filter(|report| **report != Report::Position) {
            let text = report.to_string();
            if text.chars().any(char::is_control) || text.len() > 1000 {
                self.breaks(now, format!("a report that cannot be shown: {text:?}"));
            }
        }
    }
}

/// `HH:MM:SS#` or `HH:MM.T#` in tenths of seconds of time. A reading of our own, not the driver's.
fn tenths_of_seconds(reply: &[u8]) -> Option<i64> {
    let text = std::str::from_utf8(reply).ok()?.strip_suffix('#')?;
    let number = |range: std::ops::Range<usize>| text.get(range)?.parse::<i64>().ok();
    match text.len() {
        8 => Some((number(0..2)? * 3600 + number(3..5)? * 60 + number(6..8)?) * 10),
        7 => Some((number(0..2)? * 3600 + number(3..5)? * 60 + number(6..7)? * 6) * 10),
        _ => None,
    }
}

/// `sDD?MM?SS#` or `sDD?MM#` in arcseconds.
fn arcseconds(reply: &[u8]) -> Option<i64> {
    let reply = reply.strip_suffix(b"#")?;
    let number = |range: std::ops::Range<usize>| std::str::from_utf8(reply.get(range)?).ok()?.parse::<i64>().ok();
    let size = match reply.len() {
        9 => number(1..3)? * 3600 + number(4..6)? * 60 + number(7..9)?,
        6 => number(1..3)? * 3600 + number(4..6)? * 60,
        _ => return None,
    };
    Some(if reply[0] == b'-' { -size } else { size })
}
