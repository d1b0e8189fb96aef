//! What particles do to light, against numbers that others computed or published: error against run time.

use std::time::Duration;

use num_complex::Complex64;

use super::stability::Extreme;
use super::{Answer, Case, Contender, Study, seconds_each};
use crate::physics::aerosol::climate::{AerosolError, Bulk, Climate, UnknownClimate};
use crate::physics::aerosol::components::{ComponentError, Humidity};
use crate::physics::aerosol::mie::{self, MieError};

/// Ten climates by another program, over 40,001 sizes a component.
const BULK: &str = include_str!("../../fixtures/reference/opac_bulk_550nm.csv");

/// Ten climates as published.
const PUBLISHED: &str = include_str!("../../fixtures/reference/opac_hess_1998.csv");

/// Spheres as published.
const SPHERES: &str = include_str!("../../fixtures/reference/mie_wiscombe_1979.csv");

/// Spheres in 80-digit arithmetic.
const EXACT_SPHERES: &str = include_str!("../../fixtures/reference/mie_efficiencies.csv");

/// Humidity and wavelength of the references.
const PERCENT: f64 = 80.0;
const WAVELENGTH_NM: f64 = 550.0;

/// The tolerance that the command line asks for by itself.
const TOLERANCE: f64 = 1e-3;

/// Wavelengths of a picture: this many from 380 to 720 nm.
const WAVELENGTHS: u32 = 32;

/// Why the study could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StudyError {
    /// A climate was refused.
    #[error(transparent)]
    Aerosol(#[from] AerosolError),
    /// A table names a climate that is not there.
    #[error(transparent)]
    Climate(#[from] UnknownClimate),
    /// A humidity was refused.
    #[error(transparent)]
    Component(#[from] ComponentError),
    /// A sphere was refused.
    #[error(transparent)]
    Mie(#[from] MieError),
    /// A table is damaged.
    #[error("the reference table has a line that cannot be read: '{0}'")]
    Table(String),
}

/// The lines of a table, its comment and its heading left out: the first cell and the numbers after it.
fn rows(table: &'static str) -> Result<Vec<(&'static str, Vec<f64>)>, StudyError> {
    let row = |line: &'static str| {
        let (name, rest) = line.split_once(',')?;
        let numbers: Option<Vec<f64>> = rest.split(',').map(|cell| cell.parse().ok()).collect();
        Some((name, numbers?))
    };
    table.lines().skip(2).map(|line| row(line).ok_or_else(|| StudyError::Table(line.to_owned()))).collect()
}

/// The extinction of every climate by the planned average and by fixed numbers of size intervals, relative to the reference.
///
/// # Errors
/// The table of references is damaged.
pub fn study() -> Result<Study<'static>, StudyError> {
    let humidity = Humidity::percent(PERCENT)?;
    let (mut cases, mut references) = (Vec::new(), Vec::new());
    for (name, numbers) in rows(BULK)? {
        let climate: Climate = name.parse()?;
        let &extinction = numbers.first().ok_or_else(|| StudyError::Table(name.to_owned()))?;
        cases.push(Case { group: "extinction at 550 nm and 80 %".to_owned(), name: name.to_owned(), reference: 1.0 });
        references.push((climate, extinction));
    }
    let relative = |bulk: Bulk, reference: f64| Answer {
        value: bulk.extinction_per_km / reference,
        believed: bulk.error_per_km / reference,
        steps: bulk.spheres,
    };
    let mut contenders = Vec::new();
    for tolerance in [0.1, 0.01, 1e-3, 1e-4] {
        let references = references.clone();
        let answer = move |index: usize| {
            let &(climate, reference) = references.get(index)?;
            let bulk = climate.at_ground(humidity, WAVELENGTH_NM, tolerance).ok()?;
            Some(relative(bulk, reference))
        };
        contenders.push(Contender { method: "planned", setting: format!("{tolerance:e}"), answer: Box::new(answer) });
    }
    for intervals in [16, 64, 256, 1024, 4096] {
        let references = references.clone();
        let answer = move |index: usize| {
            let &(climate, reference) = references.get(index)?;
            let bulk = climate.at_ground_with_intervals(humidity, WAVELENGTH_NM, intervals).ok()?;
            Some(relative(bulk, reference))
        };
        contenders.push(Contender {
            method: "all sizes",
            setting: format!("{intervals} bins"),
            answer: Box::new(answer),
        });
    }
    let title = "What particles take from light: error against run time (one wavelength)";
    Ok(Study { title, unit: "rel", cases, contenders })
}

/// A climate beside what is published of it, each as published, ours second.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Published {
    /// The climate.
    pub climate: &'static str,
    /// Extinction per kilometre.
    pub extinction_per_km: (f64, f64),
    /// Single scattering albedo.
    pub single_scattering_albedo: (f64, f64),
    /// Asymmetry.
    pub asymmetry: (f64, f64),
    /// Optical depth of the column.
    pub column_optical_depth: (f64, f64),
}

