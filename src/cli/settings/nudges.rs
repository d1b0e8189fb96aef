//! The nudges of the sessions with a real mount, a line each, from which the drive's periodic error is learned.

use std::path::PathBuf;

use super::state;
use crate::registration::periodic::Nudged;

/// The line that a sync leaves.
pub const SYNC: &str = "sync";

/// More nudges than this are not kept in mind: the last count.
const MOST: usize = 20_000;

/// A night ends where nobody nudged for so long, seconds.
const NIGHT_S: f64 = 4.0 * 3600.0;

/// `scotopic/nudges.csv` in the user's state folder, if there is one.
#[must_use]
pub fn default_path() -> Option<PathBuf> {
    state::default_path().map(|path| path.with_file_name("nudges.csv"))
}

/// The line of a nudge: seconds of UTC, and the whole correction that then stood, arcseconds east and north.
#[must_use]
pub fn line(at_s: f64, east_arcsec: f64, north_arcsec: f64) -> String {
    if east_arcsec == 0.0 && north_arcsec == 0.0 {
        format!("{SYNC}\n")
    } else {
        format!("{at_s:.1},{east_arcsec:.2},{north_arcsec:.2}\n")
    }
}

/// The nudges of the last night in a file's text.
///
/// # Errors
/// Which line is none.
pub fn read(text: &str) -> Result<Vec<Nudged>, String> {
    let (mut nudges, mut stretch): (Vec<Nudged>, usize) = (Vec::new(), 0);
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        if line == SYNC {
            stretch += usize::from(nudges.last().is_some_and(|last| last.stretch == stretch));
            continue;
        }
        let numbers: Vec<f64> = line.split(',').filter_map(|part| part.trim().parse().ok()).collect();
        let [at_s, east_arcsec, _north] = numbers[..] else {
            return Err(format!("line {} is not seconds,east_arcsec,north_arcsec", number + 1));
        };
        if !numbers.iter().all(|number| number.is_finite()) {
            return Err(format!("line {} has a number that is not finite", number + 1));
        }
        if nudges.last().is_some_and(|last| (at_s - last.at_s).abs() > NIGHT_S) {
            nudges.clear();
            stretch = 0;
        }
        nudges.push(Nudged { at_s, east_arcsec, stretch });
    }
    let first = nudges.len().saturating_sub(MOST);
    Ok(nudges.split_off(first))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_night_is_read_with_its_syncs() {
        let mut text = String::from("# nudges\n100.0,5.0,1.0\n");
        text += &line(900_000.0, 3.0, 0.5);
        text += &line(900_010.0, 0.0, 0.0);
        text += &line(900_020.0, -2.25, 0.0);
        let read = read(&text).unwrap();
        assert_eq!(
            read,
            [
                Nudged { at_s: 900_000.0, east_arcsec: 3.0, stretch: 0 },
                Nudged { at_s: 900_020.0, east_arcsec: -2.25, stretch: 1 },
            ]
        );
    }

    #[test]
    fn a_line_that_is_none_is_named() {
        assert!(read("1,2,3\nhello\n").unwrap_err().contains("line 2"));
        assert!(read("1,2,inf\n").unwrap_err().contains("not finite"));
    }
}
