//! The refractive index of moist air: Ciddor 1996 in full, with its slope.

/// Shortest and longest wavelength in vacuum for which the equation is published, nanometres.
pub const WAVELENGTHS_NM: (f64, f64) = (300.0, 1700.0);

/// Carbon dioxide of the reference air, parts per million.
pub const STANDARD_CO2_PPM: f64 = 450.0;

/// Why an index was not computed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum AirError {
    /// The equation is not published for this wavelength.
    #[error("wavelength {0} nm: the equation for air holds from 300 to 1700 nm (in vacuum); ask within")]
    Wavelength(f64),
    /// No air is like this.
    #[error("temperature {0} K: give 100 to 400 K")]
    Temperature(f64),
    /// Neither vacuum nor an atmosphere.
    #[error("pressure {0} Pa: give 0 to 200000 Pa")]
    Pressure(f64),
    /// Humidity is between none and saturation.
    #[error("relative humidity {0} %: give 0 to 100")]
    Humidity(f64),
    /// More carbon dioxide than the equation was made for.
    #[error("carbon dioxide {0} ppm: give 0 to 2000")]
    Co2(f64),
    /// At this temperature so much vapour does not fit under this pressure: it boils.
    #[error(
        "{humidity_percent} % humidity at {temperature_k} K needs more vapour than {pressure_pa} Pa hold: lower it"
    )]
    Boils {
        /// Relative humidity, percent.
        humidity_percent: f64,
        /// Temperature, kelvin.
        temperature_k: f64,
        /// Pressure, pascal.
        pressure_pa: f64,
    },
}

/// A parcel of air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parcel {
    /// Temperature, kelvin.
    pub temperature_k: f64,
    /// Total pressure, pascal.
    pub pressure_pa: f64,
    /// Mole fraction of water vapour.
    pub vapour: f64,
}

impl Parcel {
    /// A parcel of a relative humidity over liquid water.
    ///
    /// # Errors
    /// The temperature, pressure or humidity is no air's, or so much vapour would boil.
    pub fn moist(temperature_k: f64, pressure_pa: f64, humidity_percent: f64) -> Result<Parcel, AirError> {
        if !(100.0..=400.0).contains(&temperature_k) {
            return Err(AirError::Temperature(temperature_k));
        }
        if !(0.0..=200_000.0).contains(&pressure_pa) {
            return Err(AirError::Pressure(pressure_pa));
        }
        if !(0.0..=100.0).contains(&humidity_percent) {
            return Err(AirError::Humidity(humidity_percent));
        }
        let (saturation, _) = saturation_vapour_pressure_pa(temperature_k);
        let (enhancement, _, _) = enhancement(temperature_k, pressure_pa);
        let vapour = match humidity_percent {
            0.0 => 0.0,
            percent => enhancement * percent / 100.0 * saturation / pressure_pa,
        };
        if vapour > 1.0 {
            return Err(AirError::Boils { humidity_percent, temperature_k, pressure_pa });
        }
        Ok(Parcel { temperature_k, pressure_pa, vapour })
    }
}

/// Saturation vapour pressure over liquid water, pascal, and its slope by temperature, Pa/K.
///
/// ```text
/// svp = exp(A T² + B T + C + D/T)          T in kelvin, svp in pascal
/// ```
///
/// Source: Giacomo (1982), Metrologia 18, 33, with the constants of Davis (1992); Ciddor (1996), appendix A.
/// Liquid water also below 0 °C: over ice n differs by less than 0.04e-8.
#[must_use]
pub fn saturation_vapour_pressure_pa(temperature_k: f64) -> (f64, f64) {
    let (a, b, c, d) = (1.237_884_7e-5, -1.912_131_6e-2, 33.937_110_47, -6.343_164_5e3);
    let t = temperature_k;
    let svp = (a * t * t + b * t + c + d / t).exp();
    (svp, svp * (2.0 * a * t + b - d / (t * t)))
}

/// The enhancement factor of water vapour in air, and its slopes by temperature (1/K) and pressure (1/Pa).
///
/// ```text
/// f = α + β p + γ t²          p in pascal, t in degrees Celsius
/// ```
///
/// Source: Ciddor (1996), appendix A.
#[must_use]
pub fn enhancement(temperature_k: f64, pressure_pa: f64) -> (f64, f64, f64) {
    let (alpha, beta, gamma) = (1.000_62, 3.14e-8, 5.6e-7);
    let t = temperature_k - 273.15;
    (alpha + beta * pressure_pa + gamma * t * t, 2.0 * gamma * t, beta)
}

/// Compressibility of moist air.
///
/// ```text
/// Z = 1 - (p/T) [a0 + a1 t + a2 t² + (b0 + b1 t) x + (c0 + c1 t) x²] + (p/T)² (d + e x²)
/// ```
///
/// Source: Ciddor (1996), eq. 12; p in pascal, T in kelvin, t in degrees Celsius, x the mole fraction of vapour.
#[must_use]
pub fn compressibility(parcel: &Parcel) -> f64 {
    let Parcel { temperature_k, pressure_pa, vapour: x } = *parcel;
    let t = temperature_k - 273.15;
    let ratio = pressure_pa / temperature_k;
    1.0 - ratio * ((A0 + t * (A1 + t * A2)) + (B0 + B1 * t) * x + (C0 + C1 * t) * x * x)
        + ratio * ratio * (D + E * x * x)
}

