//! Positions twice a second, and everything that moves: slews watched to their end, stops repeated until they are obeyed,
//! moves by hand that end by themselves.

use std::time::Duration;

use super::track::{Gate, Sample};
use super::{Driver, HalfPosition, NO_POSITION, Stage};
use crate::hw::mount::belief::{Aligned, Known, Precision, Tracking};
use crate::hw::mount::command::Command;
use crate::hw::mount::estimate::{self, Estimate};
use crate::hw::mount::order::{Direction, Fault, Rate, Report};
use crate::hw::mount::reply::Reply;
use crate::sky::coords::{Equatorial, OfDate};
use crate::units::Angle;

/// Between the beginnings of two polls.
const POLL_EVERY: Duration = Duration::from_millis(500);
/// The same while the telescope moves.
const POLL_MOVING: Duration = Duration::from_millis(200);
/// Alignment and tracking are asked for this often.
pub(super) const STATUS_EVERY: Duration = Duration::from_secs(10);
/// A stop is sent again after this while the position is not still; after the alarm less often.
const STOP_EVERY: Duration = Duration::from_millis(500);
const STOP_ALARMED: Duration = Duration::from_secs(1);
/// From 8 degrees a second a telescope takes some 3 s to stop: after twice that it does not obey.
const STOP_ALARM: Duration = Duration::from_secs(6);
const ALARM_EVERY: Duration = Duration::from_secs(5);
/// "Not moving" is not believed this soon after a slew was ordered, unless it is at its target (AudeLA's wait).
const SLEW_GRACE: Duration = Duration::from_secs(5);
const AT_TARGET: Angle = Angle::arcminutes(10.0);
/// A slew that ends within this of its target has arrived: a poorly aligned mount may correct itself at the end.
const ARRIVED: Angle = Angle::degrees(0.5);
/// A declination in another form than its right ascension is half a reply, or somebody has changed the form; a mount that
/// answers so three times in a row speaks so.
const MOST_TWO_FORMS: u32 = 3;
/// One `:Q` is sometimes missed: the end of a move is sent twice.
const END_AGAIN: Duration = Duration::from_millis(100);

/// A slew of ours.
#[derive(Debug, Clone, Copy)]
pub(super) struct SlewWatch {
    target: Equatorial<OfDate>,
    since: Duration,
    bars: bool,
}

impl SlewWatch {
    pub(super) fn new(target: Equatorial<OfDate>, since: Duration) -> SlewWatch {
        SlewWatch { target, since, bars: true }
    }
}

/// A stop that has not been seen to be obeyed.
#[derive(Debug, Clone, Copy)]
pub(super) struct StopWatch {
    since: Duration,
    again_at: Duration,
    alarm_at: Duration,
    alarmed: bool,
}

impl StopWatch {
    /// How long ago the stop was ordered.
    pub(super) fn age(&self, now: Duration) -> Duration {
        now.saturating_sub(self.since)
    }
}

/// A move by hand.
#[derive(Debug, Clone, Copy)]
pub(super) struct Move {
    direction: Direction,
    rate: Rate,
    until: Duration,
}

impl Driver {
    /// The next command of a poll, if one is due.
    pub(super) fn next_poll(&mut self, now: Duration) -> Option<Command> {
        if self.polls.is_empty() {
            if now >= self.compare_at && self.stop.is_none() && !self.moving() {
                self.compare_at = now + NO_POSITION;
                self.ask_to_compare();
                return None;
            }
            if now < self.poll_at {
                return None;
            }
            let fast = self.moving() || self.track.waits();
            self.poll_at = now + if fast { POLL_MOVING } else { POLL_EVERY };
            self.polls.extend([Command::Ra, Command::Dec]);
            if self.slew.is_some() {
                self.polls.push_back(Command::Bars);
            }
            if now >= self.status_at && self.dialect.status && self.stop.is_none() && self.slew.is_none() {
                self.status_at = now + STATUS_EVERY;
                self.polls.push_back(Command::Status);
            }
        }
        self.polls.front().cloned()
    }

