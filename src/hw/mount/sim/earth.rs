//! The turning Earth: sidereal time, and the rotation between hour angle and azimuth. Degrees inside.

use glam::DVec3;

use crate::sky::time::{Moment, Utc};

/// Degrees of sidereal angle in a second of UT1: 1.002 737 811 911 354 48 turns a day (IAU 2000).
pub(super) const SIDEREAL_DEG_PER_S: f64 = 360.0 * 1.002_737_811_911_354_6 / 86_400.0;

/// Sidereal time near one instant: exact there, and carried on at the mean rate, so that it costs nothing to ask often.
#[derive(Debug, Clone, Copy)]
pub(super) struct SiderealClock {
    utc: Utc,
    greenwich_deg: f64,
}

impl SiderealClock {
    /// Exact at this instant; a day later still within 0.02 s.
    pub(super) fn at(utc: Utc) -> SiderealClock {
        SiderealClock { utc, greenwich_deg: Moment::at(utc).greenwich_sidereal_time().to_degrees() }
    }

    /// Local sidereal time in degrees, 0 to 360; longitude east positive.
    pub(super) fn local_deg(&self, utc: Utc, longitude_deg: f64) -> f64 {
        (self.greenwich_deg + (utc.0 - self.utc.0) * SIDEREAL_DEG_PER_S + longitude_deg).rem_euclid(360.0)
    }
}

/// Azimuth (north through east) and altitude of an hour angle (westwards) and a declination, all in degrees.
///
/// ```text
/// x (north) = sin(dec) cos(lat) - cos(dec) cos(h) sin(lat)
/// y (east)  = -cos(dec) sin(h)
/// z (up)    = sin(dec) sin(lat) + cos(dec) cos(h) cos(lat)
/// ```
pub(super) fn horizontal(hour_angle: f64, dec: f64, latitude: f64) -> (f64, f64) {
    let ((sin_h, cos_h), (sin_d, cos_d)) = (sin_cos(hour_angle), sin_cos(dec));
    let (sin_l, cos_l) = sin_cos(latitude);
    polar(DVec3::new(sin_d * cos_l - cos_d * cos_h * sin_l, -cos_d * sin_h, sin_d * sin_l + cos_d * cos_h * cos_l))
}

/// Hour angle (0 to 360 westwards) and declination of an azimuth and an altitude: the same rotation, its own inverse.
pub(super) fn equatorial(azimuth: f64, altitude: f64, latitude: f64) -> (f64, f64) {
    let ((sin_a, cos_a), (sin_e, cos_e)) = (sin_cos(azimuth), sin_cos(altitude));
    let (sin_l, cos_l) = sin_cos(latitude);
    polar(DVec3::new(sin_e * cos_l - cos_e * cos_a * sin_l, -cos_e * sin_a, sin_e * sin_l + cos_e * cos_a * cos_l))
}

fn sin_cos(degrees: f64) -> (f64, f64) {
    degrees.to_radians().sin_cos()
}

fn polar(v: DVec3) -> (f64, f64) {
    (v.y.atan2(v.x).to_degrees().rem_euclid(360.0), v.z.atan2(v.x.hypot(v.y)).to_degrees())
}

/// The same angle in -180 to 180 degrees.
pub(super) fn signed(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn venus_over_washington_stands_where_meeus_says() {
        // Meeus, Astronomical Algorithms, 2nd ed., example 13.b: H = 64.352133, dec = -6.719892, lat = 38.921389;
        // A = 68.0337 from south westwards (so 248.0337 from north), h = 15.1249.
        let (azimuth, altitude) = horizontal(64.352_133, -6.719_892, 38.921_389);
        assert!((azimuth - 248.0337).abs() < 1e-4 && (altitude - 15.1249).abs() < 1e-4, "{azimuth} {altitude}");
        let (hour_angle, dec) = equatorial(azimuth, altitude, 38.921_389);
        assert!((hour_angle - 64.352_133).abs() < 1e-9 && (dec + 6.719_892).abs() < 1e-9);
    }

    #[test]
    fn sidereal_time_carried_on_for_a_day_is_still_right() {
        let start = Utc(1_795_730_400.0);
        let later = start.plus_seconds(86_400.0);
        let carried = SiderealClock::at(start).local_deg(later, 10.0);
        let exact = SiderealClock::at(later).local_deg(later, 10.0);
        assert!(signed(carried - exact).abs() * 240.0 < 0.02, "seconds of time");
    }
}