/// How far we are from the tables of others.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Agreement {
    /// Published spheres compared.
    pub published_spheres: usize,
    /// The largest relative difference of Qext and Qsca from them.
    pub published_worst: f64,
    /// Spheres in 80-digit arithmetic compared.
    pub exact_spheres: usize,
    /// The largest relative difference of Qext, Qsca, Qabs from them.
    pub exact_worst: f64,
    /// The largest difference of g from them.
    pub exact_worst_asymmetry: f64,
    /// The climates as published.
    pub climates: Vec<Published>,
}

/// Compares with every table.
///
/// # Errors
/// A table is damaged.
pub fn agreement() -> Result<Agreement, StudyError> {
    let relative = |ours: f64, reference: f64| if reference == ours { 0.0 } else { (ours / reference - 1.0).abs() };
    let (mut published_spheres, mut published_worst) = (0, 0.0_f64);
    for (name, numbers) in rows(SPHERES)? {
        let [x, n, k, extinction, scattering, _] = numbers[..] else { return Err(StudyError::Table(name.to_owned())) };
        let q = mie::sphere(x, Complex64::new(n, k))?;
        let worst = relative(q.extinction, extinction).max(relative(q.scattering, scattering));
        (published_spheres, published_worst) = (published_spheres + 1, published_worst.max(worst));
    }
    let (mut exact_spheres, mut exact_worst, mut exact_worst_asymmetry) = (0, 0.0_f64, 0.0_f64);
    for (name, numbers) in rows(EXACT_SPHERES)? {
        let broken = || StudyError::Table(name.to_owned());
        let [n, k, extinction, scattering, absorption, asymmetry] = numbers[..] else { return Err(broken()) };
        let q = mie::sphere(name.parse().ok().ok_or_else(broken)?, Complex64::new(n, k))?;
        for (ours, reference) in [(q.extinction, extinction), (q.scattering, scattering), (q.absorption, absorption)] {
            exact_worst = exact_worst.max(relative(ours, reference));
        }
        exact_worst_asymmetry = exact_worst_asymmetry.max((q.asymmetry - asymmetry).abs());
        exact_spheres += 1;
    }
    let mut climates = Vec::new();
    for (name, numbers) in rows(PUBLISHED)? {
        let [extinction, albedo, asymmetry, depth] = numbers[..] else {
            return Err(StudyError::Table(name.to_owned()));
        };
        let climate: Climate = name.parse()?;
        let column = climate.column(Humidity::percent(PERCENT)?, WAVELENGTH_NM, TOLERANCE)?;
        climates.push(Published {
            climate: climate.name(),
            extinction_per_km: (extinction, column.ground.extinction_per_km),
            single_scattering_albedo: (albedo, column.ground.single_scattering_albedo()),
            asymmetry: (asymmetry, column.ground.asymmetry),
            column_optical_depth: (depth, column.optical_depth()),
        });
    }
    Ok(Agreement { published_spheres, published_worst, exact_spheres, exact_worst, exact_worst_asymmetry, climates })
}

