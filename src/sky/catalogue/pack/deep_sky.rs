//! Packs OpenNGC: one line an object, its names first.

use std::collections::{HashMap, HashSet};

use super::{PackError, Packed, Sources, Table};
use crate::sky::catalogue::constellation;

/// Names in use that OpenNGC lacks, by OpenNGC's own name. M102 is Mechain's second sight of M101, as he wrote himself in 1783
/// and as OpenNGC has it; others take NGC 5866 for it.
const BY_HAND: [(&str, &str); 38] = [
    ("NGC5457", "M102;Pinwheel Galaxy"),
    ("NGC0224", "Andromeda"),
    ("NGC0598", "Pinwheel Nebula"),
    ("Mel022", "Seven Sisters;Subaru;Melotte 22"),
    ("NGC1976", "Great Nebula in Orion"),
    ("NGC1982", "De Mairan's Nebula"),
    ("NGC2632", "Praesepe;Beehive Cluster"),
    ("NGC3034", "Cigar"),
    ("NGC3031", "Bode's Nebula"),
    ("NGC5194", "Whirlpool"),
    ("NGC4594", "Sombrero"),
    ("NGC6720", "Ring"),
    ("NGC6853", "Dumbbell;Apple Core Nebula"),
    ("NGC0650", "Little Dumbbell"),
    ("NGC6205", "Great Hercules Cluster;Hercules Cluster"),
    ("NGC6523", "Lagoon"),
    ("NGC6514", "Trifid"),
    ("NGC6618", "Swan Nebula;Omega Nebula;Horseshoe Nebula"),
    ("NGC6705", "Wild Duck"),
    ("NGC3587", "Owl"),
    ("NGC0104", "47 Tucanae;47 Tuc"),
    ("NGC5139", "omega Cen"),
    ("NGC2070", "Tarantula;30 Doradus;30 Dor"),
    ("NGC4755", "Jewel Box;Jewel Box Cluster"),
    ("NGC0869", "h Persei;h Per"),
    ("NGC0884", "chi Persei"),
    ("NGC7293", "Helix"),
    ("NGC7009", "Saturn"),
    ("NGC2392", "Clown Face Nebula"),
    ("NGC6543", "Cat Eye Nebula"),
    ("NGC3242", "Ghost of Jupiter"),
    ("NGC7662", "Blue Snowball;Blue Snowball Nebula"),
    ("NGC3372", "Eta Carinae Nebula"),
    ("NGC4565", "Needle"),
    ("NGC7789", "Caroline's Rose;White Rose Cluster"),
    ("NGC0457", "ET Cluster"),
    ("ESO056-115", "LMC"),
    ("NGC0292", "SMC"),
];

/// Places that OpenNGC has wrong by more than an arcsecond where a point can be named, by OpenNGC's own name, in degrees at
/// J2000. M57: its central star, 18h53m35.08s +33d01m45.0s; OpenNGC's place is 2.3 arcseconds from it.
const PLACES: [(&str, &str, &str); 1] = [("NGC6720", "283.396167", "33.029167")];

