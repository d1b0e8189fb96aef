//! Colours of stars by their temperatures: black bodies.

/// Effective wavelengths of Johnson's R, V and B, nanometres, red first as the thesis' bands (Bessell 2005, Annu. Rev. Astron. Astrophys. 43,
/// 293, table 1: Cousins' R).
pub const RED_GREEN_BLUE_NM: [f64; 3] = [641.0, 545.0, 436.0];

/// The second radiation constant hc/k in nanometre kelvins (CODATA 2018, exact).
const SECOND_NM_K: f64 = 1.438_776_877e7;

/// Temperatures that are understood, kelvin.
pub const TEMPERATURES: std::ops::RangeInclusive<f64> = 500.0..=1e6;

/// Spectral radiance of a black body at each wavelength (nanometres), relative to that at 545 nm, so that a star's intensity is its V.
///
/// Planck (1901): `B ~ lambda^-5 / (exp(hc / (lambda k T)) - 1)`. Nothing for temperatures beyond [`TEMPERATURES`] or wavelengths beyond 100
/// nm to 100 micrometres.
#[must_use]
pub fn colour(kelvin: f64, wavelengths_nm: &[f64]) -> Option<Vec<f64>> {
    let sound = TEMPERATURES.contains(&kelvin) && wavelengths_nm.iter().all(|nm| (100.0..=1e5).contains(nm));
    let planck = |nm: f64| nm.powi(-5) / (SECOND_NM_K / (nm * kelvin)).exp_m1();
    sound.then(|| wavelengths_nm.iter().map(|nm| planck(*nm) / planck(RED_GREEN_BLUE_NM[1])).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hot_stars_are_blue_cool_ones_red_and_very_hot_ones_as_rayleigh_and_jeans_have_it() {
        let [red, green, blue] = colour(20_000.0, &RED_GREEN_BLUE_NM).unwrap()[..] else { panic!("three bands") };
        assert!(red < 1.0 && green == 1.0 && blue > 1.0);
        assert!(colour(3500.0, &RED_GREEN_BLUE_NM).unwrap()[0] > 1.0);
        let hot = colour(1e6, &[1e5, 5e4]).unwrap();
        assert!((hot[1] / hot[0] - 16.0).abs() < 0.01, "{hot:?}");
        assert!(colour(f64::NAN, &[500.0]).is_none() && colour(5000.0, &[-1.0]).is_none());
    }

    #[test]
    fn the_ratio_of_two_wavelengths_at_5772_kelvin_is_plancks() {
        // B(450 nm) / B(650 nm) at 5772 K by hand: (650/450)^5 (exp(14387768.77/(650 5772)) - 1)/(exp(14387768.77/(450 5772)) - 1).
        let sun = colour(5772.0, &[450.0, 650.0]).unwrap();
        assert!((sun[0] / sun[1] - 1.123_357_2).abs() < 1e-6, "{}", sun[0] / sun[1]);
    }
}
