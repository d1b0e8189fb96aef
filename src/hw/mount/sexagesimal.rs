//! Angles and times as the mount writes them. Bytes, not text: the degree sign 0xDF is not UTF-8.
//!
//! Strict: a form that is not exactly one of the mount's is refused, so that a damaged reply is never taken for a position.

use super::belief::Precision;
use crate::units::Angle;

/// Two or three decimal digits.
fn digits(bytes: &[u8]) -> Option<u32> {
    bytes.iter().try_fold(0, |sum, byte| byte.is_ascii_digit().then(|| sum * 10 + u32::from(byte - b'0')))
}

/// Below sixty.
fn sixtieths(bytes: &[u8]) -> Option<f64> {
    digits(bytes).filter(|n| *n < 60 && bytes.len() == 2).map(f64::from)
}

/// `HH:MM:SS` or `HH:MM.T`, in hours.
#[must_use]
pub fn hours(text: &[u8]) -> Option<(f64, Precision)> {
    let (hour, rest) = text.split_at_checked(2)?;
    let hour = f64::from(digits(hour).filter(|h| *h < 24)?);
    match rest {
        [b':', m1, m2, b':', s1, s2] => {
            let (minutes, seconds) = (sixtieths(&[*m1, *m2])?, sixtieths(&[*s1, *s2])?);
            Some((hour + minutes / 60.0 + seconds / 3600.0, Precision::Long))
        }
        [b':', m1, m2, b'.', tenth] => {
            let minutes = sixtieths(&[*m1, *m2])? + f64::from(digits(&[*tenth])?) / 10.0;
            Some((hour + minutes / 60.0, Precision::Short))
        }
        _ => None,
    }
}

/// Right ascension or sidereal time.
#[must_use]
pub fn right_ascension(text: &[u8]) -> Option<(Angle, Precision)> {
    hours(text).map(|(hours, precision)| (Angle::hours(hours), precision))
}

/// Degrees after their sign: `DD*MM` or `DD*MM:SS`, with `*`, 0xDF or `:` after the degrees and `:` or `'` after the minutes.
fn degrees(text: &[u8], places: usize, most: u32) -> Option<(f64, Precision)> {
    let (whole, rest) = text.split_at_checked(places)?;
    let whole = digits(whole)?;
    let (minutes, seconds, precision) = match rest {
        [b'*' | 0xDF | b':', m1, m2] => (sixtieths(&[*m1, *m2])?, 0.0, Precision::Short),
        [b'*' | 0xDF | b':', m1, m2, b':' | b'\'', s1, s2] => {
            (sixtieths(&[*m1, *m2])?, sixtieths(&[*s1, *s2])?, Precision::Long)
        }
        _ => return None,
    };
    let value = f64::from(whole) + minutes / 60.0 + seconds / 3600.0;
    (value <= f64::from(most)).then_some((value, precision))
}

/// The sign, kept apart so that `-00` stays negative.
fn sign(text: &[u8]) -> Option<(f64, &[u8])> {
    match text {
        [b'+', rest @ ..] => Some((1.0, rest)),
        [b'-', rest @ ..] => Some((-1.0, rest)),
        _ => None,
    }
}

/// Declination, latitude or altitude: signed, -90 to 90 degrees.
#[must_use]
pub fn declination(text: &[u8]) -> Option<(Angle, Precision)> {
    let (sign, rest) = sign(text)?;
    let (value, precision) = degrees(rest, 2, 90)?;
    Some((Angle::degrees(sign * value), precision))
}

/// Longitude, EAST positive, from the mount's westward one: 0 to 360 without a sign (a real LX200GPS), or signed with east
/// negative (the papers).
#[must_use]
pub fn longitude(text: &[u8]) -> Option<Angle> {
    let west = match sign(text) {
        Some((sign, rest)) => sign * degrees(rest, 3, 180)?.0,
        None => degrees(text, 3, 360)?.0,
    };
    Some(Angle::degrees(-west).wrapped_signed())
}

/// Seconds of the day from `HH:MM:SS`.
#[must_use]
pub fn time_of_day(text: &[u8]) -> Option<u32> {
    match hours(text)? {
        (hours, Precision::Long) => Some((hours * 3600.0).round() as u32),
        (_, Precision::Short) => None,
    }
}

