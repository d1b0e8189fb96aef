//! Extreme air and extreme rays: each either gives finite numbers in bounded steps, or is refused in clear words.

use crate::physics::air::ciddor::refractivity;
use crate::physics::air::presets;
use crate::physics::air::profile::{Profile, Row};
use crate::physics::air::read::{ReadError, from_csv};
use crate::physics::air::us76;
use crate::physics::refraction::ray::{self, Absorber, Launch, Medium, Outcome, Ray};
use crate::units::Angle;

/// One extreme case and how it went.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Extreme {
    /// What was tried.
    pub name: &'static str,
    /// Whether it held.
    pub held: bool,
    /// What came of it.
    pub what: String,
}

/// Tries something, and says what came of it, or why it did not hold.
type Case = fn() -> Result<String, String>;

const GLOBE_M: f64 = 6_371_000.0;
const TOP_M: f64 = 1e5;

/// More steps than this are not bounded.
const MOST_STEPS: usize = 2_100_000;

/// Runs all extreme cases.
#[must_use]
pub fn run() -> Vec<Extreme> {
    let cases: [(&'static str, Case); 18] = [
        ("a duct for all colours", duct_for_all),
        ("a duct for blue only", duct_for_blue),
        ("an eye inside an inversion, and on both its edges", eye_in_inversion),
        ("an eye at 0 m and at 8 km", eye_at_ends),
        ("rays that graze the ground to a millimetre", grazing),
        ("a jump of 10 K in 1 m, warmer or colder above", jump),
        ("a profile with two points", two_points),
        ("a profile with 100,000 points", many_points),
        ("an unsorted profile", || refused_rows("0,288\n100,280\n50,285\n")),
        ("a profile with equal heights", || refused_rows("0,288\n100,280\n100,285\n")),
        ("temperatures at and below 0 K, and NaN", || {
            ["0", "-5", "NaN", "inf"].iter().map(|t| refused_rows(&format!("0,288\n100,{t}\n"))).collect()
        }),
        ("humidity 0 and 100 %", humidity),
        ("wavelengths at the ends, 300 and 1700 nm", || wavelengths(&[300.0, 1700.0])),
        ("wavelengths outside the ends", || {
            let wrong = [299.0, 1701.0, -550.0, f64::NAN];
            wrong.iter().map(|&nm| refused(refractivity(nm, 288.15, us76::P0_PA, 0.0, 450.0))).collect()
        }),
        ("a top below the eye, and no top", low_top),
        ("optical depth above 745", black),
        ("altitude 90 degrees, and -90", vertical),
        ("refraction continuous in altitude", continuous),
    ];
    cases
        .into_iter()
        .map(|(name, case)| match case() {
            Ok(what) => Extreme { name, held: true, what },
            Err(what) => Extreme { name, held: false, what },
        })
        .collect()
}

/// The cases as lines for people.
#[must_use]
pub fn table(extremes: &[Extreme]) -> String {
    let line = |e: &Extreme| format!("{} {:<52} {}\n", if e.held { "held  " } else { "FAILED" }, e.name, e.what);
    extremes.iter().map(line).collect()
}

fn air(pairs: &[(f64, f64)]) -> Result<Profile, String> {
    let row = |&(height_m, temperature_k): &(f64, f64)| Row { height_m, temperature_k, humidity_percent: 0.0 };
    Profile::new(&pairs.iter().map(row).collect::<Vec<_>>(), us76::P0_PA).map_err(|e| e.to_string())
}

/// Traces one ray by all methods; all must end, alike, in bounded steps, with finite numbers.
fn by_all(profile: &Profile, nm: f64, arcmin: f64, height_m: f64) -> Result<Vec<Ray>, String> {
    let medium = Medium::new(profile, nm, GLOBE_M, TOP_M).map_err(|e| e.to_string())?;
    let launch = Launch { apparent_altitude: Angle::arcminutes(arcmin), height_m };
    let mut rays: Vec<Ray> = Vec::new();
    for name in ray::METHODS {
        let method = ray::method(name, name.starts_with("lehn").then_some(3000)).ok_or("no such method")?;
        let tracer = method.prepare(&medium, Angle::arcseconds(0.01)).map_err(|e| e.to_string())?;
        let ray = tracer.trace(&launch).map_err(|e| e.to_string())?;
        let numbers =
            [ray.refraction.to_radians(), ray.path_length_m, ray.depths.rayleigh, ray.believed_error.to_radians()];
        if !numbers.iter().all(|x| x.is_finite()) || ray.steps > MOST_STEPS {
            return Err(format!("{name} at {arcmin}': {numbers:?} in {} steps", ray.steps));
        }
        rays.push(ray);
    }
    Ok(rays)
}

/// All methods must say that a ray ends so.
fn ends(profile: &Profile, nm: f64, arcmin: f64, height_m: f64, outcome: Outcome) -> Result<String, String> {
    let rays = by_all(profile, nm, arcmin, height_m)?;
    for (ray, name) in rays.iter().zip(ray::METHODS) {
        if ray.outcome != outcome {
            return Err(format!(
                "{name} at {arcmin}', {height_m} m, {nm} nm: {}, not {}",
                ray.outcome.word(),
                outcome.word()
            ));
        }
    }
    Ok(outcome.word().to_owned())
}

fn refused<T, E: std::fmt::Display>(result: Result<T, E>) -> Result<String, String> {
    match result {
        Ok(_) => Err("was not refused".to_owned()),
        Err(error) => Ok(format!("refused: {error}; ")),
    }
}

fn refused_rows(rows: &str) -> Result<String, String> {
    refused::<_, ReadError>(from_csv(&format!("height_m,temperature_k\n{rows}")))
}

fn duct_for_all() -> Result<String, String> {
    let duct = air(&[(0.0, 283.0), (60.0, 283.0), (70.0, 293.0), (11e3, 222.0)])?;
    for nm in [380.0, 550.0, 720.0] {
        for arcmin in [-2.0, 0.0, 2.0] {
            ends(&duct, nm, arcmin, 65.0, Outcome::Trapped)?;
        }
        ends(&duct, nm, 30.0, 65.0, Outcome::Escaped)?;
        ends(&duct, nm, -30.0, 65.0, Outcome::Ground)?;
    }
    Ok("level rays trapped, steep ones free, by all methods at 380, 550 and 720 nm".to_owned())
}

fn duct_for_blue() -> Result<String, String> {
    let duct = air(&[(0.0, 288.0), (10.0, 288.0), (40.0, 288.0 + 30.0 * 0.1284), (11e3, 222.0)])?;
    let medium = |nm| Medium::new(&duct, nm, GLOBE_M, TOP_M).map_err(|e| e.to_string());
    let (blue, red) = (medium(400.0)?.bending(20.0), medium(700.0)?.bending(20.0));
    // A hair's breadth: only the methods that follow the index itself can tell.
    for (nm, outcome) in [(400.0, Outcome::Trapped), (700.0, Outcome::Escaped)] {
        let rays = by_all(&duct, nm, 0.0, 20.0)?;
        if rays[0].outcome != outcome || rays[1].outcome != outcome {
            return Err(format!("{nm} nm: {} and {}", rays[0].outcome.word(), rays[1].outcome.word()));
        }
    }
    Ok(format!("k = {blue:.4} at 400 nm: trapped; k = {red:.4} at 700 nm: escaped"))
}

fn eye_in_inversion() -> Result<String, String> {
    let mock = presets::named("mock-mirage").ok_or("no preset")?.map_err(|e| e.to_string())?.profile;
    for height_m in [30.0, 30.0 + 1e-9, 40.0, 50.0 - 1e-9, 50.0] {
        for arcmin in [-60.0, -2.0, -1e-6, 0.0, 1e-6, 2.0, 60.0] {
            by_all(&mock, 550.0, arcmin, height_m)?;
        }
    }
    Ok("finite at 30, 40 and 50 m, also a nanometre beside the edges".to_owned())
}

fn eye_at_ends() -> Result<String, String> {
    let standard = us76::profile();
    ends(&standard, 550.0, 0.0, 0.0, Outcome::Escaped)?;
    ends(&standard, 550.0, -1e-6, 0.0, Outcome::Ground)?;
    ends(&standard, 550.0, -100.0, 8000.0, Outcome::Escaped)?;
    ends(&standard, 550.0, -170.0, 8000.0, Outcome::Ground)?;
    Ok("escaped above the horizon, ground below it".to_owned())
}

fn grazing() -> Result<String, String> {
    let standard = us76::profile();
    let medium = Medium::new(&standard, 550.0, GLOBE_M, TOP_M).map_err(|e| e.to_string())?;
    // The altitude whose invariant is n r at a height: cos a = n(z) r(z)/(n(eye) r(eye)), formed without cancellation.
    let (eye, (n_eye, _)) = (60.0, medium.refractivity(60.0));
    let altitude = |z: f64| {
        let n = medium.refractivity(z).0;
        let lack = ((1.0 + n_eye) * (eye - z) + (n_eye - n) * (GLOBE_M + z)) / ((1.0 + n_eye) * (GLOBE_M + eye));
        -Angle::radians(2.0 * (0.5 * lack).sqrt().asin()).to_arcminutes()
    };
    ends(&standard, 550.0, altitude(1e-3), eye, Outcome::Escaped)?;
    let rays = by_all(&standard, 550.0, altitude(1e-3), eye)?;
    let tangents: Vec<f64> = rays.iter().filter_map(|ray| ray.tangent_height_m).collect();
    let miss = tangents.iter().take(2).map(|z| (z - 1e-3).abs()).fold(0.0, f64::max);
    if tangents.len() < 4 || miss > 1e-4 {
        return Err(format!("tangent heights {tangents:?} m instead of 0.001 m"));
    }
    ends(&standard, 550.0, altitude(0.0) - 1e-4, eye, Outcome::Ground)?;
    Ok(format!("escaped at 1 mm (tangent height within {miss:.0e} m), ground a hair lower"))
}

fn jump() -> Result<String, String> {
    for (below, above) in [(283.0, 293.0), (293.0, 283.0)] {
        let air = air(&[(0.0, below), (20.0, below), (21.0, above), (11e3, 220.0)])?;
        for arcmin in [-40.0, -5.0, -1.0, 0.0, 1.0, 5.0, 40.0] {
            for height_m in [2.0, 20.5, 30.0] {
                by_all(&air, 550.0, arcmin, height_m)?;
            }
        }
    }
    Ok("finite, by all methods, 42 rays".to_owned())
}

fn two_points() -> Result<String, String> {
    ends(&air(&[(0.0, 288.15), (11e3, 216.65)])?, 550.0, 0.0, 2.0, Outcome::Escaped)
}

fn many_points() -> Result<String, String> {
    let points: Vec<(f64, f64)> =
        (0..100_000).map(|i| f64::from(i) * 0.5).map(|z| (z, 288.15 - 1.4e-3 * z + 0.05 * (z * 1e-2).sin())).collect();
    let rays = by_all(&air(&points)?, 550.0, 0.0, 2.0)?;
    if rays.iter().any(|ray| ray.outcome != Outcome::Escaped) {
        return Err("the level ray did not escape".to_owned());
    }
    let [exact, steps] = [&rays[0], &rays[1]].map(|ray| ray.refraction.to_arcseconds());
    if (exact - steps).abs() > 0.05 {
        return Err(format!("{exact}\" by quadrature, {steps}\" by steps"));
    }
    Ok(format!("{exact:.3}\" in {} panels; by steps {steps:.3}\" in {}", rays[0].steps, rays[1].steps))
}

fn humidity() -> Result<String, String> {
    let row = |height_m, temperature_k, humidity_percent| Row { height_m, temperature_k, humidity_percent };
    let refraction = |percent| {
        let rows = [row(0.0, 303.15, percent), row(11e3, 216.65, percent), row(47e3, 270.65, percent)];
        let humid = Profile::new(&rows, us76::P0_PA).map_err(|e| e.to_string())?;
        Ok::<f64, String>(by_all(&humid, 550.0, 0.0, 2.0)?[0].refraction.to_arcseconds())
    };
    let (dry, wet) = (refraction(0.0)?, refraction(100.0)?);
    if wet >= dry {
        return Err(format!("wet air of 30 C bends {wet}\", dry air {dry}\""));
    }
    Ok(format!("at 30 C the horizon is lifted {dry:.1}\" by dry air, {wet:.1}\" by saturated air"))
}

fn wavelengths(wavelengths_nm: &[f64]) -> Result<String, String> {
    let standard = us76::profile();
    let lift =
        |&nm: &f64| Ok(format!("{:.1}\" at {nm} nm; ", by_all(&standard, nm, 0.0, 2.0)?[0].refraction.to_arcseconds()));
    wavelengths_nm.iter().map(lift).collect()
}

fn low_top() -> Result<String, String> {
    let standard = us76::profile();
    let at = |top_m: f64| {
        let medium = Medium::new(&standard, 550.0, GLOBE_M, top_m).map_err(|e| e.to_string())?;
        let tracer =
            ray::Method::prepare(&ray::exact::Exact, &medium, Angle::arcseconds(0.01)).map_err(|e| e.to_string())?;
        tracer.trace(&Launch { apparent_altitude: Angle::ZERO, height_m: 8e3 }).map_err(|e| e.to_string())
    };
    [5e3, 8e3, 0.0, f64::NAN].into_iter().map(|top_m| refused(at(top_m))).collect()
}

/// Haze so thick that e^-τ is no number above zero.
struct Soot;

impl Absorber for Soot {
    fn per_m(&self, height_m: f64) -> f64 {
        0.1 * (-height_m / 2000.0).exp()
    }

    fn knots_m(&self) -> &[f64] {
        &[]
    }
}

fn black() -> Result<String, String> {
    let standard = us76::profile();
    let medium = Medium::new(&standard, 550.0, GLOBE_M, TOP_M).map_err(|e| e.to_string())?.with_aerosol(&Soot);
    let mut depths = Vec::new();
    for name in ray::METHODS {
        let tracer = ray::method(name, None)
            .ok_or("no method")?
            .prepare(&medium, Angle::arcseconds(0.1))
            .map_err(|e| e.to_string())?;
        let ray = tracer.trace(&Launch { apparent_altitude: Angle::ZERO, height_m: 2.0 }).map_err(|e| e.to_string())?;
        depths.push(ray.depths.aerosol);
    }
    let (least, most) = depths.iter().fold((f64::MAX, 0f64), |(a, b), &x| (a.min(x), b.max(x)));
    let light = (-least).exp();
    if !(least > 745.0 && most / least < 1.01 && light == 0.0) {
        return Err(format!("depths {depths:?}"));
    }
    Ok(format!("depth {least:.0} to {most:.0} by the four methods: finite, and e^-depth is exactly 0"))
}

fn vertical() -> Result<String, String> {
    let standard = us76::profile();
    for (degrees, outcome) in [(90.0, Outcome::Escaped), (-90.0, Outcome::Ground)] {
        ends(&standard, 550.0, degrees * 60.0, 45.0, outcome)?;
        for (ray, name) in by_all(&standard, 550.0, degrees * 60.0, 45.0)?.iter().zip(ray::METHODS) {
            if ray.refraction.to_arcseconds().abs() > 1e-9 {
                return Err(format!("{name} bends a vertical ray by {}\"", ray.refraction.to_arcseconds()));
            }
        }
    }
    Ok("no bending, by all methods".to_owned())
}

fn continuous() -> Result<String, String> {
    let mut worst = 0f64;
    let standard = us76::profile();
    let medium = Medium::new(&standard, 550.0, GLOBE_M, TOP_M).map_err(|e| e.to_string())?;
    for name in ["exact", "runge-kutta"] {
        let tracer = ray::method(name, None)
            .ok_or("no method")?
            .prepare(&medium, Angle::arcseconds(1e-4))
            .map_err(|e| e.to_string())?;
        let mut before: Option<f64> = None;
        for i in -1000..1000 {
            let launch = Launch { apparent_altitude: Angle::arcseconds(f64::from(i) * 0.01), height_m: 60.0 };
            let refraction = tracer.trace(&launch).map_err(|e| e.to_string())?.refraction.to_arcseconds();
            // Over 0.01" the refraction changes by about 0.002".
            worst = worst.max(before.map_or(0.0, |before| (refraction - before).abs()));
            before = Some(refraction);
        }
    }
    if worst > 0.004 {
        return Err(format!("a step of {worst}\""));
    }
    Ok(format!("2000 rays 0.01\" apart across the level differ by at most {worst:.4}\""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_extreme_case_holds() {
        let extremes = run();
        let failed: Vec<_> = extremes.iter().filter(|extreme| !extreme.held).collect();
        assert!(failed.is_empty(), "{failed:#?}");
        assert_eq!(table(&extremes).lines().count(), extremes.len());
    }
}
