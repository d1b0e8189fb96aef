//! Clock and sites, as the mount keeps them: local time first, and hours to add for UTC.

mod site;

use std::time::Duration;

use self::site::Memory;
use crate::hw::mount::sim::angles::{Form, clock, decimal, digits, read_degrees, read_hours};
use crate::hw::mount::sim::answer::Answer;
use crate::hw::mount::sim::earth::SiderealClock;
use crate::hw::mount::sim::settings::Settings;
use crate::numerics::streams::Stream;
use crate::sky::time::Utc;

/// 1024 weeks.
const ROLLOVER_S: f64 = 1024.0 * 7.0 * 86_400.0;
/// The first part of the reply to a date comes after this.
const DATE_TAKEN: Duration = Duration::from_millis(200);

/// Clock and sites.
#[derive(Debug)]
pub(super) struct Calendar {
    /// Local time at `now` = 0, as seconds since 1970-01-01T00:00:00 local.
    local_at_zero_s: f64,
    /// Hours to add to local standard time for UTC.
    zone_h: f64,
    daylight_saving: bool,
    twelve_hours: bool,
    sites: [Memory; 4],
    current: usize,
    sidereal: SiderealClock,
}

impl Calendar {
    pub(super) fn new(settings: &Settings) -> Calendar {
        let faults = &settings.faults;
        let to_utc_h = settings.zone_h - f64::from(u8::from(settings.daylight_saving));
        let rollover_s = if faults.rollover { ROLLOVER_S } else { 0.0 };
        let mut calendar = Calendar {
            local_at_zero_s: settings.start.0 - to_utc_h * 3600.0 - rollover_s + faults.clock_error_s,
            zone_h: if faults.zone_sign { -settings.zone_h } else { settings.zone_h },
            daylight_saving: settings.daylight_saving,
            twelve_hours: false,
            sites: Memory::four(settings),
            current: 0,
            sidereal: SiderealClock::at(settings.start),
        };
        calendar.sidereal = SiderealClock::at(calendar.utc(Duration::ZERO));
        calendar
    }

    pub(super) fn site(&self) -> &Memory {
        &self.sites[self.current]
    }

    /// Hours to add to local time for UTC, daylight saving in it.
    fn to_utc_h(&self) -> f64 {
        self.zone_h - f64::from(u8::from(self.daylight_saving))
    }

    fn local_s(&self, now: Duration) -> f64 {
        self.local_at_zero_s + now.as_secs_f64()
    }

    fn utc(&self, now: Duration) -> Utc {
        Utc(self.local_s(now) + self.to_utc_h() * 3600.0)
    }

    /// Local sidereal time of the displayed clock and site, degrees.
    pub(super) fn sidereal_deg(&self, now: Duration) -> f64 {
        self.sidereal.local_deg(self.utc(now), self.site().longitude_deg)
    }

    pub(super) fn jump(&mut self, seconds: f64) {
        self.local_at_zero_s += seconds;
    }

    /// `:GL :Ga :GC :GS :Gc :GG :GH :Gt :Gg :GM`..`:GP`.
    pub(super) fn tell(&self, body: &[u8], form: Form, now: Duration) -> Option<Answer> {
        let [b'G', letter] = *body else { return None };
        let hours = self.local_s(now).rem_euclid(86_400.0).floor() / 3600.0;
        let bytes = match letter {
            b'L' => clock(hours),
            b'a' => clock(if hours >= 13.0 { hours - 12.0 } else { hours }),
            b'C' => self.date(now)?,
            b'S' => clock(((self.sidereal_deg(now) * 240.0).floor() / 3600.0).rem_euclid(24.0)),
            b'c' => format!("{}#", if self.twelve_hours { 12 } else { 24 }).into_bytes(),
            b'G' => self.zone(),
            b'H' => format!("{}#", u8::from(self.daylight_saving)).into_bytes(),
            b't' => form.signed(self.site().latitude_deg),
            b'g' => form.turn(-self.site().longitude_deg),
            b'M'..=b'P' => self.sites[usize::from(letter - b'M')].told_name(),
            _ => return None,
        };
        Some(Answer::bytes(bytes))
    }

    /// The year and its fraction.
    pub(super) fn year(&self, now: Duration) -> f64 {
        1970.0 + self.utc(now).0 / (365.2425 * 86_400.0)
    }

    /// `MM/DD/YY#`, local.
    fn date(&self, now: Duration) -> Option<Vec<u8>> {
        let date = civil(self.local_s(now))?.date();
        Some(format!("{:02}/{:02}/{:02}#", date.month(), date.day(), date.year().rem_euclid(100)).into_bytes())
    }

    /// `sHH#`, or `sHH.H#` where the zone is no whole hour.
    fn zone(&self) -> Vec<u8> {
        // Adding zero takes the sign from a negative zero.
        let hours = self.to_utc_h() + 0.0;
        if hours.fract() == 0.0 {
            format!("{hours:+03.0}#").into_bytes()
        } else {
            format!("{hours:+05.1}#").into_bytes()
        }
    }