const A0: f64 = 1.581_23e-6;
const A1: f64 = -2.9331e-8;
const A2: f64 = 1.1043e-10;
const B0: f64 = 5.707e-6;
const B1: f64 = -2.051e-8;
const C0: f64 = 1.9898e-4;
const C1: f64 = -2.376e-6;
const D: f64 = 1.83e-11;
const E: f64 = -0.765e-8;

/// What a wavelength makes of air: refractivity per density of dry air and of vapour.
///
/// ```text
/// n - 1 = (ρa/ρaxs) (naxs - 1) + (ρv/ρws) (nws - 1)          ρa = p Ma (1 - x)/(Z R T),  ρv = p Mv x/(Z R T)
/// ```
///
/// Source: Ciddor (1996), Applied Optics 35, 1566, eq. 5. Molar masses and the gas constant cancel against the
/// reference densities, so that only p/(Z T) remains; both factors here are refractivity times kelvin per pascal.
/// Checked against: `fixtures/reference/ciddor_check_values.csv` (23 published values, all within 0.08e-8).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dispersion {
    dry: f64,
    vapour: f64,
}

impl Dispersion {
    /// The dispersion at a wavelength in vacuum (nanometres), for air with so much carbon dioxide.
    ///
    /// ```text
    /// 1e8 (nas - 1) = k1/(k0 - σ²) + k3/(k2 - σ²)             σ in 1/µm; 15 °C, 101325 Pa, 450 ppm CO2
    /// naxs - 1      = (nas - 1) [1 + 0.534e-6 (xc - 450)]      xc in ppm
    /// 1e8 (nws - 1) = 1.022 (w0 + w1 σ² + w2 σ⁴ + w3 σ⁶)      20 °C, 1333 Pa
    /// ```
    ///
    /// Source: Ciddor (1996), eqs. 1 to 3.
    ///
    /// # Errors
    /// The wavelength lies outside [`WAVELENGTHS_NM`], or the carbon dioxide outside 0 to 2000 ppm.
    pub fn new(wavelength_nm: f64, co2_ppm: f64) -> Result<Dispersion, AirError> {
        if !(WAVELENGTHS_NM.0..=WAVELENGTHS_NM.1).contains(&wavelength_nm) {
            return Err(AirError::Wavelength(wavelength_nm));
        }
        if !(0.0..=2000.0).contains(&co2_ppm) {
            return Err(AirError::Co2(co2_ppm));
        }
        let s = (1e3 / wavelength_nm).powi(2);
        let standard = (5_792_105.0 / (238.0185 - s) + 167_917.0 / (57.362 - s)) * 1e-8;
        let dry = standard * (1.0 + 0.534e-6 * (co2_ppm - STANDARD_CO2_PPM));
        let vapour = 1.022 * (295.235 + s * (2.6422 + s * (-0.032_380 + s * 0.004_028))) * 1e-8;
        let per_density = |t_k, p_pa, x| {
            let reference = Parcel { temperature_k: t_k, pressure_pa: p_pa, vapour: x };
            t_k * compressibility(&reference) / p_pa
        };
        Ok(Dispersion {
            dry: dry * per_density(288.15, 101_325.0, 0.0),
            vapour: vapour * per_density(293.15, 1333.0, 1.0),
        })
    }

    /// Refractivity n - 1 of a parcel.
    #[must_use]
    pub fn refractivity(&self, parcel: &Parcel) -> f64 {
        let mixed = self.dry * (1.0 - parcel.vapour) + self.vapour * parcel.vapour;
        parcel.pressure_pa / parcel.temperature_k * mixed / compressibility(parcel)
    }

    /// Refractivity of a parcel and its change per metre, from the parcel's own changes per metre.
    #[must_use]
    #[inline]
    pub fn with_slope(&self, parcel: &Parcel, change: &Parcel) -> (f64, f64) {
        let Parcel { temperature_k, pressure_pa, vapour: x } = *parcel;
        let Parcel { temperature_k: dt, pressure_pa: dp, vapour: dx } = *change;
        let t = temperature_k - 273.15;
        let per_t = 1.0 / temperature_k;
        let ratio = pressure_pa * per_t;
        let d_ratio = (dp - ratio * dt) * per_t;
        // The second and third virial sums and their slopes.
        let (mut second, mut d_second) = (A0 + t * (A1 + t * A2), (A1 + 2.0 * A2 * t) * dt);
        let (mut third, mut d_third) = (D, 0.0);
        let (mut mixed, mut d_mixed) = (self.dry, 0.0);
        if x != 0.0 || dx != 0.0 {
            second += (B0 + B1 * t) * x + (C0 + C1 * t) * x * x;
            d_second += (B1 * x + C1 * x * x) * dt + (B0 + B1 * t + 2.0 * (C0 + C1 * t) * x) * dx;
            third += E * x * x;
            d_third += 2.0 * E * x * dx;
            mixed += (self.vapour - self.dry) * x;
            d_mixed += (self.vapour - self.dry) * dx;
        }
        let per_z = 1.0 / (1.0 - ratio * second + ratio * ratio * third);
        let dz = -d_ratio * second - ratio * d_second + 2.0 * ratio * d_ratio * third + ratio * ratio * d_third;
        let scale = ratio * per_z;
        (scale * mixed, per_z * (mixed * (d_ratio - scale * dz) + ratio * d_mixed))
    }
}

