//! The words of the overlay: the information block on top, the eyepiece's line at the bottom.

use super::style::Eye;
use crate::eye::visibility::log10_contrast;
use crate::sky::catalogue::{Band, Kind, Object};
use crate::sky::coords::{Equatorial, J2000};
use crate::sky::field::FieldOfView;
use crate::units::angle::{DegreesMinutesSeconds, HoursMinutesSeconds};

/// The information block: its title, then a line each.
#[must_use]
pub fn about(object: &Object, eye: &Eye) -> Vec<String> {
    let mut title = vec![object.name.clone()];
    // A second name that says more than another catalogue's number.
    title.extend(object.names.iter().find(|name| **name != object.name && is_word(name)).cloned());

    let mut what = vec![object.type_words().to_owned(), format!("in {}", object.constellation)];
    what.extend(object.axes_arcmin.map(|(major, minor)| size(major, minor)));

    let place = object.astrometry.position;
    let position = position_words(&place);

    let mut light: Vec<String> = Vec::new();
    light.extend(
        object
            .magnitude
            .map(|magnitude| format!("{} {:.1}", if object.band == Band::V { "V" } else { "B" }, magnitude.0)),
    );
    match object.surface_brightness {
        Some(mean) => {
            let log10 = log10_contrast(mean, eye.sky);
            light.push(format!("mean {:.1} mag/arcsec²", mean.0));
            let log = format!("{log10:+.1}").replace('-', "−");
            light.push(format!("contrast {} (log {log})", two_digits(10f64.powf(log10))));
        }
        None => light.extend(object.colour_bv.map(|bv| format!("B−V {bv:.2}"))),
    }

    let lines = [title.join("  ·  "), what.join("  ·  "), position, light.join("  ·  ")];
    lines.into_iter().filter(|line| !line.is_empty()).collect()
}

/// The block of a field in which nothing is catalogued.
#[must_use]
pub fn about_nothing(field: &FieldOfView) -> Vec<String> {
    vec![position_words(&field.centre())]
}

/// Right ascension and declination with a typographic minus.
fn position_words(place: &Equatorial<J2000>) -> String {
    format!("{}   {}", HoursMinutesSeconds(place.ra()), DegreesMinutesSeconds(place.dec())).replace('-', "−")
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

/// An object's axes with the unit that suits them.
fn size(major: f64, minor: f64) -> String {
    let (unit, factor) = if major < 2.0 { ("″", 60.0) } else { ("′", 1.0) };
    let number = |value: f64| {
        if value * factor < 9.95 { format!("{:.1}", value * factor) } else { format!("{:.0}", value * factor) }
    };
    if (major - minor).abs() < 0.01 * major {
        format!("{}{unit}", number(major))
    } else {
        format!("{} × {}{unit}", number(major), number(minor))
    }
}

fn two_digits(value: f64) -> String {
    if value >= 9.95 {
        format!("{value:.0}")
    } else if value >= 0.095 {
        format!("{value:.1}")
    } else {
        format!("{value:.2}")
    }
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
    fn sizes_are_written_in_the_unit_that_suits_them() {
        assert_eq!(size(177.83, 69.66), "178 × 70′");
        assert_eq!(size(1.4, 1.0), "84 × 60″");
        assert_eq!(size(20.0, 20.0), "20′");
    }

    #[test]
    fn names_that_people_say_are_told_from_numbers() {
        assert!(is_word("Andromeda Galaxy") && is_word("Ring Nebula"));
        assert!(!is_word("NGC 224") && !is_word("UGC 454") && !is_word("M31") && !is_word("C 14"));
    }
}
