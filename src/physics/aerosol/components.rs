//! What the particles are: the ten components of OPAC, how they grow in humid air, and how they refract.

use std::ops::RangeInclusive;

use num_complex::Complex64;

use super::sizes::LogNormal;
use super::tables::{self, Grown, Index};

/// Wavelengths at which the refractive indices are known, nanometres.
pub const WAVELENGTHS_NM: RangeInclusive<f64> = 300.0..=1000.0;

/// Relative humidities at which growth is known, percent.
pub const HUMIDITIES_PERCENT: RangeInclusive<f64> = 0.0..=99.0;

/// Relative humidity of the air, from 0 to 99 %.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Humidity(f64);

/// What the tables do not answer.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ComponentError {
    /// The humidity is outside the table.
    #[error(
        "relative humidity {0} % is outside 0 to 99: at saturation particles become droplets of fog, which this does not know; give 99 at most"
    )]
    Humidity(f64),
    /// The wavelength is outside the table.
    #[error("wavelength {0} nm is outside 300 to 1000 nm, where the particles' refractive indices are tabulated")]
    Wavelength(f64),
}

impl Humidity {
    /// Dry air.
    pub const DRY: Humidity = Humidity(0.0);
    /// Half of saturation.
    pub const HALF: Humidity = Humidity(50.0);

    /// From percent.
    ///
    /// # Errors
    /// It is not between 0 and 99.
    pub fn percent(value: f64) -> Result<Humidity, ComponentError> {
        if HUMIDITIES_PERCENT.contains(&value) { Ok(Humidity(value)) } else { Err(ComponentError::Humidity(value)) }
    }

    /// In percent.
    #[must_use]
    pub const fn to_percent(self) -> f64 {
        self.0
    }
}

/// A kind of particle, by OPAC's four letters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Component {
    /// Insoluble: soil and organic dust.
    Inso,
    /// Water-soluble: sulphates, nitrates, organics.
    Waso,
    /// Soot.
    Soot,
    /// Sea salt, accumulation mode.
    Ssam,
    /// Sea salt, coarse mode.
    Sscm,
    /// Desert mineral, nucleation mode.
    Minm,
    /// Desert mineral, accumulation mode.
    Miam,
    /// Desert mineral, coarse mode.
    Micm,
    /// Desert mineral carried far.
    Mitr,
    /// Sulphuric acid droplets.
    Suso,
}

/// A component in air of some humidity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wet {
    component: Component,
    /// Radius over dry radius.
    pub growth: f64,
    /// The sizes.
    pub sizes: LogNormal,
}

impl Component {
    /// All of them.
    pub const ALL: [Component; 10] = [
        Component::Inso,
        Component::Waso,
        Component::Soot,
        Component::Ssam,
        Component::Sscm,
        Component::Minm,
        Component::Miam,
        Component::Micm,
        Component::Mitr,
        Component::Suso,
    ];

    /// OPAC's four letters.
    #[must_use]
    pub const fn code(self) -> &'static str {
        match self {
            Component::Inso => "inso",
            Component::Waso => "waso",
            Component::Soot => "soot",
            Component::Ssam => "ssam",
            Component::Sscm => "sscm",
            Component::Minm => "minm",
            Component::Miam => "miam",
            Component::Micm => "micm",
            Component::Mitr => "mitr",
            Component::Suso => "suso",
        }
    }

    /// The component as it is in air of this humidity.
    ///
    /// Growth comes from the table at its humidities. Between them the water taken up per dry volume is written as
    ///
    /// ```text
    /// growth^3 - 1 = b a/(1 - a)          a = humidity/100; Petters & Kreidenweis (2007), Atmos. Chem. Phys. 7, 1961, eq. 2
    /// ```
    ///
    /// and b, which varies slowly, is interpolated linearly (below 50 % it is that of 50 %). Left out one at a time, the
    /// tabulated growths from 70 to 98 % come back within 3.4 % so, and only within 14 % with the growth itself interpolated.
    #[must_use]
    pub fn in_air(self, humidity: Humidity) -> Wet {
        let (sigma, rows): (f64, &[Grown]) = match self {
            Component::Inso => (2.51, &[(0.0, 0.471, 0.005, 20.0)]),
            Component::Waso => (2.24, &tables::WATER_SOLUBLE_SIZES),
            Component::Soot => (2.0, &[(0.0, 0.0118, 0.005, 20.0)]),
            Component::Ssam => (2.03, &tables::SALT_ACCUMULATION_SIZES),
            Component::Sscm => (2.03, &tables::SALT_COARSE_SIZES),
            Component::Minm => (1.95, &[(0.0, 0.07, 0.005, 20.0)]),
            Component::Miam => (2.0, &[(0.0, 0.39, 0.005, 20.0)]),
            Component::Micm => (2.15, &[(0.0, 1.9, 0.005, 60.0)]),
            Component::Mitr => (2.2, &[(0.0, 0.5, 0.02, 5.0)]),
            Component::Suso => (2.03, &tables::SULPHATE_SIZES),
        };
        let (growth, mode_um, smallest_um, largest_um) = grown(rows, humidity);
        Wet { component: self, growth, sizes: LogNormal { mode_um, sigma, smallest_um, largest_um } }
    }

    /// Refractive index of the dry substance, as tabulated.
    const fn dry_index(self) -> &'static Index {
        match self {
            Component::Inso => &tables::INSOLUBLE,
            Component::Waso => &tables::WATER_SOLUBLE,
            Component::Soot => &tables::SOOT,
            Component::Ssam | Component::Sscm => &tables::SEA_SALT,
            Component::Minm | Component::Miam | Component::Micm | Component::Mitr => &tables::MINERAL,
            Component::Suso => &tables::SULPHATE,
        }
    }
}

