//! The wavelengths of a picture: even in refractivity, so that neighbouring pictures of the Sun are equally far apart.

use super::irradiance::Spectrum;
use crate::physics::air::ciddor::{STANDARD_CO2_PPM, refractivity};
use crate::physics::air::us76;
use crate::physics::colour::{LUMENS_PER_WATT, Xyz, matching};

/// The band of a picture, nanometres: the thesis'.
pub const BAND_NM: [f64; 2] = [380.0, 720.0];

/// Steps of the integral over a cell, nanometres.
const STEP_NM: f64 = 0.5;

/// One wavelength, standing for a cell of the spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// The wavelength at which rays are traced, in vacuum, nanometres.
    pub nm: f64,
    /// The cell, nanometres.
    pub cell_nm: [f64; 2],
    /// Refractivity of standard air at the wavelength.
    pub refractivity: f64,
    /// Sunlight of the cell above the air as the standard observer sees it, lux.
    pub light: Xyz,
}

/// Refractivity of standard air (15 °C, 101325 Pa, dry).
#[must_use]
pub fn standard_refractivity(wavelength_nm: f64) -> f64 {
    // All wavelengths asked for lie within the band.
    refractivity(wavelength_nm, 288.15, us76::P0_PA, 0.0, STANDARD_CO2_PPM).unwrap_or(0.0)
}

/// The wavelength in the band at which standard air has a refractivity.
#[must_use]
pub fn wavelength_of(wanted: f64) -> f64 {
    let [mut low, mut high] = BAND_NM;
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if standard_refractivity(middle) > wanted { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// So many samples: the band cut into cells that span the same refractivity, each sampled where half of it is reached.
#[must_use]
pub fn samples(count: usize, spectrum: Spectrum) -> Vec<Sample> {
    let [short, long] = BAND_NM.map(standard_refractivity);
    let at = |share: f64| long + (short - long) * share;
    let border = |i: usize| match i {
        0 => BAND_NM[1],
        i if i == count => BAND_NM[0],
        i => wavelength_of(at(i as f64 / count as f64)),
    };
    (0..count)
        .map(|i| {
            let refractivity = at((i as f64 + 0.5) / count as f64);
            let cell_nm = [border(i + 1), border(i)];
            Sample { nm: wavelength_of(refractivity), cell_nm, refractivity, light: light(cell_nm, spectrum) }
        })
        .collect()
}

/// So many samples, even in wavelength: to be compared with.
#[must_use]
pub fn even_in_wavelength(count: usize, spectrum: Spectrum) -> Vec<Sample> {
    let [short, long] = BAND_NM;
    let at = |share: f64| long + (short - long) * share;
    (0..count)
        .map(|i| {
            let nm = at((i as f64 + 0.5) / count as f64);
            let cell_nm = [at((i + 1) as f64 / count as f64), at(i as f64 / count as f64)];
            Sample { nm, cell_nm, refractivity: standard_refractivity(nm), light: light(cell_nm, spectrum) }
        })
        .collect()
}

/// Sunlight between two wavelengths, lux: the trapezoid rule.
fn light([low, high]: [f64; 2], spectrum: Spectrum) -> Xyz {
    let steps = ((high - low) / STEP_NM).ceil().max(1.0) as usize;
    let mut sum = [0.0; 3];
    for i in 0..=steps {
        let nm = low + (high - low) * i as f64 / steps as f64;
        let weight = if i == 0 || i == steps { 0.5 } else { 1.0 };
        let watts = weight * LUMENS_PER_WATT * spectrum.at(nm) * (high - low) / steps as f64;
        for (part, matching) in sum.iter_mut().zip(matching(nm)) {
            *part += watts * matching;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_even_in_refractivity_and_their_cells_are_the_whole_band() {
        for count in [1, 8, 64] {
            let samples = samples(count, Spectrum::Kurucz);
            assert_eq!((samples[0].cell_nm[1], samples[count - 1].cell_nm[0]), (720.0, 380.0));
            for pair in samples.windows(2) {
                assert_eq!(pair[0].cell_nm[0], pair[1].cell_nm[1]);
                let step = standard_refractivity(pair[1].nm) - standard_refractivity(pair[0].nm);
                // Ciddor: 280.9e-6 at 380 nm less 275.9e-6 at 720 nm is shared evenly.
                let whole = standard_refractivity(380.0) - standard_refractivity(720.0);
                assert!((step / whole - 1.0 / count as f64).abs() < 1e-9, "{count}");
            }
        }
    }

    #[test]
    fn the_light_of_the_cells_adds_up_whatever_their_number() {
        let sum = |count| samples(count, Spectrum::G173).iter().map(|sample| sample.light[1]).sum::<f64>();
        assert!((sum(8) / sum(64) - 1.0).abs() < 1e-4);
    }
}
