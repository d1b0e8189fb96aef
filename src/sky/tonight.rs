//! What is worth showing now: Moon, planets, and every deep-sky object that the model says this telescope and eye can see under
//! the Moon that there is, the best first.

use super::astrometry::Reduction;
use super::catalogue::{Band, Catalogue, Kind, Object};
use super::coords::{Airless, Horizontal};
use super::ephemeris::{Body, Ephemeris, InView};
use super::horizon::Horizon;
use super::optics::Instrument;
use super::physical::Aspect;
use super::site::Site;
use crate::eye::moonlight::Moonlight;
use crate::eye::powers::{self, Choice, Powers};
use crate::eye::{Model, Patch, Verdict, Viewing};
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
    /// Brightness of the sky behind it, the Moon's light in it.
    pub sky: SurfaceBrightness,
    /// Whether its V magnitude is a guess from B: [`Object::estimated_v_magnitude`].
    pub estimated: bool,
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
/// min(reserve, 1) + (Moon, planet or Messier 0.6, or Caldwell 0.4, or Herschel 400 0.2) + (a name that people say 0.2) + 0.3 sin(altitude)
/// ```
///
/// Our own weights: they order, and mean nothing else.
#[must_use]
pub fn score(object: &Object, reserve: f64, altitude: Angle) -> f64 {
    let numbered = |letter: &str| {
        let number = |name: &String| name.strip_prefix(letter).is_some_and(|rest| rest.trim().parse::<u32>().is_ok());
        object.names.iter().any(number)
    };
    let listed = if numbered("M") || object.kind == Kind::SolarSystem {
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
    moving: &Moving,
) -> Vec<Worth> {
    let (viewing, owned) = (instrument.viewing(wanted.pupil_mm), instrument.choices());
    let objects = (0..catalogue.counts().2).filter_map(|index| catalogue.object(index));
    let mut worth: Vec<Worth> = objects
        .filter(|object| {
            !matches!(object.kind, Kind::Star | Kind::DoubleStar | Kind::Nova | Kind::Other | Kind::DarkNebula)
        })
        .filter_map(|object| {
            let estimated = object.estimated_v_magnitude();
            let known = Object { magnitude: estimated.or(object.magnitude), ..object.clone() };
            let known = if estimated.is_some() { Object { band: Band::V, ..known } } else { known };
            let mut patch = known.heart()?;
            let horizontal = horizon.airless(&reduction.apparent(&object.astrometry));
            if horizontal.altitude() < wanted.minimum_altitude {
                return None;
            }
            patch.v_mag += wanted.extinction * air_masses(horizontal.altitude());
            let sky = moving.sky(wanted.sky, &horizontal);
            let powers = powers::useful(&patch, &viewing, sky, Model::Crumey, &owned);
            let reserve = powers.best_reserve.filter(|reserve| *reserve > 0.0)?;
            let score = score(&object, reserve, horizontal.altitude());
            Some(Worth { object, horizontal, powers, reserve, sky, estimated: estimated.is_some(), score })
        })
        .collect();
    worth.extend(
        moving.bodies.iter().filter_map(|seen| body(seen, reduction, horizon, &viewing, &owned, wanted, moving)),
    );
    worth.sort_by(|a, b| b.score.total_cmp(&a.score));
    worth
}

/// Nothing so near to the Sun is proposed while the Sun is up.
const SUN_CONE: Angle = Angle::degrees(30.0);
/// ... and while it is higher than this.
const SUN_COUNTS: Angle = Angle::degrees(-2.0);

/// What of the sky moves, at one moment from one site.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Moving {
    /// Moon and planets, without those that stand near a Sun that is up.
    pub bodies: Vec<InView>,
    /// The Moon's light and where it comes from.
    pub moonlight: Option<(Moonlight, Horizontal<Airless>)>,
}

impl Moving {
    /// Moon and planets from a site.
    #[must_use]
    pub fn at(ephemeris: &Ephemeris, site: &Site, extinction: f64) -> Moving {
        let reduction = ephemeris.reduction();
        let horizon = Horizon::new(reduction, site);
        let sun = reduction.sun();
        let sun_up = horizon.airless(&sun).altitude() > SUN_COUNTS;
        let safe = |seen: &InView| !sun_up || reduction.j2000(&sun).separation(&seen.position) > SUN_CONE;
        let others = Body::ALL.into_iter().filter(|body| *body != Body::Sun);
        let bodies: Vec<InView> = others.map(|body| InView::of(ephemeris, body, Some(site))).filter(safe).collect();
        let moon = ephemeris.place(Body::Moon);
        let from = horizon.airless(&moon.topocentric(reduction, site).apparent);
        let phase_angle = Aspect::topocentric(ephemeris, &moon, site).phase_angle;
        Moving { bodies, moonlight: Some((Moonlight { phase_angle, altitude: from.altitude(), extinction }, from)) }
    }

    /// The sky in a direction, with the Moon's light.
    #[must_use]
    pub fn sky(&self, dark: SurfaceBrightness, towards: &Horizontal<Airless>) -> SurfaceBrightness {
        self.moonlight
            .as_ref()
            .map_or(dark, |(light, from)| light.on(dark, towards.altitude(), towards.separation(from)))
    }
}