/// Days since 1970-01-01 from `MM/DD/YY`; some clones write another separator. Two-digit years from 92 are of the last
/// century: the first LX200 is of 1992.
#[must_use]
pub fn date(text: &[u8]) -> Option<i64> {
    let [m1, m2, b'/' | b'-' | b'.' | b':', d1, d2, b'/' | b'-' | b'.' | b':', y1, y2] = *text else { return None };
    let (month, day, year) = (digits(&[m1, m2])?, digits(&[d1, d2])?, digits(&[y1, y2])?);
    let year = if year >= 92 { 1900 + year } else { 2000 + year };
    let date = jiff::civil::Date::new(year as i16, month as i8, day as i8).ok()?;
    Some(i64::from((date - jiff::civil::date(1970, 1, 1)).get_days()))
}

/// Hours to add to local time to have UTC: `sHH` or `sHH.H`.
#[must_use]
pub fn hours_to_utc(text: &[u8]) -> Option<f64> {
    let (sign, rest) = sign(text)?;
    let hours = match rest {
        [a, b] => f64::from(digits(&[*a, *b])?),
        [a, b, b'.', c] => f64::from(digits(&[*a, *b])?) + f64::from(digits(&[*c])?) / 10.0,
        _ => return None,
    };
    (hours <= 15.0).then_some(sign * hours)
}

