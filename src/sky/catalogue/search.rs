//! Finding what a person means by what they typed.

use std::borrow::Cow;
use std::collections::HashMap;

use super::constellation;
use super::deep_sky::DeepSkyCatalogue;
use super::star_names::{GREEK, StarNames};

/// More letters than this are not read.
pub(super) const LONGEST: usize = 64;

/// What a name leads to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Target {
    /// A star by its HIP number.
    Star(u32),
    /// A row of OpenNGC.
    DeepSky(usize),
}

/// A name in the index. The order of the fields is the order of the index.
#[derive(Debug, Clone)]
struct Entry {
    key: String,
    rank: u8,
    name: Cow<'static, str>,
    target: Target,
}

/// All names, by their keys.
#[derive(Debug)]
pub(super) struct Index {
    entries: Vec<Entry>,
    bayer: HashMap<(&'static str, char), Vec<StarNames>>,
    flamsteed: HashMap<(&'static str, u16), Vec<StarNames>>,
}

/// Names that are of the solar system: they move, and no catalogue of fixed places has them.
const MOVING: [&str; 19] = [
    "sun", "moon", "mercury", "venus", "mars", "jupiter", "saturn", "uranus", "neptune", "pluto", "ceres", "vesta",
    "pallas", "juno", "triton", "charon", "nereid", "amalthea", "phoebe",
];

/// Whether a name is of the solar system.
pub(super) fn moves(text: &str) -> bool {
    MOVING.contains(&key(text).as_str())
}

/// What was typed, without terminal escapes and control characters, cut to [`LONGEST`].
pub(super) fn clean(text: &str) -> String {
    let mut cleaned = String::new();
    let mut chars = text.chars().peekable();
    while let Some(c) = chars.next() {
        if c == '\u{1b}' && chars.next_if_eq(&'[').is_some() {
            // A control sequence runs to its first letter or sign from @ to ~.
            while chars.next().is_some_and(|c| !('@'..='~').contains(&c)) {}
        } else if c.is_whitespace() {
            cleaned.push(' ');
        } else if !c.is_control() {
            cleaned.push(c);
        }
    }
    cleaned.trim().chars().take(LONGEST).collect()
}

/// Raised digits as plain ones, letters without their accents.
fn plain(c: char) -> char {
    match c {
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁴'..='⁹' => char::from(b'4' + (c as u32 - '⁴' as u32) as u8),
        'à'..='å' | 'À'..='Å' => 'a',
        'è'..='ë' | 'È'..='Ë' => 'e',
        'ì'..='ï' | 'Ì'..='Ï' => 'i',
        'ò'..='ö' | 'Ò'..='Ö' => 'o',
        'ù'..='ü' | 'Ù'..='Ü' => 'u',
        'ç' | 'Ç' => 'c',
        'ñ' | 'Ñ' => 'n',
        'ϵ' => 'ε',
        'ϑ' => 'θ',
        'ϕ' => 'φ',
        'ς' => 'σ',
        'µ' => 'μ',
        _ => c,
    }
}

/// Small letters, Greek ones in full, words apart.
fn words(text: &str) -> Vec<String> {
    let mut spaced = String::new();
    // A number stays with the Greek letter before it; a letter behind them starts the next word.
    let mut after_greek = false;
    for c in text.chars().map(plain).flat_map(char::to_lowercase) {
        if let Some(row) = GREEK.iter().find(|row| row.0 == c) {
            spaced.push(' ');
            spaced.push_str(row.2);
            after_greek = true;
        } else if c.is_alphanumeric() {
            if after_greek && !c.is_ascii_digit() {
                spaced.push(' ');
                after_greek = false;
            }
            spaced.push(c);
        } else if !"'’`".contains(c) {
            spaced.push(' ');
            after_greek = false;
        }
    }
    spaced.split_whitespace().map(str::to_owned).collect()
}

/// The form in which names are compared: small letters and digits only, no leading zeros, catalogues abbreviated.
pub(super) fn key(text: &str) -> String {
    let mut parts = words(text);
    if parts.len() > 1 && parts[0] == "the" {
        parts.remove(0);
    }
    let mut key = String::new();
    for c in parts.concat().chars() {
        let leading_zero = key.ends_with('0') && c.is_ascii_digit() && {
            let before = key.chars().rev().nth(1);
            before.is_some_and(|before| !before.is_ascii_digit())
        };
        if leading_zero {
            key.pop();
        }
        key.push(c);
    }
    for (long, short) in [
        ("messier", "m"),
        ("caldwell", "c"),
        ("melotte", "mel"),
        ("collinder", "cr"),
        ("barnard", "b"),
        ("hipparcos", "hip"),
    ] {
        if let Some(number) = key.strip_prefix(long).filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit())) {
            return format!("{short}{number}");
        }
    }
    key
}

