//! What is worth showing now: every deep-sky object that the model says this telescope and eye can see, the best first.

use super::astrometry::Reduction;
use super::catalogue::{Catalogue, Kind, Object};
use super::coords::{Airless, Horizontal};
use super::horizon::Horizon;
use super::optics::Instrument;
use crate::eye::powers::{self, Powers};
use crate::eye::{Model, Verdict};
use crate::units::{Angle, SurfaceBrightness};

/// Magnitudes that an air mass takes, on an ordinary night.
pub const EXTINCTION: f64 = 0.2;

/// For whom, and what may be asked of the sky.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wanted {
    /// The eye's pupil in millimetres.
    pub pupil_mm: f64,
    /// Brightness of the sky's background.
    pub sky: SurfaceBrightness,
    /// Magnitudes that an air mass takes.
    pub extinction: f64,
    /// Nothing lower is shown.
    pub minimum_altitude: Angle,
}

/// An object that can be shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Worth {
    /// The object.
    pub object: Object,
    /// Where it stands.
    pub horizontal: Horizontal<Airless>,
    /// Its powers among the eyepieces owned.
    pub powers: Powers,
    /// Crumey's reserve of [`Object::heart`] with the best of them, behind the air.
    pub reserve: f64,
    /// What it is ranked by: [`score`].
    pub score: f64,
}

impl Worth {
    /// What the reserve means.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        Verdict::of(Model::Crumey, self.reserve)
    }
}

/// How much an object is worth showing: how well it is seen, up to where more is not noticed; what guests have heard of; how high
/// it stands.
///
/// ```text
/// min(reserve, 1) + (Messier 0.6, or Caldwell 0.4, or Herschel 400 0.2) + (a name that people say 0.2) + 0.3 sin(altitude)
/// ```
///
/// Our own weights: they order, and mean nothing else.
#[must_use]
pub fn score(object: &Object, reserve: f64, altitude: Angle) -> f64 {
    let numbered = |letter: &str| {
        let number = |name: &String| name.strip_prefix(letter).is_some_and(|rest| rest.trim().parse::<u32>().is_ok());
        object.names.iter().any(number)
    };
    let listed = if numbered("M") {
        0.6
    } else if numbered("C") {
        0.4
    } else if object.names.iter().any(|name| name == "Herschel 400") {
        0.2
    } else {
        0.0
    };
    let said = object.names.iter().any(|name| !name.chars().any(|c| c.is_ascii_digit()));
    reserve.min(1.0) + listed + if said { 0.2 } else { 0.0 } + 0.3 * altitude.sin()
}

/// Everything above the minimum altitude whose brightness and size are known and that the model says can be seen, by [`score`].
#[must_use]
pub fn worth_showing(
    catalogue: &Catalogue,
    instrument: &Instrument,
    reduction: &Reduction,
    horizon: &Horizon,
    wanted: &Wanted,
) -> Vec<Worth> {
    let (viewing, owned) = (instrument.viewing(wanted.pupil_mm), instrument.choices());
    let objects = (0..catalogue.counts().2).filter_map(|index| catalogue.object(index));
    let mut worth: Vec<Worth> = objects
        .filter(|object| {
            !matches!(object.kind, Kind::Star | Kind::DoubleStar | Kind::Nova | Kind::Other | Kind::DarkNebula)
        })
        .filter_map(|object| {
            let mut patch = object.heart()?;
            let horizontal = horizon.airless(&reduction.apparent(&object.astrometry));
            if horizontal.altitude() < wanted.minimum_altitude {
                return None;
            }
            patch.v_mag += wanted.extinction * air_masses(horizontal.altitude());
            let powers = powers::useful(&patch, &viewing, wanted.sky, Model::Crumey, &owned);
            let reserve = powers.best_reserve.filter(|reserve| *reserve > 0.0)?;
            let score = score(&object, reserve, horizontal.altitude());
            Some(Worth { object, horizontal, powers, reserve, score })
        })
        .collect();
    worth.sort_by(|a, b| b.score.total_cmp(&a.score));
    worth
}

/// How many times the air of the zenith lies before an altitude: 1 at the zenith, 40 at the horizon. What is below it is judged as
/// at its best, behind one.
///
/// ```text
/// X = 1 / (cos z + 0.025 e^(-11 cos z))          Rozenberg (1966)
/// ```
#[must_use]
pub fn air_masses(altitude: Angle) -> f64 {
    let cos_z = altitude.sin();
    if cos_z < 0.0 {
        return 1.0;
    }
    1.0 / (cos_z + 0.025 * (-11.0 * cos_z).exp())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sky::site::Site;
    use crate::sky::time::{Moment, Utc};

    fn night(sky: f64, minimum_altitude_deg: f64) -> Vec<Worth> {
        let moment = Moment::at(Utc::from_rfc3339("2026-11-22T20:00:00Z").unwrap());
        let reduction = Reduction::at(&moment);
        let site = Site::new(60.17, 24.94, 30.0).unwrap();
        let wanted = Wanted {
            pupil_mm: 7.0,
            sky: SurfaceBrightness(sky),
            extinction: EXTINCTION,
            minimum_altitude: Angle::degrees(minimum_altitude_deg),
        };
        let horizon = Horizon::new(&reduction, &site);
        worth_showing(Catalogue::embedded(), &Instrument::default(), &reduction, &horizon, &wanted)
    }

    #[test]
    fn a_november_evening_in_helsinki_begins_with_what_everybody_shows() {
        let worth = night(20.8, 25.0);
        let place = |name: &str| worth.iter().position(|worth| worth.object.name == name);
        for famous in ["M57", "M27", "M13", "M15"] {
            let place = place(famous);
            assert!(place.is_none_or(|place| place < 60), "{famous} is at {place:?}");
        }
        // M42 has not risen to 25 degrees, and M7 never does.
        assert_eq!((place("M42"), place("M7")), (None, None));
        assert!(worth.iter().all(|worth| worth.reserve > 0.0 && worth.horizontal.altitude().to_degrees() >= 25.0));
        assert!(worth.windows(2).all(|pair| pair[0].score >= pair[1].score));
    }

    #[test]
    fn a_brighter_sky_shows_less_and_the_whole_sky_holds_more_than_the_611_objects_of_the_thesis() {
        let dark = night(20.8, -90.0).len();
        assert!(dark >= 611, "{dark}");
        let city = night(16.0, -90.0).len();
        assert!(city < dark / 2 && night(22.2, -90.0).len() > dark, "{city} {dark}");
    }

    #[test]
    fn the_zenith_is_one_air_mass_and_the_horizon_forty() {
        for (altitude_deg, masses) in [(90.0, 1.0), (30.0, 2.0), (0.0, 40.0), (-10.0, 1.0)] {
            assert!((air_masses(Angle::degrees(altitude_deg)) / masses - 1.0).abs() < 0.01);
        }
    }
}
