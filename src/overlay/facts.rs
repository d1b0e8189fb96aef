//! What is told of an object, fact by fact, and which facts the observer wants.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::style::Eye;
use crate::eye::powers::{self, Powers};
use crate::eye::{Model, Reading, visibility};
use crate::sky::atlas;
use crate::sky::catalogue::{Band, Kind, Object};
use crate::sky::coords::{Equatorial, J2000};
use crate::sky::optics::Instrument;
use crate::units::angle::{DegreesMinutesSeconds, HoursMinutesSeconds};

/// One sort of fact. Settings name it as its label in lower case with hyphens.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fact {
    /// What it is, and its class.
    Type,
    /// What else it is called.
    Names,
    /// In which constellation.
    Constellation,
    /// How large it is.
    Size,
    /// Where it is at J2000.
    Position,
    /// How bright it is.
    Magnitude,
    /// How bright it would be at 10 parsecs, where its distance is known.
    AbsoluteMagnitude,
    /// How bright its surface is on average.
    SurfaceBrightness,
    /// Its own light over the sky's.
    Contrast,
    /// How far it stands above the eye's threshold in the eyepiece in use.
    Reserve,
    /// Which magnifications are useful, and the best of the eyepieces owned.
    Power,
    /// How far it is, where that is known.
    Distance,
    /// On which charts of Uranometria 2000.0 and the Millennium Star Atlas it is.
    Charts,
}

impl Fact {
    /// All of them in the order in which they are told.
    pub const ALL: [Fact; 13] = [
        Fact::Type,
        Fact::Names,
        Fact::Constellation,
        Fact::Size,
        Fact::Position,
        Fact::Magnitude,
        Fact::AbsoluteMagnitude,
        Fact::SurfaceBrightness,
        Fact::Contrast,
        Fact::Reserve,
        Fact::Power,
        Fact::Distance,
        Fact::Charts,
    ];

    /// What stands before it in a list.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Fact::Type => "type",
            Fact::Constellation => "in",
            Fact::Size => "size",
            Fact::Position => "J2000",
            Fact::Magnitude => "magnitude",
            Fact::AbsoluteMagnitude => "absolute",
            Fact::SurfaceBrightness => "surface",
            Fact::Contrast => "contrast",
            Fact::Reserve => "reserve",
            Fact::Power => "power",
            Fact::Distance => "distance",
            Fact::Charts => "charts",
            Fact::Names => "also",
        }
    }
}

/// Facts switched on and off. `on` wins over `off`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Switches {
    /// Switched on.
    pub on: Vec<Fact>,
    /// Switched off.
    pub off: Vec<Fact>,
}

impl Switches {
    fn says(&self, fact: Fact) -> Option<bool> {
        if self.on.contains(&fact) {
            Some(true)
        } else if self.off.contains(&fact) {
            Some(false)
        } else {
            None
        }
    }
}

/// Which facts the observer wants: for all objects, for each type (in the words of the catalogue: "open cluster"), and for
/// single objects by the name that is shown. The narrower wins; what nothing is said about is told.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Choices {
    /// Not told, unless a type or an object switches it on again.
    pub off: Vec<Fact>,
    /// By type.
    pub types: BTreeMap<String, Switches>,
    /// By object.
    pub objects: BTreeMap<String, Switches>,
}

impl Choices {
    /// Whether a fact of an object is told.
    #[must_use]
    pub fn shows(&self, fact: Fact, object: &Object) -> bool {
        let by_object = self.objects.get(&object.name).and_then(|switches| switches.says(fact));
        let by_type = || self.types.get(object.kind.words()).and_then(|switches| switches.says(fact));
        by_object.or_else(by_type).unwrap_or(!self.off.contains(&fact))
    }

    /// Holds the types against those that there are.
    ///
    /// # Errors
    /// The first that is not a type, with all that are.
    pub fn checked(&self) -> Result<(), String> {
        match self.types.keys().find(|name| Kind::from_words(name).is_none()) {
            None => Ok(()),
            Some(wrong) => {
                let known: Vec<&str> = Kind::all().map(Kind::words).collect();
                Err(format!("facts.types.\"{wrong}\" is no type of object: give one of {}", known.join(", ")))
            }
        }
    }
}

