//! What the mount's answers mean. Strict: an answer that is not one to its question is refused, never guessed at.

use super::belief::{Aligned, Alignment, Display, Mounting, Precision, Tracking};
use super::command::Command;
use super::frame::{character, printable};
use super::sexagesimal as form;
use crate::units::Angle;

/// An answer.
#[derive(Debug, Clone, PartialEq)]
pub enum Reply {
    /// To a command that answers nothing, or with a lone `#`.
    Done,
    /// To ACK: how the mount stands.
    Standing(Mounting),
    /// Text without control characters.
    Text(String),
    /// Alignment and tracking.
    Status(Alignment),
    /// Right ascension, and in which form it came.
    Ra(Angle, Precision),
    /// Declination, and in which form it came.
    Dec(Angle, Precision),
    /// Whether distance bars are shown: a slew is under way.
    Bars(bool),
    /// Days since 1970-01-01, local.
    Date(i64),
    /// Seconds of the day, local.
    Time(u32),
    /// Local sidereal time.
    Sidereal(Angle),
    /// Hours to add to local time to have UTC.
    HoursToUtc(f64),
    /// Whether daylight saving is set.
    Summer(bool),
    /// Latitude.
    Latitude(Angle),
    /// Longitude, east positive.
    Longitude(Angle),
    /// Whether a value was taken.
    Taken(bool),
    /// The slew was begun.
    SlewBegun,
    /// The slew was refused, in the mount's words.
    SlewRefused(String),
    /// The hand controller's display.
    Display(Display),
}

/// Makes an answer of the whole reply to `command`, `#` included where it came; `None` when it is no answer to it.
#[must_use]
pub fn parse(command: &Command, bytes: &[u8]) -> Option<Reply> {
    let text = bytes.strip_suffix(b"#").unwrap_or(bytes);
    match command {
        Command::Ack => standing(bytes).map(Reply::Standing),
        Command::Fence => text.is_empty().then_some(Reply::Done),
        Command::Product | Command::Firmware => words(text).map(Reply::Text),
        Command::Ask(_) => Some(Reply::Text(printable(text))),
        Command::Sync => Some(Reply::Text(printable(text.trim_ascii()))),
        Command::Status => status(text).map(Reply::Status),
        Command::Ra => form::right_ascension(text).map(|(angle, precision)| Reply::Ra(angle, precision)),
        Command::Dec => form::declination(text).map(|(angle, precision)| Reply::Dec(angle, precision)),
        Command::Bars => bars(text).map(Reply::Bars),
        Command::Date => form::date(text).map(Reply::Date),
        Command::Time => form::time_of_day(text).map(Reply::Time),
        Command::Sidereal => form::right_ascension(text).map(|(angle, _)| Reply::Sidereal(angle)),
        Command::Zone => form::hours_to_utc(text).map(Reply::HoursToUtc),
        Command::Latitude => form::declination(text).map(|(angle, _)| Reply::Latitude(angle)),
        Command::Longitude => form::longitude(text).map(Reply::Longitude),
        Command::Summer => taken(text).map(Reply::Summer),
        Command::TargetRa(..)
        | Command::TargetDec(..)
        | Command::SetZone(_)
        | Command::SetSummer(_)
        | Command::SetTime(_)
        | Command::SetLatitude(_)
        | Command::SetLongitude(_) => taken(bytes).map(Reply::Taken),
        Command::SetDate(_) => taken(bytes.get(..1)?).map(Reply::Taken),
        Command::Slew => slew(text),
        Command::Display => display(text).map(Reply::Display),
        Command::ToggleFormat
        | Command::Speed(_)
        | Command::Move(_)
        | Command::MoveEnd(_)
        | Command::Stop
        | Command::Press(_) => bytes.is_empty().then_some(Reply::Done),
    }
}

/// The letter that answers ACK; `D` (in the firmware loader) is no mount that can be talked to.
fn standing(bytes: &[u8]) -> Option<Mounting> {
    match bytes {
        b"A" => Some(Mounting::AltAz),
        b"P" => Some(Mounting::Polar),
        b"L" => Some(Mounting::Land),
        _ => None,
    }
}

/// A name or number: printable, not empty, not an echo.
fn words(text: &[u8]) -> Option<String> {
    let plain = text.iter().all(|byte| matches!(byte, 0x20..=0x7E));
    (plain && !text.is_empty() && text.len() <= 80 && text[0] != b':').then(|| printable(text))
}

fn status(text: &[u8]) -> Option<Alignment> {
    let [mounting, tracking, aligned] = *text else { return None };
    Some(Alignment {
        mounting: match mounting {
            b'A' => Mounting::AltAz,
            b'P' => Mounting::Polar,
            b'G' => Mounting::German,
            b'L' => Mounting::Land,
            _ => return None,
        },
        tracking: match tracking {
            b'T' => Tracking::On,
            b'N' => Tracking::Off,
            b'S' => Tracking::Asleep,
            _ => return None,
        },
        aligned: match aligned {
            b'0'..=b'3' => Aligned::Stars(aligned - b'0'),
            b'H' => Aligned::Home,
            b'P' => Aligned::Parked,
            _ => return None,
        },
    })
}