    /// `:SL :SC :SG :SH :St :Sg :SM`..`:SP`.
    pub(super) fn set(
        &mut self,
        letter: u8,
        value: &[u8],
        now: Duration,
        utc_date: bool,
        random: &mut Stream,
    ) -> Option<Answer> {
        if letter == b'C' {
            return Some(self.set_date(value, now, utc_date, random));
        }
        let taken = match letter {
            b'L' => read_hours(value).filter(|_| value.len() == 8).and_then(|hours| self.set_time(hours, now)),
            b'G' => decimal(value).filter(|hours| hours.abs() <= 14.0).map(|hours| {
                self.zone_h = hours + f64::from(u8::from(self.daylight_saving));
            }),
            b'H' => match value {
                b"0" | b"1" => {
                    self.daylight_saving = value == b"1";
                    Some(())
                }
                _ => None,
            },
            b't' => read_degrees(value, 90.0).map(|degrees| self.sites[self.current].latitude_deg = degrees),
            // West is counted positive, 0 to 360; east may come as a negative number.
            b'g' => read_degrees(value, 360.0).map(|west| self.sites[self.current].longitude_deg = -west),
            _ => self.sites[usize::from(letter.saturating_sub(b'M')).min(3)].rename(value),
        };
        self.sidereal = SiderealClock::at(self.utc(now));
        Some(Answer::accepted(taken.is_some()))
    }

    fn set_time(&mut self, hours: f64, now: Duration) -> Option<()> {
        let local = self.local_s(now);
        let midnight = local - local.rem_euclid(86_400.0);
        self.local_at_zero_s += midnight + hours * 3600.0 - local;
        Some(())
    }

    /// `:SCMM/DD/YY#`: `0`, or `1` and two texts, the second when the planets have been computed.
    fn set_date(&mut self, value: &[u8], now: Duration, utc_date: bool, random: &mut Stream) -> Answer {
        let part = |n: usize| value.get(3 * n..3 * n + 2).and_then(digits);
        let separators = value.len() == 8 && value[2] == b'/' && value[5] == b'/';
        let date = match (part(0), part(1), part(2)) {
            (Some(month), Some(day), Some(year)) if separators => midnight_s(year, month, day),
            _ => None,
        };
        let Some(midnight) = date else { return Answer::accepted(false) };
        let shift_s = if utc_date { self.to_utc_h() * 3600.0 } else { 0.0 };
        let shown = self.local_s(now) + shift_s;
        self.local_at_zero_s += midnight - (shown - shown.rem_euclid(86_400.0));
        self.sidereal = SiderealClock::at(self.utc(now));
        let computing = Duration::from_secs_f64(1.0 + 4.0 * random.uniform());
        Answer::default().then(DATE_TAKEN, *b"1Updating Planetary Data#").then(computing, format!("{:24}#", ""))
    }

    /// Year, month, day, hour, minute, second, local.
    pub(super) fn set_all(&mut self, [year, month, day, hour, minute, second]: [f64; 6], now: Duration) -> bool {
        let time_s = hour * 3600.0 + minute * 60.0 + second;
        let sane = hour < 24.0 && minute < 60.0 && second < 60.0;
        let Some(midnight) = midnight_s(year, month, day).filter(|_| sane) else { return false };
        self.local_at_zero_s = midnight + time_s - now.as_secs_f64();
        self.sidereal = SiderealClock::at(self.utc(now));
        true
    }

    /// `:H#` and `:Wn#`.
    pub(super) fn switch(&mut self, body: &[u8], sites_from_one: bool) -> Option<Answer> {
        match body {
            b"H" => self.twelve_hours = !self.twelve_hours,
            [b'W', digit @ b'0'..=b'9'] => {
                let first = if sites_from_one { b'1' } else { b'0' };
                let chosen = usize::from(digit.checked_sub(first)?);
                if chosen < self.sites.len() {
                    self.current = chosen;
                }
            }
            _ => return None,
        }
        Some(Answer::silent())
    }
}

/// Seconds since 1970 of a day's first; years 92 to 99 are of the last century.
fn midnight_s(year: f64, month: f64, day: f64) -> Option<f64> {
    let century = if year >= 92.0 { 1900.0 } else { 2000.0 };
    let date = jiff::civil::Date::new((century + year) as i16, month as i8, day as i8).ok()?;
    let stamp = date.to_zoned(jiff::tz::TimeZone::UTC).ok()?.timestamp();
    Some(stamp.as_second() as f64)
}

/// Date and time of seconds since 1970.
fn civil(seconds: f64) -> Option<jiff::civil::DateTime> {
    let stamp = jiff::Timestamp::from_second(seconds.floor() as i64).ok()?;
    Some(jiff::tz::TimeZone::UTC.to_datetime(stamp))
}
