//! The air by height: layers in which temperature is linear and pressure hydrostatic.

use super::ciddor::{AirError, Parcel, STANDARD_CO2_PPM, enhancement, saturation_vapour_pressure_pa};
use super::us76;

/// Fall of ln p with geometric height times temperature, K/m, for profiles given by rows.
pub const HYDROSTATIC_K_PER_M: f64 = 34.1632e-3;

/// No parcel holds more vapour than this (mole fraction). Only the warm thin air of the stratopause, were it as humid as
/// the ground, would; there it changes nothing that can be seen.
const MOST_VAPOUR: f64 = 0.1;

/// Why a profile is no atmosphere.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ProfileError {
    /// A profile needs something to go by.
    #[error("the profile has {0} rows: give at least 2, height and temperature each")]
    TooFewRows(usize),
    /// Heights must rise from row to row.
    #[error("row {row}: height {height_m} m is below the row before: sort the rows by height")]
    Unsorted {
        /// Counted from 1.
        row: usize,
        /// Its height, metres.
        height_m: f64,
    },
    /// A jump would need a layer without thickness.
    #[error("row {row}: height {height_m} m stands twice: give a jump a thickness, if only 0.01 m")]
    SameHeight {
        /// Counted from 1.
        row: usize,
        /// Its height, metres.
        height_m: f64,
    },
    /// Heights count from the ground, and end with the air.
    #[error("row {row}: height {height_m} m: give 0 to 1000000 m")]
    Height {
        /// Counted from 1.
        row: usize,
        /// Its height, metres.
        height_m: f64,
    },
    /// No air is like this.
    #[error("row {row}: {source}")]
    Air {
        /// Counted from 1.
        row: usize,
        /// What is wrong with it.
        source: AirError,
    },
    /// The pressure at 0 m.
    #[error("ground pressure {0} Pa: give 1 to 200000 Pa")]
    GroundPressure(f64),
    /// The rounding of kinks.
    #[error("rounding {0} m: give 0 (sharp) to 1000 m")]
    Rounding(f64),
}

/// What is known at one height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Row {
    /// Height above the ground, metres.
    pub height_m: f64,
    /// Temperature, kelvin.
    pub temperature_k: f64,
    /// Relative humidity over liquid water, percent.
    pub humidity_percent: f64,
}

/// In which height the temperature is linear and gravity constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Heights {
    /// Metres above the ground.
    Geometric,
    /// Geopotential metres of the US Standard Atmosphere: h = r0 z/(r0 + z).
    Geopotential,
}

/// One layer: temperature and humidity linear, from its base up to the next one's.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Layer {
    /// Base, in the profile's kind of height.
    base_m: f64,
    temperature_k: f64,
    gradient: f64,
    pressure_pa: f64,
    humidity_percent: f64,
    humidity_slope: f64,
}

/// An atmosphere: temperature, pressure, humidity at every height from the ground up.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    layers: Vec<Layer>,
    heights: Heights,
    /// Carbon dioxide, parts per million.
    pub co2_ppm: f64,
}

impl Profile {
    /// Air through rows of geometric height: temperature and humidity linear between them, both constant above the last
    /// and below the first, pressure (of dry air) hydrostatic from that at 0 m.
    ///
    /// # Errors
    /// The rows are too few, unsorted, doubled, or no air's; or the pressure is none.
    pub fn new(rows: &[Row], ground_pressure_pa: f64) -> Result<Profile, ProfileError> {
        check(rows)?;
        if !(1.0..=200_000.0).contains(&ground_pressure_pa) {
            return Err(ProfileError::GroundPressure(ground_pressure_pa));
        }
        let mut rows = rows.to_vec();
        if rows[0].height_m > 0.0 {
            rows.insert(0, Row { height_m: 0.0, ..rows[0] });
        }
        Ok(Profile::stacked(&rows, 0.0, Heights::Geometric, ground_pressure_pa))
    }

