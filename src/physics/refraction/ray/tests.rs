//! Rays held against other programs' numbers, and against what holds for every ray.

use proptest::prelude::*;

use super::*;
use crate::physics::air::presets;
use crate::physics::air::profile::{Profile, Row};
use crate::physics::air::us76;

const GLOBE_M: f64 = 6_371_000.0;
const TOP_M: f64 = 1e5;

fn preset(name: &str) -> Profile {
    presets::named(name).unwrap().unwrap().profile
}

fn rows(pairs: &[(f64, f64)]) -> Profile {
    let rows: Vec<Row> =
        pairs.iter().map(|&(height_m, temperature_k)| Row { height_m, temperature_k, humidity_percent: 0.0 }).collect();
    Profile::new(&rows, us76::P0_PA).unwrap()
}

fn trace(name: &str, medium: &Medium<'_>, altitude_arcmin: f64, height_m: f64) -> Ray {
    let launch = Launch { apparent_altitude: Angle::arcminutes(altitude_arcmin), height_m };
    let method = method(name, None).unwrap();
    method.prepare(medium, Angle::arcseconds(0.001)).unwrap().trace(&launch).unwrap()
}

/// Every row and wavelength of the shared table, both radii of the Earth; the figure to stay below is 0.001 arcsecond.
#[test]
fn the_exact_method_gives_the_reference_refraction_of_the_standard_atmosphere() {
    let air = us76::profile();
    let table = include_str!("../../../../fixtures/reference/refraction_us76.csv");
    let mut lines = table.lines().filter(|line| !line.starts_with('#'));
    let micrometres = |column: &str| column.trim_start_matches("R_arcsec_").trim_end_matches("um").parse::<f64>();
    let wavelengths: Vec<f64> =
        lines.next().unwrap().split(',').skip(4).map(|c| micrometres(c).unwrap() * 1e3).collect();
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split(',').map(|f| f.parse().unwrap_or(f64::NAN)).collect()).collect();
    let mut checked = 0;
    for radius in [6_371_000.0, 6_378_120.0] {
        for (column, &nm) in wavelengths.iter().enumerate() {
            let medium = Medium::new(&air, nm, radius, TOP_M).unwrap();
            for row in rows.iter().filter(|row| row[0] == radius) {
                let ray = trace("exact", &medium, (90.0 - row[2]) * 60.0, row[1]);
                let error = (ray.refraction.to_arcseconds() - row[4 + column]).abs();
                assert!(error < 0.001, "{row:?} {nm}: {} {error}", ray.refraction.to_arcseconds());
                if nm == 550.0 && row[3].is_finite() {
                    assert!((ray.tangent_height_m.unwrap() - row[3]).abs() < 0.01, "{row:?}");
                }
                checked += 1;
            }
        }
    }
    assert_eq!(checked, 1100);
}

/// The two mirages of A. T. Young, 450 to 700 nm. Near a fold a rounding of the printed altitude is worth more than 0.05".
#[test]
fn the_exact_method_gives_the_reference_transfer_curves_of_mirages() {
    let table = include_str!("../../../../fixtures/reference/mirage_transfer.csv");
    let lines: Vec<Vec<&str>> =
        table.lines().filter(|l| l.starts_with("young")).map(|l| l.split(',').collect()).collect();
    let (mut checked, mut near_folds) = (0, 0);
    for (column, nm) in [450.0, 500.0, 550.0, 650.0, 700.0].into_iter().enumerate() {
        for (name, preset_name) in
            [("young_opn1999_inferior_mirage", "omega"), ("young_opn1999_mock_mirage", "mock-mirage")]
        {
            let air = preset(preset_name);
            let medium = Medium::new(&air, nm, GLOBE_M, TOP_M).unwrap();
            for line in lines.iter().filter(|line| line[0] == name) {
                let (altitude, height): (f64, f64) = (line[2].parse().unwrap(), line[1].parse().unwrap());
                let ray = trace("exact", &medium, altitude, height);
                let Ok(reference) = line[4 + column].parse::<f64>() else {
                    assert_eq!(ray.outcome, Outcome::Ground, "{line:?} {nm}");
                    continue;
                };
                let error = (ray.refraction.to_arcseconds() - reference).abs();
                // How much a last printed digit of the altitude moves the refraction: the slope here.
                let beside = trace("exact", &medium, altitude + 1e-5, height);
                let per_digit = ((beside.refraction - ray.refraction).to_arcseconds() * 0.1).abs();
                near_folds += usize::from(error > 0.001 + per_digit);
                assert!(error < 0.05, "{line:?} {nm}: {} {error}", ray.refraction.to_arcseconds());
                checked += 1;
            }
        }
    }
    assert!(checked > 850, "{checked}");
    assert!(near_folds <= 10, "{near_folds} rows differ by more than 0.001\" and their printed altitude explains");
}