    pub(super) fn poll_answered(&mut self, _command: &Command, reply: Reply, now: Duration) {
        self.polls.pop_front();
        match reply {
            Reply::Ra(ra, precision) => {
                self.ra = Some(HalfPosition { ra, form: precision, at: now });
                self.learn_precision(precision, now);
            }
            Reply::Dec(dec, precision) => self.take_position(dec, precision, now),
            Reply::Bars(bars) => self.take_bars(bars, now),
            Reply::Status(alignment) => {
                let changed = self.belief.alignment.value() != Some(&alignment);
                self.belief.alignment = Known::Confirmed { value: alignment, at: now };
                if changed {
                    self.compare_at = now;
                }
            }
            _ => {}
        }
    }

    /// A declination completes a position: one moment, one form, the gate, what it says of the motion, and the estimate between polls.
    pub(super) fn take_position(&mut self, dec: Angle, form: Precision, now: Duration) {
        let Some(half) = self.ra.take() else { return };
        let two_forms = half.form != form && self.two_forms < MOST_TWO_FORMS;
        self.two_forms = if half.form == form { 0 } else { self.two_forms + 1 };
        // Halves of two positions are none: the declination came after a repetition, or is the rest of a longer reply.
        if two_forms || now.saturating_sub(half.at) > self.settings.timing.first_byte * 2 {
            self.poll_at = now;
            return;
        }
        let ra = half.ra;
        self.position_due = now + NO_POSITION;
        let sample = Sample { position: Equatorial::new(ra, dec), at: now };
        self.belief.counters.polls += 1;
        match self.track.take(sample, self.moving()) {
            Gate::Passed => {}
            Gate::Held { jump, seconds, impossible } => {
                self.poll_at = now;
                self.belief.counters.jumps += u64::from(impossible);
                if impossible {
                    self.report(Report::Fault(Fault::Jump { degrees: jump.to_degrees(), seconds }));
                }
                return;
            }
        }
        let told = self.belief.alignment.value().map(|alignment| alignment.tracking == Tracking::On);
        let motion = self.track.motion(self.ordered_motion(), told);
        let stars = self.belief.alignment.value().and_then(|alignment| match alignment.aligned {
            Aligned::Stars(stars) => Some(stars),
            _ => None,
        });
        let uncertainty = estimate::uncertainty(stars, self.precision());
        self.belief.estimate = Some(match &self.belief.estimate {
            Some(before) => before.with(sample.position, motion, uncertainty, now),
            None => Estimate::new(sample.position, motion, uncertainty, now),
        });
        self.belief.position = Known::Confirmed { value: sample.position, at: now };
        self.belief.motion = Known::Confirmed { value: motion, at: now };
        self.report(Report::Position);
        if let Some(stop) = self.stop
            && self.track.still_since(stop.since, self.precision())
        {
            self.stop = None;
            self.belief.stopping = false;
            self.report(Report::Stopped);
        }
    }

    /// The distance bars, which come last in a poll: has the slew ended?
    pub(super) fn take_bars(&mut self, bars: bool, now: Duration) {
        let Some(slew) = &mut self.slew else { return };
        slew.bars = bars;
        let (slew, precision) = (*slew, self.precision());
        let Some(position) = self.belief.position.value() else { return };
        let off_by = position.separation(&slew.target);
        let believable = off_by <= AT_TARGET || now.saturating_sub(slew.since) >= SLEW_GRACE;
        if !slew.bars && believable && self.track.still_since(slew.since, precision) {
            self.slew = None;
            self.belief.slewing_to = None;
            self.report(if off_by <= ARRIVED { Report::Arrived { off_by } } else { Report::EndedShort { off_by } });
        }
    }

    fn precision(&self) -> Precision {
        self.belief.precision.value().copied().unwrap_or(Precision::Long)
    }

    /// Whether motion is under way or expected.
    fn moving(&self) -> bool {
        self.slew.is_some()
            || self.stop.is_some()
            || !self.moves.is_empty()
            || self.belief.motion.value() == Some(&crate::sky::pointing::Motion::Slewing)
    }

    /// Whether motion that blurs the view has been ordered: not guiding, which the picture follows.
    fn ordered_motion(&self) -> bool {
        self.slew.is_some() || self.moves.iter().any(|m| m.rate != Rate::Guide)
    }

