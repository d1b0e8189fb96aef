//! Who is there, in which form it speaks, where and when it thinks it is; and how that compares with ours.

use std::mem::discriminant;
use std::time::Duration;

use super::{Driver, HalfPosition, NO_POSITION, Stage};
use crate::hw::mount::advice::Disagreement;
use crate::hw::mount::belief::{Aligned, Known, LinkState, Mounting, Precision, Tracking};
use crate::hw::mount::command::Command;
use crate::hw::mount::dialect::Dialect;
use crate::hw::mount::order::{Fault, Report};
use crate::hw::mount::reconcile::{self, Theirs};
use crate::hw::mount::reply::Reply;
use crate::sky::site::Site;
use crate::sky::time::Utc;
use crate::units::Angle;

/// A question is given up after this many failures.
const GIVE_UP: u32 = 3;
/// How often the long form is asked for on one line.
const MOST_TOGGLES: u32 = 3;
/// Clock and site are compared again soon after connecting (the GPS may have set them), then seldom.
const COMPARE_SOON: Duration = Duration::from_secs(60);
const COMPARE_EVERY: Duration = Duration::from_secs(600);

/// What the mount said of itself, each with the time it said so where that matters.
#[derive(Debug, Clone, Default)]
pub(super) struct Facts {
    latitude: Option<Angle>,
    longitude: Option<Angle>,
    hours_to_utc: Option<f64>,
    pub(super) summer: bool,
    date: Option<i64>,
    time: Option<(u32, Duration)>,
    sidereal: Option<(Angle, Duration)>,
    short_form: bool,
}

/// The questions whose answers are compared with ours.
const COMPARED: [Command; 7] = [
    Command::Latitude,
    Command::Longitude,
    Command::Zone,
    Command::Summer,
    Command::Date,
    Command::Time,
    Command::Sidereal,
];

impl Driver {
    /// Asks who is there and everything that follows.
    pub(super) fn ask_everything(&mut self, now: Duration) {
        self.stage = Stage::Asking;
        self.failures = 0;
        self.toggles = 0;
        self.facts = Facts::default();
        self.position_due = now + NO_POSITION * 3;
        self.questions =
            [Command::Product, Command::Firmware, Command::Status, Command::Ra, Command::Dec, Command::Bars]
                .into_iter()
                .chain(COMPARED)
                .collect();
    }

    /// Asks for clock and site again.
    pub(super) fn ask_to_compare(&mut self) {
        self.facts = Facts { short_form: self.facts.short_form, ..Facts::default() };
        self.questions.extend(COMPARED);
    }

    pub(super) fn question_answered(&mut self, command: &Command, reply: Reply, now: Duration) {
        self.questions.pop_front();
        self.failures = 0;
        match reply {
            Reply::Text(text) if *command == Command::Product => self.identify(Some(text), now),
            Reply::Text(text) => self.belief.firmware = Known::Confirmed { value: text, at: now },
            Reply::Status(alignment) => self.belief.alignment = Known::Confirmed { value: alignment, at: now },
            Reply::Ra(ra, precision) => {
                self.ra = Some(HalfPosition { ra, form: precision, at: now });
                self.learn_precision(precision, now);
            }
            Reply::Dec(dec, precision) => self.take_position(dec, precision, now),
            Reply::Bars(bars) => self.take_bars(bars, now),
            Reply::Latitude(angle) => self.facts.latitude = Some(angle),
            Reply::Longitude(angle) => self.facts.longitude = Some(angle),
            Reply::HoursToUtc(hours) => self.facts.hours_to_utc = Some(hours),
            Reply::Summer(on) => self.facts.summer = on,
            Reply::Date(days) => self.facts.date = Some(days),
            Reply::Time(seconds) => self.facts.time = Some((seconds, now)),
            Reply::Sidereal(angle) => self.facts.sidereal = Some((angle, now)),
            _ => {}
        }
        if self.questions.is_empty() {
            self.conclude(now);
        }
    }

    pub(super) fn question_failed(&mut self, command: &Command, fault: Fault, now: Duration) {
        self.failures += 1;
        let vital = matches!(command, Command::Ra | Command::Dec);
        let garbled = matches!(fault, Fault::Garbled { .. });
        // A mount that does not know a question keeps silent: two silences are an answer, but not to a vital question.
        let give_up = self.failures >= if vital || garbled { GIVE_UP } else { GIVE_UP - 1 };
        if vital || garbled || matches!(fault, Fault::Busy { .. }) {
            self.report(Report::Fault(fault.clone()));
        }
        if !give_up {
            self.belief.counters.retries += 1;
            return;
        }
        if vital {
            self.dead(fault, now);
            return;
        }
        self.questions.pop_front();
        self.failures = 0;
        match command {
            Command::Product => self.identify(None, now),
            Command::Status => self.dialect.status = false,
            _ => {}
        }
        if self.questions.is_empty() {
            self.conclude(now);
        }
    }

