//! The words of the overlay: the information block on top, the eyepiece's line at the bottom.

use super::facts::{self, Choices, Fact};
use super::style::Eye;
use crate::sky::catalogue::{Kind, Object};
use crate::sky::field::FieldOfView;

/// The lines of the block and the facts on each. Where there is no room the last lines are left out.
const LINES: [&[Fact]; 6] = [
    &[Fact::Type, Fact::Constellation, Fact::Size],
    &[Fact::Position],
    &[Fact::Magnitude, Fact::AbsoluteMagnitude, Fact::SurfaceBrightness, Fact::Contrast],
    &[Fact::Reserve, Fact::Power],
    &[Fact::Distance],
    &[Fact::Charts],
];

/// The information block: its title, then a line each.
#[must_use]
pub fn about(object: &Object, field: &FieldOfView, eye: &Eye, choices: &Choices) -> Vec<String> {
    let mut title = vec![object.name.clone()];
    // A second name that says more than another catalogue's number.
    if choices.shows(Fact::Names, object) {
        title.extend(object.names.iter().find(|name| **name != object.name && is_word(name)).cloned());
    }
    let told = facts::of(object, &field.instrument, eye, choices);
    let line = |wanted: &[Fact]| {
        let of_line = wanted.iter().filter_map(|fact| told.iter().find(|told| told.fact == *fact));
        let words = of_line.map(|told| match told.fact {
            Fact::Constellation | Fact::Contrast | Fact::Reserve | Fact::AbsoluteMagnitude => {
                format!("{} {}", told.fact.label(), told.text)
            }
            _ => told.text.clone(),
        });
        words.collect::<Vec<_>>().join("  ·  ")
    };
    let lines = std::iter::once(title.join("  ·  ")).chain(LINES.iter().map(|facts| line(facts)));
    lines.filter(|line| !line.is_empty()).collect()
}

/// The block of a field in which nothing is catalogued.
#[must_use]
pub fn about_nothing(field: &FieldOfView) -> Vec<String> {
    vec![facts::position(&field.centre())]
}

/// The eyepiece's line: figure 8.10.
#[must_use]
pub fn eyepiece(field: &FieldOfView, eye: &Eye) -> String {
    let instrument = &field.instrument;
    let limit = instrument.limiting_magnitude(eye.pupil_mm, eye.sky);
    format!(
        "{} mm   {:.0}×   {:.0}′   pupil {:.1} mm   stars to {:.1}",
        trimmed(instrument.eyepiece().focal_length_mm),
        instrument.magnification(),
        instrument.true_field().to_arcminutes(),
        instrument.exit_pupil_mm(),
        limit.0
    )
}

/// Whether a name is one that people say: letters, at least four of them together.
fn is_word(name: &str) -> bool {
    let catalogue = ["NGC", "IC ", "HIP", "HD ", "Mel", "Cr ", "UGC", "PGC", "MCG", "ESO", "2MA", "IRA"];
    !catalogue.iter().any(|prefix| name.starts_with(prefix))
        && name.split(|c: char| !c.is_alphabetic()).any(|word| word.chars().count() >= 4)
}

fn trimmed(value: f64) -> String {
    format!("{value:.1}").trim_end_matches(".0").to_owned()
}

/// Whether an object is drawn as a point: stars.
#[must_use]
pub fn is_point(kind: Kind) -> bool {
    matches!(kind, Kind::Star | Kind::DoubleStar | Kind::Nova)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_people_say_are_told_from_numbers() {
        assert!(is_word("Andromeda Galaxy") && is_word("Ring Nebula"));
        assert!(!is_word("NGC 224") && !is_word("UGC 454") && !is_word("M31") && !is_word("C 14"));
    }
}