/// Writes right ascension; rounded first, so that neither 24 hours nor 60 seconds appear.
#[must_use]
pub fn write_right_ascension(ra: Angle, precision: Precision) -> String {
    let hours = ra.wrapped().to_hours();
    match precision {
        Precision::Long => {
            let s = (hours * 3600.0).round() as u64 % 86_400;
            format!("{:02}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
        }
        Precision::Short => {
            let tenths = (hours * 600.0).round() as u64 % 14_400;
            format!("{:02}:{:02}.{}", tenths / 600, tenths / 10 % 60, tenths % 10)
        }
    }
}

/// Writes a declination or latitude with `*`, which every Meade takes. The sign of -00 is kept.
#[must_use]
pub fn write_declination(dec: Angle, precision: Precision) -> String {
    let degrees = dec.to_degrees().clamp(-90.0, 90.0);
    let sign = if degrees < 0.0 { '-' } else { '+' };
    match precision {
        Precision::Long => {
            let s = (degrees.abs() * 3600.0).round() as u64;
            format!("{sign}{:02}*{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
        }
        Precision::Short => {
            let m = (degrees.abs() * 60.0).round() as u64;
            format!("{sign}{:02}*{:02}", m / 60, m % 60)
        }
    }
}

/// Writes a longitude (east positive) as the mount's safe form: 0 to 360 degrees WEST, to the minute.
#[must_use]
pub fn write_longitude(east: Angle) -> String {
    let minutes = ((-east).wrapped().to_degrees() * 60.0).round() as u64 % 21_600;
    format!("{:03}*{:02}", minutes / 60, minutes % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dec(text: &[u8]) -> Option<f64> {
        declination(text).map(|(angle, _)| angle.to_degrees())
    }

    fn close(a: Option<f64>, b: f64) -> bool {
        a.is_some_and(|a| (a - b).abs() < 1e-9)
    }

    #[test]
    fn captured_replies_of_a_real_lx200gps_are_read() {
        // 4.2l, capture of 2023, and Stellarium issue 818.
        assert!(close(hours(b"05:29:28").map(|h| h.0), 5.0 + 29.0 / 60.0 + 28.0 / 3600.0));
        assert!(close(dec(b"+37\xDF17:16"), 37.0 + 17.0 / 60.0 + 16.0 / 3600.0));
        assert!(close(dec(b"+51\xDF14:20"), 51.0 + 14.0 / 60.0 + 20.0 / 3600.0));
        assert!(close(dec(b"+00\xDF00:10"), 10.0 / 3600.0));
        assert!(close(longitude(b"354\xDF36:54").map(Angle::to_degrees), 5.385));
        assert_eq!(date(b"09/07/23"), Some(19_607));
        assert_eq!(time_of_day(b"20:01:31"), Some(72_091));
        assert_eq!(hours_to_utc(b"-01"), Some(-1.0));
    }

    #[test]
    fn all_four_separators_and_both_lengths_are_read() {
        for text in [&b"-05*23"[..], b"-05\xDF23", b"-05:23", b"-05*23:00", b"-05\xDF23'00", b"-05*23'00"] {
            assert!(close(dec(text), -(5.0 + 23.0 / 60.0)), "{text:?}");
        }
        assert_eq!(right_ascension(b"05:29.4").unwrap().1, Precision::Short);
    }

    #[test]
    fn minus_zero_degrees_is_negative() {
        assert!(close(dec(b"-00\xDF30:00"), -0.5));
        assert_eq!(write_declination(Angle::degrees(-0.5), Precision::Long), "-00*30:00");
    }

    #[test]
    fn what_the_mount_never_writes_is_refused() {
        for text in [
            &b"+91*00:00"[..],
            b"+90*00:01",
            b"+45*60:00",
            b"+45*00:60",
            b"45*00:00",
            b"+45*00:0",
            b"+45*00:000",
            b"+4e*00:00",
            b"",
            b"+",
            b"\xFF\xFF",
            b"+45*00:00 ",
        ] {
            assert_eq!(declination(text), None, "{text:?}");
        }
        for text in [&b"24:00:00"[..], b"05.29:28", b"05:60:00", b"5:29:28", b"05:29:28 ", b"05*29:28", b"-5:29:28"] {
            assert_eq!(hours(text), None, "{text:?}");
        }
        assert_eq!(longitude(b"361\xDF00:00"), None);
        assert_eq!(longitude(b"-181*00"), None);
        assert_eq!(date(b"13/01/23"), None);
        assert_eq!(date(b"02/30/23"), None);
    }

    #[test]
    fn the_papers_signed_longitude_has_east_negative() {
        assert!(close(longitude(b"-005*23").map(Angle::to_degrees), 5.0 + 23.0 / 60.0));
        assert!(close(longitude(b"+117*52").map(Angle::to_degrees), -(117.0 + 52.0 / 60.0)));
    }

    #[test]
    fn rounding_never_writes_twenty_four_or_sixty() {
        assert_eq!(write_right_ascension(Angle::hours(23.999_99), Precision::Long), "00:00:00");
        assert_eq!(write_right_ascension(Angle::hours(23.999_99), Precision::Short), "00:00.0");
        assert_eq!(write_declination(Angle::degrees(-5.999_999), Precision::Long), "-06*00:00");
        assert_eq!(write_declination(Angle::degrees(89.999_99), Precision::Long), "+90*00:00");
        assert_eq!(write_longitude(Angle::degrees(0.000_01)), "000*00");
    }

    #[test]
    fn orion_and_a_site_east_of_greenwich_are_written_as_in_the_papers() {
        assert_eq!(write_right_ascension(Angle::hours(5.0 + 35.0 / 60.0 + 17.0 / 3600.0), Precision::Long), "05:35:17");
        assert_eq!(
            write_declination(Angle::degrees(-(5.0 + 23.0 / 60.0 + 28.0 / 3600.0)), Precision::Long),
            "-05*23:28"
        );
        assert_eq!(write_longitude(Angle::degrees(5.385)), "354*37");
    }

    proptest::proptest! {
        #[test]
        fn any_bytes_are_read_or_refused(bytes: Vec<u8>) {
            let _ = (hours(&bytes), declination(&bytes), longitude(&bytes), date(&bytes), hours_to_utc(&bytes), time_of_day(&bytes));
        }

        #[test]
        fn a_position_survives_writing_and_reading_to_half_a_step(ra in 0.0..360.0f64, dec in -90.0..90.0f64) {
            let (back, _) = right_ascension(write_right_ascension(Angle::degrees(ra), Precision::Long).as_bytes()).unwrap();
            proptest::prop_assert!((back - Angle::degrees(ra)).wrapped_signed().abs().to_arcseconds() <= 7.501);
            let (back, _) = declination(write_declination(Angle::degrees(dec), Precision::Long).as_bytes()).unwrap();
            proptest::prop_assert!((back.to_degrees() - dec).abs() * 3600.0 <= 0.501);
        }
    }
}
