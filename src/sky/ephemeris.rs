//! Where the Sun, the Moon, the planets and their moons are, to an arcsecond or so.

/// The bodies and their sizes.
pub mod body;
/// What of the solar system is in a field.
pub mod inview;
/// The Moon round the Earth.
pub mod moon;
/// The moons of the planets.
pub mod moons;
/// Apparent places, geocentric and topocentric.
pub mod place;
/// The planets round the Sun.
pub mod planets;

pub use body::Body;
pub use inview::{Almanac, Globe, InView};
pub use place::{AU_KM, Ephemeris, EphemerisError, LIGHT_DAYS_PER_AU, Place, Topocentric};
