//! What is in the field, and what an object is, in words.

use super::log::printable;
use crate::sky::catalogue::{Catalogue, Found, Object};
use crate::sky::coords::{Equatorial, J2000};
use crate::units::Angle;
use crate::units::angle::{DegreesMinutesSeconds, HoursMinutesSeconds};

/// So many stars are named in a list; the field holds hundreds.
const STARS: usize = 12;

/// Something in the field.
#[derive(Debug, Clone, PartialEq)]
pub struct Listed {
    /// Its name, without control characters.
    pub name: String,
    /// What it is.
    pub what: String,
    /// V (or B) magnitude.
    pub magnitude: Option<f64>,
    /// Distance from the centre of the field.
    pub separation: Angle,
    /// Where it is.
    pub position: Equatorial<J2000>,
}

/// What is in the field: deep-sky objects, then the named and the brightest stars, each nearest first.
#[must_use]
pub fn listed(found: &Found, catalogue: &Catalogue) -> Vec<Listed> {
    let objects = found.objects.iter().map(|object| Listed {
        name: printable(object.name),
        what: object.kind.words().to_owned(),
        magnitude: object.magnitude.map(|magnitude| magnitude.0),
        separation: object.separation,
        position: object.position,
    });
    let mut brightest: Vec<_> = found.stars.iter().collect();
    brightest.sort_by(|a, b| a.v_mag.total_cmp(&b.v_mag));
    brightest.truncate(STARS);
    brightest.sort_by(|a, b| a.separation.to_radians().total_cmp(&b.separation.to_radians()));
    let stars = brightest.into_iter().map(|star| Listed {
        name: catalogue.star_name(star.id).map_or_else(|| "star".to_owned(), |name| printable(&name)),
        what: String::new(),
        magnitude: Some(f64::from(star.v_mag)),
        separation: star.separation,
        position: star.astrometry.position,
    });
    objects.chain(stars).collect()
}

/// What is known of an object: a label and a value a line.
#[must_use]
pub fn of(object: &Object) -> Vec<(&'static str, String)> {
    let position = &object.astrometry.position;
    let mut facts = vec![
        ("type", format!("{} in {}", object.type_words(), object.constellation)),
        ("RA J2000", HoursMinutesSeconds(position.ra()).to_string()),
        ("Dec J2000", DegreesMinutesSeconds(position.dec()).to_string()),
    ];
    if let Some(magnitude) = object.magnitude {
        facts.push(("magnitude", format!("{:.1} {:?}", magnitude.0, object.band)));
    }
    if let Some(surface) = object.surface_brightness {
        facts.push(("surface", format!("{:.1} mag/arcsec² (mean)", surface.0)));
    }
    if let Some((major, minor)) = object.axes_arcmin {
        let angle = object.position_angle.map(|angle| format!(", at {:.0}°", angle.to_degrees())).unwrap_or_default();
        facts.push(("size", format!("{major:.1}′ × {minor:.1}′{angle}")));
    }
    let others: Vec<String> =
        object.names.iter().filter(|name| **name != object.name).map(|name| printable(name)).collect();
    if !others.is_empty() {
        facts.push(("also", others.join(", ")));
    }
    facts
}
