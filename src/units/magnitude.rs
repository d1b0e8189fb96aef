//! Magnitudes and surface brightness. f64: they are few, and differences of them are exponentiated.

/// An apparent magnitude in the V band unless its name says otherwise: smaller is brighter.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Magnitude(pub f64);

/// Magnitudes per square arcsecond: smaller is brighter.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct SurfaceBrightness(pub f64);

impl Magnitude {
    /// Flux relative to a star of magnitude zero.
    ///
    /// ```text
    /// F = 10^(-0.4 m)          Pogson (1856)
    /// ```
    #[must_use]
    pub fn flux(self) -> f64 {
        10f64.powf(-0.4 * self.0)
    }
}

impl SurfaceBrightness {
    /// Mean surface brightness of an ellipse of full axes `major` and `minor` in arcminutes.
    ///
    /// ```text
    /// SB = m + 2.5 log10(pi/4 a b 3600)
    /// ```
    ///
    /// It is the mean out to the catalogue's isophote: cores are far brighter. Checked against M57 (8.8, 1.4' x 1.0') = 17.79.
    #[must_use]
    pub fn of_ellipse(total: Magnitude, major_arcmin: f64, minor_arcmin: f64) -> SurfaceBrightness {
        SurfaceBrightness(total.0 + 2.5 * (std::f64::consts::FRAC_PI_4 * major_arcmin * minor_arcmin * 3600.0).log10())
    }

    /// Luminance in cd/m2.
    ///
    /// ```text
    /// mu = 12.58 - 2.5 log10(B)          Crumey (2014), MNRAS 442, 2600
    /// ```
    #[must_use]
    pub fn to_candela_per_m2(self) -> f64 {
        10f64.powf((12.58 - self.0) / 2.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn m57_and_m51_have_the_published_means() {
        assert!((SurfaceBrightness::of_ellipse(Magnitude(8.8), 1.4, 1.0).0 - 17.79).abs() < 0.01);
        assert!((SurfaceBrightness::of_ellipse(Magnitude(8.4), 11.2, 6.9).0 - 21.75).abs() < 0.01);
    }

    #[test]
    fn a_dark_sky_of_22_is_a_fifth_of_a_millicandela() {
        assert!((SurfaceBrightness(22.0).to_candela_per_m2() - 1.71e-4).abs() < 0.01e-4);
    }
}
