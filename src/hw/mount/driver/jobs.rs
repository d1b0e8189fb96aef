//! Orders, made into commands one after the other, and what their answers mean.

use std::collections::VecDeque;
use std::time::Duration;

use super::watch::SlewWatch;
use super::{Driver, MOST_ORDERS, Stage};
use crate::hw::mount::belief::{Clock, Display, Known, Precision};
use crate::hw::mount::command::Command;
use crate::hw::mount::order::{Fault, Key, Order, Report};
use crate::hw::mount::reply::Reply;
use crate::sky::site::Site;

/// A command of an order is sent this often at most.
const MOST_TRIES: u32 = 3;

/// So long after a synchronisation the position may jump.
const SYNC_SETTLES: Duration = Duration::from_secs(3);

/// An order under way.
#[derive(Debug)]
pub(super) struct Job {
    order: Order,
    steps: VecDeque<Command>,
    tries: u32,
}

/// What is checked when clock and site have been read again.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Verify {
    /// The site that was set.
    Site(Site),
    /// The clock that was set; whether the other reading of "date" has been tried.
    Clock { offset_hours: f64, date: i64, retried: bool },
}

impl Driver {
    /// Takes an order.
    pub fn order(&mut self, order: Order, now: Duration) {
        match order {
            Order::Stop => return self.begin_stop(now),
            Order::MoveEnd(direction) => return self.end_move(direction, now),
            Order::Move(direction, rate) if self.renew_move(direction, rate, now) => return,
            _ => {}
        }
        let name = name(&order);
        let refused = match self.stage {
            Stage::Ready if self.stop.is_some() => Some("a stop has not been obeyed yet"),
            Stage::Ready if matches!(order, Order::Move(..)) && self.slew.is_some() => {
                Some("a slew is under way: stop it first")
            }
            Stage::Ready => None,
            Stage::Closed => Some("there is no line to the mount"),
            Stage::Finding(_) | Stage::Asking => Some("the mount is still being asked who it is"),
        };
        if let Some(why) = refused {
            self.report(Report::OrderFailed { order: name, why: why.into() });
        } else if self.orders.len() >= MOST_ORDERS {
            self.report(Report::Fault(Fault::QueueFull(MOST_ORDERS)));
        } else {
            self.orders.push_back(order);
            self.tick(now);
        }
    }

    /// The next command of the order under way, or of the next order.
    pub(super) fn next_of_job(&mut self, now: Duration) -> Option<Command> {
        loop {
            if let Some(command) = self.job.as_ref().and_then(|job| job.steps.front()) {
                return Some(command.clone());
            }
            self.job = None;
            let order = self.orders.pop_front()?;
            let steps = self.steps(&order, now);
            self.job = Some(Job { order, steps, tries: 0 });
        }
    }

    fn steps(&mut self, order: &Order, now: Duration) -> VecDeque<Command> {
        let precision = self.belief.precision.value().copied().unwrap_or(Precision::Long);
        let steps = match order {
            Order::Goto(target) => vec![
                Command::TargetRa(target.ra(), precision),
                Command::TargetDec(target.dec(), precision),
                Command::Slew,
            ],
            Order::Sync(target) => vec![
                Command::TargetRa(target.ra(), precision),
                Command::TargetDec(target.dec(), precision),
                Command::Sync,
            ],
            Order::Move(direction, rate) => {
                self.begin_move(*direction, *rate, now);
                let speed = (self.rate != Some(*rate)).then_some(Command::Speed(*rate));
                self.rate = Some(*rate);
                speed.into_iter().chain([Command::Move(*direction)]).collect()
            }
            Order::SetSite(site) => {
                self.settings.ours.site = Some(*site);
                vec![Command::SetLatitude(site.latitude), Command::SetLongitude(site.longitude)]
            }
            Order::SetClock(utc, offset_hours) => {
                let local = utc.0 + offset_hours * 3600.0;
                let summer = self.facts.summer.then_some(Command::SetSummer(false));
                summer
                    .into_iter()
                    .chain([
                        Command::SetZone(*offset_hours),
                        Command::SetTime(local.rem_euclid(86_400.0) as u32),
                        Command::SetDate(local.div_euclid(86_400.0) as i64),
                    ])
                    .collect()
            }
            Order::ReadDisplay => vec![Command::Display],
            // The display is read first: blind presses can reach the firmware loader's menu.
            Order::PressKey(key) => vec![Command::Display, Command::Press(*key), Command::Display],
            Order::Ask(question) => vec![Command::Ask(question.clone())],
            Order::Compare => {
                self.ask_to_compare();
                Vec::new()
            }
            Order::Stop | Order::MoveEnd(_) => Vec::new(), // done as they come
        };
        steps.into()
    }

