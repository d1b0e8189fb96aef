//! The veil that a bright point lays over the eye: light scattered in lens and humours.

/// Angles for which the equation holds, degrees at the eye.
pub const HOLDS_DEG: (f64, f64) = (0.1, 100.0);

/// Who looks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observer {
    /// Age in years: at seventy the veil is twice and a half that of twenty.
    pub age_years: f64,
    /// Pigmentation of the eye: 0 very dark, 0.5 brown, 1.0 blue, 1.2 very light.
    pub pigmentation: f64,
}

impl Default for Observer {
    fn default() -> Observer {
        Observer { age_years: 35.0, pigmentation: 0.5 }
    }
}

/// The veil's luminance at an angle from the point, and whether the angle was beyond the equation and taken at its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Veil {
    /// cd/m2.
    pub cd_m2: f64,
    /// Whether an end of [`HOLDS_DEG`] was taken.
    pub clamped: bool,
}

/// The veil of a point that gives so many lux at the pupil, at an angle in degrees **at the eye**.
///
/// ```text
/// L / E = 10/t^3 + (5/t^2 + 0.1 p/t) (1 + (A/62.5)^4) + 0.0025 p          t in degrees, A the age, p the pigmentation
/// ```
///
/// CIE 146:2002, the general disability glare equation, 0.1 to 100 degrees.
#[must_use]
pub fn veil(lux: f64, angle_deg: f64, observer: &Observer) -> Veil {
    let t = angle_deg.clamp(HOLDS_DEG.0, HOLDS_DEG.1);
    let p = observer.pigmentation;
    let age = 1.0 + (observer.age_years / 62.5).powi(4);
    let each = 10.0 / (t * t * t) + (5.0 / (t * t) + 0.1 * p / t) * age + 0.0025 * p;
    Veil { cd_m2: lux * each, clamped: t != angle_deg }
}

/// Lux that a star of a V magnitude gives at the pupil of an eye behind a telescope: all that the aperture gathers and the exit
/// pupil lets into the eye, spread over the eye's pupil.
///
/// ```text
/// E = 10^(-0.4 (m + 13.99)) T (D / max(p, d))^2          D aperture, d exit pupil, p the eye's
/// ```
#[must_use]
pub fn lux_of_star(v_mag: f64, viewing: &super::Viewing) -> f64 {
    let gathered = viewing.aperture_mm / viewing.pupil_mm.max(viewing.exit_pupil_mm());
    10f64.powf(-0.4 * (v_mag + 13.99)) * viewing.transmission * gathered * gathered
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eye::Viewing;

    /// By hand for a young dark eye (A = 25, p = 0): at 1 degree 10 + 5 x 1.0256 = 15.128; at 10 degrees 0.01 + 0.05128.
    #[test]
    fn the_veil_is_the_equations_by_hand() {
        let young = Observer { age_years: 25.0, pigmentation: 0.0 };
        for (angle, by_hand) in [(1.0, 15.128), (10.0, 0.06128)] {
            assert!((veil(1.0, angle, &young).cd_m2 / by_hand - 1.0).abs() < 1e-4);
        }
        // Stiles and Holladay's 10 E / t^2 is what the older formula says about 3 to 30 degrees: the same within a half.
        for angle in [3.0, 10.0, 30.0] {
            let older = 10.0 / (angle * angle);
            let ratio = veil(1.0, angle, &Observer::default()).cd_m2 / older;
            assert!((0.5..1.5).contains(&ratio), "{angle}: {ratio}");
        }
    }

    #[test]
    fn beyond_its_angles_the_end_is_taken_and_told() {
        let near = veil(1.0, 0.01, &Observer::default());
        assert!(near.clamped && near.cd_m2 == veil(1.0, 0.1, &Observer::default()).cd_m2);
        assert!(
            veil(1.0, 0.0, &Observer::default()).cd_m2.is_finite() && veil(1.0, 180.0, &Observer::default()).clamped
        );
    }

    /// Vega gives 2.54e-6 lux to the naked eye (Crumey's zero point) and 0.75 (254 / 7)^2 times as much through 254 mm.
    #[test]
    fn a_telescope_makes_a_star_brighter_by_its_aperture() {
        let viewing = Viewing { transmission: 0.75, ..Viewing::typical(254.0, 104.0) };
        let lux = lux_of_star(0.0, &viewing);
        assert!((lux / (2.54e-6 * 0.75 * (254.0f64 / 7.0).powi(2)) - 1.0).abs() < 3e-3, "{lux}");
    }
}