/// INDI's rule: anything that is not a space is a bar.
fn bars(text: &[u8]) -> Option<bool> {
    (text.len() <= 40).then(|| text.iter().any(|byte| *byte != b' '))
}

fn taken(bytes: &[u8]) -> Option<bool> {
    match bytes {
        b"1" => Some(true),
        b"0" => Some(false),
        _ => None,
    }
}

fn slew(text: &[u8]) -> Option<Reply> {
    let (first, words) = text.split_first()?;
    let words = printable(words.trim_ascii());
    let meant = match first {
        b'0' if words.is_empty() => return Some(Reply::SlewBegun),
        b'1' => "the target is below the horizon",
        b'2' => "the target is beyond a limit",
        b'3' => "the tube could hit the tripod",
        b'4' => "the target is above the limit",
        _ => return None,
    };
    Some(Reply::SlewRefused(if words.is_empty() { meant.into() } else { words }))
}

/// Status byte (bit 7 set, bit 6 cursor shown, bit 4 its row, bits 0 to 3 its column), 16 characters, the rest.
fn display(text: &[u8]) -> Option<Display> {
    let (status, text) = text.split_first()?;
    if status & 0x80 == 0 || text.len() < 16 {
        return None;
    }
    let (top, bottom) = text.split_at(16);
    let shown = |bytes: &[u8]| bytes.iter().map(|byte| character(*byte)).collect();
    Some(Display {
        top: shown(top),
        bottom: shown(bottom),
        cursor_shown: status & 0x40 != 0,
        row: (status >> 4) & 1,
        column: status & 0x0F,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_captured_identity_and_status_are_read() {
        assert_eq!(parse(&Command::Product, b"LX2001#"), Some(Reply::Text("LX2001".into())));
        assert_eq!(parse(&Command::Firmware, b"4.2l#"), Some(Reply::Text("4.2l".into())));
        let parked = Alignment { mounting: Mounting::AltAz, tracking: Tracking::Off, aligned: Aligned::Parked };
        assert_eq!(parse(&Command::Status, b"ANP"), Some(Reply::Status(parked)));
        assert_eq!(parse(&Command::Status, b"ANP#"), Some(Reply::Status(parked)));
    }

    #[test]
    fn an_echo_is_no_name_and_no_answer_to_ack() {
        assert_eq!(parse(&Command::Product, b":GVP#"), None);
        assert_eq!(parse(&Command::Ack, b"\x06"), None);
    }

    #[test]
    fn a_bar_is_anything_but_spaces() {
        assert_eq!(parse(&Command::Bars, b"\x7F#"), Some(Reply::Bars(true)));
        assert_eq!(parse(&Command::Bars, b"|#"), Some(Reply::Bars(true)));
        assert_eq!(parse(&Command::Bars, b"#"), Some(Reply::Bars(false)));
        let mut classic = vec![0xFF; 7];
        classic.extend([b' '; 25]);
        classic.push(b'#');
        assert_eq!(parse(&Command::Bars, &classic), Some(Reply::Bars(true)));
        assert_eq!(parse(&Command::Bars, &[[b' '; 32].as_slice(), b"#"].concat()), Some(Reply::Bars(false)));
    }

    #[test]
    fn a_refusal_keeps_the_mounts_words_and_has_some_when_it_has_none() {
        let refused = |bytes: &[u8]| parse(&Command::Slew, bytes);
        assert_eq!(refused(b"0"), Some(Reply::SlewBegun));
        assert_eq!(
            refused(b"1Object Below Horizon\x1b[2J#"),
            Some(Reply::SlewRefused("Object Below Horizon.[2J".into()))
        );
        assert_eq!(refused(b"1"), Some(Reply::SlewRefused("the target is below the horizon".into())));
        assert_eq!(refused(b"9what#"), None);
    }

    #[test]
    fn the_display_of_the_capture_is_decoded() {
        // 0x97: row 1, column 7, "Object" on the second line.
        let reply = [&[0x97][..], b"Select Item:    ", b" Object         ", b"#"].concat();
        let Some(Reply::Display(display)) = parse(&Command::Display, &reply) else { panic!() };
        assert_eq!((display.row, display.column, display.cursor_shown), (1, 7, false));
        assert_eq!((display.top.as_str(), display.bottom.as_str()), ("Select Item:    ", " Object         "));
        assert_eq!(parse(&Command::Display, b"\x97short#"), None);
    }

    #[test]
    fn a_declination_never_answers_for_a_right_ascension_nor_the_other_way_round() {
        assert_eq!(parse(&Command::Ra, b"+37\xDF17:16#"), None);
        assert_eq!(parse(&Command::Dec, b"05:29:28#"), None);
    }

    #[test]
    fn a_date_is_taken_by_its_first_byte() {
        assert_eq!(parse(&Command::SetDate(0), b"1Updating Planetary Data#      #"), Some(Reply::Taken(true)));
        assert_eq!(parse(&Command::SetDate(0), b"0"), Some(Reply::Taken(false)));
    }
}
