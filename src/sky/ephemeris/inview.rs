//! What of the solar system is in a field: globes with their axes and their light, and moons, ready to be drawn.

use glam::{DMat3, DVec3};

use super::body::Body;
use super::moons::{self, Moon};
use super::place::{Ephemeris, site_au};
use crate::sky::astrometry::Astrometry;
use crate::sky::catalogue::{Band, Kind, Object, constellation};
use crate::sky::coords::{Equatorial, J2000};
use crate::sky::physical::Aspect;
use crate::sky::project::tangent_basis;
use crate::sky::site::Site;
use crate::sky::time::Moment;
use crate::units::{Angle, Magnitude};

/// Days for which a rough place serves to tell what may be in a field: the Moon moves 8 arcminutes.
const ROUGH_DAYS: f64 = 0.01;
/// How far a body may be from its rough place, and its moons from it: the Moon's parallax is a degree.
const MARGIN_MOON: Angle = Angle::degrees(1.5);
const MARGIN: Angle = Angle::degrees(0.4);
/// Saturn's rings in its radii.
const RINGS: f64 = 2.27;

/// A body in the field.
#[derive(Debug, Clone, PartialEq)]
pub struct InView {
    /// The body.
    pub body: Body,
    /// Its centre among the catalogue's stars: with parallax if the site is known.
    pub position: Equatorial<J2000>,
    /// The globe.
    pub globe: Globe,
    /// Apparent visual magnitude.
    pub magnitude: Magnitude,
    /// Its moons.
    pub moons: Vec<(Moon, Equatorial<J2000>)>,
}

/// A globe as it is seen and lit. Vectors are east, north (of J2000, at the globe) and towards the observer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Globe {
    /// Half of the equator's diameter.
    pub radius: Angle,
    /// Polar over equatorial radius.
    pub polar: f64,
    /// Unit vectors to the prime meridian, to 90 degrees east and to the north pole.
    pub axes: [DVec3; 3],
    /// Unit vector to the Sun; for the Sun itself, to the observer.
    pub sun: DVec3,
}

/// Remembers roughly where everything is, so that a field without planets costs nothing.
#[derive(Debug, Clone, Default)]
pub struct Almanac {
    rough: Option<Rough>,
}

/// Apparent places of all bodies at a Julian date.
#[derive(Debug, Clone)]
struct Rough {
    jde: f64,
    places: Vec<(Body, Equatorial<J2000>)>,
}

impl Almanac {
    /// What of the solar system is within a circle, nearest first. Beyond the years of the ephemeris nothing is.
    #[must_use]
    pub fn within(
        &mut self,
        moment: &Moment,
        site: Option<&Site>,
        centre: &Equatorial<J2000>,
        radius: Angle,
    ) -> Vec<InView> {
        let (day, fraction) = moment.tt();
        let jde = day + fraction;
        // A moment that is not a number is beyond the ephemeris.
        let stale = self.rough.as_ref().is_none_or(|rough| (jde - rough.jde).abs() > ROUGH_DAYS || jde.is_nan());
        let mut ephemeris = None;
        if stale {
            let Ok(fresh) = Ephemeris::at(moment) else { return Vec::new() };
            let place = |body| (body, fresh.reduction().j2000(&fresh.place(body).apparent));
            self.rough = Some(Rough { jde, places: Body::ALL.into_iter().map(place).collect() });
            ephemeris = Some(fresh);
        }
        let margin = |body| if body == Body::Moon { MARGIN_MOON } else { MARGIN };
        let near = |(body, position): &(Body, Equatorial<J2000>)| {
            (centre.separation(position) <= radius + margin(*body)).then_some(*body)
        };
        let bodies: Vec<Body> = self.rough.iter().flat_map(|rough| rough.places.iter().filter_map(near)).collect();
        if bodies.is_empty() {
            return Vec::new();
        }
        let Some(ephemeris) = ephemeris.or_else(|| Ephemeris::at(moment).ok()) else { return Vec::new() };
        let mut seen: Vec<InView> = bodies.into_iter().map(|body| InView::of(&ephemeris, body, site)).collect();
        seen.retain(|seen| centre.separation(&seen.position) <= radius + seen.extent());
        seen.sort_by(|a, b| {
            let away = |seen: &InView| centre.separation(&seen.position).to_radians();
            away(a).total_cmp(&away(b))
        });
        seen
    }
}

impl InView {
    /// A body as it is seen from a site, or else from the centre of the Earth.
    #[must_use]
    pub fn of(ephemeris: &Ephemeris, body: Body, site: Option<&Site>) -> InView {
        let reduction = ephemeris.reduction();
        let place = ephemeris.place(body);
        let (apparent, distance_au, aspect, to_body) = match site {
            Some(site) => {
                let seen = place.topocentric(reduction, site);
                let from_site = place.from_earth_au - reduction.to_of_date().transpose() * site_au(reduction, site);
                (seen.apparent, seen.distance_au, Aspect::topocentric(ephemeris, &place, site), from_site)
            }
            None => (place.apparent, place.distance_au, Aspect::geocentric(ephemeris, &place), place.from_earth_au),
        };
        let position = reduction.j2000(&apparent);
        // Rows east, north and away; the third turned towards the observer.
        let basis = tangent_basis(&position);
        let to_view = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0)) * basis;
        let to_sun = if body == Body::Sun { -to_body } else { -place.from_sun_au };
        let moon = |moon: Moon| (moon, reduction.j2000(&moon.beside(&apparent)));
        InView {
            body,
            position,
            globe: Globe {
                radius: place.angular_diameter(distance_au) / 2.0,
                polar: body.polar_radius_km() / body.equatorial_radius_km(),
                axes: aspect.rotation.axes().map(|axis| to_view * axis),
                sun: (to_view * to_sun).normalize_or(DVec3::Z),
            },
            magnitude: aspect.magnitude,
            moons: moons::beside(ephemeris, &place).into_iter().map(moon).collect(),
        }
    }

    /// The body as an object to look at: where it is now, with its size and brightness.
    #[must_use]
    pub fn object(&self) -> Object {
        let diameter = self.globe.radius.to_arcminutes() * 2.0;
        let polar = if self.body == Body::Saturn { 1.0 } else { self.globe.polar };
        let pole = self.globe.axes[2];
        Object {
            name: self.body.name().to_owned(),
            names: vec![self.body.name().to_owned()],
            kind: Kind::SolarSystem,
            hubble: None,
            astrometry: Astrometry::fixed(self.position),
            magnitude: Some(self.magnitude),
            band: Band::V,
            colour_bv: None,
            axes_arcmin: Some((diameter, diameter * polar)),
            // The equator lies across the axis.
            position_angle: Some((Angle::atan2(pole.x, pole.y) + Angle::degrees(90.0)).wrapped()),
            surface_brightness: None,
            distance: None,
            hand_controllers_place: false,
            constellation: constellation::at(&self.position),
        }
    }

    /// How far from its centre there is something to see: rings or the outermost moon.
    #[must_use]
    pub fn extent(&self) -> Angle {
        let rings = if self.body == Body::Saturn { RINGS } else { 1.0 };
        let moons = self.moons.iter().map(|(moon, _)| moon.east.to_radians().hypot(moon.north.to_radians()));
        Angle::radians(moons.fold(self.globe.radius.to_radians() * rings, f64::max))
    }
}
