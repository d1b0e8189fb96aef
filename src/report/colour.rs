//! The colour of the low Sun: error against the number of wavelengths, for colours that another program computed and for whole
//! pictures.

use std::time::Duration;

use super::disc::{Shown, shown};
use super::{Answer, Case, Contender, Study};
use crate::physics::colour::{Tone, Xyz};
use crate::physics::ozone::{OzoneError, cross_section_m2};
use crate::physics::rayleigh;
use crate::physics::sun::irradiance::Spectrum;
use crate::physics::sun::wavelengths::{Sample, even_in_wavelength, samples};
use crate::physics::sun::{SceneError, render};

/// The references: sunlight through four columns of air, in steps of 0.1 nm, by another program.
const CASES: &str = include_str!("../../fixtures/reference/colour_cases.csv");

/// Numbers of wavelengths tried; the thesis took 8.
const COUNTS: [usize; 5] = [4, 8, 16, 32, 64];

/// Wavelengths that stand for all of them in a picture.
const ALL: usize = 256;

/// Carbon dioxide of the references, parts per million.
const CO2_PPM: f64 = 360.0;

/// Why the study could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum StudyError {
    /// A scene was refused.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Ozone was refused.
    #[error(transparent)]
    Ozone(#[from] OzoneError),
    /// An atmosphere could not be read.
    #[error("{0}")]
    Air(String),
    /// A table is damaged.
    #[error("the reference table has a line that cannot be read: '{0}'")]
    Table(String),
}

/// u', v' of CIE 1976: equal distances are about equally seen.
fn uniform([x, y, z]: Xyz) -> [f64; 2] {
    let sum = x + 15.0 * y + 3.0 * z;
    [4.0 * x / sum, 9.0 * y / sum]
}

/// Colours of the references by few wavelengths, even in refractivity and even in wavelength. The error is the distance in u', v',
/// or the share by which the light is wrong, whichever is more.
///
/// # Errors
/// The table of references is damaged.
pub fn study() -> Result<Study<'static>, StudyError> {
    let (mut cases, mut columns) = (Vec::new(), Vec::new());
    for line in CASES.lines().skip(2) {
        let broken = || StudyError::Table(line.to_owned());
        let fields: Vec<&str> = line.split(',').collect();
        let numbers: Option<Vec<f64>> = fields.iter().skip(1).map(|field| field.parse().ok()).collect();
        let numbers = numbers.filter(|numbers| numbers.len() == 5).ok_or_else(broken)?;
        cases.push(Case { group: "sunlight".to_owned(), name: fields[0].to_owned(), reference: 0.0 });
        columns.push(([numbers[0], numbers[1]], [numbers[2], numbers[3], numbers[4]]));
    }
    let mut contenders = Vec::new();
    type Choice = fn(usize, Spectrum) -> Vec<Sample>;
    for (method, choice) in [("refractivity", samples as Choice), ("wavelength", even_in_wavelength as Choice)] {
        for count in COUNTS {
            let chosen = choice(count, Spectrum::Kurucz);
            let mut takes = Vec::with_capacity(count);
            for sample in &chosen {
                takes.push([rayleigh::cross_section_m2(sample.nm, CO2_PPM), cross_section_m2(sample.nm)?]);
            }
            let columns = columns.clone();
            let answer = move |index: usize| {
                let (columns, reference) = columns.get(index)?;
                let mut sum = [0.0; 3];
                for (sample, takes) in chosen.iter().zip(&takes) {
                    let share = (-takes[0] * columns[0] - takes[1] * columns[1]).exp();
                    sum.iter_mut().zip(sample.light).for_each(|(sum, part)| *sum += part * share);
                }
                let ([u, v], [u0, v0]) = (uniform(sum), uniform(*reference));
                let value = (u - u0).hypot(v - v0).max((sum[1] / reference[1] - 1.0).abs());
                Some(Answer { value, believed: 0.0, steps: count })
            };
            contenders.push(Contender { method, setting: format!("{count} waves"), answer: Box::new(answer) });
        }
    }
    Ok(Study { title: "Colour of sunlight: error against the number of wavelengths", unit: "u'v'", cases, contenders })
}

/// What few wavelengths cost a picture.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Cost {
    /// The scene.
    pub scene: &'static str,
    /// Wavelengths.
    pub wavelengths: usize,
    /// Codes of 255 by which the worst channel of a pixel differs from the picture with 256 wavelengths.
    pub worst_code: u8,
    /// Mean difference over the pixels that show light, codes.
    pub mean_code: f64,
    /// What the picture took, milliseconds.
    pub time_ms: f64,
}

/// Whole pictures of some 10 arcseconds a pixel by few wavelengths, against 256.
///
/// # Errors
/// A scene was refused.
pub fn costs(clock: &dyn Fn() -> Duration) -> Result<Vec<Cost>, StudyError> {
    let mut costs = Vec::new();
    for name in ["us76", "omega", "green-flash"] {
        let Shown { profile, observer_height_m, sun_arcmin, bottom_arcmin, white } = shown(name)?;
        let picture = |count| {
            let mut scene = super::disc::scene(&profile, observer_height_m, sun_arcmin, 240, bottom_arcmin);
            scene.wavelengths = Some(count);
            render(&scene, clock).map(|(picture, _)| picture.codes(Tone::Thesis, white))
        };
        let all = picture(ALL)?;
        for count in COUNTS {
            let begin = clock();
            let few = picture(count)?;
            let time = clock().saturating_sub(begin);
            let lit = all.iter().filter(|code| **code != [0; 3]).count().max(1);
            let differences = few.as_flattened().iter().zip(all.as_flattened()).map(|(a, b)| a.abs_diff(*b));
            let (worst, sum) = differences
                .fold((0, 0u64), |(worst, sum), difference| (difference.max(worst), sum + u64::from(difference)));
            costs.push(Cost {
                scene: name,
                wavelengths: count,
                worst_code: worst,
                mean_code: sum as f64 / (3 * lit) as f64,
                time_ms: time.as_secs_f64() * 1e3,
            });
        }
    }
    Ok(costs)
}

/// The costs as a table for people.
#[must_use]
pub fn table(costs: &[Cost]) -> String {
    let mut text = format!(
        "Pictures of 240 x 240 pixels (10\" each) by few wavelengths, against {ALL}: codes of 255\n\n  {:<14} {:>12} {:>8} {:>8} {:>10}\n",
        "scene", "wavelengths", "worst", "mean", "time ms"
    );
    for cost in costs {
        text += &format!(
            "  {:<14} {:>12} {:>8} {:>8.3} {:>10.1}\n",
            cost.scene, cost.wavelengths, cost.worst_code, cost.mean_code, cost.time_ms
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_approach_those_of_another_program_and_fewer_wavelengths_need_even_refractivity() {
        let study = study().unwrap();
        assert_eq!(study.cases.len(), 4);
        for (index, case) in study.cases.iter().enumerate() {
            let error = |method: &str, setting: &str| {
                let of = |c: &&Contender<'_>| c.method == method && c.setting == setting;
                (study.contenders.iter().find(of).unwrap().answer)(index).unwrap().value
            };
            assert!(error("refractivity", "64 waves") < 3e-3, "{case:?}: {}", error("refractivity", "64 waves"));
            assert!(error("wavelength", "64 waves") < 3e-3, "{case:?}");
            assert!(error("refractivity", "64 waves") <= error("refractivity", "8 waves") + 1e-3, "{case:?}");
        }
    }
}