impl Wet {
    /// Refractive index at a wavelength, mixed of the dry substance and water by volume (Hess et al. 1998, eq. 2):
    ///
    /// ```text
    /// m = m_water + (m_dry - m_water)/growth^3
    /// ```
    ///
    /// # Errors
    /// The wavelength is outside 300 to 1000 nm.
    pub fn refractive_index(&self, wavelength_nm: f64) -> Result<Complex64, ComponentError> {
        let dry = at_wavelength(self.component.dry_index(), wavelength_nm)?;
        let water = at_wavelength(&tables::WATER, wavelength_nm)?;
        Ok(water + (dry - water) / self.growth.powi(3))
    }
}

/// Growth, mode, smallest and largest radius at a humidity.
fn grown(rows: &[Grown], humidity: Humidity) -> (f64, f64, f64, f64) {
    let (_, dry, smallest, largest) = rows[0];
    let above = rows.iter().position(|row| row.0 >= humidity.0);
    let Some((above, below)) = above.and_then(|above| Some((above, above.checked_sub(1)?))) else {
        return (1.0, dry, smallest, largest);
    };
    let (below, above) = (rows[below], rows[above]);
    let activity = humidity.0 / 100.0;
    let share = (humidity.0 - below.0) / (above.0 - below.0);
    let uptake_above = uptake(dry, above);
    let uptake_below = if below.0 > 0.0 { uptake(dry, below) } else { uptake_above };
    let b = uptake_below + (uptake_above - uptake_below) * share;
    let growth = (1.0 + b * activity / (1.0 - activity)).cbrt();
    // The ends of the distribution grow less than its middle; they follow the middle between two rows.
    let along = (growth * dry - below.1) / (above.1 - below.1);
    (growth, growth * dry, below.2 + (above.2 - below.2) * along, below.3 + (above.3 - below.3) * along)
}

/// Water taken up per dry volume, divided by a/(1 - a).
fn uptake(dry: f64, row: Grown) -> f64 {
    let activity = row.0 / 100.0;
    ((row.1 / dry).powi(3) - 1.0) * (1.0 - activity) / activity
}

/// A tabulated index, linear between wavelengths.
fn at_wavelength(index: &Index, wavelength_nm: f64) -> Result<Complex64, ComponentError> {
    if !WAVELENGTHS_NM.contains(&wavelength_nm) {
        return Err(ComponentError::Wavelength(wavelength_nm));
    }
    let nm = &tables::WAVELENGTHS_NM;
    let i = nm.partition_point(|&tabulated| tabulated <= wavelength_nm).clamp(1, nm.len() - 1) - 1;
    let share = (wavelength_nm - nm[i]) / (nm[i + 1] - nm[i]);
    let [below, above] = [index[i], index[i + 1]].map(|(re, im)| Complex64::new(re, im));
    Ok(below + (above - below) * share)
}

#[cfg(test)]
mod tests {
    use super::super::{mie, sizes};
    use super::*;

    fn humidity(percent: f64) -> Humidity {
        Humidity::percent(percent).unwrap()
    }

