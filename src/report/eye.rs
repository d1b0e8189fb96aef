//! The models of the eye held against tables of independent implementations.

use super::stability::Extreme;
use crate::eye::crumey::{self, ONE_EYE, Range};
use crate::eye::lamp::scotopic_trolands;
use crate::eye::tone::{Adapted, Method, PROJECTOR_CONTRAST, display_luminance, least_adaptation_cd_m2};
use crate::eye::{Adaptation, Model, Patch, Reading, Viewing, blackwell, limit, rods};
use crate::units::SurfaceBrightness;

/// What is asked: so much of a dex or a magnitude, or relative, or half of the last digit that the table prints.
const ASKED: f64 = 1e-3;

/// How one table agrees.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Agreement {
    /// The file.
    pub table: &'static str,
    /// What is compared.
    pub what: &'static str,
    /// How many numbers.
    pub compared: usize,
    /// The greatest difference, in dex or magnitudes, or relative for `relative` ones.
    pub worst: f64,
    /// The greatest difference as a share of what is asked: 1 or less holds.
    pub share: f64,
}

/// A number of ours, the cell of the table, and whether the difference is taken relative to it.
type Pair<'a> = (f64, &'a str, bool);

/// A table: its file, what it holds, and our numbers for the cells of a row.
type Table = (&'static str, &'static str, fn(&[&str]) -> Vec<(f64, usize, bool)>);

const TABLES: [Table; 7] = [
    ("crumey_check.csv", "Crumey's threshold, night to day", thresholds),
    ("odm_check.csv", "contrast, threshold and reserve, both models", reserves),
    ("crumey_telescope_limit.csv", "stars through a telescope", limits),
    ("sqm_conversion.csv", "stars to the naked eye", naked_eye),
    ("tumblin_rushmeier_check.csv", "the 1993 operator where it holds", toned),
    ("tvi_check.csv", "thresholds of rods and cones", lit),
    ("adaptation_check.csv", "bleach, loss and recovery", recovered),
];

/// Holds every table against ours; `read` gives a file's text.
///
/// # Errors
/// What `read` says, or a table without a number to compare.
pub fn agreements(read: &mut dyn FnMut(&str) -> Result<String, String>) -> Result<Vec<Agreement>, String> {
    TABLES.into_iter().map(|table| agreement(&table, &read(table.0)?)).collect()
}

fn agreement(&(table, what, ours): &Table, text: &str) -> Result<Agreement, String> {
    let mut agreement = Agreement { table, what, compared: 0, worst: 0.0, share: 0.0 };
    for row in text.lines().skip(1) {
        let cells: Vec<&str> = row.split(',').collect();
        let pairs = ours(&cells).into_iter().filter_map(|(ours, column, relative)| {
            cells.get(column).filter(|cell| !cell.is_empty()).map(|cell| (ours, *cell, relative))
        });
        for pair in pairs {
            let (worst, share) = difference(pair).ok_or_else(|| format!("{table}: '{}' is no number", pair.1))?;
            agreement.compared += 1;
            agreement.worst = agreement.worst.max(worst);
            agreement.share = agreement.share.max(share);
        }
    }
    if agreement.compared == 0 {
        return Err(format!("{table} has nothing to compare: give the folder of the tables of the eye"));
    }
    Ok(agreement)
}

/// The difference, and its share of what is asked.
fn difference((ours, cell, relative): Pair<'_>) -> Option<(f64, f64)> {
    let theirs: f64 = cell.parse().ok()?;
    let off = (ours - theirs).abs();
    let asked = if relative { ASKED * theirs.abs() } else { ASKED };
    let share = off / asked.max(1.001 * half_digit(cell)?);
    Some((if relative && theirs != 0.0 { off / theirs.abs() } else { off }, share))
}

/// Half of the last digit that a cell prints.
fn half_digit(cell: &str) -> Option<f64> {
    let (digits, exponent) = cell.split_once(['e', 'E']).unwrap_or((cell, "0"));
    let decimals = digits.split_once('.').map_or(0, |(_, after)| after.len());
    let decimals = i32::try_from(decimals).ok()?;
    Some(0.5 * 10f64.powi(exponent.parse::<i32>().ok()?.checked_sub(decimals)?))
}

