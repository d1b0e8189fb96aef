//! What moves the true axis and never the reported position: pointing error, worms, drift, a push of the tube.

use std::f64::consts::TAU;
use std::time::Duration;

use super::settings::Settings;
use crate::numerics::streams::Stream;

/// Degrees of an axis for one turn of its worm: 180 teeth, so eight minutes at the sidereal rate.
pub(super) const WORM_DEG: f64 = 2.0;

/// Nearer to the zenith than this cosine the azimuth terms stop growing.
const LEAST_COS: f64 = 0.05;

/// The errors of one mount. Angles in degrees.
///
/// ```text
/// reading - true:  dA = IA + tan E (AN sin A + AW cos A) + CA sec E
///                  dE = IE + AN cos A - AW sin A
/// ```
///
/// Azimuth A from north through east, altitude E; AN and AW are the tilts of the azimuth axis to north and west, CA the
/// collimation (Wallace's alt-azimuth terms, signs as for an exact rotation). Each worm adds a sine of its own phase.
#[derive(Debug)]
pub(super) struct PointingError {
    ia: f64,
    ie: f64,
    an: f64,
    aw: f64,
    ca: f64,
    worm_amplitude: f64,
    worm_phases: [f64; 2],
    drift_deg_per_s: f64,
    push: Option<(Duration, f64, f64)>,
}

impl PointingError {
    pub(super) fn new(settings: &Settings) -> PointingError {
        let mut stream = Stream::seeded(settings.seed ^ 0x706f_696e_7469_6e67);
        let size = settings.pointing_error.to_degrees();
        // Five terms of either sign, each half of the whole: together they come to about its size on the sky.
        let mut term = || size * (0.3 + 0.4 * stream.uniform()) * if stream.chance(0.5) { 1.0 } else { -1.0 };
        let (ia, ie, an, aw, ca) = (term(), term(), term(), term(), term());
        PointingError {
            ia,
            ie,
            an,
            aw,
            ca,
            worm_amplitude: settings.periodic_error.to_degrees() / 2.0,
            worm_phases: [stream.uniform() * TAU, stream.uniform() * TAU],
            drift_deg_per_s: settings.drift_arcsec_per_s / 3600.0,
            push: settings.faults.push,
        }
    }

    /// Azimuth and altitude of the true axis where the encoders' are these.
    pub(super) fn apply(&self, (azimuth, altitude): (f64, f64), now: Duration) -> (f64, f64) {
        let ((sin_a, cos_a), (sin_e, cos_e)) = (azimuth.to_radians().sin_cos(), altitude.to_radians().sin_cos());
        let cos_e = cos_e.max(LEAST_COS);
        let d_az = self.ia + (sin_e * (self.an * sin_a + self.aw * cos_a) + self.ca) / cos_e;
        let d_alt = self.ie + self.an * cos_a - self.aw * sin_a;
        let (pushed_az, pushed_alt) = self.pushed(now);
        (
            azimuth - d_az + self.worm(0, azimuth) + self.drift_deg_per_s * now.as_secs_f64() + pushed_az,
            altitude - d_alt + self.worm(1, altitude) + pushed_alt,
        )
    }

    /// The sine of one worm, whose phase is the angle of its axis.
    fn worm(&self, axis: usize, degrees: f64) -> f64 {
        self.worm_amplitude * (degrees / WORM_DEG * TAU + self.worm_phases[axis]).sin()
    }

    /// A push takes one second.
    fn pushed(&self, now: Duration) -> (f64, f64) {
        let Some((at, azimuth, altitude)) = self.push else { return (0.0, 0.0) };
        let part = now.saturating_sub(at).as_secs_f64().min(1.0);
        (azimuth * part, altitude * part)
    }
}

#[cfg(test)]
mod tests {
    use super::super::earth::SIDEREAL_DEG_PER_S;
    use super::*;
    use crate::units::Angle;

    fn only_worms() -> PointingError {
        PointingError::new(&Settings { pointing_error: Angle::ZERO, ..Settings::default() })
    }

    #[test]
    fn the_worm_turns_once_in_eight_minutes_at_the_sidereal_rate() {
        let error = only_worms();
        let after = |seconds: f64| error.apply((100.0 + SIDEREAL_DEG_PER_S * seconds, 45.0), Duration::ZERO).0;
        let deviation = |seconds: f64| (after(seconds) - 100.0 - SIDEREAL_DEG_PER_S * seconds) * 3600.0;
        // 360 / 180 degrees at 15.041 arcseconds a second: 478.7 s, the eight minutes of the manual.
        assert!((deviation(0.0) - deviation(WORM_DEG / SIDEREAL_DEG_PER_S)).abs() < 1e-6);
        assert!((WORM_DEG / SIDEREAL_DEG_PER_S - 480.0).abs() < 1.5);
        let all: Vec<f64> = (0..480).map(|s| deviation(f64::from(s))).collect();
        let peak_to_peak = all.iter().cloned().fold(f64::MIN, f64::max) - all.iter().cloned().fold(f64::MAX, f64::min);
        assert!((peak_to_peak - 25.0).abs() < 0.05, "{peak_to_peak}");
    }

    #[test]
    fn the_pointing_error_is_of_the_asked_size_over_the_sky() {
        for seed in 0..50 {
            let settings = Settings { seed, periodic_error: Angle::ZERO, ..Settings::default() };
            let error = PointingError::new(&settings);
            let mut sum = 0.0;
            for azimuth in (0..360).step_by(10) {
                for altitude in (10..70).step_by(5) {
                    let (a, e) = error.apply((f64::from(azimuth), f64::from(altitude)), Duration::ZERO);
                    let across = (a - f64::from(azimuth)) * f64::from(altitude).to_radians().cos();
                    sum += (across * 60.0).hypot((e - f64::from(altitude)) * 60.0);
                }
            }
            let mean = sum / (36.0 * 12.0);
            assert!((0.5..4.0).contains(&mean), "seed {seed}: {mean} arcminutes");
        }
    }
}
