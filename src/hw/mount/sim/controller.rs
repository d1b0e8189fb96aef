//! The firmware: what it knows, and which command goes to which room of it.

mod calendar;
mod identity;
mod motion;
mod odds;
mod position;
mod power;

use std::time::Duration;

use self::calendar::Calendar;
use self::odds::Odds;
use self::position::Told;
use self::power::Power;
use super::angles::{Form, digits};
use super::answer::Answer;
use super::fault::{Degree, Faults};
use super::handset::{Handset, Wish, messier_position};
use super::settings::Settings;
use super::tube::{Arrow, Goal, Tube};
use crate::numerics::streams::Stream;
use crate::sky::coords::{Equatorial, OfDate};
use crate::units::Angle;

/// The firmware of the simulated mount.
#[derive(Debug)]
pub(super) struct Controller {
    tube: Tube,
    calendar: Calendar,
    told: Told,
    handset: Handset,
    odds: Odds,
    power: Power,
    /// `A` alt-azimuth, `P` polar, `L` land.
    mounting: u8,
    /// `0` to `3` stars, `H` by home, `P` parked.
    aligned: u8,
    /// Degrees a second of the arrow keys, both axes, and of guide pulses.
    arrow_deg_s: (f64, f64),
    guide_deg_s: f64,
    stops_to_ignore: u32,
    goto_began: Duration,
    random: Stream,
    /// Replies that nobody asked for.
    unasked: Vec<Answer>,
    /// Up to when time has passed; `None` before the first.
    now: Option<Duration>,
    faults: Faults,
}

impl Controller {
    pub(super) fn new(settings: Settings) -> Controller {
        let faults = settings.faults.clone();
        Controller {
            tube: Tube::new(&settings),
            calendar: Calendar::new(&settings),
            told: Told::new(!faults.short),
            handset: Handset::default(),
            odds: Odds::default(),
            power: if faults.asleep { Power::Asleep } else { Power::Awake },
            mounting: b'A',
            aligned: if faults.unaligned { b'0' } else { b'2' },
            arrow_deg_s: (8.0, 8.0),
            guide_deg_s: 15.041 / 3600.0,
            stops_to_ignore: faults.ignored_stops,
            goto_began: Duration::ZERO,
            random: Stream::seeded(settings.seed),
            unasked: Vec::new(),
            now: None,
            faults,
        }
    }

    /// Lets time pass: the axes move, and what a person or the power company does happens at its time.
    pub(super) fn advance(&mut self, now: Duration) {
        let before = self.now;
        if before.is_some_and(|before| now < before) {
            return;
        }
        self.now = Some(now);
        let due = |at: Duration| before.is_none_or(|before| before < at) && at <= now;
        if let Some((at, letter, lasts)) = self.faults.keypad
            && due(at)
            && let Some(arrow) = Arrow::of(letter as u8)
        {
            self.tube.advance(at);
            self.tube.press(self.felt(arrow), self.tube.fastest_deg_s, Some(at.saturating_add(lasts)));
        }
        if self.faults.restart.is_some_and(due) {
            self.restart(now);
        }
        if self.faults.format_switch.is_some_and(due) {
            self.told.long = !self.told.long;
        }
        if let Some((at, seconds)) = self.faults.clock_jump
            && due(at)
        {
            self.calendar.jump(seconds);
        }
        self.tube.advance(now);
        self.power_tick(now);
    }

    /// When something will happen without a command.
    pub(super) fn next_event(&self) -> Option<Duration> {
        let faults = &self.faults;
        let started = if let Power::Starting(until) = self.power { Some(until) } else { None };
        let jump = faults.clock_jump.map(|(at, _)| at);
        let keypad = faults.keypad.map(|(at, _, _)| at);
        let scheduled = [faults.restart, faults.format_switch, jump, keypad].into_iter().flatten();
        let ahead = scheduled.filter(|at| self.now.is_none_or(|now| now < *at));
        ahead.chain(started).min()
    }

    /// What the mount says of itself.
    pub(super) fn unasked(&mut self) -> Vec<Answer> {
        std::mem::take(&mut self.unasked)
    }

    /// ACK or EOT.
    pub(super) fn control(&mut self, byte: u8) -> Answer {
        match byte {
            0x06 => self.ack(),
            _ => self.enter_downloader(),
        }
    }

    /// One command, without its `:` and `#`.
    pub(super) fn obey(&mut self, body: &[u8], at: Duration) -> Answer {
        if !self.listens_to(body) {
            return Answer::silent();
        }
        let Some(letter) = body.first() else { return Answer::silent() };
        let answer = match letter {
            b'G' => self.tell(body, at),
            b'S' => self.set(body, at),
            b'M' | b'Q' | b'R' | b'D' | b'C' => self.move_by(body, at),
            b'U' => self.told.toggle(body),
            b'P' => self.told.toggle_high_precision_pointing(body),
            b'E' => self.handset_command(body, at),
            b'h' | b'I' | b'A' => self.power_command(body, at),
            b'T' => self.rate_command(body),
            b'H' | b'W' => self.calendar.switch(body, self.faults.sites_from_one),
            _ => self.odds.obey(body),
        };
        answer.unwrap_or_default()
    }