    pub(super) fn job_answered(&mut self, command: &Command, reply: Reply, now: Duration) {
        let Some(mut job) = self.job.take() else { return };
        job.steps.pop_front();
        job.tries = 0;
        match (&job.order, reply) {
            (Order::Goto(_), Reply::Taken(false)) => {
                self.belief.counters.refused += 1;
                let reason = format!("it does not take the target ({})", command.name());
                return self.report(Report::GotoRefused { reason });
            }
            (Order::Goto(target), Reply::SlewBegun) => {
                self.belief.counters.slews += 1;
                self.slew = Some(SlewWatch::new(*target, now));
                self.belief.slewing_to = Some(*target);
                self.poll_at = now;
                self.report(Report::SlewStarted);
            }
            (_, Reply::SlewRefused(reason)) => {
                self.belief.counters.refused += 1;
                self.report(Report::GotoRefused { reason });
            }
            (Order::Sync(_), Reply::Text(reply)) => {
                self.track.allow_jump(now + SYNC_SETTLES);
                self.poll_at = now;
                self.report(Report::Synced { reply });
            }
            (Order::Ask(question), Reply::Text(text)) => {
                let command = format!(":{}#", question.letters());
                self.report(Report::Answer { command, text });
            }
            (order, Reply::Taken(false)) => {
                let why = format!("the mount does not take {}", command.name());
                return self.report(Report::OrderFailed { order: name(order), why });
            }
            (order, Reply::Display(display)) => {
                if matches!(order, Order::PressKey(Key::Enter)) && job.steps.len() > 1 && offers_download(&display) {
                    let why = "ENTER would open the firmware loader (Download)".to_owned();
                    return self.report(Report::OrderFailed { order: name(order), why });
                }
                self.belief.display = Known::Confirmed { value: display, at: now };
                if job.steps.is_empty() {
                    self.report(Report::Display);
                }
            }
            _ => {}
        }
        if !job.steps.is_empty() {
            self.job = Some(job);
            return;
        }
        match job.order {
            Order::SetSite(site) => {
                self.belief.site = Known::Assumed { value: site, at: now };
                self.verify = Some(Verify::Site(site));
                self.ask_to_compare();
            }
            Order::SetClock(utc, offset_hours) => {
                self.belief.clock = Known::Assumed { value: Clock { utc, offset_hours }, at: now };
                let date = (utc.0 + offset_hours * 3600.0).div_euclid(86_400.0) as i64;
                let retried = matches!(self.verify, Some(Verify::Clock { retried: true, .. }));
                self.verify = Some(Verify::Clock { offset_hours, date, retried });
                self.ask_to_compare();
            }
            _ => {}
        }
    }

    pub(super) fn job_failed(&mut self, command: &Command, fault: Fault, now: Duration) {
        self.report(Report::Fault(fault.clone()));
        let Some(job) = &mut self.job else { return };
        job.tries += 1;
        let busy = matches!(fault, Fault::Busy { .. });
        if command.may_be_repeated() && !busy && job.tries < MOST_TRIES {
            self.belief.counters.retries += 1;
            return;
        }
        let Some(job) = self.job.take() else { return };
        match (job.order, command) {
            (Order::Goto(target), Command::Slew) if !busy => {
                // The order may have been heard and its answer lost: watch what the mount does, order nothing again.
                self.slew = Some(SlewWatch::new(target, now));
                self.belief.slewing_to = Some(target);
                self.report(Report::GotoFailed { why: fault });
            }
            (Order::Goto(_), _) => self.report(Report::GotoFailed { why: fault }),
            (Order::Move(direction, _), _) => self.end_move(direction, now),
            (order, _) => self.report(Report::OrderFailed { order: name(&order), why: fault.to_string() }),
        }
    }

