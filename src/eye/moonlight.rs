//! How much brighter the Moon makes the sky.

use crate::units::{Angle, SurfaceBrightness};

/// The Moon as a lamp in the sky.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moonlight {
    /// Between Sun and Earth as seen from the Moon: 0 when full.
    pub phase_angle: Angle,
    /// Its altitude. Below the horizon it gives nothing.
    pub altitude: Angle,
    /// Magnitudes that an air mass takes.
    pub extinction: f64,
}

/// Nanolamberts of a surface brightness: Krisciunas and Schaefer's equation 1.
fn nanolambert(sky: SurfaceBrightness) -> f64 {
    34.08 * (20.7233 - 0.92104 * sky.0).exp()
}

/// Magnitudes per square arcsecond of nanolamberts.
fn of_nanolambert(nl: f64) -> SurfaceBrightness {
    SurfaceBrightness((20.7233 - (nl / 34.08).ln()) / 0.92104)
}

/// Air masses for light that is scattered on its way.
///
/// ```text
/// X(Z) = (1 - 0.96 sin^2 Z)^-1/2          eq. 3: 1 at the zenith, 5 at the horizon
/// ```
fn air_masses(altitude: Angle) -> f64 {
    let sin_z = altitude.cos();
    (1.0 - 0.96 * sin_z * sin_z).max(0.04).powf(-0.5)
}

impl Moonlight {
    /// What moonlight adds to the sky at an altitude and distance from the Moon, nanolamberts.
    ///
    /// ```text
    /// B = f(rho) I* 10^(-0.4 k X(Z_m)) (1 - 10^(-0.4 k X(Z)))                                 eq. 15
    /// I* = 10^(-0.4 (3.84 + 0.026 |alpha| + 4e-9 alpha^4))          alpha in degrees          eq. 20
    /// f = 10^5.36 (1.06 + cos^2 rho) + 10^(6.15 - rho/40), nearer than 10 degrees 6.2e7/rho^2   eqs. 17 to 19, 21
    /// ```
    ///
    /// Krisciunas and Schaefer (1991), PASP 103, 1033; right to 8 to 23 %. The corona nearer than 0.25 degrees is held there.
    #[must_use]
    pub fn nanolambert(&self, altitude: Angle, from_moon: Angle) -> f64 {
        if self.altitude.to_radians() <= 0.0 || altitude.to_radians() < 0.0 {
            return 0.0;
        }
        let alpha = self.phase_angle.to_degrees().abs();
        let lit = 10f64.powf(-0.4 * (3.84 + 0.026 * alpha + 4e-9 * alpha.powi(4)));
        let rho = from_moon.to_degrees().max(0.25);
        let rayleigh = 10f64.powf(5.36) * (1.06 + from_moon.cos().powi(2));
        let mie = if rho < 10.0 { 6.2e7 / (rho * rho) } else { 10f64.powf(6.15 - rho / 40.0) };
        let passes = |altitude| 10f64.powf(-0.4 * self.extinction * air_masses(altitude));
        (rayleigh + mie) * lit * passes(self.altitude) * (1.0 - passes(altitude))
    }

    /// A dark sky as moonlight makes it.
    #[must_use]
    pub fn on(&self, dark: SurfaceBrightness, altitude: Angle, from_moon: Angle) -> SurfaceBrightness {
        let added = self.nanolambert(altitude, from_moon);
        if added > 0.0 { of_nanolambert(nanolambert(dark) + added) } else { dark }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moon(phase_deg: f64, altitude_deg: f64) -> Moonlight {
        Moonlight { phase_angle: Angle::degrees(phase_deg), altitude: Angle::degrees(altitude_deg), extinction: 0.172 }
    }

    /// By hand, Mauna Kea's k of 0.172, both at zenith distance 30, 60 degrees apart: X = 1.14708, I* = 0.029107,
    /// f = 229087 x 1.31 + 44668 = 344772, 10^(-0.4 k X) = 0.83384; B = 1390.3 nL.
    #[test]
    fn the_full_moon_gives_what_the_equations_give_by_hand() {
        let added = moon(0.0, 60.0).nanolambert(Angle::degrees(60.0), Angle::degrees(60.0));
        assert!((added / 1390.3 - 1.0).abs() < 1e-3, "{added}");
        let sky = moon(0.0, 60.0).on(SurfaceBrightness(21.587), Angle::degrees(60.0), Angle::degrees(60.0)).0;
        // 79 nL are the dark sky of 21.587 there (their section 2).
        assert!((nanolambert(SurfaceBrightness(21.587)) - 79.0).abs() < 1.0);
        assert!((sky - 18.41).abs() < 0.01, "{sky}");
    }

    #[test]
    fn a_thin_moon_hardly_counts_a_near_one_counts_most_and_one_that_is_down_not_at_all() {
        let (dark, high) = (SurfaceBrightness(21.8), Angle::degrees(60.0));
        let sky = |moon: Moonlight, rho: f64| moon.on(dark, high, Angle::degrees(rho)).0;
        assert!(sky(moon(140.0, 20.0), 90.0) > 21.6);
        assert!(
            sky(moon(0.0, 45.0), 5.0) < sky(moon(0.0, 45.0), 30.0)
                && sky(moon(0.0, 45.0), 30.0) < sky(moon(0.0, 45.0), 90.0)
        );
        assert_eq!(sky(moon(0.0, -0.1), 90.0), 21.8);
        assert_eq!(moon(0.0, 45.0).on(dark, Angle::degrees(-5.0), Angle::degrees(50.0)), dark);
    }

    proptest::proptest! {
        #[test]
        fn the_moon_never_darkens_a_sky_and_always_leaves_a_number(
            phase in -180.0..180.0f64, moon_up in -90.0..90.0f64, up in -90.0..90.0f64, rho in 0.0..180.0f64, dark in 16.0..22.2f64,
        ) {
            let sky = moon(phase, moon_up).on(SurfaceBrightness(dark), Angle::degrees(up), Angle::degrees(rho)).0;
            proptest::prop_assert!(sky.is_finite() && sky <= dark + 1e-9);
        }
    }
}
