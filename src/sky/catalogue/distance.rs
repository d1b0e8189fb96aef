//! How far deep-sky objects are: Messier's and Caldwell's, from a table; stars by their parallax.

use std::collections::HashMap;
use std::sync::OnceLock;

/// See its head for where the numbers come from.
static TABLE: &str = include_str!("data/distances.tsv");

/// Light years in a parsec.
pub const LIGHT_YEARS: f64 = 3.261_563_8;

/// How far something is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distance {
    /// Parsecs.
    pub parsec: f64,
    /// Whether it is right to a factor of 2 only, as those of planetary nebulae are.
    pub rough: bool,
}

impl Distance {
    /// From a parallax that says something: larger than a milliarcsecond, about its own error in the catalogue.
    #[must_use]
    pub fn of_parallax(mas: f64) -> Option<Distance> {
        (mas > 1.0).then(|| Distance { parsec: 1000.0 / mas, rough: false })
    }

    /// The distance in the table under any of an object's names.
    #[must_use]
    pub fn listed<'a>(names: impl IntoIterator<Item = &'a str>) -> Option<Distance> {
        static READ: OnceLock<HashMap<&'static str, Distance>> = OnceLock::new();
        let table = READ.get_or_init(|| TABLE.lines().filter(|line| !line.starts_with('#')).filter_map(row).collect());
        names.into_iter().find_map(|name| table.get(name).copied())
    }

    /// How much fainter than at 10 parsecs the distance alone makes it, magnitudes: m - M = 5 lg(d / 10 pc).
    #[must_use]
    pub fn modulus(&self) -> f64 {
        5.0 * (self.parsec / 10.0).log10()
    }

    /// In light years: `25.0 ly`, `1290 ly`, `23 500 ly`, `2.58 million ly`; `about` before what is rough.
    #[must_use]
    pub fn words(&self) -> String {
        let ly = self.parsec * LIGHT_YEARS;
        let number = if ly < 100.0 {
            format!("{ly:.1}")
        } else if ly < 1e4 {
            format!("{:.0}", if ly < 1000.0 { ly } else { (ly / 10.0).round() * 10.0 })
        } else if ly < 1e6 {
            let hundreds = (ly / 100.0).round() as u64;
            format!("{} {:03}", hundreds / 10, hundreds % 10 * 100)
        } else {
            format!("{:.*} million", if ly < 1e7 { 2 } else { 0 }, ly / 1e6)
        };
        format!("{}{number} ly", if self.rough { "about " } else { "" })
    }
}

fn row(line: &'static str) -> Option<(&'static str, Distance)> {
    let mut cells = line.split('\t');
    let (name, parsec) = (cells.next()?, cells.next()?.parse().ok()?);
    Some((name, Distance { parsec, rough: cells.next() == Some("~") }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::catalogue::Catalogue;

    /// NASA's pages: M31 2.5 million light years, M13 22,000 to 25,000, the Pleiades 440; Vega 25.0 by Hipparcos.
    #[test]
    fn what_everybody_knows_the_distance_of_is_so_far() {
        for (name, light_years, within) in
            [("M31", 2.5e6, 0.05), ("M13", 23_500.0, 0.07), ("M45", 440.0, 0.05), ("Vega", 25.05, 0.02)]
        {
            let distance = Catalogue::embedded().search(name).unwrap().distance.unwrap();
            assert!((distance.parsec * LIGHT_YEARS / light_years - 1.0).abs() < within, "{name}: {}", distance.words());
        }
        let ring = Catalogue::embedded().search("M57").unwrap().distance.unwrap();
        assert!(ring.rough && ring.words().starts_with("about "));
    }

    #[test]
    fn every_name_of_the_table_is_an_object_of_the_catalogue_and_every_messier_object_but_one_has_a_distance() {
        let rows: Vec<_> = TABLE.lines().filter(|line| !line.starts_with('#')).filter_map(row).collect();
        assert_eq!(rows.len(), TABLE.lines().filter(|line| !line.starts_with('#')).count());
        for (name, distance) in &rows {
            let object = Catalogue::embedded().search(name).unwrap();
            assert!(object.names.iter().any(|own| own == name) && object.distance.is_some(), "{name}");
            assert!((10.0..2e8).contains(&distance.parsec), "{name}");
        }
        let without = (1..=110).filter(|n| Catalogue::embedded().search(&format!("M{n}")).unwrap().distance.is_none());
        // M40 is two stars that only look like a pair.
        assert_eq!(without.collect::<Vec<_>>(), [40]);
    }

    #[test]
    fn light_years_are_said_as_a_person_says_them() {
        let words = |parsec| Distance { parsec, rough: false }.words();
        assert_eq!(words(7.68), "25.0 ly");
        assert_eq!(words(133.0), "434 ly");
        assert_eq!(words(1205.0), "3930 ly");
        assert_eq!(words(7100.0), "23 200 ly");
        assert_eq!(words(790_000.0), "2.58 million ly");
        assert_eq!(words(1.6e7), "52 million ly");
    }
}
