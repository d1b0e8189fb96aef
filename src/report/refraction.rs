//! The refraction of single rays by every method, against numbers that others computed.

use super::{Answer, Case, Contender, Study};
use crate::physics::air::presets;
use crate::physics::air::profile::{Profile, ProfileError, Row};
use crate::physics::air::read::ReadError;
use crate::physics::air::us76;
use crate::physics::refraction::ray::{self, Launch, Medium, MediumError, Outcome, RayError, Tracer};
use crate::units::Angle;

/// The references: 16 rays in 50 digits, by tanh-sinh quadrature in another program.
const CASES: &str = include_str!("../../fixtures/reference/ray_cases.csv");

/// Refraction of the standard atmosphere, by another program in long double.
const US76: &str = include_str!("../../fixtures/reference/refraction_us76.csv");

/// Transfer curves of two mirages, by the same.
const MIRAGES: &str = include_str!("../../fixtures/reference/mirage_transfer.csv");

const GLOBE_M: f64 = 6_371_000.0;
const TOP_M: f64 = 1e5;
const WAVELENGTH_NM: f64 = 550.0;

/// Why the study could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StudyError {
    /// An atmosphere could not be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// An atmosphere is none.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// A medium cannot be.
    #[error(transparent)]
    Medium(#[from] MediumError),
    /// A method refused.
    #[error(transparent)]
    Ray(#[from] RayError),
    /// A table is damaged.
    #[error("the reference table has a line that cannot be read: '{0}'")]
    Table(String),
}

/// The four atmospheres of the study.
///
/// # Errors
/// None for the atmospheres there are (tested).
pub fn airs() -> Result<Vec<(&'static str, Profile)>, StudyError> {
    let mut airs = Vec::new();
    for name in ["standard", "omega", "mock-mirage"] {
        if let Some(described) = presets::named(name) {
            airs.push((name, described?.profile));
        }
    }
    airs.push(("near-duct", near_duct()?));
    Ok(airs)
}

/// An inversion of +0.115 K/m over 30 m: level rays bend 0.9 times as much as the globe.
///
/// # Errors
/// None (tested).
pub fn near_duct() -> Result<Profile, ProfileError> {
    let row = |height_m, temperature_k| Row { height_m, temperature_k, humidity_percent: 0.0 };
    Profile::new(&[row(0.0, 288.15), row(30.0, 291.60), row(11e3, 216.65), row(20e3, 216.65)], us76::P0_PA)
}

/// Green light in each of the atmospheres.
///
/// # Errors
/// None for the atmospheres there are (tested).
pub fn mediums<'a>(airs: &'a [(&'static str, Profile)]) -> Result<Vec<(&'static str, Medium<'a>)>, StudyError> {
    let medium = |air: &'a (&'static str, Profile)| Ok((air.0, Medium::new(&air.1, WAVELENGTH_NM, GLOBE_M, TOP_M)?));
    airs.iter().map(medium).collect()
}

/// Every method over every case.
///
/// # Errors
/// A method refused its setting, or the table of references is damaged.
pub fn study<'a>(mediums: &'a [(&'static str, Medium<'a>)]) -> Result<Study<'a>, StudyError> {
    let (mut cases, mut launches) = (Vec::new(), Vec::new());
    for line in CASES.lines().filter(|line| !line.starts_with(['#', 'p'])) {
        let broken = || StudyError::Table(line.to_owned());
        let fields: Vec<&str> = line.split(',').collect();
        let number = |i: usize| fields.get(i).and_then(|field| field.parse::<f64>().ok()).ok_or_else(broken);
        let (height_m, arcmin, reference) = (number(1)?, number(2)?, number(3)?);
        let medium = mediums.iter().position(|(name, _)| *name == fields[0]).ok_or_else(broken)?;
        let name = match arcmin {
            0.0 => "horizon".to_owned(),
            // Only the mirages have a fold; elsewhere the ray that grazes the ground, or that turns inside the inversion.
            a if a < 0.0 => match fields[0] {
                "standard" => format!("grazing ({a:.2}')"),
                "near-duct" => format!("in the inversion ({a:.2}')"),
                _ => format!("fold ({a:.2}')"),
            },
            a => format!("{} degrees", a / 60.0),
        };
        cases.push(Case { group: fields[0].to_owned(), name, reference });
        launches.push((medium, Launch { apparent_altitude: Angle::arcminutes(arcmin), height_m }));
    }

    // Each method with the settings over which its error runs.
    let tolerances: &[f64] = &[10.0, 0.1, 1e-3, 1e-6];
    let mut contenders = Vec::new();
    for (method, layers, tolerances) in [
        ("exact", &[][..], tolerances),
        ("runge-kutta", &[], tolerances),
        ("lehn", &[300, 1000, 3000, 10_000, 30_000], &[]),
        ("lehn-knots", &[100, 300, 1000, 3000], &[]),
    ] {
        let with_layers = layers.iter().map(|&n: &usize| (Some(n), 1.0, format!("{n} layers")));
        let with_tolerance = tolerances.iter().map(|&t| (None, t, format!("{t}\"")));
        for (layers, tolerance, setting) in with_layers.chain(with_tolerance) {
            if let Some(contender) = contender(method, layers, tolerance, setting, mediums, &launches)? {
                contenders.push(contender);
            }
        }
    }
    Ok(Study {
        title: "Refraction of a ray: error against run time (550 nm, top at 100 km)",
        unit: "arcsec",
        cases,
        contenders,
    })
}

