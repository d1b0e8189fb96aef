//! What ozone takes from light: its absorption, and how it lies in the air.

use crate::physics::refraction::ray::Absorber;

/// Molecules in a square metre of a layer of one Dobson unit.
const MOLECULES_PER_M2_AND_DU: f64 = 2.686_78e20;

/// First and last wavelength that are answered, nanometres.
const WAVELENGTHS_NM: [f64; 2] = [360.0, 840.0];
/// Width of the bins of [`CROSS_SECTIONS`], nanometres; the first begins at 360 nm.
const BIN_NM: f64 = 10.0;

/// Absorption cross-section at 233 K, means over 10 nm, 1e-25 cm^2 a molecule.
///
/// Source: Serdyuchenko, Gorshelev, Weber, Chehade & Burrows (2014), Atmos. Meas. Tech. 7, 625. In the Chappuis band older
/// measurements differ by up to 10 % (Shettle & Anderson 1995: 5.1e-21 for 4.9e-21 cm^2 at 600 nm).
const CROSS_SECTIONS: [f64; 48] = [
    118.0, 21.82, 28.18, 66.36, 152.7, 276.3, 552.0, 845.1, 1582.0, 2316.0, 3669.0, 4924.0, 7752.0, 9016.0, 14800.0,
    16020.0, 21390.0, 27550.0, 30910.0, 35000.0, 42660.0, 46720.0, 43980.0, 47010.0, 50190.0, 43050.0, 37400.0,
    32150.0, 26620.0, 22380.0, 18520.0, 14730.0, 12090.0, 9423.0, 7455.0, 6566.0, 5105.0, 4150.0, 4228.0, 3237.0,
    2451.0, 2801.0, 2534.0, 1624.0, 1465.0, 2078.0, 1383.0, 710.5,
];

/// Ozone in the U.S. standard atmosphere: height in kilometres, 1e12 molecules/cm^3.
///
/// Source: Anderson, Clough, Kneizys, Chetwynd & Shettle (1986), AFGL-TR-86-0110, table 1f. Only its shape is used.
const PROFILE: [(f64, f64); 36] = [
    (0.0, 0.6778),
    (1.0, 0.6777),
    (2.0, 0.6785),
    (3.0, 0.6278),
    (4.0, 0.5777),
    (5.0, 0.5776),
    (6.0, 0.5643),
    (7.0, 0.6152),
    (8.0, 0.6531),
    (9.0, 0.8912),
    (10.0, 1.1269),
    (11.0, 1.6316),
    (12.0, 2.0116),
    (13.0, 2.1352),
    (14.0, 2.3837),
    (15.0, 2.6366),
    (16.0, 3.0119),
    (17.0, 3.5224),
    (18.0, 4.0227),
    (19.0, 4.3909),
    (20.0, 4.7704),
    (21.0, 4.7722),
    (22.0, 4.8983),
    (23.0, 4.7705),
    (24.0, 4.5212),
    (25.0, 4.2685),
    (27.5, 3.2712),
    (30.0, 2.5086),
    (32.5, 1.8602),
    (35.0, 1.3806),
    (37.5, 0.9656),
    (40.0, 0.6066),
    (42.5, 0.3598),
    (45.0, 0.2147),
    (47.5, 0.1197),
    (50.0, 0.0662),
];

/// Why no ozone is computed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum OzoneError {
    /// The wavelength is outside the table.
    #[error("ozone at {0} nm: its absorption is known here from 360 to 840 nm")]
    Wavelength(f64),
    /// The column is none.
    #[error("ozone column of {0} Dobson units: give 0 to 1000; the Earth has 100 to 500, mostly 300")]
    Column(f64),
}

/// Absorption cross-section, square metres a molecule: linear between the middles of the bins.
///
/// # Errors
/// The wavelength is outside 360 to 840 nm.
pub fn cross_section_m2(wavelength_nm: f64) -> Result<f64, OzoneError> {
    let [first, last] = WAVELENGTHS_NM;
    if !(first..=last).contains(&wavelength_nm) {
        return Err(OzoneError::Wavelength(wavelength_nm));
    }
    let end = (CROSS_SECTIONS.len() - 1) as f64;
    let place = ((wavelength_nm - first) / BIN_NM - 0.5).clamp(0.0, end);
    let below = (place as usize).min(CROSS_SECTIONS.len() - 2);
    let [low, high] = [CROSS_SECTIONS[below], CROSS_SECTIONS[below + 1]];
    Ok(1e-29 * (low + (high - low) * (place - below as f64)))
}