/// Refractivity n - 1 of air at a wavelength in vacuum.
///
/// # Errors
/// The wavelength or the air lies outside what the equation is for.
pub fn refractivity(
    wavelength_nm: f64,
    temperature_k: f64,
    pressure_pa: f64,
    humidity_percent: f64,
    co2_ppm: f64,
) -> Result<f64, AirError> {
    let dispersion = Dispersion::new(wavelength_nm, co2_ppm)?;
    Ok(dispersion.refractivity(&Parcel::moist(temperature_k, pressure_pa, humidity_percent)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// NIST's Engineering Metrology Toolbox and the paper's own tables 1 to 3.
    #[test]
    fn the_published_values_come_out() {
        let table = include_str!("../../../fixtures/reference/ciddor_check_values.csv");
        let mut rows = 0;
        for line in table.lines().filter(|line| !line.starts_with(['#', 's'])) {
            let fields: Vec<&str> = line.split(',').collect();
            let at = |i: usize| fields[i].parse::<f64>();
            let (nm, t, p) = (at(1).unwrap(), at(2).unwrap() + 273.15, at(3).unwrap());
            let parcel = match (at(4), at(5)) {
                (Ok(humidity), _) => Parcel::moist(t, p, humidity).unwrap(),
                (_, Ok(pw)) => Parcel { temperature_k: t, pressure_pa: p, vapour: enhancement(t, p).0 * pw / p },
                _ => Parcel { temperature_k: t, pressure_pa: p, vapour: 0.0 },
            };
            let got = Dispersion::new(nm, at(6).unwrap()).unwrap().refractivity(&parcel) * 1e8;
            let published = at(7).unwrap();
            assert!((got - published).abs() < 0.08, "{line}: {got}");
            rows += 1;
        }
        assert_eq!(rows, 23);
    }

    #[test]
    fn what_no_air_is_like_is_refused() {
        assert!(matches!(refractivity(299.0, 288.0, 1e5, 0.0, 450.0), Err(AirError::Wavelength(_))));
        assert!(matches!(refractivity(f64::NAN, 288.0, 1e5, 0.0, 450.0), Err(AirError::Wavelength(_))));
        assert!(matches!(refractivity(550.0, 0.0, 1e5, 0.0, 450.0), Err(AirError::Temperature(_))));
        assert!(matches!(refractivity(550.0, f64::NAN, 1e5, 0.0, 450.0), Err(AirError::Temperature(_))));
        assert!(matches!(refractivity(550.0, 288.0, -1.0, 0.0, 450.0), Err(AirError::Pressure(_))));
        assert!(matches!(refractivity(550.0, 288.0, 1e5, 101.0, 450.0), Err(AirError::Humidity(_))));
        assert!(matches!(refractivity(550.0, 380.0, 1e4, 100.0, 450.0), Err(AirError::Boils { .. })));
    }

    #[test]
    fn a_vacuum_has_no_refractivity() {
        assert_eq!(refractivity(550.0, 288.0, 0.0, 0.0, 450.0), Ok(0.0));
    }

    proptest! {
        /// The slope is the derivative: held against central differences along a line through temperature, pressure, vapour.
        #[test]
        fn the_slope_is_that_of_the_index(
            t in 200.0..330.0f64, p in 1e3..1.1e5f64, x in 0.0..0.03f64, dt in -0.5..0.5f64, dp in -20.0..20.0f64, dx in -1e-4..1e-4f64,
        ) {
            let dispersion = Dispersion::new(550.0, 450.0).unwrap();
            let along = |h: f64| Parcel { temperature_k: t + h * dt, pressure_pa: p + h * dp, vapour: x + h * dx };
            let change = Parcel { temperature_k: dt, pressure_pa: dp, vapour: dx };
            let (value, slope) = dispersion.with_slope(&along(0.0), &change);
            let difference = (dispersion.refractivity(&along(0.01)) - dispersion.refractivity(&along(-0.01))) / 0.02;
            prop_assert!((value - dispersion.refractivity(&along(0.0))).abs() < 1e-18);
            prop_assert!((slope - difference).abs() < 1e-6 * difference.abs() + 1e-13, "{slope} {difference}");
        }
    }
}