    /// Says of the order under way, and of those that wait, that they came to nothing.
    pub(super) fn fail_job(&mut self, why: &str) {
        let failed: Vec<Order> =
            self.job.take().map(|job| job.order).into_iter().chain(self.orders.drain(..)).collect();
        for order in failed {
            self.report(Report::OrderFailed { order: name(&order), why: why.into() });
        }
    }

    /// Clock and site were read again: did the mount take what it was given?
    pub(super) fn verify_order(&mut self, now: Duration) {
        use crate::hw::mount::advice::Disagreement as D;
        let Some(verify) = self.verify.take() else { return };
        let off: Vec<D> = self.belief.decision.iter().flat_map(|decision| decision.disagreements.clone()).collect();
        match verify {
            Verify::Site(_) => match off.iter().find(|d| matches!(d, D::Site { .. } | D::LongitudeSign { .. })) {
                None => self.report(Report::SiteSet),
                Some(why) => self.report(Report::OrderFailed { order: "setting the site", why: why.to_string() }),
            },
            Verify::Clock { offset_hours, date, retried } => {
                let wrong = |d: &&D| {
                    matches!(
                        d,
                        D::Clock { .. }
                            | D::Zone { .. }
                            | D::ZoneSign { .. }
                            | D::Date { .. }
                            | D::GpsRollover { .. }
                            | D::Sidereal { .. }
                    )
                };
                let Some(why) = off.iter().find(wrong) else { return self.report(Report::ClockSet) };
                // Papers and drivers disagree whether the date is local or UTC: sidereal time tells, by 3 m 56 s.
                let by_a_day = matches!(why, D::Sidereal { seconds } if (seconds.abs() - 236.6).abs() < 10.0);
                let utc_date = self.utc(now).0.div_euclid(86_400.0) as i64;
                if by_a_day && !retried && utc_date != date {
                    self.verify = Some(Verify::Clock { offset_hours, date, retried: true });
                    let order = Order::SetClock(self.utc(now), offset_hours);
                    self.job = Some(Job { order, steps: [Command::SetDate(utc_date)].into(), tries: 0 });
                } else {
                    self.report(Report::OrderFailed { order: "setting the clock", why: why.to_string() });
                }
            }
        }
    }

    /// Drops the order of a move that has been ended before it was sent.
    pub(super) fn forget_moves(&mut self, direction: Option<crate::hw::mount::order::Direction>) {
        let meant = |order: &Order| match order {
            Order::Move(other, _) => direction.is_none_or(|direction| direction == *other),
            _ => false,
        };
        self.orders.retain(|order| !meant(order));
        if self.job.as_ref().is_some_and(|job| meant(&job.order)) {
            self.job = None;
        }
    }
}

/// An order in words.
fn name(order: &Order) -> &'static str {
    match order {
        Order::Goto(_) => "the go-to",
        Order::Stop => "the stop",
        Order::Sync(_) => "the synchronisation",
        Order::Move(..) => "the move",
        Order::MoveEnd(_) => "ending the move",
        Order::SetSite(_) => "setting the site",
        Order::SetClock(..) => "setting the clock",
        Order::ReadDisplay => "reading the hand controller",
        Order::PressKey(_) => "pressing a key",
        Order::Ask(_) => "the question",
        Order::Compare => "comparing clock and site",
    }
}

/// Whether the hand controller stands in the menu of the firmware loader.
fn offers_download(display: &Display) -> bool {
    let text = format!("{}{}", display.top, display.bottom).to_lowercase();
    text.contains("download")
}
