//! The tube, its mirrors, and the mounting that carries it.

use serde::{Deserialize, Serialize};

use crate::units::Angle;

/// What stands between the tube and the eyepiece.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Diagonal {
    /// Nothing that reflects: the eyepiece sits on the optical axis, as in the thesis, whose projection unit is flanged
    /// straight to the tube.
    #[default]
    None,
    /// A mirror or simple prism: one reflection more. The image stands upright and is mirrored.
    Mirror,
    /// A roof (Amici) prism: two reflections more. The image is as the naked eye sees it.
    Erecting,
}

impl Diagonal {
    /// How many reflections it adds.
    #[must_use]
    pub fn reflections(self) -> u32 {
        match self {
            Diagonal::None => 0,
            Diagonal::Mirror => 1,
            Diagonal::Erecting => 2,
        }
    }
}

/// What the tube's upper side follows as the sky turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mounting {
    /// Fork on its base: the tube's upper side looks at the zenith, so the field turns with the parallactic angle.
    #[default]
    AltAz,
    /// Fork on a wedge, or any equatorial mount: the tube's upper side looks at the celestial north pole.
    Equatorial,
}

/// A telescope. The default is the thesis' own: a 10-inch Meade LX200 GPS, called 250 mm there and measuring 254.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Telescope {
    /// What the observer calls it.
    pub name: String,
    /// Clear aperture in millimetres.
    pub aperture_mm: f64,
    /// Focal length in millimetres, with any reducer.
    pub focal_length_mm: f64,
    /// Mirrors inside the tube: a Schmidt-Cassegrain and a Newtonian have 2, a refractor 0.
    pub reflections: u32,
    /// What stands between the tube and the eyepiece.
    pub diagonal: Diagonal,
    /// What carries the tube.
    pub mounting: Mounting,
    /// Share of the light that reaches the eyepiece, central obstruction and coatings together.
    pub transmission: f64,
}

impl Default for Telescope {
    fn default() -> Telescope {
        Telescope {
            name: "Meade LX200 GPS 10 inch".into(),
            aperture_mm: 254.0,
            focal_length_mm: 2500.0,
            reflections: 2,
            diagonal: Diagonal::None,
            mounting: Mounting::AltAz,
            transmission: 0.75,
        }
    }
}

impl Telescope {
    /// The smallest gap between two equal stars that can be split.
    ///
    /// ```text
    /// 115.82 / D          D in mm, arcseconds
    /// ```
    ///
    /// Dawes (1867), as in section 8.3 of the thesis. Checked: 0.456 arcseconds for 254 mm.
    #[must_use]
    pub fn dawes_limit(&self) -> Angle {
        Angle::arcseconds(115.82 / self.aperture_mm)
    }

    /// Focal ratio.
    #[must_use]
    pub fn focal_ratio(&self) -> f64 {
        self.focal_length_mm / self.aperture_mm
    }

    /// Whether the eyepiece shows the sky mirrored: after an odd number of reflections.
    #[must_use]
    pub fn mirrored(&self) -> bool {
        (self.reflections + self.diagonal.reflections()) % 2 == 1
    }

    /// Where the tube's upper side is in the eyepiece's view, from the view's top counter-clockwise.
    ///
    /// An objective's image stands upside down (half a turn); a diagonal, looked into from behind, sets it upright.
    #[must_use]
    pub fn upper_side(&self) -> Angle {
        match self.diagonal {
            Diagonal::None => Angle::degrees(180.0),
            Diagonal::Mirror | Diagonal::Erecting => Angle::ZERO,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dawes_limit_of_254_mm_is_456_milliarcseconds() {
        assert!((Telescope::default().dawes_limit().to_arcseconds() - 0.456).abs() < 5e-4);
    }

    #[test]
    fn a_mirror_diagonal_on_a_schmidt_cassegrain_makes_three_reflections_and_a_mirrored_upright_view() {
        let plain = Telescope::default();
        let diagonal = Telescope { diagonal: Diagonal::Mirror, ..Telescope::default() };
        let erecting = Telescope { diagonal: Diagonal::Erecting, ..Telescope::default() };
        assert!(!plain.mirrored() && diagonal.mirrored() && !erecting.mirrored());
        assert_eq!(plain.upper_side().to_degrees(), 180.0);
        assert_eq!(diagonal.upper_side(), Angle::ZERO);
        assert_eq!(erecting.upper_side(), Angle::ZERO);
    }
}
