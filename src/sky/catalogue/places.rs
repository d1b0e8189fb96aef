//! The hand controller's own places of objects, laid over the catalogue's, so that mount and picture mean the same place.
//!
//! ```text
//! # name, right ascension, declination (J2000)
//! M31, 00:42:44, +41:16
//! NGC 7331, 339.267, 34.416
//! ```
//!
//! A line an object. A right ascension with colons is hours, minutes, seconds; a plain number is degrees. What follows a `#` is for people.

use crate::sky::coords::{Equatorial, J2000};
use crate::units::Angle;

/// More lines are no list of a hand controller: the largest has 147,000 objects.
pub const MOST_LINES: usize = 200_000;

/// Longest name.
const LONGEST: usize = 60;

/// An object's place in the list.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    /// Any name by which the catalogue knows it.
    pub name: String,
    /// Where the hand controller has it.
    pub position: Equatorial<J2000>,
}

/// Why a list cannot be used: nothing of it is then.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlacesError {
    /// A line is not as it should be.
    #[error("line {line} of the list of coordinates: {what}; write `M31, 00:42:44, +41:16:09` or degrees, J2000")]
    Line {
        /// Counted from 1.
        line: usize,
        /// What is wrong.
        what: String,
    },
    /// Too long.
    #[error("the list of coordinates has more than {MOST_LINES} lines: cut it to the objects that you go to")]
    TooLong,
}

/// Reads a list.
///
/// # Errors
/// The line, and what is wrong there.
pub fn read(text: &str) -> Result<Vec<Placed>, PlacesError> {
    let mut placed = Vec::new();
    for (index, line) in text.lines().enumerate() {
        if index >= MOST_LINES {
            return Err(PlacesError::TooLong);
        }
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.is_empty() {
            continue;
        }
        placed.push(row(line).map_err(|what| PlacesError::Line { line: index + 1, what })?);
    }
    Ok(placed)
}

fn row(line: &str) -> Result<Placed, String> {
    let cells: Vec<&str> = line.split([',', ';', '\t']).map(str::trim).collect();
    let &[name, ra, dec] = cells.as_slice() else {
        return Err(format!("it has {} columns instead of name, right ascension, declination", cells.len()));
    };
    let name: String = name.chars().filter(|c| !c.is_control()).take(LONGEST).collect();
    if name.is_empty() {
        return Err(String::from("it has no name"));
    }
    let hours = ra.contains(':');
    let ra_deg = angle(ra).map(|value| if hours { value * 15.0 } else { value });
    let ra_deg = ra_deg.filter(|deg| (0.0..=360.0).contains(deg));
    let ra_deg = ra_deg.ok_or_else(|| format!("'{}' is no right ascension", shown(ra)))?;
    let dec_deg = angle(dec).filter(|deg| deg.abs() <= 90.0);
    let dec_deg = dec_deg.ok_or_else(|| format!("'{}' is no declination", shown(dec)))?;
    Ok(Placed { name, position: Equatorial::new(Angle::degrees(ra_deg), Angle::degrees(dec_deg)) })
}

/// A number, or up to three with colons between them, each but the first less than 60.
fn angle(text: &str) -> Option<f64> {
    let (sign, text) = match text.strip_prefix(['-', '\u{2212}']) {
        Some(rest) => (-1.0, rest),
        None => (1.0, text.strip_prefix('+').unwrap_or(text)),
    };
    let plain =
        |part: &str| part.parse::<f64>().ok().filter(|n| n.is_finite() && *n >= 0.0 && !part.starts_with(['+', '-']));
    let parts: Option<Vec<f64>> = text.split(':').map(|part| plain(part.trim())).collect();
    let value = match *parts?.as_slice() {
        [whole] => whole,
        [whole, minutes] if minutes < 60.0 => whole + minutes / 60.0,
        [whole, minutes, seconds] if minutes < 60.0 && seconds < 60.0 => whole + minutes / 60.0 + seconds / 3600.0,
        _ => return None,
    };
    Some(sign * value)
}

fn shown(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(30).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hours_and_degrees_are_told_apart_and_southern_arcminutes_stay_southern() {
        let text = "# Autostar II\nM31, 00:42:44, +41:16\n\nM42;83.822;-00:05:23.5 # the trapezium\nNGC 104\t00:24:05\t\u{2212}72:05\n";
        let placed = read(text).unwrap();
        let degrees: Vec<(f64, f64)> =
            placed.iter().map(|p| (p.position.ra().to_degrees(), p.position.dec().to_degrees())).collect();
        let wanted = [(10.683_333, 41.266_667), (83.822, -0.089_861), (6.020_833, -72.083_333)];
        for ((ra, dec), (wanted_ra, wanted_dec)) in degrees.iter().zip(wanted) {
            assert!((ra - wanted_ra).abs() < 1e-5 && (dec - wanted_dec).abs() < 1e-5, "{ra} {dec}");
        }
        assert_eq!(placed[2].name, "NGC 104");
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        for (text, words) in [
            ("M31, 0, 0\nM32, 25:00:00, 0", "line 2"),
            ("M31, 00:42:44, 91", "no declination"),
            ("M31, 00:61:00, 0", "no right ascension"),
            ("M31, nan, 0", "no right ascension"),
            ("M31, 0", "2 columns"),
            (", 0, 0", "no name"),
            ("M31, 1, --4", "no declination"),
            ("M31, \u{1b}[2J, 0", "'[2J' is no right ascension"),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains(words) && !error.chars().any(char::is_control), "{text:?}: {error}");
        }
        assert_eq!(read(&"\n".repeat(MOST_LINES + 1)), Err(PlacesError::TooLong));
    }

    proptest::proptest! {
        #[test]
        fn no_text_makes_it_fail(text in "\\PC{0,200}") {
            let _ = read(&text);
        }
    }
}
