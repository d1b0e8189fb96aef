//! Scattering by the molecules of dry air.

/// Scattering cross-section of a molecule of dry air, square metres.
///
/// ```text
/// σ = 24 π³ (n² - 1)² / (λ⁴ Ns² (n² + 2)²) * F(air)                                       (eq. 2)
/// 1e8 (n300 - 1) = 8060.51 + 2480990/(132.274 - λ⁻²) + 17455.7/(39.32957 - λ⁻²)          (eq. 18)
/// (n - 1)/(n300 - 1) = 1 + 0.54 (C - 0.0003)                                             (eq. 19)
/// ```
///
/// λ in micrometres in the dispersion; Ns = 2.546899e19 per cm³ at 288.15 K and 1013.25 hPa, at which n is taken; C the
/// volume fraction of CO2.
///
/// Source: Bodhaine, Wood, Dutton & Slusser (1999), J. Atmos. Oceanic Technol. 16, 1854; dispersion of Peck & Reeder (1972).
/// Checked against: `fixtures/reference/rayleigh.csv`, 330 to 830 nm, within 2e-5.
#[must_use]
pub fn cross_section_m2(wavelength_nm: f64, co2_ppm: f64) -> f64 {
    let s = (1e3 / wavelength_nm).powi(2);
    let n300 = 1e-8 * (8060.51 + 2_480_990.0 / (132.274 - s) + 17_455.7 / (39.32957 - s));
    let n = 1.0 + n300 * (1.0 + 0.54e-6 * (co2_ppm - 300.0));
    let lorentz = (n * n - 1.0) / (n * n + 2.0);
    let wavelength_m = wavelength_nm * 1e-9;
    let per_volume = lorentz / MOLECULES_PER_M3;
    24.0 * std::f64::consts::PI.powi(3) * per_volume * per_volume / wavelength_m.powi(4)
        * king_factor(wavelength_nm, co2_ppm)
}

/// Molecules in a cubic metre of air at 288.15 K and 1013.25 hPa.
const MOLECULES_PER_M3: f64 = 2.546_899e25;

/// Boltzmann's constant, J/K.
const BOLTZMANN: f64 = 1.380_649e-23;

/// How much the molecules' unroundness adds to scattering: the King factor of air.
///
/// ```text
/// F(N2) = 1.034 + 3.17e-4 λ⁻²,  F(O2) = 1.096 + 1.385e-3 λ⁻² + 1.448e-4 λ⁻⁴,  F(Ar) = 1.00,  F(CO2) = 1.15
/// F(air) = (78.084 F(N2) + 20.946 F(O2) + 0.934 + C 1.15)/(78.084 + 20.946 + 0.934 + C)          C in percent
/// ```
///
/// Source: Bates (1984), as in Bodhaine et al. (1999), eqs. 5, 6 and 23; λ in micrometres.
#[must_use]
pub fn king_factor(wavelength_nm: f64, co2_ppm: f64) -> f64 {
    let s = (1e3 / wavelength_nm).powi(2);
    let nitrogen = 1.034 + 3.17e-4 * s;
    let oxygen = 1.096 + s * (1.385e-3 + s * 1.448e-4);
    let c = co2_ppm * 1e-4;
    (78.084 * nitrogen + 20.946 * oxygen + 0.934 + c * 1.15) / (78.084 + 20.946 + 0.934 + c)
}

/// Molecules in a cubic metre of air, by the law of ideal gases.
#[must_use]
pub fn molecules_per_m3(temperature_k: f64, pressure_pa: f64) -> f64 {
    pressure_pa / (BOLTZMANN * temperature_k)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cross_sections_and_king_factors_are_bodhaines() {
        let table = include_str!("../../fixtures/reference/rayleigh.csv");
        let mut rows = 0;
        for line in table.lines().filter(|l| l.starts_with(|c: char| c.is_ascii_digit())) {
            let f: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
            let got = cross_section_m2(f[0], 360.0) * 1e4;
            assert!((got / f[1] - 1.0).abs() < 5e-6, "{} nm: {got} {}", f[0], f[1]);
            // The paper's own fit, its eq. 29.
            assert!((got / f[2] - 1.0).abs() < 2e-4, "{} nm: {got} {}", f[0], f[2]);
            assert!((king_factor(f[0], 360.0) - f[3]).abs() < 6e-6, "{} nm", f[0]);
            rows += 1;
        }
        assert!(rows > 40);
    }

    #[test]
    fn the_reference_air_has_the_reference_number_of_molecules() {
        assert!((molecules_per_m3(288.15, 101_325.0) / MOLECULES_PER_M3 - 1.0).abs() < 1e-5);
    }
}
