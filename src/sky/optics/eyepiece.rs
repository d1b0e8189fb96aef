//! One eyepiece: focal length, apparent field, field stop.

use serde::{Deserialize, Serialize};

use super::Telescope;
use crate::units::Angle;

/// An eyepiece.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Eyepiece {
    /// Focal length in millimetres.
    pub focal_length_mm: f64,
    /// Apparent field in degrees, as its maker states it. 52 when not given: a plain Plössl.
    #[serde(default = "plossl_field_deg")]
    pub apparent_field_deg: f64,
    /// Diameter of the field stop in millimetres, when it is known: it fixes the true field exactly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub field_stop_mm: Option<f64>,
}

fn plossl_field_deg() -> f64 {
    52.0
}

impl Eyepiece {
    /// An eyepiece of which only the focal length is known: taken as a Plössl of 52 degrees.
    #[must_use]
    pub fn plossl(focal_length_mm: f64) -> Eyepiece {
        Eyepiece { focal_length_mm, apparent_field_deg: plossl_field_deg(), field_stop_mm: None }
    }

    /// How many times larger the telescope shows the sky with this eyepiece.
    #[must_use]
    pub fn magnification(&self, telescope: &Telescope) -> f64 {
        telescope.focal_length_mm / self.focal_length_mm
    }

    /// Diameter of the sky that is seen.
    ///
    /// ```text
    /// field stop / F            when the field stop is known, else
    /// apparent field / M
    /// ```
    ///
    /// The two differ by 7 % at 52 degrees; timing a star's drift across the field and giving the stop as
    /// `F * field` is better than either.
    #[must_use]
    pub fn true_field(&self, telescope: &Telescope) -> Angle {
        match self.field_stop_mm {
            Some(stop) => Angle::radians(stop / telescope.focal_length_mm),
            None => Angle::degrees(self.apparent_field_deg) / self.magnification(telescope),
        }
    }

    /// Diameter of the field's circle in the focal plane in millimetres: the field stop, or what stands for it.
    #[must_use]
    pub fn field_circle_mm(&self, telescope: &Telescope) -> f64 {
        self.field_stop_mm.unwrap_or_else(|| self.true_field(telescope).to_radians() * telescope.focal_length_mm)
    }

    /// Diameter in millimetres of the light that leaves the eyepiece.
    #[must_use]
    pub fn exit_pupil_mm(&self, telescope: &Telescope) -> f64 {
        self.focal_length_mm / telescope.focal_ratio()
    }
}

/// The thesis' eyepieces: section 8.3 names 32 mm (78x), 24 mm (104x) and 5 mm (500x), and a range between them.
///
/// Their makes are not told, so their fields are assumptions: 27.0 mm stops for 32 and 24 mm (the widest that a 1.25 inch
/// barrel holds; what makers publish for a 32 mm Plössl and a 24 mm wide field of 68 degrees), 7.0 mm for a 5 mm of
/// 82 degrees, and plain Plössls of 52 degrees at 15 and 10 mm. An `instrument.toml` with the observer's own replaces them.
#[must_use]
pub fn of_the_thesis() -> Vec<Eyepiece> {
    vec![
        Eyepiece { focal_length_mm: 32.0, apparent_field_deg: 52.0, field_stop_mm: Some(27.0) },
        Eyepiece { focal_length_mm: 24.0, apparent_field_deg: 68.0, field_stop_mm: Some(27.0) },
        Eyepiece::plossl(15.0),
        Eyepiece::plossl(10.0),
        Eyepiece { focal_length_mm: 5.0, apparent_field_deg: 82.0, field_stop_mm: Some(7.0) },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_thesis_has_78_104_and_500_times() {
        let telescope = Telescope::default();
        let powers: Vec<f64> =
            of_the_thesis().iter().map(|eyepiece| eyepiece.magnification(&telescope).round()).collect();
        assert_eq!(powers, [78.0, 104.0, 167.0, 250.0, 500.0]);
    }

    #[test]
    fn exit_pupils_are_those_of_a_254_mm_f_10() {
        let telescope = Telescope::default();
        for (focal_length_mm, pupil_mm) in [(32.0, 3.251), (24.0, 2.438), (15.0, 1.524), (5.0, 0.508)] {
            let pupil = Eyepiece::plossl(focal_length_mm).exit_pupil_mm(&telescope);
            assert!((pupil - pupil_mm).abs() < 1e-3, "{focal_length_mm} mm: {pupil}");
        }
    }

    #[test]
    fn a_field_stop_of_27_mm_shows_37_arcminutes_and_a_bare_plossl_its_apparent_field_over_the_power() {
        let telescope = Telescope::default();
        let stop = Eyepiece { field_stop_mm: Some(27.0), ..Eyepiece::plossl(32.0) };
        assert!((stop.true_field(&telescope).to_arcminutes() - 37.128).abs() < 1e-3);
        assert!((Eyepiece::plossl(32.0).true_field(&telescope).to_arcminutes() - 39.936).abs() < 1e-3);
    }
}