/// One fact of one object.
#[derive(Debug, Clone, PartialEq)]
pub struct Told {
    /// Which.
    pub fact: Fact,
    /// In words.
    pub text: String,
}

/// All that is known of an object and wanted, as this eye sees it through the eyepiece in use, in the order of [`Fact::ALL`].
#[must_use]
pub fn of(object: &Object, instrument: &Instrument, eye: &Eye, choices: &Choices) -> Vec<Told> {
    let wanted = Fact::ALL.into_iter().filter(|fact| choices.shows(*fact, object));
    wanted.filter_map(|fact| text(fact, object, instrument, eye).map(|text| Told { fact, text })).collect()
}

/// The useful powers of an object for this eye among the eyepieces owned, where brightness and size are known.
#[must_use]
pub fn powers_of(object: &Object, instrument: &Instrument, eye: &Eye) -> Option<Powers> {
    let patch = object.heart()?;
    let (viewing, owned) = (instrument.viewing(eye.pupil_mm), instrument.choices());
    Some(match object.kind {
        Kind::SolarSystem => powers::of_disc(&patch, &viewing, eye.sky, &owned),
        _ => powers::useful(&patch, &viewing, eye.sky, Model::Crumey, &owned),
    })
}

fn text(fact: Fact, object: &Object, instrument: &Instrument, eye: &Eye) -> Option<String> {
    match fact {
        Fact::Type => {
            let class = object.hubble.map(|class| format!(", {class}")).unwrap_or_default();
            Some(format!("{}{class}", object.type_words()))
        }
        Fact::Constellation => Some(object.constellation.to_owned()),
        Fact::Size => {
            let (major, minor) = object.axes_arcmin?;
            let angle =
                object.position_angle.map(|angle| format!(" at {:.0}°", angle.to_degrees())).unwrap_or_default();
            Some(size(major, minor) + if major > minor { &angle } else { "" })
        }
        Fact::Position => {
            let whose = if object.hand_controllers_place { "   (hand controller's)" } else { "" };
            Some(position(&object.astrometry.position) + whose)
        }
        Fact::Magnitude => {
            let band = if object.band == Band::V { "V" } else { "B" };
            object.magnitude.map(|magnitude| format!("{band} {:.1}", magnitude.0).replace('-', "−"))
        }
        Fact::AbsoluteMagnitude => {
            let about = if object.distance?.rough { "about " } else { "" };
            Some(format!("{about}{:.1}", object.absolute_magnitude()?).replace('-', "−"))
        }
        Fact::SurfaceBrightness => object.surface_brightness.map(|mean| format!("mean {:.1} mag/arcsec²", mean.0)),
        Fact::Contrast => {
            let log10 = visibility::log10_contrast(object.surface_brightness?, eye.sky);
            let log = format!("{log10:+.1}").replace('-', "−");
            Some(format!("{} (log {log})", two_digits(10f64.powf(log10))))
        }
        Fact::Reserve => {
            let reading = Reading::of(&object.heart()?, &instrument.viewing(eye.pupil_mm), eye.sky, Model::Crumey);
            let reserve = format!("{:+.1}", reading.reserve()).replace('-', "−");
            let part = if object.heart() == object.patch() { "" } else { " (inner half)" };
            Some(format!("{reserve}, {}{part}", reading.verdict().words()))
        }
        Fact::Power => power(&powers_of(object, instrument, eye)?, instrument),
        Fact::Distance => Some(object.distance?.words()),
        Fact::Charts => {
            let place = &object.astrometry.position;
            Some(format!("Uranometria {}, Millennium {}", atlas::uranometria(place), atlas::millennium(place)))
        }
        Fact::Names => {
            let others: Vec<&str> =
                object.names.iter().map(String::as_str).filter(|name| *name != object.name).collect();
            if others.is_empty() { None } else { Some(others.join(", ")) }
        }
    }
}

