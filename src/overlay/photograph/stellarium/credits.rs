//! The terms under which the pictures of Stellarium's set may be used, from the credits that its package brings.

use super::names::designation;

/// What stands for a picture that the credits do not name: their section 4.1.
pub const OF_THE_SET: &str = "GPL-2.0-or-later, as the set";

const GRASSLANDS: &str = "Grasslands Observatory";

/// Who gives which pictures, and on which terms.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Credits {
    entries: Vec<Entry>,
    /// The terms of all pictures of Messier's objects from Grasslands Observatory, section 4.7.
    grasslands: bool,
}

#[derive(Debug, Clone, PartialEq)]
struct Entry {
    /// Names of objects as [`designation`] has them.
    objects: Vec<String>,
    licence: Option<String>,
}

impl Credits {
    /// From the text of the package's file (`CREDITS.md`): numbered paragraphs `4.n Images of OBJECT, OBJECT from PERSON ...
    /// License: TERMS`. What is not such a paragraph is passed over.
    #[must_use]
    pub fn read(text: &str) -> Credits {
        let mut paragraphs: Vec<String> = Vec::new();
        for line in text.lines().take(20_000) {
            let trimmed = line.trim();
            let number = trimmed.split_whitespace().next().unwrap_or_default();
            if number.starts_with("4.") && number[2..].starts_with(|c: char| c.is_ascii_digit()) {
                paragraphs.push(trimmed[number.len()..].to_owned());
            } else if trimmed.is_empty() || trimmed.starts_with("5.") {
                paragraphs.push(String::new());
            } else if let Some(paragraph) = paragraphs.last_mut().filter(|paragraph| !paragraph.is_empty()) {
                paragraph.push(' ');
                paragraph.push_str(trimmed);
            }
        }
        let grasslands =
            paragraphs.iter().any(|text| text.contains(GRASSLANDS) && text.contains("as long as it is credited"));
        Credits { entries: paragraphs.iter().filter_map(|paragraph| entry(paragraph)).collect(), grasslands }
    }

    /// The terms of the picture with this file name (without ending) and credit. A picture that is named without terms, or not
    /// at all, is under the set's own.
    #[must_use]
    pub fn licence(&self, stem: &str, credit: Option<&str>) -> &str {
        if self.grasslands && credit.is_some_and(|credit| credit.contains(GRASSLANDS)) {
            return "free use with credit";
        }
        let name = designation(stem);
        let entry = self.entries.iter().find(|entry| entry.objects.contains(&name));
        entry.and_then(|entry| entry.licence.as_deref()).unwrap_or(OF_THE_SET)
    }
}

fn entry(paragraph: &str) -> Option<Entry> {
    let (named, rest) = named(paragraph.trim())?;
    let objects = named.split(',').flat_map(|part| part.split(" and ")).map(designation);
    let licence = rest.split_once("License:").map(|(_, terms)| short(terms.trim()));
    Some(Entry { objects: objects.collect(), licence })
}

/// The objects that a paragraph names, and all of it from there on: `Images of M1, M27 from ...` or `M31 pictures come from ...`.
fn named(paragraph: &str) -> Option<(&str, &str)> {
    if let Some((object, _)) = paragraph.split_once(" pictures come from ") {
        return (!object.contains(' ')).then_some((object, paragraph));
    }
    let rest = paragraph.strip_prefix("Image").map(|rest| rest.trim_start_matches('s'))?;
    let rest = rest.trim_start().strip_prefix("of ")?;
    let end = rest.find(" from ").or(rest.find(" No machine-readable")).unwrap_or(rest.len());
    Some((&rest[..end], rest))
}

/// Terms in a few words: what has a usual name is called by it.
fn short(terms: &str) -> String {
    let lower = terms.to_lowercase();
    let version = ["4.0", "3.0", "2.5"].into_iter().find(|version| lower.contains(version)).unwrap_or_default();
    let named = if lower.starts_with("public domain") {
        "public domain".to_owned()
    } else if lower.contains("cc0") {
        "CC0-1.0".to_owned()
    } else if lower.contains("attribution") && lower.contains("share") {
        format!("CC-BY-SA-{version}")
    } else if lower.contains("creative commons attribution") {
        format!("CC-BY-{version}")
    } else if lower.contains("gnu free documentation") {
        "GFDL-1.2-or-later".to_owned()
    } else {
        terms.chars().filter(|c| !c.is_control()).take(60).collect::<String>()
    };
    named.trim().trim_end_matches('-').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Paragraphs of Stellarium 0.22.2's CREDITS.md.
    const SOME: &str = "4. Graphics\n\t4.8 M31 pictures come from LEE ang HG731GZ\n\t    License: Creative Commons Attribution 3.0 Unported\n\t4.10 Images of M1, M27, M57, M97, NGC6946 from Stephane\n\t     Dumont\n\t4.16 Images of NGC2903, NGC3185,\n\t     NGC3190\n\t     from Oleg Bryzgalov \n\t     http://olegbr.astroclub.kiev.ua/\n\t     License: Creative Commons Attribution 3.0 Unported\n\t4.31 Images of NGC1579, Barnard Loop, IC342, SH2-297 from Sun Shuwei\n\t     License: public domain\n\t4.39 Images of M4, M12\n\t     from Hewholooks\n\t     License: Creative Commons Attribution-Share Alike 3.0 Unported\n\n5. Other\n";

    #[test]
    fn a_picture_is_under_the_terms_of_its_paragraph() {
        let credits = Credits::read(SOME);
        for (stem, licence) in [
            ("n2903oleg", "CC-BY-3.0"),
            ("n3190oleg", "CC-BY-3.0"),
            ("m4", "CC-BY-SA-3.0"),
            ("m12", "CC-BY-SA-3.0"),
            ("sh2-297", "public domain"),
            ("barnard_loop-1", "public domain"),
            ("ic342", "public domain"),
            ("m57dumont", OF_THE_SET),
            ("m31", "CC-BY-3.0"),
            ("m32", OF_THE_SET),
            ("m1dumont", OF_THE_SET),
        ] {
            assert_eq!(credits.licence(stem, None), licence, "{stem}");
        }
    }

    #[test]
    fn text_of_anything_else_gives_the_sets_own_terms() {
        assert_eq!(Credits::read("4.\n4.9\nImages of\n4.1 Image of é from").licence("m4", None), OF_THE_SET);
    }
}
