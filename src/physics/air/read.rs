//! Profiles from text: TOML and CSV.

use serde::Deserialize;

use super::profile::{Profile, ProfileError, Row};
use super::rounding::rounded;
use super::us76;

/// Why a text is no profile.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ReadError {
    /// The rows are no atmosphere.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// Not TOML, or a key that is not known.
    #[error("{0}")]
    Toml(String),
    /// The first line of a CSV must name the columns.
    #[error("the columns are '{found}': the first line must be height_m,temperature_k[,relative_humidity_percent]")]
    Columns {
        /// The line found.
        found: String,
    },
    /// A field that is no number, or a missing or extra one.
    #[error("line {line}: '{found}' does not give the {columns} numbers that the first line names")]
    Line {
        /// Counted from 1.
        line: usize,
        /// The line found.
        found: String,
        /// How many numbers belong there.
        columns: usize,
    },
    /// A row of TOML must say its temperature once.
    #[error("row {row}: give temperature_k here or gradient_k_per_m in the row before, one of the two")]
    Temperature {
        /// Counted from 1.
        row: usize,
    },
}

/// A profile as TOML says it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    /// What it is, for people.
    #[serde(default)]
    name: String,
    /// Whose numbers they are.
    #[serde(default)]
    source: String,
    /// Height of the eye for which it was made, metres.
    observer_height_m: Option<f64>,
    /// Pressure at 0 m, pascal.
    ground_pressure_pa: Option<f64>,
    /// Carbon dioxide, parts per million.
    co2_ppm: Option<f64>,
    /// Standard deviation of the Gaussian that rounds kinks below 5 km, metres.
    #[serde(default)]
    rounding_m: f64,
    /// Humidity of rows that do not say theirs, percent.
    #[serde(default)]
    relative_humidity_percent: f64,
    row: Vec<DocumentRow>,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct DocumentRow {
    height_m: f64,
    temperature_k: Option<f64>,
    /// From this row up to the next.
    gradient_k_per_m: Option<f64>,
    relative_humidity_percent: Option<f64>,
}

/// A profile with what its file says about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Described {
    /// What it is, for people; may be empty.
    pub name: String,
    /// Whose numbers they are; may be empty.
    pub source: String,
    /// Height of the eye for which it was made, metres.
    pub observer_height_m: Option<f64>,
    /// The air.
    pub profile: Profile,
}

/// Reads a profile in TOML.
///
/// ```
/// let text = "
///     ground_pressure_pa = 101325      # at 0 m; this if left out
///     rounding_m = 2                   # kinks rounded by a Gaussian; sharp if left out
///     [[row]]
///     height_m = 0
///     temperature_k = 288
///     gradient_k_per_m = 0.08          # up to the next row, which then gives no temperature
///     [[row]]
///     height_m = 15
///     gradient_k_per_m = -0.0065
///     [[row]]
///     height_m = 11000                 # constant temperature above the last row
/// ";
/// let air = scotopic::physics::air::read::from_toml(text)?.profile;
/// // Halfway up the inversion the rounded kinks at its ends are not felt.
/// assert!((air.parcel(7.5).temperature_k - 288.6).abs() < 1e-3);
/// # Ok::<(), scotopic::physics::air::read::ReadError>(())
/// ```
///
/// # Errors
/// It is not TOML, has unknown keys, or its rows are no atmosphere.
pub fn from_toml(text: &str) -> Result<Described, ReadError> {
    let document: Document = toml::from_str(text).map_err(|error| ReadError::Toml(error.to_string()))?;
    let mut rows: Vec<Row> = Vec::with_capacity(document.row.len());
    for (i, row) in document.row.iter().enumerate() {
        let before = i.checked_sub(1).map(|j| (rows[j], document.row[j].gradient_k_per_m));
        let temperature_k = match (row.temperature_k, before) {
            (Some(t), None | Some((_, None))) => t,
            (None, Some((last, Some(gradient)))) => last.temperature_k + gradient * (row.height_m - last.height_m),
            _ => return Err(ReadError::Temperature { row: i + 1 }),
        };
        let humidity_percent = row.relative_humidity_percent.unwrap_or(document.relative_humidity_percent);
        rows.push(Row { height_m: row.height_m, temperature_k, humidity_percent });
    }
    if document.row.last().is_some_and(|row| row.gradient_k_per_m.is_some()) {
        return Err(ReadError::Temperature { row: rows.len() + 1 });
    }
    let sharp = Profile::new(&rows, document.ground_pressure_pa.unwrap_or(us76::P0_PA))?;
    let mut profile = match document.rounding_m {
        0.0 => sharp,
        width => Profile::new(&rounded(&rows, width)?, document.ground_pressure_pa.unwrap_or(us76::P0_PA))?,
    };
    if let Some(co2_ppm) = document.co2_ppm {
        profile = profile.with_co2_ppm(co2_ppm);
    }
    let Document { name, source, observer_height_m, .. } = document;
    Ok(Described { name, source, observer_height_m, profile })
}

