//! Tables of reference places, as the fixtures have them.

use scotopic::sky::coords::{Equatorial, OfDate};
use scotopic::units::Angle;

/// The cells of a fixture, header left out.
pub(crate) fn rows(name: &str) -> Vec<Vec<String>> {
    let path = format!("{}/fixtures/reference/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// A number of a cell.
pub(crate) fn number(cell: &str) -> f64 {
    cell.parse().unwrap()
}

/// Degrees of date.
pub(crate) fn of_date(ra: &str, dec: &str) -> Equatorial<OfDate> {
    Equatorial::new(Angle::degrees(number(ra)), Angle::degrees(number(dec)))
}