/// What a climate costs at all the wavelengths of a picture.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Cost {
    /// The climate.
    pub climate: &'static str,
    /// Relative humidity, percent.
    pub humidity_percent: f64,
    /// Spheres computed.
    pub spheres: usize,
    /// Time, milliseconds.
    pub time_ms: f64,
}

/// Times every climate at 32 wavelengths from 380 to 720 nm, at 80 % and at 99 %, to 1e-3, on one core.
///
/// # Errors
/// None for the climates there are (tested).
pub fn costs(clock: &dyn Fn() -> Duration) -> Result<Vec<Cost>, StudyError> {
    let mut costs = Vec::new();
    for humidity_percent in [PERCENT, 99.0] {
        let humidity = Humidity::percent(humidity_percent)?;
        for climate in Climate::ALL {
            let spectrum = || -> Result<usize, AerosolError> {
                let nm = |i: u32| 380.0 + 340.0 * f64::from(i) / f64::from(WAVELENGTHS - 1);
                (0..WAVELENGTHS).map(|i| climate.at_ground(humidity, nm(i), TOLERANCE).map(|bulk| bulk.spheres)).sum()
            };
            let spheres = spectrum()?;
            // The faster of two counts: the other was slowed by whatever else the machine does.
            let once = || seconds_each(clock, || _ = std::hint::black_box(spectrum()));
            costs.push(Cost { climate: climate.name(), humidity_percent, spheres, time_ms: 1e3 * once().min(once()) });
        }
    }
    Ok(costs)
}

