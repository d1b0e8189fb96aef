//! Instrument and eye together: exit pupil, and the background that the eye gets.

use super::crumey;
use crate::units::SurfaceBrightness;

/// A telescope of which only the aperture is told: Crumey's light loss of F_t = 1.33, so that 0.752 reaches the eye.
pub const CRUMEY_TRANSMISSION: f64 = 1.0 / 1.33;

/// The pupil of a young eye in the dark, millimetres. It shrinks with age: about 6.2 at fifty, 5.5 at seventy.
pub const DARK_PUPIL_MM: f64 = 7.0;

/// An eye behind a telescope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viewing {
    /// Clear aperture in millimetres.
    pub aperture_mm: f64,
    /// Magnification.
    pub magnification: f64,
    /// Share of the light that reaches the eye.
    pub transmission: f64,
    /// The eye's pupil in millimetres.
    pub pupil_mm: f64,
    /// How many times more contrast this observer needs than Blackwell's, one eye included: Crumey's phi = F F_T.
    pub field_factor: f64,
}

impl Viewing {
    /// A typical observer behind a telescope: pupil 7 mm, Crumey's transmission, F = 2 and one eye.
    #[must_use]
    pub fn typical(aperture_mm: f64, magnification: f64) -> Viewing {
        Viewing {
            aperture_mm,
            magnification,
            transmission: CRUMEY_TRANSMISSION,
            pupil_mm: DARK_PUPIL_MM,
            field_factor: crumey::TYPICAL_OBSERVER * crumey::ONE_EYE,
        }
    }

    /// Diameter in millimetres of the light that leaves the eyepiece.
    ///
    /// ```text
    /// d = D / M
    /// ```
    #[must_use]
    pub fn exit_pupil_mm(&self) -> f64 {
        self.aperture_mm / self.magnification
    }

    /// How many times dimmer than to the naked eye a surface is: background and object alike.
    ///
    /// ```text
    /// T min(1, d/p)^2          p the eye's pupil
    /// ```
    ///
    /// Magnification never makes a surface brighter.
    #[must_use]
    pub fn dimming(&self) -> f64 {
        self.transmission * (self.exit_pupil_mm() / self.pupil_mm).min(1.0).powi(2)
    }

    /// The sky's luminance at the eye, cd/m2.
    #[must_use]
    pub fn background_cd_m2(&self, sky: SurfaceBrightness) -> f64 {
        sky.to_candela_per_m2() * self.dimming()
    }

    /// The sky at the eye, magnitudes per square arcsecond.
    #[must_use]
    pub fn background(&self, sky: SurfaceBrightness) -> SurfaceBrightness {
        SurfaceBrightness(sky.0 - 2.5 * self.dimming().log10())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn under_a_sky_of_21_5_the_eye_gets_44_25_and_1_1_microcandela() {
        for (magnification, published) in [(78.125, 4.4e-5), (104.1667, 2.5e-5), (500.0, 1.1e-6)] {
            let viewing = Viewing { transmission: 0.75, ..Viewing::typical(254.0, magnification) };
            let background = viewing.background_cd_m2(SurfaceBrightness(21.5));
            assert!((background / published - 1.0).abs() < 0.05, "{magnification}: {background}");
        }
    }

    #[test]
    fn an_exit_pupil_wider_than_the_eye_makes_nothing_brighter() {
        let wide = Viewing::typical(254.0, 20.0);
        assert!((wide.dimming() - CRUMEY_TRANSMISSION).abs() < 1e-12);
        assert!(wide.background(SurfaceBrightness(20.0)).0 > 20.0);
    }
}
