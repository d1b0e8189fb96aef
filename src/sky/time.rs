//! Instants. UTC is taken as UT1 (under 0.9 s, 13 arcseconds of sidereal time) until an Earth orientation table is given;
//! TT = UT1 + delta T.

use crate::units::Angle;

/// An instant of UTC: f64 seconds since 1970-01-01T00:00:00, good to 0.3 microseconds today (4 microarcseconds of rotation).
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Utc(pub f64);

/// An instant with the delta T to use for it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// UTC, taken as UT1.
    pub utc: Utc,
    /// TT - UT1 in seconds.
    pub delta_t_s: f64,
}

/// Why a time was refused.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("'{text}' is not a time: write it as 2026-11-22T20:00:00Z (UTC), or with an offset such as +02:00 ({why})")]
pub struct TimeError {
    text: String,
    why: String,
}

impl Utc {
    /// Days as two parts whose sum is the Julian date, the first a whole number and a half: as SOFA wants it.
    #[must_use]
    pub fn julian_date(self) -> (f64, f64) {
        let days = self.0 / 86_400.0;
        (2_440_587.5 + days.floor(), days - days.floor())
    }

    /// Reads RFC 3339.
    ///
    /// # Errors
    /// Says what is wrong and shows the form that is wanted.
    pub fn from_rfc3339(text: &str) -> Result<Utc, TimeError> {
        let stamp: jiff::Timestamp = text.parse().map_err(|error: jiff::Error| TimeError {
            text: text.chars().filter(|c| !c.is_control()).take(60).collect(),
            why: error.to_string(),
        })?;
        Ok(Utc(stamp.as_second() as f64 + f64::from(stamp.subsec_nanosecond()) * 1e-9))
    }

    /// Writes RFC 3339 to the second, or what the number is if it is no time.
    #[must_use]
    pub fn to_rfc3339(self) -> String {
        jiff::Timestamp::from_second(self.0.round() as i64)
            .map_or_else(|_out_of_range| format!("{} s since 1970", self.0), |stamp| stamp.to_string())
    }

    /// This instant, some seconds later (or earlier).
    #[must_use]
    pub fn plus_seconds(self, seconds: f64) -> Utc {
        Utc(self.0 + seconds)
    }
}

impl Moment {
    /// An instant with the delta T to use where none is given.
    #[must_use]
    pub fn at(utc: Utc) -> Moment {
        Moment { utc, delta_t_s: super::delta_t::default_seconds(utc) }
    }

    /// Terrestrial time as a two-part Julian date.
    #[must_use]
    pub fn tt(&self) -> (f64, f64) {
        let (day, fraction) = self.utc.julian_date();
        (day, fraction + self.delta_t_s / 86_400.0)
    }

    /// UT1 as a two-part Julian date.
    #[must_use]
    pub fn ut1(&self) -> (f64, f64) {
        self.utc.julian_date()
    }

    /// Greenwich apparent sidereal time (IAU 2006 precession, 2000A nutation), by SOFA.
    #[must_use]
    pub fn greenwich_sidereal_time(&self) -> Angle {
        let ((ut1, ut2), (tt1, tt2)) = (self.ut1(), self.tt());
        Angle::radians(sofars::erst::gst06a(ut1, ut2, tt1, tt2))
    }

    /// Local apparent sidereal time at a longitude (east positive).
    #[must_use]
    pub fn sidereal_time(&self, longitude: Angle) -> Angle {
        (self.greenwich_sidereal_time() + longitude).wrapped()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rfc3339_reads_offsets_and_fractions() {
        let zulu = Utc::from_rfc3339("2026-11-22T18:00:00.5Z").unwrap();
        let offset = Utc::from_rfc3339("2026-11-22T20:00:00.5+02:00").unwrap();
        assert_eq!(zulu, offset);
        assert_eq!(zulu.0.fract(), 0.5);
    }

    #[test]
    fn the_julian_date_of_j2000_is_2451545() {
        let (day, fraction) = Utc::from_rfc3339("2000-01-01T12:00:00Z").unwrap().julian_date();
        assert_eq!(day + fraction, 2_451_545.0);
    }
}