/// One method at one setting, made ready for every atmosphere.
fn contender<'a>(
    name: &'static str,
    layers: Option<usize>,
    tolerance: f64,
    setting: String,
    mediums: &'a [(&'static str, Medium<'a>)],
    launches: &[(usize, Launch)],
) -> Result<Option<Contender<'a>>, StudyError> {
    let Some(method) = ray::method(name, layers) else { return Ok(None) };
    let mut tracers: Vec<Box<dyn Tracer + 'a>> = Vec::new();
    for (_, medium) in mediums {
        tracers.push(method.prepare(medium, Angle::arcseconds(tolerance))?);
    }
    let launches = launches.to_vec();
    let answer = move |index: usize| {
        let (medium, launch) = launches.get(index)?;
        let ray = tracers.get(*medium)?.trace(launch).ok().filter(|ray| ray.outcome == Outcome::Escaped)?;
        let (value, believed) = (ray.refraction.to_arcseconds(), ray.believed_error.to_arcseconds());
        Some(Answer { value, believed, steps: ray.steps })
    };
    Ok(Some(Contender { method: name, setting, answer: Box::new(answer) }))
}

/// How far the exact method is from the long tables of others.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Agreement {
    /// Values compared with the table of the standard atmosphere.
    pub standard_values: usize,
    /// The largest difference, arcseconds.
    pub standard_worst_arcsec: f64,
    /// Values compared with the table of mirages.
    pub mirage_values: usize,
    /// The largest difference, arcseconds.
    pub mirage_worst_arcsec: f64,
}