    /// Rows known to be good, the first at 0 m, with the gradient above the last.
    pub(super) fn stacked(rows: &[Row], last_gradient: f64, heights: Heights, ground_pressure_pa: f64) -> Profile {
        let constant = hydrostatic(heights);
        let mut pressure_pa = ground_pressure_pa;
        let mut layers = Vec::with_capacity(rows.len());
        for (i, row) in rows.iter().enumerate() {
            let mut layer = Layer {
                base_m: row.height_m,
                temperature_k: row.temperature_k,
                gradient: last_gradient,
                pressure_pa,
                humidity_percent: row.humidity_percent,
                humidity_slope: 0.0,
            };
            if let Some(next) = rows.get(i + 1) {
                let thickness = next.height_m - row.height_m;
                layer.gradient = (next.temperature_k - row.temperature_k) / thickness;
                layer.humidity_slope = (next.humidity_percent - row.humidity_percent) / thickness;
                pressure_pa *= layer.fall(thickness, constant);
            }
            layers.push(layer);
        }
        Profile { layers, heights, co2_ppm: STANDARD_CO2_PPM }
    }

    /// The same air with another share of carbon dioxide, parts per million.
    #[must_use]
    pub fn with_co2_ppm(self, co2_ppm: f64) -> Profile {
        Profile { co2_ppm, ..self }
    }

    /// How many layers there are.
    #[must_use]
    pub fn layer_count(&self) -> usize {
        self.layers.len()
    }

    /// Geometric height of the base of a layer, metres.
    #[must_use]
    pub fn base_m(&self, layer: usize) -> f64 {
        let h = self.layers[layer].base_m;
        match self.heights {
            Heights::Geometric => h,
            Heights::Geopotential => us76::R0_M * h / (us76::R0_M - h),
        }
    }

    /// The layer in which a geometric height lies; on a base, the layer above it.
    #[must_use]
    pub fn layer_at(&self, height_m: f64) -> usize {
        let (h, _) = self.own_height(height_m);
        self.layers.partition_point(|layer| layer.base_m <= h).saturating_sub(1)
    }

    /// The parcel at a geometric height.
    #[must_use]
    pub fn parcel(&self, height_m: f64) -> Parcel {
        self.parcel_with_slope(self.layer_at(height_m), height_m).0
    }

    /// The parcel at a geometric height by a layer's own formula (which may be asked beyond the layer), and the change per
    /// metre of each of its parts.
    #[must_use]
    #[inline]
    pub fn parcel_with_slope(&self, layer: usize, height_m: f64) -> (Parcel, Parcel) {
        let layer = &self.layers[layer];
        let (own, stretch) = self.own_height(height_m);
        let h = own - layer.base_m;
        let constant = hydrostatic(self.heights);
        let t = layer.temperature_k + layer.gradient * h;
        let p = layer.pressure_pa * layer.fall(h, constant);
        let (dt, dp) = (layer.gradient * stretch, -constant * p / t * stretch);
        let (mut x, mut dx) = (0.0, 0.0);
        if layer.humidity_percent != 0.0 || layer.humidity_slope != 0.0 {
            let humidity = (layer.humidity_percent + layer.humidity_slope * h) / 100.0;
            let (svp, svp_by_t) = saturation_vapour_pressure_pa(t);
            let (f, f_by_t, f_by_p) = enhancement(t, p);
            x = f * humidity * svp / p;
            dx = (f_by_t * dt + f_by_p * dp) * humidity * svp / p
                + f * (layer.humidity_slope / 100.0 * stretch) * svp / p
                + f * humidity * svp_by_t * dt / p
                - x * dp / p;
            if x > MOST_VAPOUR {
                (x, dx) = (MOST_VAPOUR, 0.0);
            }
        }
        let parcel = Parcel { temperature_k: t, pressure_pa: p, vapour: x };
        (parcel, Parcel { temperature_k: dt, pressure_pa: dp, vapour: dx })
    }