/// How well a name is known: the best known are offered first.
fn rank_of_deep_sky(name: &str) -> u8 {
    let catalogue = name.split(|c: char| c.is_ascii_digit()).next().unwrap_or("");
    let has_number = name.len() > catalogue.len();
    match catalogue {
        "M" if has_number => 0,
        "C" if has_number => 3,
        "NGC " => 6,
        "IC " => 7,
        "Mel " | "Cr " | "Harvard " | "B " | "HCG " | "UGC " | "PGC " | "ESO " | "MWSC" => 9,
        _ => 2,
    }
}

impl Index {
    pub(super) fn new(stars: &[StarNames], deep_sky: &DeepSkyCatalogue) -> Index {
        let mut entries = Vec::with_capacity(32_768);
        let mut add = |name: Cow<'static, str>, rank: u8, target: Target| {
            entries.push(Entry { key: key(&name), rank, name, target });
        };
        let mut bayer: HashMap<(&'static str, char), Vec<StarNames>> = HashMap::new();
        let mut flamsteed: HashMap<(&'static str, u16), Vec<StarNames>> = HashMap::new();
        for star in stars {
            let target = Target::Star(star.hip);
            star.proper.split(';').filter(|name| !name.is_empty()).for_each(|name| add(Cow::Borrowed(name), 1, target));
            if let Some(full) = star.bayer_in_full() {
                add(Cow::Owned(full), 4, target);
            }
            if let Some(letter) = star.letter() {
                bayer.entry((star.constellation, letter)).or_default().push(*star);
            }
            if let Ok(number) = star.flamsteed.parse() {
                add(Cow::Owned(format!("{} {}", star.flamsteed, star.constellation)), 5, target);
                flamsteed.entry((star.constellation, number)).or_default().push(*star);
            }
            if !star.variable.is_empty() && !star.constellation.is_empty() {
                add(Cow::Owned(format!("{} {}", star.variable, star.constellation)), 8, target);
            }
            if !star.henry_draper.is_empty() {
                add(Cow::Owned(format!("HD {}", star.henry_draper)), 9, target);
            }
        }
        for (index, object) in deep_sky.objects.iter().enumerate() {
            for name in object.names.split(';') {
                add(Cow::Borrowed(name), rank_of_deep_sky(name), Target::DeepSky(index));
            }
        }
        entries.sort_by(|a, b| (&a.key, a.rank).cmp(&(&b.key, b.rank)));
        Index { entries, bayer, flamsteed }
    }

    /// What `text` means; `v_mag` gives the magnitude of a star by its HIP number.
    pub(super) fn find(&self, text: &str, v_mag: impl Fn(u32) -> f32) -> Option<Target> {
        self.designation(text, &v_mag).map(Target::Star).or_else(|| self.named(text, &v_mag))
    }

    /// Names as they stand, the better known before the less; of stars of one name the brightest.
    fn named(&self, text: &str, v_mag: &impl Fn(u32) -> f32) -> Option<Target> {
        let key = key(text);
        if let Some(hip) = key.strip_prefix("hip").and_then(|number| number.parse().ok()) {
            return Some(Target::Star(hip));
        }
        let start = self.entries.partition_point(|entry| entry.key < key);
        let same: Vec<&Entry> = self.entries[start..].iter().take_while(|entry| entry.key == key).collect();
        let best = same.first()?.rank;
        let brightness = |entry: &&&Entry| match entry.target {
            Target::Star(hip) => v_mag(hip),
            Target::DeepSky(_) => f32::MAX,
        };
        same.iter()
            .filter(|entry| entry.rank == best)
            .min_by(|a, b| brightness(a).total_cmp(&brightness(b)))
            .map(|entry| entry.target)
    }

    /// Bayer's and Flamsteed's designations: `alpha centauri`, `α Cen`, `alf cen b`, `beta1 sco`, `61 Cyg`.
    fn designation(&self, text: &str, v_mag: &impl Fn(u32) -> f32) -> Option<u32> {
        let mut parts = words(text);
        let latin = text.trim().chars().next().filter(char::is_ascii_alphabetic);
        let stars = match self.components(&parts, latin) {
            Some(stars) => return main_component(&stars, v_mag),
            None => {
                let component = parts.pop()?;
                let nth = ["a", "b", "c", "d"].iter().position(|letter| *letter == component)?;
                let mut stars = self.components(&parts, latin)?;
                stars.sort_by(|a, b| a.index().cmp(&b.index()).then(v_mag(a.hip).total_cmp(&v_mag(b.hip))));
                stars.get(nth).copied()
            }
        };
        stars.map(|star| star.hip)
    }

    /// The stars that share a designation.
    fn components(&self, parts: &[String], latin: Option<char>) -> Option<Vec<StarNames>> {
        let compact = parts.concat();
        let forms = constellation::NAMES.iter().flat_map(|(short, name, genitive)| {
            [*short, *name, *genitive].map(|form| (form.replace(' ', "").to_lowercase(), *short))
        });
        let mut heads: Vec<(&str, &'static str)> = Vec::new();
        for (form, short) in forms {
            if let Some(head) = compact.strip_suffix(form.as_str()).filter(|head| !head.is_empty()) {
                heads.push((&compact[..head.len()], short));
            }
        }
        heads.sort_by_key(|(head, _)| head.len());
        let word = parts.first().map_or(0, String::len);
        heads.into_iter().find_map(|(head, con)| self.of_head(head, con, latin.filter(|_| word == head.len())))
    }

    /// The stars of a constellation that the words before its name mean.
    fn of_head(&self, head: &str, con: &'static str, latin: Option<char>) -> Option<Vec<StarNames>> {
        if let Ok(number) = head.parse::<u16>() {
            return self.flamsteed.get(&(con, number)).cloned();
        }
        // "50 alpha Cygni": Bayer's letter says it all.
        let head = head.trim_start_matches(|c: char| c.is_ascii_digit());
        let letters = head.trim_end_matches(|c: char| c.is_ascii_digit());
        let index: Option<u8> = head[letters.len()..].parse().ok();
        let greek = GREEK.iter().find(|row| [row.1, row.2, row.3].contains(&letters)).map(|row| row.0);
        let tried = [
            greek,
            latin.filter(|_| letters.len() == 1),
            latin
                .filter(|_| letters.len() == 1)
                .map(|c| if c.is_uppercase() { c.to_ascii_lowercase() } else { c.to_ascii_uppercase() }),
        ];
        let stars = tried.into_iter().flatten().find_map(|letter| self.bayer.get(&(con, letter)))?;
        let chosen: Vec<StarNames> =
            stars.iter().filter(|star| index.is_none_or(|index| star.index() == index)).copied().collect();
        (!chosen.is_empty()).then_some(chosen)
    }

    /// Names spelt nearly so, the nearest first, and of these the best known.
    pub(super) fn near(&self, text: &str) -> Vec<String> {
        let key = key(text);
        if key.is_empty() {
            return Vec::new();
        }
        let allowed = match key.len() {
            0..=3 => 1,
            4..=7 => 2,
            _ => 3,
        };
        let mut scored: Vec<(usize, u8, usize, &Entry)> = Vec::new();
        for entry in &self.entries {
            let part = key.len() >= 4 && entry.key.contains(&key);
            let distance = if part { Some(1) } else { edits(&key, &entry.key, allowed) };
            if let Some(distance) = distance {
                scored.push((distance, entry.rank, entry.key.len(), entry));
            }
        }
        scored.sort_by(|a, b| (a.0, a.1, a.2, &a.3.key).cmp(&(b.0, b.1, b.2, &b.3.key)));
        first_different(scored.into_iter().map(|scored| scored.3), 5)
    }

    /// Names that begin so, the best known first.
    pub(super) fn complete(&self, prefix: &str, most: usize) -> Vec<String> {
        let key = key(prefix);
        if key.is_empty() {
            return Vec::new();
        }
        let start = self.entries.partition_point(|entry| entry.key < key);
        let mut found: Vec<&Entry> =
            self.entries[start..].iter().take_while(|entry| entry.key.starts_with(&key)).collect();
        found.sort_by(|a, b| (a.rank, a.key.len(), &a.key).cmp(&(b.rank, b.key.len(), &b.key)));
        first_different(found.into_iter(), most)
    }
}

/// The star that is meant when no component is named: the brightest, but of nearly equal ones (half a magnitude) the first
/// numbered. So alpha Librae is alpha2, and epsilon Lyrae is epsilon1.
fn main_component(stars: &[StarNames], v_mag: &impl Fn(u32) -> f32) -> Option<u32> {
    let brightest = stars.iter().map(|star| v_mag(star.hip)).min_by(f32::total_cmp)?;
    stars
        .iter()
        .filter(|star| v_mag(star.hip) <= brightest + 0.5)
        .min_by(|a, b| a.index().cmp(&b.index()).then(v_mag(a.hip).total_cmp(&v_mag(b.hip))))
        .map(|star| star.hip)
}

/// The first names, none twice, no object twice.
fn first_different<'a>(entries: impl Iterator<Item = &'a Entry>, most: usize) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    let mut targets: Vec<Target> = Vec::new();
    for entry in entries {
        if names.len() >= most {
            break;
        }
        if !targets.contains(&entry.target) {
            targets.push(entry.target);
            names.push(entry.name.to_string());
        }
    }
    names
}