/// A number of a row, not a number where there is none.
fn number(cells: &[&str], column: usize) -> f64 {
    cells.get(column).and_then(|cell| cell.parse().ok()).unwrap_or(f64::NAN)
}

fn thresholds(cells: &[&str]) -> Vec<(f64, usize, bool)> {
    let background = SurfaceBrightness(number(cells, 0)).to_candela_per_m2();
    let area = std::f64::consts::FRAC_PI_4 * (number(cells, 2) / 60.0).to_radians().powi(2);
    let at = |range| crumey::log10_threshold(area, background, 1.0, range);
    vec![(at(Range::All), 3, false), (at(Range::Night), 4, false)]
}

fn reserves(cells: &[&str]) -> Vec<(f64, usize, bool)> {
    let n = |column| number(cells, column);
    let object = Patch { v_mag: n(1), major_arcmin: n(2), minor_arcmin: n(3) };
    let viewing = Viewing { transmission: 0.7, field_factor: 2.0 * ONE_EYE, ..Viewing::typical(254.0, n(6)) };
    let of = |model| Reading::of(&object, &viewing, SurfaceBrightness(n(5)), model);
    let (table, crumey) = (of(Model::Blackwell), of(Model::Crumey));
    vec![
        (table.log10_contrast, 8, false),
        (table.log10_threshold, 9, false),
        (table.reserve(), 10, false),
        (crumey.log10_threshold, 12, false),
        (crumey.reserve(), 13, false),
    ]
}

fn limits(cells: &[&str]) -> Vec<(f64, usize, bool)> {
    let viewing = Viewing::typical(number(cells, 0), number(cells, 2));
    vec![(limit::through_telescope(&viewing, SurfaceBrightness(number(cells, 1))).0, 6, false)]
}

fn naked_eye(cells: &[&str]) -> Vec<(f64, usize, bool)> {
    vec![(limit::naked_eye(SurfaceBrightness(number(cells, 0)), crumey::TYPICAL_OBSERVER).0, 5, false)]
}

fn toned(cells: &[&str]) -> Vec<(f64, usize, bool)> {
    let (world_cd_m2, display_cd_m2) = (number(cells, 0), number(cells, 1));
    let least = least_adaptation_cd_m2(Method::Tr93);
    if world_cd_m2 < least || display_cd_m2 < least {
        return Vec::new();
    }
    let adapted = Adapted { world_cd_m2, display_cd_m2, contrast: PROJECTOR_CONTRAST };
    vec![(display_luminance(Method::Tr93, &adapted, number(cells, 2)).display_cd_m2, 7, true)]
}

fn lit(cells: &[&str]) -> Vec<(f64, usize, bool)> {
    let luminance = number(cells, 0);
    vec![
        (rods::rod_threshold_cd_m2(luminance), 1, true),
        (rods::cone_threshold_cd_m2(luminance), 2, true),
        (rods::rod_elevation_dex(luminance), 3, false),
    ]
}

fn recovered(cells: &[&str]) -> Vec<(f64, usize, bool)> {
    // The name of a light may hold no comma; the columns count from the ratio on.
    let (scotopic, photopic) = (number(cells, 1) * number(cells, 2), number(cells, 2));
    let eye = Adaptation::default().after_scotopic(scotopic, photopic, number(cells, 3));
    vec![
        (scotopic_trolands(scotopic, number(cells, 4)), 6, true),
        (eye.bleached(), 7, true),
        (rods::rod_elevation_dex(scotopic), 8, false),
        (eye.elevation_dex(), 9, false),
        (eye.loss_magnitudes(), 10, false),
        (eye.minutes_to(0.3), 11, true),
        (eye.minutes_until_back(), 12, true),
    ]
}

