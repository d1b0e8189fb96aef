//! The air over ground warmer than itself: the profile of Monin and Obukhov's similarity.

use super::profile::Row;

/// Adiabatic fall of temperature with height, K/m.
const ADIABATIC_K_PER_M: f64 = 9.8e-3;

/// Von Kármán's constant.
const KARMAN: f64 = 0.4;

/// What the warm ground does to the air near it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceLayer {
    /// Temperature at the roughness height, kelvin.
    pub ground_k: f64,
    /// Scale temperature, kelvin; negative where the ground warms the air.
    pub scale_k: f64,
    /// Obukhov's length, metres; negative where the ground warms the air.
    pub obukhov_length_m: f64,
    /// Roughness height, metres.
    pub roughness_m: f64,
}

impl SurfaceLayer {
    /// Temperature at a height above the roughness height, kelvin.
    ///
    /// ```text
    /// T(z) = T0 + (θ*/k) [ln(z/z0) - ψ(z/L) + ψ(z0/L)] - Γd z,   ψ(ζ) = 2 ln((1 + √(1 - 16 ζ))/2)
    /// ```
    ///
    /// Source: Businger et al. (1971), J. Atmos. Sci. 28, 181, and Dyer (1974), Boundary-Layer Meteorol. 7, 363, with
    /// the integral of Paulson (1970), J. Appl. Meteorol. 9, 857. Here θ is T + Γd z.
    #[must_use]
    pub fn temperature_k(&self, height_m: f64) -> f64 {
        let z = height_m.max(self.roughness_m);
        let psi = |z: f64| 2.0 * ((1.0 + (1.0 - 16.0 * z / self.obukhov_length_m).sqrt()) / 2.0).ln();
        let shape = (z / self.roughness_m).ln() - psi(z) + psi(self.roughness_m);
        self.ground_k + self.scale_k / KARMAN * shape - ADIABATIC_K_PER_M * z
    }

    /// Rows spaced evenly in the logarithm of height up to 50 m, under the standard atmosphere's gradients.
    #[must_use]
    pub fn rows(&self) -> Vec<Row> {
        const STEPS: i32 = 120;
        let row = |height_m, temperature_k| Row { height_m, temperature_k, humidity_percent: 0.0 };
        let mut rows = vec![row(0.0, self.temperature_k(0.0))];
        for i in 0..=STEPS {
            let z = self.roughness_m * (50.0 / self.roughness_m).powf(f64::from(i) / f64::from(STEPS));
            rows.push(row(z, self.temperature_k(z)));
        }
        let top = self.temperature_k(50.0) - 6.5e-3 * (11_000.0 - 50.0);
        rows.extend([(11e3, 0.0), (20e3, 0.0), (32e3, 12.0), (47e3, 54.0)].map(|(z, warmer)| row(z, top + warmer)));
        rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same similarity computed by somebody else's program.
    #[test]
    fn the_profile_is_that_of_the_reference() {
        let layer = SurfaceLayer { ground_k: 288.0, scale_k: -0.10, obukhov_length_m: -10.0, roughness_m: 1e-3 };
        let table = include_str!("../../../fixtures/reference/profiles.csv");
        let mut checked = 0;
        for line in table.lines().filter(|line| line.starts_with("monin")) {
            let fields: Vec<f64> = line.split(',').skip(1).map(|f| f.parse().unwrap()).collect();
            // The reference prints heights to 0.1 mm: near the ground that is too coarse to compare at.
            if (0.05..=50.0).contains(&fields[0]) {
                let got = layer.temperature_k(fields[0]);
                assert!((got - fields[1]).abs() < 5e-4, "{line}: {got}");
                checked += 1;
            }
        }
        assert!(checked > 70, "{checked}");
    }
}