    /// Geometric height at which a pressure (pascal) is met, metres.
    #[must_use]
    pub fn height_of_pressure_m(&self, pressure_pa: f64) -> f64 {
        let above = self.layers.partition_point(|layer| layer.pressure_pa >= pressure_pa).saturating_sub(1);
        let layer = &self.layers[above];
        let ln = (layer.pressure_pa / pressure_pa).ln() / hydrostatic(self.heights);
        let h = match layer.gradient {
            0.0 => layer.temperature_k * ln,
            g => layer.temperature_k * (g * ln).exp_m1() / g,
        };
        let h = layer.base_m + h;
        match self.heights {
            Heights::Geometric => h,
            Heights::Geopotential => us76::R0_M * h / (us76::R0_M - h),
        }
    }

    /// Lowest height at which a layer's formula ends because its gradient reaches 0 K, or infinity; geometric metres.
    #[must_use]
    pub fn coldest_m(&self) -> f64 {
        let Some(last) = self.layers.last().filter(|layer| layer.gradient < 0.0) else { return f64::INFINITY };
        // Not to absolute zero: 100 K is colder than any air below 100 km, and the formulas are still smooth.
        let h = last.base_m + (last.temperature_k - 100.0) / -last.gradient;
        match self.heights {
            Heights::Geometric => h,
            Heights::Geopotential => us76::R0_M * h / (us76::R0_M - h),
        }
    }

    /// The profile's own height of a geometric one, and its change per metre.
    #[inline]
    fn own_height(&self, height_m: f64) -> (f64, f64) {
        match self.heights {
            Heights::Geometric => (height_m, 1.0),
            Heights::Geopotential => {
                let ratio = us76::R0_M / (us76::R0_M + height_m);
                (height_m * ratio, ratio * ratio)
            }
        }
    }
}

impl Layer {
    /// Pressure at a height above the base, as a fraction of that at the base.
    ///
    /// ```text
    /// p/p_b = (T/T_b)^(-c/Γ) = exp(-(c/Γ) ln(1 + Γ h/T_b)),  exp(-c h/T_b) where Γ = 0
    /// ```
    #[inline]
    fn fall(&self, h: f64, constant: f64) -> f64 {
        let exponent = match self.gradient {
            0.0 => h / self.temperature_k,
            g => (g * h / self.temperature_k).ln_1p() / g,
        };
        (-constant * exponent).exp()
    }
}

fn hydrostatic(heights: Heights) -> f64 {
    match heights {
        Heights::Geometric => HYDROSTATIC_K_PER_M,
        Heights::Geopotential => us76::HYDROSTATIC_K_PER_M,
    }
}

/// Whether rows make a profile.
fn check(rows: &[Row]) -> Result<(), ProfileError> {
    if rows.len() < 2 {
        return Err(ProfileError::TooFewRows(rows.len()));
    }
    for (i, row) in rows.iter().enumerate() {
        let (number, height_m) = (i + 1, row.height_m);
        if !(0.0..=1e6).contains(&height_m) {
            return Err(ProfileError::Height { row: number, height_m });
        }
        if i > 0 && height_m == rows[i - 1].height_m {
            return Err(ProfileError::SameHeight { row: number, height_m });
        }
        if i > 0 && height_m < rows[i - 1].height_m {
            return Err(ProfileError::Unsorted { row: number, height_m });
        }
        // Only the row's own numbers are judged here; what pressure it stands under follows from all rows below.
        let wrong = match (row.temperature_k, row.humidity_percent) {
            (t, _) if !(100.0..=373.0).contains(&t) => AirError::Temperature(t),
            (_, humidity) if !(0.0..=100.0).contains(&humidity) => AirError::Humidity(humidity),
            _ => continue,
        };
        return Err(ProfileError::Air { row: number, source: wrong });
    }
    Ok(())
}