/// What is tried, and how.
type Case = (&'static str, fn() -> Result<String, String>);

/// Extreme skies, lights and adaptations: each gives finite numbers, clamped and told where a model does not hold.
#[must_use]
pub fn extremes() -> Vec<Extreme> {
    let cases: [Case; 4] = [
        ("tone at adaptations of 0, 1e-8 and 1e4 cd/m2", tone_extremes),
        ("skies of 16 and 22.2, objects of 1e-3' and 180 degrees", sky_extremes),
        ("Blackwell's table outside its edges", table_extremes),
        ("lights of 0, 1e-8 and 1e4 cd/m2 for 0 s and a year", light_extremes),
    ];
    let tried = cases.into_iter().map(|(name, case)| (name, case()));
    tried
        .map(|(name, result)| match result {
            Ok(what) => Extreme { name, held: true, what },
            Err(what) => Extreme { name, held: false, what },
        })
        .collect()
}

fn tone_extremes() -> Result<String, String> {
    let mut clamped = 0;
    for method in Method::ALL {
        for world_cd_m2 in [0.0, 1e-8, 1e4] {
            for display_cd_m2 in [0.0, 1e-8, 1e4] {
                let adapted = Adapted { world_cd_m2, display_cd_m2, contrast: PROJECTOR_CONTRAST };
                let toned = [0.0, 1e-8, 1.0, 1e4].map(|luminance| display_luminance(method, &adapted, luminance));
                if !toned.iter().all(|toned| toned.display_cd_m2.is_finite()) {
                    return Err(format!("{method} at {world_cd_m2} and {display_cd_m2}: {toned:?}"));
                }
                if toned.windows(2).any(|pair| pair[0].display_cd_m2 > pair[1].display_cd_m2) {
                    return Err(format!("{method} at {world_cd_m2} and {display_cd_m2} turns brightness round"));
                }
                clamped += usize::from(toned[0].clamped);
            }
        }
    }
    Ok(format!("{clamped} of 36 clamped and told"))
}

fn sky_extremes() -> Result<String, String> {
    for sky in [16.0, 22.2] {
        let viewing = Viewing::typical(254.0, 104.0);
        let star = limit::through_telescope(&viewing, SurfaceBrightness(sky)).0;
        for arcmin in [1e-3, 10_800.0] {
            let object = Patch { v_mag: 8.0, major_arcmin: arcmin, minor_arcmin: arcmin };
            for model in [Model::Crumey, Model::Blackwell] {
                let reserve = Reading::of(&object, &viewing, SurfaceBrightness(sky), model).reserve();
                if !reserve.is_finite() || !star.is_finite() {
                    return Err(format!("{model} under {sky} at {arcmin}': {reserve}, stars to {star}"));
                }
            }
        }
    }
    Ok("finite".into())
}

fn table_extremes() -> Result<String, String> {
    for (arcmin, background) in [(1e-9, 22.0), (1e9, 22.0), (10.0, -50.0), (10.0, 99.0)] {
        let found = blackwell::threshold(arcmin, background);
        if !found.clamped || !(-2.6..4.7).contains(&found.log10) {
            return Err(format!("{arcmin}' over {background}: {found:?}"));
        }
    }
    Ok("the edge is taken and told".into())
}

fn light_extremes() -> Result<String, String> {
    let mut most: f64 = 0.0;
    for luminance in [0.0, 1e-8, 1e4] {
        for seconds in [0.0, 3.2e7] {
            let eye = Adaptation::default().after_scotopic(luminance, luminance, seconds);
            let (loss, minutes) = (eye.loss_magnitudes(), eye.minutes_until_back());
            if !loss.is_finite() || !minutes.is_finite() {
                return Err(format!("{luminance} cd/m2 for {seconds} s: {loss} mag, {minutes} minutes"));
            }
            most = most.max(minutes);
        }
    }
    Ok(format!("back in at most {most:.0} minutes"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_holds_to_what_is_asked() {
        let mut read = |name: &str| {
            std::fs::read_to_string(format!("fixtures/reference/eye/{name}")).map_err(|error| error.to_string())
        };
        for agreement in agreements(&mut read).unwrap() {
            assert!(agreement.share <= 1.0 && agreement.compared > 10, "{agreement:?}");
        }
    }

    #[test]
    fn every_extreme_case_holds() {
        assert!(extremes().iter().all(|extreme| extreme.held), "{:?}", extremes());
    }

    #[test]
    fn half_of_the_last_digit_is_read_from_how_a_number_is_printed() {
        assert_eq!(half_digit("12.69"), Some(0.005));
        assert!((half_digit("9.0537e-09").unwrap() / 5e-14 - 1.0).abs() < 1e-9);
        assert_eq!(half_digit("7"), Some(0.5));
    }

    #[test]
    fn a_table_without_numbers_is_refused() {
        assert!(agreements(&mut |_| Ok("header\n".into())).unwrap_err().contains("nothing to compare"));
    }
}
