//! From the names of the set's files to those of catalogues.

use crate::sky::catalogue::{Catalogue, Kind, Object};
use crate::sky::coords::{Equatorial, J2000};
use crate::units::{Angle, Magnitude};

/// Names without a number, as they are written in files and in the credits, and what they mean.
const WORDS: [(&str, &str); 16] = [
    ("etacarinae", "NGC 3372"),
    ("jonesemberson", "PK 164+31.1"),
    ("lmc", "LMC"),
    // Messier's 102nd is taken as NGC 5866 by the set, as M101 by the catalogue.
    ("m102", "NGC 5866"),
    ("medusa", "Abell 21"),
    ("n869884spano", "NGC 869"),
    ("pleiades", "M 45"),
    ("sadrregion", "Gamma Cygni"),
    ("gammacygni", "Gamma Cygni"),
    ("smcha", "SMC H-alpha"),
    ("smchydrogenalpha", "SMC H-alpha"),
    ("smc", "SMC"),
    ("velas", "Vela supernova remnant"),
    ("calabash", "Calabash"),
    ("darkshark", "LDN 1235"),
    ("wilds", "Wild's Triplet"),
];

/// Letters before a number, and the catalogue that they stand for.
const CATALOGUES: [(&str, &str); 17] = [
    ("m", "M"),
    ("n", "NGC"),
    ("ngc", "NGC"),
    ("ic", "IC"),
    ("u", "UGC"),
    ("ugc", "UGC"),
    ("p", "PGC"),
    ("pgc", "PGC"),
    ("b", "B"),
    ("barnard", "B"),
    ("abell", "Abell"),
    ("ldn", "LDN"),
    ("lbn", "LBN"),
    ("vdb", "vdB"),
    ("rcw", "RCW"),
    ("cassiopeia", "Cassiopeia"),
    ("sh", "Sh 2"),
];

/// An object's name in one writing: `n2903oleg`, `NGC2903` and `NGC 2903` are `NGC 2903`. What is in no known catalogue is its
/// letters in lower case.
#[must_use]
pub fn designation(name: &str) -> String {
    let lower = name.trim().to_lowercase();
    let lower = lower.strip_prefix("the ").unwrap_or(&lower);
    let letters_only: String = lower.chars().filter(|c| c.is_alphanumeric()).collect();
    if let Some((_, meant)) = WORDS.iter().find(|(word, _)| letters_only.starts_with(word)) {
        return (*meant).to_owned();
    }
    let digits = lower.find(|c: char| c.is_ascii_digit()).unwrap_or(lower.len());
    let (letters, rest) = lower.split_at(digits);
    // Sharpless' second catalogue has its number after "2-".
    let (letters, rest) = match (letters.trim(), rest.strip_prefix("2-")) {
        ("sh", Some(rest)) => ("sh", rest),
        (letters, _) => (letters, rest),
    };
    let number: String = rest.chars().take_while(char::is_ascii_digit).collect();
    let number = number.trim_start_matches('0');
    match CATALOGUES.iter().find(|(short, _)| *short == letters) {
        Some((_, catalogue)) if !number.is_empty() => format!("{catalogue} {number}"),
        _ => {
            let first = lower.split(['-', '.']).next().unwrap_or_default();
            first.chars().filter(|c| c.is_alphabetic()).collect()
        }
    }
}

/// The object of a photograph: the one that its name means, where the catalogue knows it; else the one that fills most of it.
#[must_use]
pub fn subject(name: &str, middle: &Equatorial<J2000>, radius: Angle, catalogue: &Catalogue) -> Option<Object> {
    let meant = designation(name);
    let numbered = meant.contains(|c: char| c.is_ascii_digit()) || WORDS.iter().any(|(_, word)| *word == meant);
    if numbered && let Ok(object) = catalogue.search(&meant) {
        return Some(object);
    }
    foremost(middle, radius, catalogue)
}

/// The object that a photograph of this place and reach is of: with its middle in the inner third, and of these the one that is
/// nearest to filling the photograph; stars are none.
#[must_use]
pub fn foremost(middle: &Equatorial<J2000>, radius: Angle, catalogue: &Catalogue) -> Option<Object> {
    let reach = radius * 0.33;
    let found = catalogue.within(middle, reach, Magnitude(99.0));
    let misfit = |axes_arcmin: f64| (axes_arcmin.max(0.05) / radius.to_arcminutes().max(1e-3)).ln().abs();
    let candidates = found.objects.iter().filter(|object| {
        !matches!(object.kind, Kind::Star | Kind::DoubleStar | Kind::Nova | Kind::SolarSystem | Kind::DarkNebula)
    });
    let sized = candidates.filter_map(|object| Some((object, misfit(object.axes_arcmin?.0))));
    let best = sized.filter(|(_, misfit)| *misfit < 2.3).min_by(|a, b| a.1.total_cmp(&b.1))?;
    catalogue.object(best.0.index)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_and_credits_write_one_name_in_many_ways() {
        for (written, name) in [
            ("n2903oleg", "NGC 2903"),
            ("NGC2903", "NGC 2903"),
            ("m51-vasey", "M 51"),
            ("m1dumont", "M 1"),
            ("ic4592", "IC 4592"),
            ("sh2-101-vasey", "Sh 2 101"),
            ("SH2-101", "Sh 2 101"),
            ("sh2-1-1", "Sh 2 1"),
            ("Barnard 142", "B 142"),
            ("barnard142-vasey", "B 142"),
            ("the Pleiades", "M 45"),
            ("pleiades", "M 45"),
            ("n869-884spano", "NGC 869"),
            ("u8335h", "UGC 8335"),
            ("barnard_loop-3", "barnardloop"),
            ("Barnard Loop", "barnardloop"),
            ("Cassiopeia A", "cassiopeiaa"),
            ("cassiopeia_a", "cassiopeiaa"),
            ("Virgo Cluster", "virgocluster"),
            ("lmc_07", "LMC"),
            ("LMC (Magellanic Clouds)", "LMC"),
        ] {
            assert_eq!(designation(written), name, "{written}");
        }
    }

    #[test]
    fn a_name_wins_and_without_one_the_object_that_fills_the_picture_does() {
        let catalogue = Catalogue::embedded();
        let at = |ra, dec| Equatorial::new(Angle::degrees(ra), Angle::degrees(dec));
        let ring = at(283.396, 33.029);
        let named = |name: &str| subject(name, &ring, Angle::arcminutes(3.0), catalogue).map(|object| object.name);
        assert_eq!(named("m31"), Some("M31".into()));
        assert_eq!(named("my first picture"), Some("M57".into()));
        // Two degrees about the Andromeda galaxy hold M32 and M110 too.
        let around = foremost(&at(10.685, 41.269), Angle::degrees(1.4), catalogue).unwrap();
        assert_eq!(around.name, "M31");
        assert_eq!(foremost(&at(10.0, -5.0), Angle::arcminutes(1.0), catalogue), None);
    }
}