/// Packs `openngc.tsv`.
pub(super) fn pack(sources: &Sources<'_>, packed: &mut Packed) -> Result<(), PackError> {
    let lists = lists(sources.lists)?;
    let table = Table::new("openngc.csv", ';', sources.openngc);
    let text = ["name", "type", "ra_deg", "dec_deg", "const", "majax", "minax", "pa", "bmag", "vmag", "hubble"];
    let columns = text.map(|column| table.column(column));
    let [name, kind, ra, dec, con, major, minor, angle, b, v, hubble] = columns;
    let (name, kind, con, hubble) = (name?, kind?, con?, hubble?);
    let (ra, dec, major, minor, angle, b, v) = (ra?, dec?, major?, minor?, angle?, b?, v?);
    let (messier, ngc, ic) = (table.column("messier")?, table.column("ngc")?, table.column("ic")?);
    let common = table.column("commonnames")?;
    packed.openngc = String::from(
        "# From OpenNGC by Mattia Verga (https://github.com/mattiaverga/OpenNGC), CC-BY-SA-4.0; this file is under that licence.\n\
         # names\tlists\ttype\tra_deg\tdec_deg\tconstellation\tmajor_arcmin\tminor_arcmin\tposition_angle_deg\tB\tV\thubble\n",
    );
    let rows: HashSet<&str> = Table::new("openngc.csv", ';', sources.openngc).map(|row| row.text(name)).collect();
    let (mut objects, mut listed) = (0, 0);
    for row in table {
        for column in [ra, dec] {
            row.required(column)?;
        }
        for column in [major, minor, angle, b, v] {
            row.number(column)?;
        }
        let own = row.text(name);
        // A number of the lists that OpenNGC has only as another name of a row (NGC 2244 is its NGC 2239) counts for that row.
        let numbers = |column, catalogue: &'static str| {
            let numbers = row.text(column).split(',').filter(|number| !number.is_empty());
            numbers.map(move |number| format!("{catalogue}{number}"))
        };
        let others = numbers(ngc, "NGC").chain(numbers(ic, "IC")).filter(|other| !rows.contains(other.as_str()));
        let members: Vec<&str> = std::iter::once(own.to_owned())
            .chain(others)
            .filter_map(|name| lists.get(&name))
            .flat_map(|member| member.split_whitespace())
            .collect();
        let mut names: Vec<String> = Vec::new();
        let mut add = |name: String| {
            if !name.is_empty() && !names.iter().any(|known| known.eq_ignore_ascii_case(&name)) {
                names.push(name);
            }
        };
        add(Some(row.text(messier))
            .filter(|number| !number.is_empty())
            .map_or(String::new(), |n| display(&format!("M{n}"))));
        members.iter().filter(|entry| entry.starts_with('M')).for_each(|entry| add((*entry).to_owned()));
        add(display(own));
        numbers(ngc, "NGC").chain(numbers(ic, "IC")).for_each(|name| add(display(&name)));
        members.iter().filter(|entry| entry.starts_with('C')).for_each(|entry| add((*entry).to_owned()));
        let by_hand = BY_HAND.iter().find(|entry| entry.0 == own).map_or("", |entry| entry.1);
        let common = row.text(common).split(',').chain(by_hand.split(';'));
        common.for_each(|name| add(name.trim().trim_start_matches("the ").to_owned()));
        let herschel = if members.contains(&"H400") { "H400" } else { "" };
        listed += usize::from(!members.is_empty());
        let con = match row.text(con) {
            "Se1" | "Se2" => "Ser",
            other => constellation::abbreviation(other).unwrap_or(""),
        };
        let names = names.join(";");
        let mended = PLACES.iter().find(|place| place.0 == own);
        let (ra, dec) = mended.map_or((row.text(ra), row.text(dec)), |place| (place.1, place.2));
        let line = [
            &names,
            herschel,
            row.text(kind),
            ra,
            dec,
            con,
            row.text(major),
            row.text(minor),
            row.text(angle),
            row.text(b),
            row.text(v),
            row.text(hubble),
        ];
        let line = line.map(|cell| cell.chars().filter(|c| !c.is_control()).collect::<String>()).join("\t");
        packed.openngc.push_str(&line);
        packed.openngc.push('\n');
        objects += 1;
    }
    packed.notes.push(format!(
        "{objects} objects of OpenNGC, {listed} of them in Messier's, Caldwell's or the Herschel 400 list"
    ));
    Ok(())
}

/// The observing lists by OpenNGC's name: `H400 M110`.
fn lists(text: &str) -> Result<HashMap<String, String>, PackError> {
    let table = Table::new("observing_lists.csv", ',', text);
    let (name, lists) = (table.column("name")?, table.column("lists")?);
    Ok(table.map(|row| (row.text(name).to_owned(), row.text(lists).to_owned())).collect())
}

/// OpenNGC's name as people write it: `NGC0224` is NGC 224, `M031` is M31, `Cl399` is Cr 399.
fn display(name: &str) -> String {
    let digits = name.find(|c: char| c.is_ascii_digit()).unwrap_or(name.len());
    let (catalogue, rest) = name.split_at(digits);
    let number = rest.trim_start_matches('0');
    match catalogue {
        "M" | "C" => format!("{catalogue}{number}"),
        "ESO" => format!("ESO {rest}"),
        "Cl" => format!("Cr {number}"),
        "H" => format!("Harvard {number}"),
        _ => format!("{catalogue} {number}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_written_as_people_write_them() {
        for (raw, written) in [
            ("NGC0224", "NGC 224"),
            ("M031", "M31"),
            ("C009", "C9"),
            ("IC0080 NED01", "IC 80 NED01"),
            ("ESO056-115", "ESO 056-115"),
            ("Cl399", "Cr 399"),
        ] {
            assert_eq!(display(raw), written);
        }
    }
}
