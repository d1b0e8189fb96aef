//! How a body of the solar system presents itself: its axis, the middle of its disc, its phase, its brightness.

/// How bright it is.
pub mod magnitude;
/// Axis and rotation.
pub mod rotation;

use glam::DVec3;

use super::astrometry::Reduction;
use super::coords::{Equatorial, J2000, OfDate};
use super::ephemeris::place::site_au;
use super::ephemeris::{Body, Ephemeris, Place};
use super::site::Site;
use crate::units::{Angle, Magnitude};
use magnitude::Lighting;
pub use rotation::Rotation;

/// How a body presents itself to an observer.
#[derive(Debug, Clone, PartialEq)]
pub struct Aspect {
    /// The body.
    pub body: Body,
    /// Axis and rotation when the light left it.
    pub rotation: Rotation,
    /// The north pole, catalogue axes.
    pub pole: Equatorial<J2000>,
    /// Position angle of the axis' northern half: from the north of date through east.
    pub pole_position_angle: Angle,
    /// Planetocentric longitude (eastwards) and latitude of the middle of the disc.
    pub sub_observer: (Angle, Angle),
    /// Planetocentric longitude (eastwards) and latitude under the Sun.
    pub sub_sun: (Angle, Angle),
    /// Longitude of the central meridian, by the system in which it is counted.
    pub central_meridians: Vec<(&'static str, Angle)>,
    /// Angle at the body between Sun and observer.
    pub phase_angle: Angle,
    /// Position angle of the middle of the bright limb: from the north of date through east.
    pub bright_limb_position_angle: Angle,
    /// Apparent visual magnitude.
    pub magnitude: Magnitude,
}

impl Aspect {
    /// As seen from the centre of the Earth: what an almanac prints.
    #[must_use]
    pub fn geocentric(ephemeris: &Ephemeris, place: &Place) -> Aspect {
        Aspect::of(ephemeris.reduction(), place, place.from_earth_au)
    }

    /// As seen from a site: for the Moon this differs by up to a degree.
    #[must_use]
    pub fn topocentric(ephemeris: &Ephemeris, place: &Place, site: &Site) -> Aspect {
        let reduction = ephemeris.reduction();
        let site = reduction.to_of_date().transpose() * site_au(reduction, site);
        Aspect::of(reduction, place, place.from_earth_au - site)
    }

    fn of(reduction: &Reduction, place: &Place, to_body: DVec3) -> Aspect {
        let body = place.body;
        let rotation = Rotation::of(body, place.left_jde);
        let (to_observer, to_sun) = (-to_body, -place.from_sun_au);
        // Of the Sun all is lit: its "Sun" stands behind the observer.
        let to_sun = if body == Body::Sun { to_observer } else { to_sun };
        let phase_angle = super::coords::separation(to_observer.normalize_or(DVec3::X), to_sun.normalize_or(DVec3::X));
        let (sub_observer, sub_sun) = (rotation.under(to_observer), rotation.under(to_sun));
        let lit = Lighting {
            from_sun_au: place.from_sun_au.length(),
            from_observer_au: to_body.length(),
            phase_angle,
            latitude_observer: sub_observer.1,
            latitude_sun: sub_sun.1,
            jde: place.left_jde,
        };
        Aspect {
            body,
            rotation,
            pole: Equatorial::from_direction(rotation.pole),
            pole_position_angle: position_angle(reduction, to_body, rotation.pole),
            sub_observer,
            sub_sun,
            central_meridians: rotation.central_meridians(body, place.left_jde, to_observer),
            phase_angle,
            bright_limb_position_angle: position_angle(reduction, to_body, to_sun),
            magnitude: magnitude::visual(body, &lit),
        }
    }

    /// The lit fraction of the disc, 0 to 1.
    ///
    /// ```text
    /// k = (1 + cos i) / 2
    /// ```
    #[must_use]
    pub fn phase(&self) -> f64 {
        f64::midpoint(1.0, self.phase_angle.cos())
    }

    /// How far the rings are open, for Saturn: positive if their north face is seen.
    #[must_use]
    pub fn ring_tilt(&self) -> Option<Angle> {
        (self.body == Body::Saturn).then_some(self.sub_observer.1)
    }

    /// The Moon's libration in longitude and latitude: positive if more of the eastern (Mare Crisium) and northern side is
    /// seen.
    #[must_use]
    pub fn libration(&self) -> Option<(Angle, Angle)> {
        (self.body == Body::Moon).then(|| (self.sub_observer.0.wrapped_signed(), self.sub_observer.1))
    }

    /// The Moon's selenographic longitude of the morning terminator, counted westwards: 270 degrees at new moon, 0 at first
    /// quarter, 90 at full, 180 at last.
    #[must_use]
    pub fn colongitude(&self) -> Option<Angle> {
        (self.body == Body::Moon).then(|| (Angle::degrees(90.0) - self.sub_sun.0).wrapped())
    }
}

/// Position angle on the sky of date, at the body, of a direction in space.
fn position_angle(reduction: &Reduction, to_body: DVec3, direction: DVec3) -> Angle {
    let to_of_date = reduction.to_of_date();
    let here: Equatorial<OfDate> = Equatorial::from_direction(to_of_date * to_body);
    let (seen, there) = (here.direction(), to_of_date * direction);
    // Along the sky at `here`: east is across the pole's direction, north completes it.
    let east = DVec3::Z.cross(seen).normalize_or(DVec3::Y);
    let north = seen.cross(east);
    Angle::atan2(there.dot(east), there.dot(north)).wrapped()
}