/// 16 rays in 50 digits by tanh-sinh quadrature: refraction and length of path.
#[test]
fn refraction_and_length_are_those_of_fifty_digits() {
    let table = include_str!("../../../../fixtures/reference/ray_cases.csv");
    for line in table.lines().filter(|line| !line.starts_with(['#', 'p'])) {
        let field: Vec<&str> = line.split(',').collect();
        let at = |i: usize| field[i].parse::<f64>().unwrap();
        let air = match field[0] {
            "near-duct" => near_duct(),
            name => preset(name),
        };
        let medium = Medium::new(&air, 550.0, GLOBE_M, TOP_M).unwrap();
        let (exact, steps) = (trace("exact", &medium, at(2), at(1)), trace("runge-kutta", &medium, at(2), at(1)));
        assert!((exact.refraction.to_arcseconds() - at(3)).abs() < 1e-6, "{line} {}", exact.refraction.to_arcseconds());
        assert!((exact.path_length_m - at(4)).abs() < 1e-4, "{line} {}", exact.path_length_m);
        assert!((steps.refraction.to_arcseconds() - at(3)).abs() < 1e-3, "{line} {}", steps.refraction.to_arcseconds());
        assert!((steps.path_length_m - at(4)).abs() < 0.1, "{line} {}", steps.path_length_m);
    }
}

/// +0.115 K/m over 30 m: level rays bend 0.9 times as much as the Earth.
fn near_duct() -> Profile {
    rows(&[(0.0, 288.15), (30.0, 291.60), (11e3, 216.65), (20e3, 216.65)])
}

/// The pilot of the reference: 300 layers of equal molecule count -3.016", 3000 layers -2.937" at the horizon.
#[test]
fn lehn_as_in_the_thesis_has_its_known_floor() {
    let air = us76::profile();
    let medium = Medium::new(&air, 550.0, GLOBE_M, TOP_M).unwrap();
    let launch = Launch { apparent_altitude: Angle::ZERO, height_m: 0.0 };
    for (layers, error) in [(300, -3.016), (3000, -2.937)] {
        let lehn = lehn::Lehn { grid: lehn::Grid::EqualMolecules, layers: Some(layers) };
        let ray = lehn.prepare(&medium, Angle::arcseconds(1.0)).unwrap().trace(&launch).unwrap();
        let got = ray.refraction.to_arcseconds() - 1980.5461;
        assert!((got - error).abs() < 0.02, "{layers}: {got}");
        assert!(
            ray.believed_error.to_arcseconds() > 2.9,
            "the missing air above 35 km is known: {}",
            ray.believed_error.to_arcseconds()
        );
    }
}

#[test]
fn three_hundred_layers_on_the_knots_stay_within_one_and_a_half_arcseconds() {
    let mut worst = Vec::new();
    for name in presets::NAMES {
        let preset = presets::named(name).unwrap().unwrap();
        let eye = preset.observer_height_m.unwrap();
        let medium = Medium::new(&preset.profile, 550.0, GLOBE_M, TOP_M).unwrap();
        let lehn = lehn::Lehn { grid: lehn::Grid::Knots, layers: Some(300) };
        let tracer = lehn.prepare(&medium, Angle::arcseconds(1.0)).unwrap();
        let mut most: (f64, f64) = (0.0, 0.0);
        for step in -100..=600 {
            let altitude = f64::from(step) * 0.1 + 0.013;
            let launch = Launch { apparent_altitude: Angle::arcminutes(altitude), height_m: eye };
            let (exact, parabolas) = (trace("exact", &medium, altitude, eye), tracer.trace(&launch).unwrap());
            if exact.outcome == Outcome::Escaped && parabolas.outcome == Outcome::Escaped {
                let error = (parabolas.refraction - exact.refraction).to_arcseconds().abs();
                most = if error > most.0 { (error, altitude) } else { most };
            }
        }
        worst.push((name, most));
    }
    println!("{worst:?}");
    assert!(worst.iter().all(|(_, most)| most.0 < 1.5), "{worst:?}");
}