/// The useful powers in words: `best 24 mm, 51–216×`.
fn power(powers: &Powers, instrument: &Instrument) -> Option<String> {
    let best = instrument.eyepieces.get(powers.best?)?;
    let name = format!("{:.1}", best.focal_length_mm);
    let name = name.trim_end_matches(".0");
    let wide = if powers.overflows { ", larger than the field" } else { "" };
    Some(match powers.range {
        Some((low, high)) => format!("best {name} mm, {low:.0}–{high:.0}×{wide}"),
        None => format!("not seen; least badly {name} mm{wide}"),
    })
}

/// Right ascension and declination with a typographic minus.
#[must_use]
pub fn position(place: &Equatorial<J2000>) -> String {
    format!("{}   {}", HoursMinutesSeconds(place.ra()), DegreesMinutesSeconds(place.dec())).replace('-', "−")
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::catalogue::Catalogue;
    use crate::units::SurfaceBrightness;

    fn told(name: &str, choices: &Choices) -> Vec<Told> {
        let object = Catalogue::embedded().search(name).unwrap();
        let eye = Eye { sky: SurfaceBrightness(21.5), ..Eye::default() };
        of(&object, &Instrument::default(), &eye, choices)
    }

    fn text_of(told: &[Told], fact: Fact) -> Option<&str> {
        told.iter().find(|told| told.fact == fact).map(|told| told.text.as_str())
    }

    #[test]
    fn sizes_are_written_in_the_unit_that_suits_them() {
        assert_eq!(size(177.83, 69.66), "178 × 70′");
        assert_eq!(size(1.4, 1.0), "84 × 60″");
        assert_eq!(size(20.0, 20.0), "20′");
    }

    #[test]
    fn vega_is_25_light_years_away_and_of_absolute_magnitude_0_6() {
        let vega = told("Vega", &Choices::default());
        assert_eq!(text_of(&vega, Fact::Distance), Some("25.0 ly"));
        assert_eq!(text_of(&vega, Fact::AbsoluteMagnitude), Some("0.6"));
        assert_eq!(text_of(&vega, Fact::Reserve), None);
    }

    #[test]
    fn the_ring_nebula_has_its_charts_its_reserve_and_its_best_eyepiece() {
        let ring = told("M57", &Choices::default());
        // PyEphem 4.2.1: V1 - P 49 and V3 - P1153.
        assert_eq!(text_of(&ring, Fact::Charts), Some("Uranometria 49 (vol. 1), Millennium 1153 (vol. 3)"));
        assert!(text_of(&ring, Fact::Reserve).unwrap().ends_with("very easy"), "{ring:?}");
        assert!(text_of(&ring, Fact::Power).unwrap().contains("best "), "{ring:?}");
    }

    #[test]
    fn a_fact_is_switched_off_for_all_and_on_again_for_a_type_and_an_object() {
        let text = "off = [\"charts\", \"reserve\"]\n\
                    [types.\"planetary nebula\"]\non = [\"charts\"]\n\
                    [objects.M57]\non = [\"reserve\"]\noff = [\"size\"]\n";
        let choices: Choices = toml::from_str(text).unwrap();
        choices.checked().unwrap();
        let has = |name: &str, fact| text_of(&told(name, &choices), fact).is_some();
        assert!(has("M57", Fact::Charts) && has("M57", Fact::Reserve) && !has("M57", Fact::Size));
        assert!(has("M27", Fact::Charts) && !has("M27", Fact::Reserve) && has("M27", Fact::Size));
        assert!(!has("M31", Fact::Charts) && !has("M31", Fact::Reserve));
        assert!(toml::from_str::<Choices>("off = [\"chart\"]").unwrap_err().to_string().contains("charts"));
        let wrong: Choices = toml::from_str("[types.planetoid]\non = []").unwrap();
        assert!(wrong.checked().unwrap_err().contains("planetary nebula"));
    }
}