    /// `:G...#`: what is asked for, from whichever room knows it.
    fn tell(&mut self, body: &[u8], at: Duration) -> Option<Answer> {
        let form = self.form();
        self.identity(body)
            .or_else(|| self.tell_position(body, at))
            .or_else(|| self.calendar.tell(body, form, at))
            .or_else(|| self.odds.tell(body))
            .or_else(|| {
                (body == b"GT").then(|| Answer::text(&format!("{:+.1}", (self.tube.rate_hz() * 10.0).floor() / 10.0)))
            })
    }

    /// `:S...#`: one space may stand after the two letters.
    fn set(&mut self, body: &[u8], at: Duration) -> Option<Answer> {
        let letter = *body.get(1)?;
        let value = match body.get(2..)? {
            [b' ', value @ ..] => value,
            value => value,
        };
        match letter {
            b'r' | b'd' | b'a' | b'z' => self.told.set_target(letter, value),
            b'w' | b'T' | b'B' => self.set_rate(letter, value),
            b'S' => self.set_sidereal_time(value, at),
            b'L' | b'C' | b'G' | b'H' | b't' | b'g' | b'M' | b'N' | b'O' | b'P' => {
                self.calendar.set(letter, value, at, self.faults.utc_date, &mut self.random)
            }
            _ => self.odds.set(letter, value),
        }
    }

    /// How angles are written now.
    pub(super) fn form(&self) -> Form {
        let (degree, minute) = match self.faults.degree {
            Degree::Real => (0xDF, b':'),
            Degree::Star => (b'*', b'\''),
            Degree::Colon => (b':', b':'),
            Degree::E1 => (0xE1, b':'),
        };
        Form { long: self.told.long, degree, minute }
    }

    /// Which way an arrow moves the tube: the fault `reversed` exchanges east and west.
    fn felt(&self, arrow: Arrow) -> Arrow {
        match arrow {
            Arrow::East if self.faults.reversed => Arrow::West,
            Arrow::West if self.faults.reversed => Arrow::East,
            arrow => arrow,
        }
    }

    pub(super) fn encoders(&self) -> (f64, f64) {
        self.tube.encoders()
    }

    pub(super) fn axis_speeds(&self) -> (f64, f64) {
        self.tube.speeds()
    }

    pub(super) fn sky_of(&self, ground: (f64, f64), now: Duration) -> Equatorial<OfDate> {
        position(self.tube.sky_of(ground, now))
    }

    pub(super) fn reported(&self, now: Duration) -> Equatorial<OfDate> {
        position(self.tube.believed(now))
    }
}

fn position((ra, dec): (f64, f64)) -> Equatorial<OfDate> {
    Equatorial::new(Angle::degrees(ra), Angle::degrees(dec))
}

impl Controller {
    /// `:ED# :EKn# :EQ n# :ESn#`.
    fn handset_command(&mut self, body: &[u8], at: Duration) -> Option<Answer> {
        match body {
            b"ED" => {
                let (ra, dec) = self.tube.believed(at);
                let form = self.form();
                let without_hash = |mut text: Vec<u8>| {
                    text.pop();
                    text
                };
                let ra = without_hash(form.hours(ra / 15.0));
                let dec = without_hash(form.signed(dec));
                Some(self.handset.display(&String::from_utf8_lossy(&ra), &dec))
            }
            [b'E', b'K', code @ ..] => {
                let code = digits(code).filter(|code| *code < 256.0)? as u8;
                let wish = self.handset.press(code);
                self.grant(wish, at);
                Some(Answer::silent())
            }
            [b'E', b'Q', address @ ..] => self.handset.query(digits(address.trim_ascii())? as usize),
            [b'E', b'S', address @ ..] => {
                self.handset.jump(digits(address.trim_ascii())? as usize);
                Some(Answer::silent())
            }
            _ => None,
        }
    }

    /// What a key of the hand controller asked for.
    fn grant(&mut self, wish: Wish, at: Duration) {
        match wish {
            Wish::Nothing => {}
            Wish::Messier(number) => match messier_position(number, self.calendar.year(at)) {
                None => self.handset.say("Not simulated", ""),
                Some(place) if self.tube.ground_of(place, at).1 < self.odds.lowest_deg => {
                    self.handset.say("Object is below", "the horizon");
                }
                Some((ra, dec)) => {
                    self.begin(Goal::Sky(ra, dec), at);
                }
            },
            Wish::Speed(speed) => {
                self.move_by(&[b'R', b'0' + speed], at);
            }
            Wish::Daylight => self.power = Power::Awake,
        }
    }
}