/// The vertical depth of the standard atmosphere at 550 nm by Bodhaine et al.: 0.09707 (their gravity is that of 45 degrees).
#[test]
fn the_vertical_rayleigh_depth_is_bodhaines() {
    let air = us76::profile();
    let medium = Medium::new(&air, 550.0, GLOBE_M, TOP_M).unwrap();
    for name in METHODS {
        let ray = trace(name, &medium, 5400.0, 0.0);
        assert!((ray.depths.rayleigh - 0.09707).abs() < 0.0007, "{name}: {}", ray.depths.rayleigh);
        assert!(ray.refraction.to_arcseconds().abs() < 1e-6);
    }
}

#[test]
fn a_duct_traps_level_rays_and_lets_steep_ones_go() {
    // +1 K/m over 10 m: far beyond the 0.129 K/m at which light follows the globe.
    let air = rows(&[(0.0, 283.0), (60.0, 283.0), (70.0, 293.0), (11e3, 222.0)]);
    let medium = Medium::new(&air, 550.0, GLOBE_M, TOP_M).unwrap();
    assert!(medium.bending(65.0) > 5.0 && medium.bending(65.0) < 10.0, "{}", medium.bending(65.0));
    for name in METHODS {
        for (altitude, outcome) in [
            (0.0, Outcome::Trapped),
            (2.0, Outcome::Trapped),
            (-2.0, Outcome::Trapped),
            (30.0, Outcome::Escaped),
            (-30.0, Outcome::Ground),
        ] {
            let ray = trace(name, &medium, altitude, 65.0);
            assert_eq!(ray.outcome, outcome, "{name} {altitude}'");
            assert!(ray.refraction.is_finite() && ray.path_length_m.is_finite());
            assert!(ray.steps < 200_000);
        }
    }
}

/// k = 1 for blue, not for red: where the gradient lies between 0.1258 and 0.1299 K/m (288 K), blue light alone is trapped.
#[test]
fn blue_light_is_ducted_before_red() {
    let air = rows(&[(0.0, 288.0), (10.0, 288.0), (40.0, 288.0 + 30.0 * 0.1284), (11e3, 222.0)]);
    let [blue, red] = [400.0, 700.0].map(|nm| {
        let medium = Medium::new(&air, nm, GLOBE_M, TOP_M).unwrap();
        (medium.bending(20.0), trace("exact", &medium, 0.0, 20.0).outcome)
    });
    assert!(blue.0 > 1.0 && red.0 < 1.0, "{blue:?} {red:?}");
    assert_eq!((blue.1, red.1), (Outcome::Trapped, Outcome::Escaped));
}