    /// Sends the stop ahead of everything and goes on until the position is still.
    pub(super) fn begin_stop(&mut self, now: Duration) {
        let since = self.stop.map_or(now, |stop| stop.since);
        self.orders.clear();
        self.job = None;
        self.verify = None;
        self.questions.retain(|_| self.stage == Stage::Asking);
        self.polls.clear();
        self.slew = None;
        self.moves.clear();
        self.ends.clear();
        self.belief.slewing_to = None;
        self.belief.moving_by_order = false;
        self.belief.stopping = true;
        self.stop = Some(StopWatch {
            since,
            again_at: now + STOP_EVERY,
            alarm_at: since.max(now.saturating_sub(STOP_ALARM)) + STOP_ALARM,
            alarmed: false,
        });
        if self.stage == Stage::Closed {
            self.report(Report::StopNotObeyed { after: Duration::ZERO, answers: false });
            return;
        }
        self.wire.stop(now);
        self.poll_at = now;
        self.report(Report::Stopping);
    }

    /// Renews a move by hand that is under way at this rate.
    pub(super) fn renew_move(&mut self, direction: Direction, rate: Rate, now: Duration) -> bool {
        let until = now + self.settings.move_bound;
        match self.moves.iter_mut().find(|m| m.direction == direction && m.rate == rate) {
            Some(under_way) => {
                under_way.until = until;
                true
            }
            None => false,
        }
    }

    /// Notes a move by hand that is about to be ordered; one the other way, or at another rate, is ended first.
    pub(super) fn begin_move(&mut self, direction: Direction, rate: Rate, now: Duration) {
        let across = |other: Direction| {
            use Direction::{East, North, South, West};
            matches!((direction, other), (North | South, North | South) | (East | West, East | West))
        };
        let ended: Vec<Direction> = self.moves.iter().map(|m| m.direction).filter(|d| across(*d)).collect();
        for other in ended {
            self.moves.retain(|m| m.direction != other);
            self.wire.interject(&Command::MoveEnd(other).bytes());
        }
        self.moves.push(Move { direction, rate, until: now + self.settings.move_bound });
        self.belief.moving_by_order = true;
        self.poll_at = now;
    }

    /// Ends a move by hand, now and once more.
    pub(super) fn end_move(&mut self, direction: Direction, now: Duration) {
        self.moves.retain(|m| m.direction != direction);
        self.forget_moves(Some(direction));
        self.belief.moving_by_order = !self.moves.is_empty();
        if self.stage == Stage::Closed {
            return;
        }
        self.wire.interject(&Command::MoveEnd(direction).bytes());
        self.ends.push((now + END_AGAIN, direction));
        self.ends.truncate(16);
        self.poll_at = now;
    }

    /// What is due by the clock.
    pub(super) fn keep_watch(&mut self, now: Duration) {
        let expired: Vec<Direction> = self.moves.iter().filter(|m| now >= m.until).map(|m| m.direction).collect();
        for direction in expired {
            self.end_move(direction, now);
            self.report(Report::MoveBounded(direction));
        }
        let due: Vec<Direction> = self.ends.iter().filter(|(at, _)| now >= *at).map(|(_, d)| *d).collect();
        self.ends.retain(|(at, _)| now < *at);
        for direction in due.into_iter().filter(|d| self.moves.iter().all(|m| m.direction != *d)) {
            self.wire.interject(&Command::MoveEnd(direction).bytes());
        }
        let Some(stop) = &mut self.stop else { return };
        let mut alarm = None;
        if now >= stop.alarm_at {
            stop.alarm_at = now + ALARM_EVERY;
            stop.alarmed = true;
            alarm = Some(now.saturating_sub(stop.since));
        }
        if now >= stop.again_at {
            stop.again_at = now + if stop.alarmed { STOP_ALARMED } else { STOP_EVERY };
            self.wire.interject(crate::hw::mount::command::STOP);
        }
        if let Some(after) = alarm {
            let since = now.saturating_sub(after);
            let answers = self.belief.position.confirmed().is_some()
                && self.belief.position.age(now).is_some_and(|age| now.saturating_sub(age) > since);
            self.report(Report::StopNotObeyed { after, answers });
        }
    }

    /// When [`Driver::keep_watch`] has something to do.
    pub(super) fn watch_at(&self) -> Duration {
        let moves = self.moves.iter().map(|m| m.until);
        let ends = self.ends.iter().map(|(at, _)| *at);
        let stop = self.stop.iter().flat_map(|stop| [stop.again_at, stop.alarm_at]);
        moves.chain(ends).chain(stop).chain([self.position_due]).min().unwrap_or(Duration::MAX)
    }
}
