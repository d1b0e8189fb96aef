//! Rays held against other programs' numbers, and against what holds for every ray.

use super::*;
use crate::physics::air::presets;

const ARCSEC: f64 = 0.001;

/// The exact method's refraction of every row of the shared table for the standard atmosphere, within 0.001 arcsecond.
#[test]
fn the_exact_method_gives_the_reference_refraction_of_the_standard_atmosphere() {
    let air = presets::named("us76").unwrap().unwrap().profile;
    let table = include_str!("../../../../fixtures/reference/refraction_us76.csv");
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let header = lines.next().unwrap();
    let wavelengths: Vec<f64> = header
        .split(',')
        .skip(4)
        .map(|c| c.trim_start_matches("R_arcsec_").trim_end_matches("um").parse::<f64>().unwrap() * 1e3)
        .collect();
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|f| f.parse().unwrap_or(f64::NAN)).collect()).collect();
    let (mut worst, mut checked): (f64, usize) = (0.0, 0);
    for radius in [6_371_000.0, 6_378_120.0] {
        for (column, &nm) in wavelengths.iter().enumerate() {
            let medium = Medium::new(&air, nm, radius, 1e5).unwrap();
            let tracer = exact::Exact.prepare(&medium, Angle::arcseconds(ARCSEC)).unwrap();
            for row in rows.iter().filter(|row| row[0] == radius) {
                let launch = Launch { apparent_altitude: Angle::degrees(90.0 - row[2]), height_m: row[1] };
                let ray = tracer.trace(&launch).unwrap();
                let error = (ray.refraction.to_arcseconds() - row[4 + column]).abs();
                // The lowest rows give z to 1e-6 degree only, which is worth up to 0.003 arcsecond there.
                let printed = if row[2] > 90.0 { 0.5e-6 * 3600.0 * 0.9 } else { 0.0 };
                assert!(error < ARCSEC + printed, "{row:?} {nm}: {} {error}", ray.refraction.to_arcseconds());
                if printed == 0.0 {
                    worst = worst.max(error);
                }
                checked += 1;
            }
        }
    }
    println!("worst {worst} of {checked}");
}