#[test]
fn what_cannot_be_is_refused() {
    let air = us76::profile();
    assert!(matches!(Medium::new(&air, 250.0, GLOBE_M, TOP_M), Err(MediumError::Air(_))));
    assert!(matches!(Medium::new(&air, 550.0, 0.0, TOP_M), Err(MediumError::Radius(_))));
    for top in [0.0, -1.0, f64::NAN, 1e9] {
        assert!(matches!(Medium::new(&air, 550.0, GLOBE_M, top), Err(MediumError::Top { .. })), "{top}");
    }
    let medium = Medium::new(&air, 550.0, GLOBE_M, 5e3).unwrap();
    for name in METHODS {
        let tracer = method(name, None).unwrap().prepare(&medium, Angle::arcseconds(1.0)).unwrap();
        let at = |degrees: f64, height_m: f64| {
            tracer.trace(&Launch { apparent_altitude: Angle::degrees(degrees), height_m })
        };
        assert!(matches!(at(91.0, 0.0), Err(RayError::Altitude(_))), "{name}");
        assert!(matches!(at(f64::NAN, 0.0), Err(RayError::Altitude(_))));
        for height in [5e3, 8e3, -1.0, f64::NAN] {
            assert!(matches!(at(0.0, height), Err(RayError::Height { .. })), "{name} {height}");
        }
        for arcsec in [0.0, -1.0, f64::NAN] {
            assert!(matches!(
                method(name, None).unwrap().prepare(&medium, Angle::arcseconds(arcsec)),
                Err(RayError::Tolerance(_))
            ));
        }
    }
    assert!(matches!(
        method("lehn", Some(0)).unwrap().prepare(&medium, Angle::arcseconds(1.0)),
        Err(RayError::Layers(0))
    ));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// Refraction falls with altitude in the standard atmosphere, by every method.
    #[test]
    fn refraction_falls_with_altitude_in_the_standard_atmosphere(arcmin in 0.0..5000.0f64, step in 1.0..300.0f64, eye in 0.0..8000.0f64) {
        let air = us76::profile();
        let medium = Medium::new(&air, 550.0, GLOBE_M, TOP_M).unwrap();
        for name in ["exact", "runge-kutta"] {
            let (low, high) = (trace(name, &medium, arcmin, eye), trace(name, &medium, arcmin + step, eye));
            prop_assert!(high.refraction < low.refraction, "{name}");
        }
    }

    /// Passages add up to the whole, in length, bending and depth.
    #[test]
    fn depths_and_lengths_add_up_over_the_layers(arcmin in -12.0..5400.0f64, which in 0..presets::NAMES.len()) {
        let described = presets::named(presets::NAMES[which]).unwrap().unwrap();
        let medium = Medium::new(&described.profile, 500.0, GLOBE_M, TOP_M).unwrap();
        for name in METHODS {
            let ray = trace(name, &medium, arcmin, described.observer_height_m.unwrap());
            let sum = |of: fn(&Crossing) -> f64| ray.crossings.iter().map(of).sum::<f64>();
            prop_assert!((sum(|c| c.path_m) - ray.path_length_m).abs() < 1e-9 * ray.path_length_m);
            prop_assert!((sum(|c| c.depths.rayleigh) - ray.depths.rayleigh).abs() < 1e-9 * ray.depths.rayleigh + 1e-15);
            prop_assert!((sum(|c| c.refraction.to_radians()) - ray.refraction.to_radians()).abs() < 1e-12);
        }
    }

    /// In a vacuum light is straight, and the lengths add up to the chord from the eye to the top.
    #[test]
    fn a_vacuum_bends_nothing_and_lengths_add_up_to_the_chord(arcmin in 0.0..5400.0f64, eye in 0.0..9000.0f64) {
        let air = us76::profile();
        let medium = Medium::new(&air, 550.0, GLOBE_M, TOP_M).unwrap().emptied();
        let (sin, from, to) = (Angle::arcminutes(arcmin).sin(), GLOBE_M + eye, GLOBE_M + TOP_M);
        let chord = ((from * sin).powi(2) + (to - from) * (to + from)).sqrt() - from * sin;
        for name in ["exact", "runge-kutta"] {
            let ray = trace(name, &medium, arcmin, eye);
            prop_assert_eq!(ray.refraction, Angle::ZERO);
            prop_assert!((ray.path_length_m - chord).abs() < 1e-6 * chord, "{name}: {} {chord}", ray.path_length_m);
        }
        // The parabolas lay out the globe as one: at low altitudes they agree too.
        if arcmin < 300.0 {
            let ray = trace("lehn-knots", &medium, arcmin, eye);
            prop_assert!((ray.path_length_m / chord - 1.0).abs() < 2e-3, "{} {chord}", ray.path_length_m);
        }
    }

    /// A ray sent back from where it left the air arrives at the eye: the same length, bending and depth.
    #[test]
    fn reversing_a_ray_returns_it(degrees in 0.05..89.0f64, which in 0..presets::NAMES.len()) {
        let air = preset(presets::NAMES[which]);
        let medium = Medium::new(&air, 550.0, GLOBE_M, TOP_M).unwrap();
        for name in ["exact", "runge-kutta"] {
            let out = trace(name, &medium, degrees * 60.0, 0.0);
            prop_assert_eq!(out.outcome, Outcome::Escaped);
            let at_eye = (1.0 + medium.refractivity(0.0).0) * GLOBE_M;
            let height_m = TOP_M - 1e-6;
            let at_top = (1.0 + medium.refractivity(height_m).0) * (GLOBE_M + height_m);
            let arrival = (at_eye / at_top * Angle::degrees(degrees).cos()).acos();
            let back = trace(name, &medium, -Angle::radians(arrival).to_arcminutes(), height_m);
            prop_assert_eq!(back.outcome, Outcome::Ground, "{}", name);
            prop_assert!((back.refraction - out.refraction).to_arcseconds().abs() < 3e-3, "{name} {}", (back.refraction - out.refraction).to_arcseconds());
            prop_assert!((back.path_length_m / out.path_length_m - 1.0).abs() < 1e-6);
            prop_assert!((back.depths.rayleigh / out.depths.rayleigh - 1.0).abs() < 1e-5);
        }
    }
}
