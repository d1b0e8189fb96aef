//! How much the air lifts what we see: mean refraction, good to 0.1 arcminute above 15 degrees of altitude.

use crate::units::Angle;

/// The path of light through layered air.
pub mod ray;

/// The air at the telescope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// Pressure at the site itself (not reduced to sea level), hectopascal.
    pub pressure_hpa: f64,
    /// Temperature, degrees Celsius.
    pub temperature_c: f64,
}

impl Default for Air {
    /// The air for which the formulas are printed: 1010 hPa, 10 degrees Celsius.
    fn default() -> Air {
        Air { pressure_hpa: 1010.0, temperature_c: 10.0 }
    }
}

impl Air {
    /// How much stronger this air bends than the formulas' own.
    ///
    /// ```text
    /// P/1010 * 283/(273 + T)          P in hPa, T in degrees Celsius
    /// ```
    ///
    /// Source: Meeus, *Astronomical Algorithms*, ch. 16. Air colder than 150 K counts as 150 K.
    fn strength(&self) -> f64 {
        self.pressure_hpa.max(0.0) / 1010.0 * 283.0 / (273.0 + self.temperature_c).max(150.0)
    }
}

/// Below this true altitude nothing is seen, and the formula is not used.
const LOWEST_DEG: f64 = -1.0;

/// Where the refraction, let fade from [`LOWEST_DEG`] down, ends.
const NONE_DEG: f64 = -5.0;

/// Refraction of a true (airless) altitude.
///
/// ```text
/// R = 1.02 cot(h + 10.3/(h + 5.11))          h true altitude in degrees, R in arcminutes
/// ```
///
/// Source: Saemundsson (1986), Sky & Telescope 72, 70; as in Meeus, *Astronomical Algorithms*, eq. 16.4.
/// Valid from -1 degree to the zenith, where it would give -0.08 arcsecond and zero is used. Below -1 degree, where
/// only geometry is left, it fades to zero at -5 degrees, so that the altitude seen still grows with the true one.
#[must_use]
pub fn of_true_altitude(altitude: Angle, air: &Air) -> Angle {
    let h = altitude.to_degrees();
    let saemundsson = |h: f64| (1.02 / (h + 10.3 / (h + 5.11)).to_radians().tan()).max(0.0);
    let fade = ((h - NONE_DEG) / (LOWEST_DEG - NONE_DEG)).clamp(0.0, 1.0);
    Angle::arcminutes(saemundsson(h.max(LOWEST_DEG)) * fade * air.strength())
}

/// Refraction of an apparent altitude.
///
/// ```text
/// R = cot(h + 7.31/(h + 4.4))          h apparent altitude in degrees, R in arcminutes
/// ```
///
/// Source: Bennett (1982), Journal of Navigation 35, 255; as in Meeus, *Astronomical Algorithms*, eq. 16.3.
/// Valid from the horizon to the zenith (where zero is used); at negative altitudes the value at the horizon is held.
/// Saemundsson's formula agrees with it within 0.1 arcminute (tested below).
#[must_use]
pub fn bennett(apparent: Angle, air: &Air) -> Angle {
    let h = apparent.to_degrees().max(0.0);
    Angle::arcminutes((1.0 / (h + 7.31 / (h + 4.4)).to_radians().tan()).max(0.0) * air.strength())
}

/// The altitude at which the eye sees what stands at a true altitude.
#[must_use]
pub fn refracted(airless: Angle, air: &Air) -> Angle {
    airless + of_true_altitude(airless, air)
}

/// The true altitude of what the eye sees at an altitude: the inverse of [`refracted`], exactly.
///
/// It is found by halving, because a formula and its inverse must agree better than Saemundsson's and Bennett's do.
#[must_use]
pub fn airless(refracted_altitude: Angle, air: &Air) -> Angle {
    let (mut low, mut high) = (refracted_altitude - Angle::degrees(3.0), refracted_altitude);
    for _ in 0..60 {
        let middle = (low + high) / 2.0;
        if refracted(middle, air) < refracted_altitude { low = middle } else { high = middle }
    }
    (low + high) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Meeus, *Astronomical Algorithms*, example 16.a: the Sun's lower limb is seen at 0.5 degrees; R = 28.754'.
    #[test]
    fn bennett_gives_meeus_example_16a() {
        let r = bennett(Angle::degrees(0.5), &Air::default());
        assert!((r.to_arcminutes() - 28.754).abs() < 0.001, "{}", r.to_arcminutes());
    }

    /// The same example: the upper limb's true altitude is 0.5541 degrees; R = 24.618'.
    #[test]
    fn saemundsson_gives_meeus_example_16a() {
        let r = of_true_altitude(Angle::degrees(0.5541), &Air::default());
        assert!((r.to_arcminutes() - 24.618).abs() < 0.001, "{}", r.to_arcminutes());
    }

    #[test]
    fn the_two_formulas_agree_to_a_tenth_of_an_arcminute() {
        let air = Air::default();
        for tenths in 0..=900 {
            let truth = Angle::degrees(f64::from(tenths) / 10.0);
            let seen = refracted(truth, &air);
            let difference = (seen - truth - bennett(seen, &air)).to_arcminutes();
            assert!(difference.abs() < 0.1, "{} deg: {difference}'", truth.to_degrees());
        }
    }

    #[test]
    fn thin_warm_air_bends_less() {
        let mauna_kea = Air { pressure_hpa: 616.0, temperature_c: 2.0 };
        let ratio = of_true_altitude(Angle::degrees(30.0), &mauna_kea)
            / of_true_altitude(Angle::degrees(30.0), &Air::default());
        assert!((ratio - 616.0 / 1010.0 * 283.0 / 275.0).abs() < 1e-12);
    }

    #[test]
    fn altitude_seen_grows_with_true_altitude_and_comes_back() {
        let air = Air { pressure_hpa: 1050.0, temperature_c: -30.0 };
        let mut before = Angle::degrees(-91.0);
        for hundredths in -9000..=9000 {
            let truth = Angle::degrees(f64::from(hundredths) / 100.0);
            let seen = refracted(truth, &air);
            assert!(seen > before);
            before = seen;
            assert!((airless(seen, &air) - truth).abs().to_arcseconds() < 1e-4, "{}", truth.to_degrees());
        }
    }
}