/// Extreme particles, and air at the ends of the tables: finite and conserved, or refused with the range.
#[must_use]
pub fn extremes() -> Vec<Extreme> {
    let cases: [(&'static str, Result<String, String>); 4] = [
        ("spheres from 1e-3 to 1e4, clear and black", spheres_at_the_ends()),
        ("a sphere of index 1", invisible()),
        ("particles at 0 and 99 %, and at 100 %", humidities()),
        ("particles at 300 and 1000 nm, and outside", wavelengths()),
    ];
    let extreme = |(name, result): (&'static str, Result<String, String>)| Extreme {
        name,
        held: result.is_ok(),
        what: result.unwrap_or_else(|what| what),
    };
    cases.into_iter().map(extreme).collect()
}

fn spheres_at_the_ends() -> Result<String, String> {
    let mut worst = 0.0_f64;
    for x in [1e-3, 1e4] {
        for m in [(1.5, 0.0), (1.33, 1e-9), (1.75, 0.44), (10.0, 10.0), (1.0001, 0.0), (1.0, 5.0)] {
            let q = mie::sphere(x, Complex64::new(m.0, m.1)).map_err(|e| e.to_string())?;
            worst = worst.max((q.extinction / (q.scattering + q.absorption) - 1.0).abs());
            if !(q.asymmetry.abs() <= 1.0 && q.absorption >= 0.0 && worst < 1e-9) {
                return Err(format!("x {x}, m {} + {} i: {q:?}", m.0, m.1));
            }
        }
    }
    Ok(format!("what is taken is scattered or absorbed to {worst:.0e}"))
}

fn invisible() -> Result<String, String> {
    let q = mie::sphere(100.0, Complex64::new(1.0, 0.0)).map_err(|e| e.to_string())?;
    if q.extinction == 0.0 { Ok("takes nothing".to_owned()) } else { Err(format!("{q:?}")) }
}

fn humidities() -> Result<String, String> {
    let thickness = |percent| -> Result<f64, String> {
        let humidity = Humidity::percent(percent).map_err(|e| e.to_string())?;
        let bulk = Climate::MaritimeClean.at_ground(humidity, WAVELENGTH_NM, 0.01).map_err(|e| e.to_string())?;
        Ok(bulk.extinction_per_km)
    };
    match (thickness(0.0)?, thickness(99.0)?, thickness(100.0), thickness(f64::NAN)) {
        (dry, wet, Err(refused), Err(_)) if dry > 0.0 && wet > dry => {
            Ok(format!("{dry:.3} and {wet:.3} /km; refused: {refused}"))
        }
        other => Err(format!("{other:?}")),
    }
}

fn wavelengths() -> Result<String, String> {
    let at = |nm: f64| Climate::Urban.at_ground(Humidity::DRY, nm, 0.01).map(|bulk| bulk.extinction_per_km);
    match (at(300.0), at(1000.0), at(299.0), at(1001.0), at(f64::NAN)) {
        (Ok(violet), Ok(infrared), Err(refused), Err(_), Err(_)) if violet > infrared && infrared > 0.0 => {
            Ok(format!("{violet:.3} and {infrared:.3} /km; refused: {refused}"))
        }
        other => Err(format!("{other:?}")),
    }
}

/// Agreement and costs as tables for people.
#[must_use]
pub fn tables(agreement: &Agreement, costs: &[Cost]) -> String {
    let mut text = format!(
        "Mie's series\n  \
         Wiscombe (1979), {} published spheres   worst {:.1e} of Qext and Qsca (printed to 7 digits)\n  \
         80-digit arithmetic, {} spheres         worst {:.1e} of Qext, Qsca and Qabs, {:.1e} of g\n\n\
         Climates at 550 nm and 80 %, published (Hess et al. 1998, table 4) and ours\n  \
         {:<21} {:>14} {:>16} {:>16} {:>16}\n",
        agreement.published_spheres,
        agreement.published_worst,
        agreement.exact_spheres,
        agreement.exact_worst,
        agreement.exact_worst_asymmetry,
        "",
        "extinction /km",
        "albedo",
        "g",
        "column depth"
    );
    for c in &agreement.climates {
        let pair = |(published, ours): (f64, f64)| format!("{published:.3}  {ours:.4}");
        text += &format!(
            "  {:<21} {:>14} {:>16} {:>16} {:>16}\n",
            c.climate,
            pair(c.extinction_per_km),
            pair(c.single_scattering_albedo),
            pair(c.asymmetry),
            pair(c.column_optical_depth)
        );
    }
    text += &format!(
        "\n{WAVELENGTHS} wavelengths from 380 to 720 nm, to {TOLERANCE:e}, on one core\n  {:<21} {:>10} {:>9} {:>9}\n",
        "", "humidity", "spheres", "time ms"
    );
    for c in costs {
        text += &format!("  {:<21} {:>8} % {:>9} {:>9.1}\n", c.climate, c.humidity_percent, c.spheres, c.time_ms);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_contender_errs_less_than_it_believes_where_it_is_asked_to() {
        let study = study().unwrap();
        assert_eq!(study.cases.len(), 10);
        for index in 0..study.cases.len() {
            for contender in study.contenders.iter().filter(|c| c.method == "planned" && c.setting != "1e-4") {
                let answer = (contender.answer)(index).unwrap();
                let tolerance: f64 = contender.setting.parse().unwrap();
                assert!(answer.believed <= tolerance * 1.01, "{:?} {}", study.cases[index], contender.setting);
                assert!(
                    (answer.value - 1.0).abs() <= tolerance,
                    "{:?} {}: {answer:?}",
                    study.cases[index],
                    contender.setting
                );
            }
        }
    }

    #[test]
    fn every_extreme_case_of_particles_holds() {
        for extreme in extremes() {
            assert!(extreme.held, "{}: {}", extreme.name, extreme.what);
        }
    }

    #[test]
    fn the_agreement_is_that_of_the_figures_to_reach() {
        let agreement = agreement().unwrap();
        assert!(agreement.published_spheres == 15 && agreement.published_worst < 1e-6, "{agreement:?}");
        assert!(agreement.exact_spheres > 60 && agreement.exact_worst < 1e-9, "{agreement:?}");
        assert_eq!(agreement.climates.len(), 10);
        let text = tables(&agreement, &[Cost { climate: "urban", humidity_percent: 80.0, spheres: 7, time_ms: 1.5 }]);
        assert!(text.contains("0.353") && text.contains("1.5"), "{text}");
    }
}
