//! A table as text: parameters in comments, then a line for each row, numbers in full precision.
//!
//! ```text
//! # scotopic scattering table 1
//! # albedo = 0.6
//! ...
//! depth,unscattered,unscattered_error,share 1,...,share M,error 1,...,error M
//! 0,1,0,0,...
//! ```

use std::fmt::Write as _;

use super::{Depth, Length, Parameters, Spacing, Table, TableError};
use crate::physics::dust::phase::HenyeyGreenstein;
use crate::physics::dust::sphere::Source;

/// The first line.
const MAGIC: &str = "# scotopic scattering table 1";

/// Bytes beyond which a file is no table.
pub const LARGEST: usize = 1 << 29;

/// Why a text is no table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReadError {
    /// It begins otherwise.
    #[error("it does not begin with '# scotopic scattering table 1'")]
    Magic,
    /// A parameter.
    #[error("its heading has no usable {0}")]
    Heading(&'static str),
    /// The parameters together.
    #[error(transparent)]
    Parameters(#[from] TableError),
    /// A line.
    #[error("line {0} has not the numbers that its heading tells of")]
    Line(usize),
}

const SPACINGS: [(Spacing, &str); 2] = [(Spacing::Cosine, "cosine"), (Spacing::Angle, "angle")];
const LENGTHS: [(Length, &str); 2] = [(Length::Edge, "edge"), (Length::Diameter, "diameter")];
const DEPTHS: [(Depth, &str); 3] =
    [(Depth::Extinction, "extinction"), (Depth::Scattering, "scattering"), (Depth::Printed, "printed")];

fn word<T: PartialEq>(of: &[(T, &'static str)], value: &T) -> &'static str {
    of.iter().find(|(each, _)| each == value).map_or("", |(_, word)| word)
}

fn value<T: Copy>(of: &[(T, &'static str)], word: &str) -> Option<T> {
    of.iter().find(|(_, each)| *each == word).map(|(value, _)| *value)
}

macro_rules! words {
    ($type:ty, $all:ident, $what:literal) => {
        impl std::str::FromStr for $type {
            type Err = String;

            fn from_str(word: &str) -> Result<$type, String> {
                value(&$all, word).ok_or_else(|| {
                    let words: Vec<&str> = $all.iter().map(|(_, word)| *word).collect();
                    format!(concat!("'{}' is no ", $what, ": give {}"), word, words.join(" or "))
                })
            }
        }

        impl std::fmt::Display for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(word(&$all, self))
            }
        }
    };
}

words!(Spacing, SPACINGS, "spacing");
words!(Length, LENGTHS, "length");
words!(Depth, DEPTHS, "depth");

/// The parameters as lines of `name = value`: equal for equal tables, and so a key to them.
#[must_use]
pub fn heading(p: &Parameters) -> String {
    format!(
        "albedo = {}\nasymmetry = {}\ndeepest = {}\ndepths = {}\ndirections = {}\nspacing = {}\nsource = {}\nlength = {}\ndepth = {}\n",
        p.albedo,
        p.phase.asymmetry(),
        p.deepest,
        p.depths,
        p.directions,
        p.spacing,
        p.source.name(),
        p.length,
        p.depth,
    )
}

/// A table as text.
#[must_use]
pub fn write(table: &Table) -> String {
    let p = table.parameters();
    let mut text = format!("{MAGIC}\n");
    for line in heading(p).lines() {
        text += &format!("# {line}\n");
    }
    text += "# Shares of the light that enters, in bins of direction between these cosines of the angle turned through:\n# cosines = ";
    text += &p.edges().iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    text += "\ndepth,unscattered,unscattered_error";
    for what in ["share", "error"] {
        for bin in 1..=p.directions {
            // Writing to a string does not fail.
            let _ = write!(text, ",{what}_{bin}");
        }
    }
    text.push('\n');
    for row in 0..p.depths {
        let [share, error] = table.unscattered(row);
        let _ = write!(text, "{},{share},{error:e}", p.row(row));
        for number in table.bins(row).iter().chain(table.errors(row)) {
            let _ = write!(text, ",{number:e}");
        }
        text.push('\n');
    }
    text
}

/// The table of a text.
///
/// # Errors
/// What is wrong, and where.
pub fn read(text: &str) -> Result<Table, ReadError> {
    let (comments, body): (Vec<_>, Vec<_>) = (1..).zip(text.lines()).partition(|(_, line)| line.starts_with('#'));
    if comments.first().is_none_or(|(_, line)| *line != MAGIC) {
        return Err(ReadError::Magic);
    }
    let find = |name: &'static str| {
        let values = comments.iter().filter_map(|(_, line)| line.strip_prefix("# ")?.split_once(" = "));
        values.into_iter().find(|(key, _)| *key == name).map(|(_, value)| value).ok_or(ReadError::Heading(name))
    };
    let number = |name| find(name)?.parse::<f64>().map_err(|_no_number| ReadError::Heading(name));
    let count = |name| find(name)?.parse::<usize>().map_err(|_no_number| ReadError::Heading(name));
    let parameters = Parameters {
        albedo: number("albedo")?,
        phase: HenyeyGreenstein::new(number("asymmetry")?).ok_or(ReadError::Heading("asymmetry"))?,
        deepest: number("deepest")?,
        depths: count("depths")?,
        directions: count("directions")?,
        spacing: value(&SPACINGS, find("spacing")?).ok_or(ReadError::Heading("spacing"))?,
        source: find("source")?.parse::<Source>().map_err(|_no_source| ReadError::Heading("source"))?,
        length: value(&LENGTHS, find("length")?).ok_or(ReadError::Heading("length"))?,
        depth: value(&DEPTHS, find("depth")?).ok_or(ReadError::Heading("depth"))?,
    };
    parameters.checked()?;
    let m = parameters.directions;
    let (mut unscattered, mut bins, mut errors) = (Vec::new(), Vec::new(), Vec::new());
    let mut last = 0;
    for (number, line) in body.into_iter().skip(1) {
        let cells: Option<Vec<f64>> = line.split(',').map(|cell| cell.parse().ok()).collect();
        let cells = cells.filter(|cells| cells.len() == 3 + 2 * m).ok_or(ReadError::Line(number))?;
        unscattered.push([cells[1], cells[2]]);
        bins.extend(&cells[3..3 + m]);
        errors.extend(&cells[3 + m..]);
        last = number;
    }
    Table::new(parameters, unscattered, bins, errors).ok_or(ReadError::Line(last))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let parameters = Parameters { depths: 3, directions: 2, deepest: 0.3, ..Parameters::thesis().unwrap() };
        Table::new(parameters, vec![[1.0, 0.0], [0.7, 1e-15], [0.1 + 0.2, 1e-15]], vec![0.1; 6], vec![1e-3; 6]).unwrap()
    }

    #[test]
    fn a_table_is_read_as_it_was_written_to_the_last_bit() {
        assert_eq!(read(&write(&table())), Ok(table()));
    }

    #[test]
    fn what_is_no_table_is_refused_in_words() {
        let text = write(&table());
        for (wrong, word) in [
            (String::new(), "begin"),
            (text.replace("# albedo = 0.6\n", ""), "albedo"),
            (text.replace("albedo = 0.6", "albedo = 7"), "albedo of 7"),
            (text.replace("source = pencil", "source = lamp"), "source"),
            (text.replace("depths = 3", "depths = 4"), "numbers"),
            (text.replace("depths = 3", "depths = 99999999999"), "depths"),
            (text.replace("1e-15", "NaN"), "numbers"),
            (text.replace("0.7,", "0.7,0,"), "line 15"),
        ] {
            let told = read(&wrong).unwrap_err().to_string();
            assert!(told.contains(word), "{told}");
        }
    }
}
