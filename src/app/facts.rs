//! What is in the field, and what an object is, in words.

use super::adapting::Observer;
use super::log::printable;
use crate::overlay::facts::{self, Fact};
use crate::sky::atlas;
use crate::sky::catalogue::{Catalogue, Found, Object};
use crate::sky::coords::{Equatorial, J2000};
use crate::sky::ephemeris::moons::Moon;
use crate::sky::optics::Instrument;
use crate::units::angle::{DegreesMinutesSeconds, HoursMinutesSeconds};
use crate::units::{Angle, Magnitude};

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
    /// Whether it can be taken as the target: it has a name of its own, and is no planet's moon.
    pub choosable: bool,
}

/// What is in the field: Sun, Moon and planets with their moons, deep-sky objects, then the named and the brightest stars, each
/// nearest first.
#[must_use]
pub fn listed(found: &Found, centre: &Equatorial<J2000>, catalogue: &Catalogue) -> Vec<Listed> {
    let bodies = found.bodies.iter().flat_map(|seen| {
        let at = |name: &str, what: String, magnitude: Magnitude, position: Equatorial<J2000>| Listed {
            name: name.to_owned(),
            what,
            magnitude: Some(magnitude.0),
            separation: position.separation(centre),
            position,
            choosable: false,
        };
        let body = Listed {
            choosable: true,
            ..at(seen.body.name(), seen.body.type_words().to_owned(), seen.magnitude, seen.position)
        };
        let moons = seen.moons.iter().map(move |(moon, position)| {
            let state = match moon {
                Moon { hidden: true, .. } => ", hidden",
                Moon { eclipsed: true, .. } => ", eclipsed",
                Moon { in_front: true, .. } if position.separation(&seen.position) < seen.globe.radius => ", in front",
                _ => "",
            };
            at(moon.name, format!("moon{state}"), moon.magnitude, *position)
        });
        std::iter::once(body).chain(moons)
    });
    let objects = found.objects.iter().map(|object| Listed {
        name: printable(object.name),
        what: object.kind.words().to_owned(),
        magnitude: object.magnitude.map(|magnitude| magnitude.0),
        separation: object.separation,
        position: object.position,
        choosable: true,
    });
    let mut brightest: Vec<_> = found.stars.iter().collect();
    brightest.sort_by(|a, b| a.v_mag.total_cmp(&b.v_mag));
    brightest.truncate(STARS);
    brightest.sort_by(|a, b| a.separation.to_radians().total_cmp(&b.separation.to_radians()));
    let stars = brightest.into_iter().map(|star| {
        let name = catalogue.star_name(star.id);
        Listed {
            choosable: name.is_some(),
            name: name.map_or_else(|| "star".to_owned(), |name| printable(&name)),
            what: String::new(),
            magnitude: Some(f64::from(star.v_mag)),
            separation: star.separation,
            position: star.astrometry.position,
        }
    });
    bodies.chain(objects).chain(stars).collect()
}

/// What is known of an object and wanted: a label and a value a line.
#[must_use]
pub fn of(object: &Object, instrument: &Instrument, observer: &Observer) -> Vec<(&'static str, String)> {
    let place = &object.astrometry.position;
    let told = facts::of(object, instrument, &observer.eye, &observer.facts);
    let lines = told.into_iter().flat_map(|told| match told.fact {
        Fact::Position => {
            let mut lines = vec![
                ("RA J2000", HoursMinutesSeconds(place.ra()).to_string()),
                ("Dec J2000", DegreesMinutesSeconds(place.dec()).to_string()),
            ];
            if object.hand_controllers_place {
                lines.push(("place", "the hand controller's own".to_owned()));
            }
            lines
        }
        Fact::Charts => {
            vec![("U2000", atlas::uranometria(place).to_string()), ("Millennium", atlas::millennium(place).to_string())]
        }
        fact => vec![(fact.label(), printable(&told.text))],
    });
    lines.collect()
}