/// Reads a profile in CSV: `height_m,temperature_k[,relative_humidity_percent]`, lines that begin with `#` left out.
///
/// # Errors
/// The columns or numbers are not those, or the rows are no atmosphere.
pub fn from_csv(text: &str) -> Result<Profile, ReadError> {
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let (_, header) = lines.next().unwrap_or_default();
    let columns = match header.split(',').map(str::trim).collect::<Vec<_>>()[..] {
        ["height_m", "temperature_k"] => 2,
        ["height_m", "temperature_k", "relative_humidity_percent"] => 3,
        _ => return Err(ReadError::Columns { found: header.to_owned() }),
    };
    let mut rows = Vec::new();
    for (line, found) in lines {
        let numbers: Result<Vec<f64>, _> = found.split(',').map(|field| field.trim().parse()).collect();
        match numbers.as_deref() {
            Ok(&[height_m, temperature_k]) if columns == 2 => {
                rows.push(Row { height_m, temperature_k, humidity_percent: 0.0 });
            }
            Ok(&[height_m, temperature_k, humidity_percent]) if columns == 3 => {
                rows.push(Row { height_m, temperature_k, humidity_percent });
            }
            _ => return Err(ReadError::Line { line, found: found.to_owned(), columns }),
        }
    }
    Ok(Profile::new(&rows, us76::P0_PA)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn csv_with_humidity_and_remarks_is_read() {
        let air =
            from_csv("# mine\nheight_m,temperature_k,relative_humidity_percent\n10,288,80\n\n1000,281.5,20\n").unwrap();
        assert!((air.parcel(0.0).temperature_k - 288.0).abs() < 1e-12, "isothermal below the first row");
        assert!((air.parcel(5000.0).temperature_k - 281.5).abs() < 1e-12, "isothermal above the last");
        assert!(air.parcel(10.0).vapour > air.parcel(1000.0).vapour);
    }

    #[test]
    fn what_is_no_profile_is_refused_with_its_line() {
        let head = "height_m,temperature_k\n";
        let refused = |rows: &str| from_csv(&format!("{head}{rows}")).unwrap_err().to_string();
        assert!(refused("0,288\nten,280\n").contains("line 3"));
        assert!(refused("0,288,50\n10,280\n").contains("line 2"));
        assert!(refused("0,288\n").contains("at least 2"));
        assert!(refused("0,288\n100,280\n50,285\n").contains("row 3"));
        assert!(refused("0,288\n100,280\n100,285\n").contains("stands twice"));
        assert!(refused("0,288\n100,NaN\n").contains("temperature NaN"));
        assert!(refused("0,288\n100,0\n").contains("temperature 0 K"));
        assert!(refused("0,288\n100,-5\n").contains("temperature -5 K"));
        assert!(refused("-10,288\n100,280\n").contains("height -10 m"));
        assert!(from_csv("z,T\n0,288\n").unwrap_err().to_string().contains("z,T"));
        assert!(from_csv("").unwrap_err().to_string().contains("height_m"));
    }

    #[test]
    fn toml_says_temperature_once_a_row() {
        let twice =
            "[[row]]\nheight_m=0\ntemperature_k=288\ngradient_k_per_m=1\n[[row]]\nheight_m=1\ntemperature_k=289\n";
        assert_eq!(from_toml(twice), Err(ReadError::Temperature { row: 2 }));
        let never = "[[row]]\nheight_m=0\ntemperature_k=288\n[[row]]\nheight_m=1\n";
        assert_eq!(from_toml(never), Err(ReadError::Temperature { row: 2 }));
        let typo = "[[row]]\nheight=0\ntemperature_k=288\n";
        assert!(matches!(from_toml(typo), Err(ReadError::Toml(text)) if text.contains("height")));
    }
}
