//! What is sent to the mount, and the one place that turns it into bytes.

use std::time::Duration;

use super::belief::Precision;
use super::frame::Shape;
use super::order::{Direction, Key, Rate};
use super::sexagesimal::{write_declination, write_longitude, write_right_ascension};
use super::table::{self, Policy};
use crate::units::Angle;

/// A command. Its reply is the [`super::reply::Reply`] that [`super::reply::parse`] makes of the answer.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// ACK: who listens? Also the probe that finds a lost conversation again.
    Ack,
    /// Product name.
    Product,
    /// Firmware number.
    Firmware,
    /// Mounting, tracking, alignment.
    Status,
    /// A question whose answer is a lone `#`: behind a silent command it says that the command was taken.
    Fence,
    /// Right ascension.
    Ra,
    /// Declination.
    Dec,
    /// Distance bars: progress of a slew.
    Bars,
    /// Local date.
    Date,
    /// Local time.
    Time,
    /// Local sidereal time.
    Sidereal,
    /// Hours to add to local time to have UTC.
    Zone,
    /// Latitude of the site.
    Latitude,
    /// Longitude of the site.
    Longitude,
    /// Toggle long and short format.
    ToggleFormat,
    /// Target right ascension.
    TargetRa(Angle, Precision),
    /// Target declination.
    TargetDec(Angle, Precision),
    /// Slew to the target.
    Slew,
    /// Synchronise on the target.
    Sync,
    /// Read the daylight saving flag.
    Summer,
    /// Set the daylight saving flag.
    SetSummer(bool),
    /// Set the zone, hours EAST of Greenwich (written with the mount's opposite sign).
    SetZone(f64),
    /// Set local time, seconds of the day.
    SetTime(u32),
    /// Set the date, days since 1970-01-01.
    SetDate(i64),
    /// Set the site's latitude.
    SetLatitude(Angle),
    /// Set the site's longitude, east positive.
    SetLongitude(Angle),
    /// Choose the speed of moves by hand.
    Speed(Rate),
    /// Begin a move by hand.
    Move(Direction),
    /// End a move by hand.
    MoveEnd(Direction),
    /// Halt all slewing.
    Stop,
    /// Read the hand controller's display.
    Display,
    /// Press a key of the hand controller.
    Press(Key),
    /// Any other question.
    Ask(Question),
}

impl Command {
    /// The bytes to send.
    #[must_use]
    pub fn bytes(&self) -> Vec<u8> {
        let text = match self {
            Command::Ack => return vec![0x06],
            Command::Product => ":GVP#".into(),
            Command::Firmware => ":GVN#".into(),
            Command::Status => ":GW#".into(),
            Command::Fence => ":G0#".into(),
            Command::Ra => ":GR#".into(),
            Command::Dec => ":GD#".into(),
            Command::Bars => ":D#".into(),
            Command::Date => ":GC#".into(),
            Command::Time => ":GL#".into(),
            Command::Sidereal => ":GS#".into(),
            Command::Zone => ":GG#".into(),
            Command::Latitude => ":Gt#".into(),
            Command::Longitude => ":Gg#".into(),
            Command::ToggleFormat => ":U#".into(),
            Command::TargetRa(ra, precision) => format!(":Sr{}#", write_right_ascension(*ra, *precision)),
            Command::TargetDec(dec, precision) => format!(":Sd{}#", write_declination(*dec, *precision)),
            Command::Slew => ":MS#".into(),
            Command::Sync => ":CM#".into(),
            Command::Summer => ":GH#".into(),
            Command::SetSummer(on) => format!(":SH{}#", u8::from(*on)),
            Command::SetZone(east) => format!(":SG{}#", zone(-east)),
            Command::SetTime(s) => format!(":SL{:02}:{:02}:{:02}#", s / 3600 % 24, s / 60 % 60, s % 60),
            Command::SetDate(days) => format!(":SC{}#", calendar(*days)),
            Command::SetLatitude(latitude) => format!(":St{}#", write_declination(*latitude, Precision::Short)),
            Command::SetLongitude(longitude) => format!(":Sg{}#", write_longitude(*longitude)),
            Command::Speed(rate) => format!(":R{}#", speed(*rate)),
            Command::Move(direction) => format!(":M{}#", letter(*direction)),
            Command::MoveEnd(direction) => format!(":Q{}#", letter(*direction)),
            Command::Stop => ":Q#".into(),
            Command::Display => ":ED#".into(),
            Command::Press(key) => format!(":EK{}#", key_code(*key)),
            Command::Ask(question) => format!(":{}#", question.letters()),
        };
        text.into_bytes()
    }

    /// The command as a person reads it.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Command::Ack => "ACK".into(),
            other => super::frame::printable(&other.bytes()),
        }
    }

    /// The shape of its reply.
    #[must_use]
    pub fn shape(&self) -> Shape {
        table::entry(&self.bytes()).map_or(Shape::Nothing, |entry| entry.shape)
    }

    /// How long the mount may think before its first byte, and between bytes, where that is longer than for other commands.
    #[must_use]
    pub fn patience(&self) -> Duration {
        Duration::from_millis(match self {
            Command::SetDate(_) => 30_000, // the planets are computed anew
            Command::Slew | Command::Sync => 3000,
            Command::Display | Command::Ask(_) => 2000,
            Command::SetTime(_) | Command::SetZone(_) | Command::Ack => 1000,
            _ => 0,
        })
    }

    /// Whether it may be sent again when its reply did not come: questions may, and what sets a value.
    #[must_use]
    pub fn may_be_repeated(&self) -> bool {
        !matches!(self, Command::Slew | Command::Sync | Command::ToggleFormat | Command::Press(_) | Command::Move(_))
    }
}

