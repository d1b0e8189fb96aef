//! Angles as the mount writes and reads them. Rounding comes first, so that 60 never stands in a place of minutes or seconds.

/// How angles are written: long or short, with the characters of a real mount or of a clone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Form {
    /// Seconds are written.
    pub(super) long: bool,
    /// The degree sign: 0xDF on a real mount.
    pub(super) degree: u8,
    /// Between minutes and seconds of arc: `:` on a real mount.
    pub(super) minute: u8,
}

impl Form {
    /// `HH:MM:SS#` or `HH:MM.T#`.
    pub(super) fn hours(self, hours: f64) -> Vec<u8> {
        if self.long {
            return clock(hours);
        }
        let tenths = (hours.rem_euclid(24.0) * 600.0).round() as u64 % 14_400;
        format!("{:02}:{:02}.{}#", tenths / 600, tenths / 10 % 60, tenths % 10).into_bytes()
    }

    /// `sDD<DF>MM:SS#` or `sDD<DF>MM#`; the sign is kept on `-00` unless all that is written is naught.
    pub(super) fn signed(self, degrees: f64) -> Vec<u8> {
        let parts = if self.long { degrees * 3600.0 } else { degrees * 60.0 };
        let sign = if parts.round() < 0.0 { b'-' } else { b'+' };
        let mut text = vec![sign];
        text.extend(self.unsigned(degrees.abs(), 2));
        text
    }

    /// `DDD<DF>MM:SS#` or `DDD<DF>MM#`, 0 to 360.
    pub(super) fn turn(self, degrees: f64) -> Vec<u8> {
        let whole = if self.long { 3600.0 } else { 60.0 };
        let parts = (degrees.rem_euclid(360.0) * whole).round() % (360.0 * whole);
        self.unsigned(parts / whole, 3)
    }

    fn unsigned(self, degrees: f64, width: usize) -> Vec<u8> {
        let seconds = if self.long { (degrees * 3600.0).round() as u64 } else { (degrees * 60.0).round() as u64 * 60 };
        let mut text = format!("{:0width$}", seconds / 3600).into_bytes();
        text.push(self.degree);
        text.extend(format!("{:02}", seconds / 60 % 60).bytes());
        if self.long {
            text.push(self.minute);
            text.extend(format!("{:02}", seconds % 60).bytes());
        }
        text.push(b'#');
        text
    }
}

/// `HH:MM:SS#`, whatever the format.
pub(super) fn clock(hours: f64) -> Vec<u8> {
    let seconds = (hours.rem_euclid(24.0) * 3600.0).round() as u64 % 86_400;
    format!("{:02}:{:02}:{:02}#", seconds / 3600, seconds / 60 % 60, seconds % 60).into_bytes()
}

/// Hours from `HH:MM:SS` or `HH:MM.T`; `None` for anything else, 24:00:00 and :60 among it.
pub(super) fn read_hours(text: &[u8]) -> Option<f64> {
    let (hours, rest) = (digits(text.get(..2)?)?, text.get(2..)?);
    let minutes = digits(rest.get(1..3)?)?;
    if rest.first() != Some(&b':') || hours > 23.0 || minutes > 59.0 {
        return None;
    }
    let seconds = match rest.get(3..)? {
        [b':', seconds @ ..] if seconds.len() == 2 => digits(seconds).filter(|s| *s < 60.0)?,
        [b'.', tenth] if tenth.is_ascii_digit() => f64::from(tenth - b'0') * 6.0,
        [] => 0.0,
        _ => return None,
    };
    Some(hours + minutes / 60.0 + seconds / 3600.0)
}

/// Degrees from `sDD*MM`, `sDD*MM:SS` or `DDD*MM`: the sign may be missing, the separators be those of any dialect.
pub(super) fn read_degrees(text: &[u8], most: f64) -> Option<f64> {
    let (sign, rest) = match text {
        [b'-', rest @ ..] => (-1.0, rest),
        [b'+', rest @ ..] => (1.0, rest),
        rest => (1.0, rest),
    };
    let width = rest.iter().take_while(|c| c.is_ascii_digit()).count();
    let degrees = digits(rest.get(..width).filter(|d| (1..=3).contains(&d.len()))?)?;
    let tail = rest.get(width..)?;
    let minutes = digits(tail.get(1..3)?)?;
    if !matches!(tail.first(), Some(b'*' | b':' | 0xDF | 0xE1)) || minutes > 59.0 {
        return None;
    }
    let seconds = match tail.get(3..)? {
        [b':' | b'\'', seconds @ ..] if seconds.len() == 2 => digits(seconds).filter(|s| *s < 60.0)?,
        [] => 0.0,
        _ => return None,
    };
    let size = degrees + minutes / 60.0 + seconds / 3600.0;
    (size <= most).then_some(sign * size)
}