/// Number of single changes (a letter more, less, other, or two swapped) between two keys, if at most `allowed`.
///
/// Source: the optimal string alignment distance; Damerau (1964), CACM 7, 171.
fn edits(a: &str, b: &str, allowed: usize) -> Option<usize> {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    if a.len().abs_diff(b.len()) > allowed {
        return None;
    }
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let other = usize::from(a[i - 1] != b[j - 1]);
            row[j] = (last[j] + 1).min(row[j - 1] + 1).min(last[j - 1] + other);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        if row.iter().all(|edits| *edits > allowed) {
            return None;
        }
        before = std::mem::replace(&mut last, row);
    }
    last.last().copied().filter(|edits| *edits <= allowed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_key_for_all_ways_to_write_a_number() {
        for text in ["M31", "m 31", "Messier 31", "messier031", " M-31 "] {
            assert_eq!(key(text), "m31", "{text}");
        }
        assert_eq!(key("NGC0224"), "ngc224");
        assert_eq!(key("The Barnard's Star"), "barnardsstar");
        assert_eq!(key("Barnard 33"), "b33");
        assert_eq!(key("M100"), "m100");
    }

    #[test]
    fn greek_letters_stand_for_their_names() {
        assert_eq!(words("α Cen"), ["alpha", "cen"]);
        assert_eq!(words("β¹Sco"), ["beta1", "sco"]);
        assert_eq!(words("ξUMa"), ["xi", "uma"]);
    }

    #[test]
    fn escapes_are_taken_off() {
        assert_eq!(clean("\u{1b}[31mM31\u{1b}[0m\u{7}"), "M31");
        assert_eq!(clean(&"x".repeat(1000)).len(), LONGEST);
    }

    #[test]
    fn edits_count_a_swap_as_one() {
        assert_eq!(edits("vega", "vgea", 2), Some(1));
        assert_eq!(edits("polaris", "polris", 2), Some(1));
        assert_eq!(edits("vega", "rigel", 2), None);
    }
}