    /// Chooses the dialect; a mount that does not say who it is need not be asked for its firmware and status.
    fn identify(&mut self, product: Option<String>, now: Duration) {
        self.dialect = Dialect::of(product.as_deref());
        if product.is_none() {
            self.questions
                .retain(|question| !matches!(question, Command::Firmware | Command::Status | Command::Summer));
            self.belief.firmware = Known::Unknown;
            self.belief.alignment = Known::Unknown;
        }
        self.belief.product = product.map_or(Known::Unknown, |value| Known::Confirmed { value, at: now });
    }

    /// Learns the form from the length of a right ascension; asks for the long one where it is short.
    pub(super) fn learn_precision(&mut self, precision: Precision, now: Duration) {
        self.belief.precision = Known::Confirmed { value: precision, at: now };
        self.facts.short_form = precision == Precision::Short;
        if precision == Precision::Short && self.toggles < MOST_TOGGLES && self.stop.is_none() {
            self.toggles += 1;
            self.polls.clear();
            self.ra = None;
            let again = self.questions.front() == Some(&Command::Dec);
            self.questions.push_front(Command::Ra);
            if self.dialect.fence {
                self.questions.push_front(Command::Fence);
            }
            self.questions.push_front(Command::ToggleFormat);
            if !again {
                self.poll_at = now;
            }
        }
    }

    /// All is asked: compares it with ours and says what disagrees.
    pub(super) fn conclude(&mut self, now: Duration) {
        let theirs = self.theirs(now);
        let mut decision = reconcile::reconcile(&theirs, self.utc(now), self.settings.ours.site);
        decision.disagreements.extend(self.states());
        for disagreement in &decision.disagreements {
            if !self.said.iter().any(|said| discriminant(said) == discriminant(disagreement)) {
                self.reports.push_back(Report::Disagreement(disagreement.clone()));
            }
        }
        self.said.clone_from(&decision.disagreements);
        self.belief.decision = Some(decision);
        if self.stage == Stage::Asking {
            self.stage = Stage::Ready;
            self.belief.link = LinkState::Ready;
            self.ended_by = None;
            self.poll_at = now;
            self.status_at = now + super::watch::STATUS_EVERY;
            self.position_due = now + NO_POSITION;
            let product = self.belief.product.value().cloned().unwrap_or_else(|| self.dialect.name.to_owned());
            self.report(Report::Connected { product, firmware: self.belief.firmware.value().cloned() });
            self.compare_at = now + COMPARE_SOON;
        } else {
            self.compare_at = now + COMPARE_EVERY;
        }
        self.report(Report::Compared);
        self.verify_order(now);
    }

    /// The mount's clock and site as they stand now.
    fn theirs(&mut self, now: Duration) -> Theirs {
        let passed = |at: Duration| now.saturating_sub(at).as_secs_f64();
        let site = self.facts.latitude.zip(self.facts.longitude).map(|(latitude, longitude)| Site {
            latitude,
            longitude,
            elevation_m: self.settings.ours.site.map_or(0.0, |site| site.elevation_m),
        });
        let sidereal =
            self.facts.sidereal.map(|(angle, at)| (angle + Angle::degrees(360.0 / 86_164.1 * passed(at))).wrapped());
        let longitude = site.or(self.settings.ours.site).map(|site| site.longitude);
        let clock = match (self.facts.date, self.facts.time, self.facts.hours_to_utc) {
            (Some(days), Some((seconds, at)), Some(hours)) => {
                // It shows whole seconds that have passed: half a second more on average.
                let local = Utc(days as f64 * 86_400.0 + f64::from(seconds) + 0.5 + passed(at));
                Some(reconcile::clock(local, hours, self.facts.summer, sidereal, longitude))
            }
            _ => None,
        };
        self.belief.site = site.map_or(Known::Unknown, |value| Known::Confirmed { value, at: now });
        self.belief.clock = clock.map_or(Known::Unknown, |value| Known::Confirmed { value, at: now });
        self.belief.sidereal = sidereal.map_or(Known::Unknown, |value| Known::Confirmed { value, at: now });
        Theirs { clock, site, sidereal }
    }

    /// States of the mount that spoil pointing.
    fn states(&self) -> Vec<Disagreement> {
        let mut states = Vec::new();
        match self.belief.product.value() {
            Some(product) if product != "LX2001" => states.push(Disagreement::Clone { product: product.clone() }),
            Some(_) => {}
            None => states.push(Disagreement::Clone { product: self.dialect.name.to_owned() }),
        }
        if let Some(alignment) = self.belief.alignment.value() {
            match alignment.aligned {
                Aligned::Stars(stars) if stars < 2 => states.push(Disagreement::NotAligned { stars }),
                Aligned::Parked => states.push(Disagreement::Parked),
                _ => {}
            }
            match alignment.tracking {
                Tracking::On => {}
                Tracking::Off => states.push(Disagreement::NotTracking),
                Tracking::Asleep => states.push(Disagreement::Asleep),
            }
            if alignment.mounting == Mounting::German {
                states.push(Disagreement::German);
            }
        }
        if self.facts.short_form {
            states.push(Disagreement::ShortFormat);
        }
        states
    }
}