/// A number of decimal digits and nothing else.
pub(super) fn digits(text: &[u8]) -> Option<f64> {
    if text.is_empty() || text.len() > 9 || !text.iter().all(u8::is_ascii_digit) {
        return None;
    }
    Some(text.iter().fold(0.0, |number, digit| number * 10.0 + f64::from(digit - b'0')))
}

/// A decimal number such as `-05.5`.
pub(super) fn decimal(text: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(text).ok()?;
    let plain = !text.is_empty() && text.bytes().all(|c| c.is_ascii_digit() || matches!(c, b'+' | b'-' | b'.'));
    text.parse().ok().filter(|_| plain)
}

#[cfg(test)]
mod tests {
    use super::*;

    const REAL: Form = Form { long: true, degree: 0xDF, minute: b':' };

    #[test]
    fn the_declination_of_a_real_mount_comes_out_byte_for_byte() {
        // Stellarium issue 818: 2b 35 31 df 31 34 3a 32 30 23.
        let degrees = 51.0 + 14.0 / 60.0 + 20.0 / 3600.0;
        assert_eq!(REAL.signed(degrees), [0x2b, 0x35, 0x31, 0xdf, 0x31, 0x34, 0x3a, 0x32, 0x30, 0x23]);
    }

    #[test]
    fn the_replies_of_the_2023_capture_come_out_byte_for_byte() {
        assert_eq!(REAL.hours(5.0 + 29.0 / 60.0 + 28.0 / 3600.0), b"05:29:28#");
        assert_eq!(REAL.signed(10.0 / 3600.0), b"+00\xDF00:10#");
        assert_eq!(REAL.turn(359.0 + 49.0 / 60.0 + 34.0 / 3600.0), b"359\xDF49:34#");
        assert_eq!(REAL.turn(354.0 + 36.0 / 60.0 + 54.0 / 3600.0), b"354\xDF36:54#");
    }

    #[test]
    fn the_short_form_is_one_digit_of_a_minute_and_whole_arcminutes() {
        let short = Form { long: false, ..REAL };
        assert_eq!(short.hours(5.0 + 29.4 / 60.0), b"05:29.4#");
        assert_eq!(short.signed(37.0 + 17.0 / 60.0), b"+37\xDF17#");
        assert_eq!(short.turn(359.999), b"000\xDF00#");
    }

    #[test]
    fn neither_sixty_nor_twenty_four_is_ever_written() {
        assert_eq!(REAL.hours(23.999_999), b"00:00:00#");
        assert_eq!(REAL.signed(-0.999_999_9), b"-01\xDF00:00#");
        assert_eq!(REAL.signed(-0.5), b"-00\xDF30:00#");
        assert_eq!(REAL.signed(-1e-12), b"+00\xDF00:00#");
        assert_eq!(REAL.turn(359.999_99), b"000\xDF00:00#");
    }

    #[test]
    fn impossible_angles_are_refused() {
        for text in [&b"24:00:00"[..], b"05:60:00", b"05:00:60", b"5:00:00", b"05-00-00", b"", b"05:00:00x"] {
            assert_eq!(read_hours(text), None, "{}", text.escape_ascii());
        }
        for text in [&b"+90*01"[..], b"+45*60", b"+45", b"++45*00", b"+45*00:60", b"+4x*00"] {
            assert_eq!(read_degrees(text, 90.0), None, "{}", text.escape_ascii());
        }
    }

    #[test]
    fn every_dialect_of_declination_is_read() {
        let wanted = -(5.0 + 23.0 / 60.0 + 28.0 / 3600.0);
        for text in [&b"-05*23:28"[..], b"-05\xDF23:28", b"-05:23:28", b"-05\xDF23'28", b"-05*23'28"] {
            assert!((read_degrees(text, 90.0).unwrap() - wanted).abs() < 1e-12, "{}", text.escape_ascii());
        }
        assert!(read_degrees(b"-00*30", 90.0).unwrap() < 0.0);
    }
}
