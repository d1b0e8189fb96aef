//! The US Standard Atmosphere 1976, in geopotential height as it was made.

use super::profile::{Heights, Profile, Row};

/// Radius of the Earth in the standard's law of gravity, metres. It stays this whatever radius rays are traced around.
pub const R0_M: f64 = 6_356_766.0;

/// Pressure at 0 m, pascal.
pub const P0_PA: f64 = 101_325.0;

/// g0 M0/R*: the fall of ln p with geopotential height times temperature, K/m.
///
/// ```text
/// 9.80665 m/s² * 28.9644 kg/kmol / 8314.32 J/(kmol K)
/// ```
pub const HYDROSTATIC_K_PER_M: f64 = 9.806_65 * 28.9644 / 8314.32;

/// Base of each layer (geopotential metres) and its temperature gradient (K/m).
///
/// Source: *U.S. Standard Atmosphere, 1976*, NOAA-S/T 76-1562, table 4. The last gradient runs on above 84.852 km'.
const LAYERS: [(f64, f64); 7] = [
    (0.0, -6.5e-3),
    (11_000.0, 0.0),
    (20_000.0, 1.0e-3),
    (32_000.0, 2.8e-3),
    (47_000.0, 0.0),
    (51_000.0, -2.8e-3),
    (71_000.0, -2.0e-3),
];

/// The standard atmosphere, dry.
///
/// Checked against: the standard's own printed base pressures (all digits).
#[must_use]
pub fn profile() -> Profile {
    let mut temperature_k = 288.15;
    let mut rows = Vec::new();
    for (i, &(height_m, gradient)) in LAYERS.iter().enumerate() {
        rows.push(Row { height_m, temperature_k, humidity_percent: 0.0 });
        let next = LAYERS.get(i + 1).map_or(height_m, |layer| layer.0);
        temperature_k += gradient * (next - height_m);
    }
    Profile::stacked(&rows, LAYERS[LAYERS.len() - 1].1, Heights::Geopotential, P0_PA)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The pressures that the standard prints at the bases of its layers.
    #[test]
    fn base_pressures_are_those_printed() {
        let us76 = profile();
        let printed = [
            (11e3, 22_632.06),
            (20e3, 5474.889),
            (32e3, 868.0187),
            (47e3, 110.9063),
            (51e3, 66.93887),
            (71e3, 3.956_420),
        ];
        for (h, pressure) in printed {
            let z = R0_M * h / (R0_M - h);
            let got = us76.parcel(z).pressure_pa;
            assert!((got / pressure - 1.0).abs() < 2e-7, "{h}: {got}");
        }
    }

    /// Geometric heights: the standard's table I prints 226.509 K, 1197.0 Pa at 30 km and 270.650 K, 79.779 Pa at 50 km.
    #[test]
    fn geometric_heights_are_turned_into_geopotential_ones() {
        let us76 = profile();
        for (z, t, p) in [(30e3, 226.509, 1197.0), (50e3, 270.650, 79.779)] {
            let parcel = us76.parcel(z);
            assert!(
                (parcel.temperature_k - t).abs() < 6e-4 && (parcel.pressure_pa / p - 1.0).abs() < 1e-4,
                "{parcel:?}"
            );
        }
    }
}