/// Moon or planet, judged by the same model as an even disc, with the powers of [`powers::of_disc`].
fn body(
    seen: &InView,
    reduction: &Reduction,
    horizon: &Horizon,
    viewing: &Viewing,
    owned: &[Choice],
    wanted: &Wanted,
    moving: &Moving,
) -> Option<Worth> {
    let object = seen.object();
    let horizontal = horizon.airless(&reduction.apparent(&object.astrometry));
    if horizontal.altitude() < wanted.minimum_altitude {
        return None;
    }
    let (major_arcmin, minor_arcmin) = object.axes_arcmin?;
    let v_mag = seen.magnitude.0 + wanted.extinction * air_masses(horizontal.altitude());
    let patch = Patch { v_mag, major_arcmin, minor_arcmin };
    // The Moon does not stand in its own light.
    let sky = if seen.body == Body::Moon { wanted.sky } else { moving.sky(wanted.sky, &horizontal) };
    let powers = powers::of_disc(&patch, viewing, sky, owned);
    let reserve = powers.best_reserve?;
    if reserve.is_nan() || reserve <= 0.0 {
        return None;
    }
    let score = score(&object, reserve, horizontal.altitude());
    Some(Worth { object, horizontal, powers, reserve, sky, estimated: false, score })
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
        at("2026-11-22T20:00:00Z", sky, minimum_altitude_deg, false)
    }

    fn at(at: &str, sky: f64, minimum_altitude_deg: f64, moves: bool) -> Vec<Worth> {
        let moment = Moment::at(Utc::from_rfc3339(at).unwrap());
        let reduction = Reduction::at(&moment);
        let site = Site::new(60.17, 24.94, 30.0).unwrap();
        let wanted = Wanted {
            pupil_mm: 7.0,
            sky: SurfaceBrightness(sky),
            extinction: EXTINCTION,
            minimum_altitude: Angle::degrees(minimum_altitude_deg),
        };
        let horizon = Horizon::new(&reduction, &site);
        let moving =
            if moves { Moving::at(&Ephemeris::at(&moment).unwrap(), &site, EXTINCTION) } else { Moving::default() };
        worth_showing(Catalogue::embedded(), &Instrument::default(), &reduction, &horizon, &wanted, &moving)
    }

    /// Sky and Telescope's almanac: on 2026 November 24 the Moon is full; Saturn and Jupiter are up in the night.
    #[test]
    fn the_full_moon_brightens_the_sky_hides_galaxies_and_is_shown_itself_with_saturn() {
        let (dark, moonlit) =
            (at("2026-11-24T20:00:00Z", 21.5, 25.0, false), at("2026-11-24T20:00:00Z", 21.5, 25.0, true));
        let deep = |all: &[Worth]| all.iter().filter(|worth| worth.object.kind != Kind::SolarSystem).count();
        assert!(deep(&moonlit) < deep(&dark) / 2, "{} {}", deep(&moonlit), deep(&dark));
        let of = |name: &str| moonlit.iter().position(|worth| worth.object.name == name);
        assert!(of("Moon").is_some_and(|place| place < 5) && of("Saturn").is_some_and(|place| place < 10));
        // The Moon wants a field that shows it whole: no more than 104 times here. Saturn bears more.
        let power = |name: &str| {
            let best = moonlit[of(name).unwrap()].powers.best.unwrap();
            Instrument::default().choices()[best].magnification
        };
        assert!(
            power("Moon") < 110.0 && (150.0..=250.0).contains(&power("Saturn")),
            "{} {}",
            power("Moon"),
            power("Saturn")
        );
        assert!(moonlit.iter().filter(|worth| worth.object.kind != Kind::SolarSystem).all(|worth| worth.sky.0 < 20.0));
        assert!(moonlit.iter().all(|worth| worth.object.name != "Sun"));
    }

    #[test]
    fn by_day_nothing_near_the_sun_is_proposed() {
        let noon = at("2026-11-22T10:30:00Z", 20.8, -90.0, true);
        let site = Site::new(60.17, 24.94, 30.0).unwrap();
        let moment = Moment::at(Utc::from_rfc3339("2026-11-22T10:30:00Z").unwrap());
        let sun = crate::sky::sun::horizontal(&moment, &site);
        assert!(sun.altitude().to_degrees() > 5.0, "it is day");
        let bodies = noon.iter().filter(|worth| worth.object.kind == Kind::SolarSystem);
        assert!(
            bodies.clone().count() > 0
                && bodies.clone().all(|worth| worth.horizontal.separation(&sun).to_degrees() > 29.0)
        );
    }

    #[test]
    fn galaxies_of_which_only_b_is_known_are_in_with_a_v_by_their_type() {
        let worth = night(22.2, -90.0);
        let estimated: Vec<&Worth> = worth.iter().filter(|worth| worth.estimated).collect();
        assert!(estimated.len() > 50, "{}", estimated.len());
        for worth in estimated {
            let colour = worth.object.magnitude.unwrap().0 - worth.object.estimated_v_magnitude().unwrap().0;
            assert!((0.4199..0.9001).contains(&colour) && worth.object.v_magnitude().is_none());
        }
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