/// Traces every row of the tables with the exact method at 0.001 arcsecond.
///
/// # Errors
/// A table is damaged.
pub fn agreement() -> Result<Agreement, StudyError> {
    let standard = us76::profile();
    let (mut standard_values, mut standard_worst) = (0, 0f64);
    for (row, columns) in rows(US76, &["0.38", "0.42", "0.45", "0.5", "0.55", "0.59", "0.633", "0.65", "0.7", "0.72"]) {
        let at = |i: usize| field(row, i);
        for (micrometres, reference) in columns {
            let medium = Medium::new(&standard, micrometres * 1e3, at(0)?, TOP_M)?;
            let error = difference(&medium, 90.0 * 60.0 - at(2)? * 60.0, at(1)?, reference)?;
            (standard_values, standard_worst) = (standard_values + 1, standard_worst.max(error));
        }
    }
    let airs = airs()?;
    let (mut mirage_values, mut mirage_worst) = (0, 0f64);
    for (row, columns) in rows(MIRAGES, &["0.45", "0.5", "0.55", "0.65", "0.7"]) {
        let air = if row.starts_with("young_opn1999_inferior") { "omega" } else { "mock-mirage" };
        let profile = airs.iter().find(|(name, _)| *name == air).ok_or_else(|| StudyError::Table(row.to_owned()))?;
        for (micrometres, reference) in columns {
            let medium = Medium::new(&profile.1, micrometres * 1e3, GLOBE_M, TOP_M)?;
            let error = difference(&medium, field(row, 2)?, field(row, 1)?, reference)?;
            (mirage_values, mirage_worst) = (mirage_values + 1, mirage_worst.max(error));
        }
    }
    Ok(Agreement {
        standard_values,
        standard_worst_arcsec: standard_worst,
        mirage_values,
        mirage_worst_arcsec: mirage_worst,
    })
}

/// The rows of numbers of a table, each with its wavelengths (micrometres) and refractions, which stand after 4 columns.
fn rows<'t>(table: &'t str, micrometres: &'t [&'t str]) -> impl Iterator<Item = (&'t str, Vec<(f64, f64)>)> {
    table.lines().filter(|line| line.starts_with(['6', 'y'])).map(move |line| {
        let values = line.split(',').skip(4).zip(micrometres);
        (line, values.filter_map(|(value, nm)| Some((nm.parse().ok()?, value.parse().ok()?))).collect())
    })
}

fn field(row: &str, index: usize) -> Result<f64, StudyError> {
    row.split(',').nth(index).and_then(|text| text.parse().ok()).ok_or_else(|| StudyError::Table(row.to_owned()))
}

/// How far the exact method is from a reference, arcseconds.
fn difference(medium: &Medium<'_>, arcmin: f64, height_m: f64, reference: f64) -> Result<f64, StudyError> {
    let tracer = ray::Method::prepare(&ray::exact::Exact, medium, Angle::arcseconds(1e-3))?;
    let ray = tracer.trace(&Launch { apparent_altitude: Angle::arcminutes(arcmin), height_m })?;
    Ok((ray.refraction.to_arcseconds() - reference).abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The figures to reach: 0.001" over the standard's table, 0.05" over the mirages'.
    #[test]
    fn the_exact_method_agrees_with_both_tables() {
        let agreement = agreement().unwrap();
        assert_eq!((agreement.standard_values, agreement.mirage_values > 850), (1100, true));
        assert!(agreement.standard_worst_arcsec < 0.001 && agreement.mirage_worst_arcsec < 0.05, "{agreement:?}");
    }

    /// What the study is there to show: each method's error where it is known.
    #[test]
    fn every_method_answers_every_case_within_its_known_error() {
        let airs = airs().unwrap();
        let mediums = mediums(&airs).unwrap();
        let study = study(&mediums).unwrap();
        assert_eq!(study.cases.len(), 16);
        for (index, case) in study.cases.iter().enumerate() {
            for contender in &study.contenders {
                let allowed = match (contender.method, contender.setting.as_str()) {
                    ("exact", "0.001\"") => 1e-3,
                    ("exact", "0.000001\"") => 1e-6,
                    ("runge-kutta", "0.001\"") => 1e-3,
                    ("lehn-knots", "300 layers") => 1.5,
                    _ => continue,
                };
                let answer = (contender.answer)(index).unwrap();
                let error = (answer.value - case.reference).abs();
                assert!(error < allowed, "{case:?} {} {}: {error}", contender.method, contender.setting);
                assert!(answer.believed < 2.0 * allowed, "{case:?} {}: {answer:?}", contender.method);
            }
        }
    }
}