    /// OPAC's own tables of wet indices: component, humidity, wavelength, m. Last digits of 0.001 and 1e-4 relative.
    #[test]
    fn mixing_with_water_gives_the_published_wet_indices() {
        for (component, percent, nm, re, im) in [
            (Component::Waso, 50.0, 300.0, 1.445, 4.238e-3),
            (Component::Waso, 80.0, 550.0, 1.399, 1.995e-3),
            (Component::Waso, 99.0, 1000.0, 1.339, 9.726e-4),
            (Component::Ssam, 50.0, 550.0, 1.373, 3.895e-9),
            (Component::Ssam, 99.0, 900.0, 1.329, 8.744e-7),
            (Component::Sscm, 50.0, 1000.0, 1.361, 3.590e-5),
            (Component::Sscm, 99.0, 400.0, 1.340, 2.098e-9),
            (Component::Suso, 50.0, 300.0, 1.392, 1.386e-8),
        ] {
            let m = component.in_air(humidity(percent)).refractive_index(nm).unwrap();
            assert!((m.re - re).abs() <= 5.1e-4, "{component:?} {percent} % {nm} nm: {m}");
            assert!((m.im / im - 1.0).abs() <= 5e-4, "{component:?} {percent} % {nm} nm: {m}");
        }
    }

    #[test]
    fn growth_is_that_of_the_table_at_its_humidities_and_grows_between() {
        let salt = Component::Ssam;
        for (percent, mode_um) in [(0.0, 0.209), (50.0, 0.336), (80.0, 0.416), (99.0, 0.995)] {
            let wet = salt.in_air(humidity(percent));
            assert!((wet.sizes.mode_um - mode_um).abs() < 1e-12, "{percent} %: {wet:?}");
        }
        for component in [Component::Waso, Component::Ssam, Component::Sscm, Component::Suso] {
            let mut before = 0.0;
            for tenths in 0..=990 {
                let wet = component.in_air(humidity(f64::from(tenths) / 10.0));
                assert!(wet.growth > before, "{component:?} at {tenths}/10 %");
                assert!(wet.sizes.largest_um <= 100.0 && wet.sizes.smallest_um >= 0.005);
                before = wet.growth;
            }
        }
    }

    /// Each tabulated humidity from 70 to 98 % left out and interpolated from its neighbours.
    #[test]
    fn growth_left_out_of_the_table_comes_back() {
        let mut worst = (0.0_f64, 0.0_f64);
        let all = [
            tables::WATER_SOLUBLE_SIZES,
            tables::SALT_ACCUMULATION_SIZES,
            tables::SALT_COARSE_SIZES,
            tables::SULPHATE_SIZES,
        ];
        for rows in all {
            for i in 2..7 {
                let without: Vec<Grown> = rows.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, r)| *r).collect();
                let (_, mode, ..) = grown(&without, Humidity(rows[i].0));
                let share = (rows[i].0 - rows[i - 1].0) / (rows[i + 1].0 - rows[i - 1].0);
                let linear = rows[i - 1].1 + share * (rows[i + 1].1 - rows[i - 1].1);
                worst.0 = worst.0.max((mode / rows[i].1 - 1.0).abs());
                worst.1 = worst.1.max((linear / rows[i].1 - 1.0).abs());
            }
        }
        assert!(worst.0 < 0.034 && worst.1 > 0.14, "{worst:?}");
    }

    #[test]
    fn insoluble_particles_do_not_grow() {
        for component in [Component::Inso, Component::Soot, Component::Minm, Component::Mitr] {
            assert_eq!(component.in_air(humidity(0.0)), component.in_air(humidity(99.0)));
        }
    }

    #[test]
    fn what_the_tables_do_not_know_is_refused_with_the_range() {
        for percent in [-0.1, 99.1, 100.0, f64::NAN] {
            assert!(Humidity::percent(percent).unwrap_err().to_string().contains("0 to 99"));
        }
        let wet = Component::Soot.in_air(Humidity::DRY);
        for nm in [299.0, 1000.5, -550.0, f64::NAN] {
            assert!(wet.refractive_index(nm).unwrap_err().to_string().contains("300 to 1000"));
        }
        assert!(wet.refractive_index(300.0).is_ok() && wet.refractive_index(1000.0).is_ok());
    }

    #[test]
    fn no_sphere_extinguishes_more_than_the_bound_that_the_size_window_rests_on() {
        let mut largest = 0.0_f64;
        for component in Component::ALL {
            for percent in [0.0, 80.0, 99.0] {
                let wet = component.in_air(humidity(percent));
                for nm in [300.0, 550.0, 1000.0] {
                    let m = wet.refractive_index(nm).unwrap();
                    for step in 0..600 {
                        let x = 10_f64.powf(-1.0 + f64::from(step) * 0.005);
                        largest = largest.max(mie::sphere(x, m).unwrap().extinction);
                    }
                }
            }
        }
        assert!(largest > 4.0 && largest < 4.4 && largest < sizes::LARGEST_EFFICIENCY, "{largest}");
    }
}