/// Ozone over a place, at one wavelength: a column that lies in the air as in the U.S. standard atmosphere, up to 50 km.
#[derive(Debug, Clone, PartialEq)]
pub struct OzoneLayer {
    heights_m: Vec<f64>,
    absorption_per_m: Vec<f64>,
}

impl OzoneLayer {
    /// A column of so many Dobson units.
    ///
    /// # Errors
    /// The wavelength is outside 360 to 840 nm, or the column outside 0 to 1000.
    pub fn new(column_du: f64, wavelength_nm: f64) -> Result<OzoneLayer, OzoneError> {
        if !(0.0..=1000.0).contains(&column_du) {
            return Err(OzoneError::Column(column_du));
        }
        let depth = cross_section_m2(wavelength_nm)? * column_du * MOLECULES_PER_M2_AND_DU;
        let whole: f64 = PROFILE.windows(2).map(|w| 0.5e3 * (w[1].0 - w[0].0) * (w[1].1 + w[0].1)).sum();
        Ok(OzoneLayer {
            heights_m: PROFILE.iter().map(|row| row.0 * 1e3).collect(),
            absorption_per_m: PROFILE.iter().map(|row| row.1 * depth / whole).collect(),
        })
    }
}

impl Absorber for OzoneLayer {
    fn per_m(&self, height_m: f64) -> f64 {
        let last = self.heights_m.len() - 1;
        if height_m > self.heights_m[last] {
            return 0.0;
        }
        let above = self.heights_m.partition_point(|&knot| knot <= height_m).clamp(1, last);
        let [low, high] = [above - 1, above];
        let share = ((height_m - self.heights_m[low]) / (self.heights_m[high] - self.heights_m[low])).max(0.0);
        self.absorption_per_m[low] + (self.absorption_per_m[high] - self.absorption_per_m[low]) * share
    }

    fn knots_m(&self) -> &[f64] {
        &self.heights_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Older measurements: Shettle & Anderson's give 300 Dobson units an optical depth of 0.0415 at 600 nm, Leckner (1978)
    /// has 4.44e-21 cm^2 there.
    #[test]
    fn three_hundred_dobson_units_take_four_percent_of_orange_light() {
        let depth = cross_section_m2(600.0).unwrap() * 300.0 * MOLECULES_PER_M2_AND_DU;
        assert!((depth / 0.0415 - 1.0).abs() < 0.1, "{depth}");
        assert!((cross_section_m2(600.0).unwrap() * 1e4 / 4.444e-21 - 1.0).abs() < 0.12);
    }

    #[test]
    fn the_layer_adds_up_to_its_column_and_is_thickest_at_22_km() {
        let layer = OzoneLayer::new(345.8, 550.0).unwrap();
        let sum: f64 = (0..60_000).map(|m| layer.per_m(f64::from(m) + 0.5)).sum();
        let depth = cross_section_m2(550.0).unwrap() * 345.8 * MOLECULES_PER_M2_AND_DU;
        assert!((sum / depth - 1.0).abs() < 1e-6, "{sum} for {depth}");
        let at_km = |km: i32| layer.per_m(f64::from(km) * 1e3);
        assert_eq!((0..50).max_by(|a, b| at_km(*a).total_cmp(&at_km(*b))), Some(22));
        // The report's own density there, for its own column: 4.8983e12 molecules/cm^3.
        let density = at_km(22) / cross_section_m2(550.0).unwrap();
        assert!((density / 4.8983e18 - 1.0).abs() < 5e-3, "{density:e}");
    }

    #[test]
    fn no_ozone_takes_nothing_and_nonsense_is_refused() {
        assert_eq!(OzoneLayer::new(0.0, 550.0).unwrap().per_m(22_000.0), 0.0);
        for (du, nm) in [(-1.0, 550.0), (f64::NAN, 550.0), (2000.0, 550.0), (300.0, 359.0), (300.0, f64::NAN)] {
            assert!(OzoneLayer::new(du, nm).is_err(), "{du} DU at {nm} nm");
        }
        assert!(OzoneLayer::new(300.0, 360.0).is_ok() && OzoneLayer::new(300.0, 840.0).is_ok());
    }
}