/// The stop: a `#` ends whatever the mount may have half received, then everything that halts motion.
pub const STOP: &[u8] = b"#:Q#:Qn#:Qs#:Qe#:Qw#";

/// A question from the command table that changes nothing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Question(String);

/// Why a question was refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum QuestionError {
    /// Not in the table.
    #[error("':{0}#' is in no LX200 command table")]
    Unknown(String),
    /// It would change something.
    #[error("':{0}#' changes the mount: only questions may be asked this way")]
    Changes(String),
    /// On the list of commands never to send.
    #[error("':{letters}#' is never sent: {why}")]
    Never {
        /// Its letters.
        letters: String,
        /// The reason.
        why: &'static str,
    },
}

impl Question {
    /// A question by its letters between `:` and `#`, such as `GT`.
    ///
    /// # Errors
    /// It is unknown, changes something, or must never be sent.
    pub fn new(letters: &str) -> Result<Question, QuestionError> {
        let shown: String = letters.chars().filter(|c| !c.is_control()).take(40).collect();
        if letters.len() > 40 || letters.contains(['#', ':']) || shown != letters {
            return Err(QuestionError::Unknown(shown));
        }
        match table::entry(format!(":{letters}#").as_bytes()).map(|entry| entry.policy) {
            Some(Policy::Ask) => Ok(Question(shown)),
            Some(Policy::Change) => Err(QuestionError::Changes(shown)),
            Some(Policy::Never(why)) => Err(QuestionError::Never { letters: shown, why }),
            None => Err(QuestionError::Unknown(shown)),
        }
    }

    /// The letters between `:` and `#`.
    #[must_use]
    pub fn letters(&self) -> &str {
        &self.0
    }
}

/// Hours with their sign; whole ones without a decimal, which OnStep would refuse.
fn zone(hours_to_utc: f64) -> String {
    let tenths = (hours_to_utc * 10.0).round() as i64;
    let sign = if tenths < 0 { '-' } else { '+' };
    match (tenths.abs() / 10, tenths.abs() % 10) {
        (hours, 0) => format!("{sign}{hours:02}"),
        (hours, tenth) => format!("{sign}{hours:02}.{tenth}"),
    }
}

/// `MM/DD/YY`.
fn calendar(days: i64) -> String {
    let epoch = jiff::civil::date(1970, 1, 1);
    let date = epoch.checked_add(jiff::Span::new().days(days.clamp(0, 47_000))).unwrap_or(epoch);
    format!("{:02}/{:02}/{:02}", date.month(), date.day(), date.year() % 100)
}

fn letter(direction: Direction) -> char {
    match direction {
        Direction::North => 'n',
        Direction::South => 's',
        Direction::East => 'e',
        Direction::West => 'w',
    }
}

fn speed(rate: Rate) -> char {
    match rate {
        Rate::Guide => 'G',
        Rate::Centre => 'C',
        Rate::Find => 'M',
        Rate::Slew => 'S',
    }
}

/// Key codes of the Autostar II: those of the captured application where there are two.
fn key_code(key: Key) -> u8 {
    match key {
        Key::Mode => 9,
        Key::ModeLong => 11,
        Key::Enter => 13,
        Key::EnterLong => 10,
        Key::Goto => 24,
        Key::Help => 63,
        Key::Up => 85,
        Key::Down => 68,
        Key::Left => 87,
        Key::Right => 69,
        Key::Digit(digit) => b'0' + digit.min(9),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_command_has_the_bytes_of_the_papers() {
        let orion =
            (Angle::hours(5.0 + 35.0 / 60.0 + 17.0 / 3600.0), Angle::degrees(-(5.0 + 23.0 / 60.0 + 28.0 / 3600.0)));
        for (command, bytes) in [
            (Command::Ack, &b"\x06"[..]),
            (Command::TargetRa(orion.0, Precision::Long), b":Sr05:35:17#"),
            (Command::TargetRa(orion.0, Precision::Short), b":Sr05:35.3#"),
            (Command::TargetDec(orion.1, Precision::Long), b":Sd-05*23:28#"),
            (Command::TargetDec(orion.1, Precision::Short), b":Sd-05*23#"),
            (Command::SetZone(1.0), b":SG-01#"), // Central Europe
            (Command::SetZone(-8.0), b":SG+08#"),
            (Command::SetZone(5.5), b":SG-05.5#"),
            (Command::SetTime(72_091), b":SL20:01:31#"),
            (Command::SetDate(19_607), b":SC09/07/23#"),
            (Command::SetLatitude(Angle::degrees(52.0 + 10.0 / 60.0)), b":St+52*10#"),
            (Command::SetLongitude(Angle::degrees(5.4)), b":Sg354*36#"),
            (Command::Speed(Rate::Find), b":RM#"),
            (Command::Press(Key::Help), b":EK63#"),
            (Command::Press(Key::Digit(7)), b":EK55#"),
        ] {
            assert_eq!(command.bytes(), bytes, "{command:?}");
        }
    }

    #[test]
    fn the_stop_is_made_of_commands_that_the_table_knows() {
        for part in STOP[1..].split_inclusive(|byte| *byte == b'#') {
            assert_eq!(table::entry(part).map(|e| e.shape), Some(Shape::Nothing));
        }
    }

    #[test]
    fn only_harmless_questions_can_be_asked() {
        assert!(Question::new("GT").is_ok());
        assert!(Question::new("EQ 0").is_ok());
        assert!(matches!(Question::new("MS"), Err(QuestionError::Changes(_))));
        assert!(matches!(Question::new("hP"), Err(QuestionError::Never { .. })));
        assert!(matches!(Question::new("GR#:hP"), Err(QuestionError::Unknown(_))));
        assert!(matches!(Question::new("\u{4}"), Err(QuestionError::Unknown(_))));
    }
}
