//! Photons through spheres of dust, and the scattering table, as a user asks for them: against closed forms and another program's photons.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use scotopic::physics::dust::phase::HenyeyGreenstein;
use scotopic::physics::dust::sphere::Source;
use scotopic::physics::dust::table::{Accuracy, Depth, Length, Parameters, Spacing, file, shared};
use serde_json::Value;

/// Depth, albedo, g and so on of another program's spheres, two million photons each.
const SPHERES: &str = include_str!("../fixtures/reference/sphere_mc.csv");
/// The same, by angle.
const ANGLES: &str = include_str!("../fixtures/reference/sphere_mc_angular_72.csv");
/// Photons of that program.
const THEIR_PHOTONS: f64 = 1_999_872.0;

fn scotopic(arguments: &[&str], threads: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_scotopic"))
        .args(arguments)
        .env("RAYON_NUM_THREADS", threads)
        .env("XDG_CACHE_HOME", folder("cache-of-all"))
        .output()
        .unwrap()
}

fn json(arguments: &[&str]) -> Value {
    let output = scotopic(arguments, "2");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// A folder of the tests' own.
fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("photons").join(name);
    std::fs::create_dir_all(&path).unwrap();
    path
}

fn number(told: &Value, key: &str) -> f64 {
    assert!(told[key].is_number(), "{key} in {told}");
    told[key].as_f64().unwrap()
}

fn photons(more: &str) -> Value {
    let line = format!("nebula photons --json --quiet {more}");
    json(&line.split_whitespace().collect::<Vec<_>>())
}

/// How far two numbers are apart, in standard errors.
fn apart(a: f64, a_error: f64, b: f64, b_error: f64) -> f64 {
    (a - b).abs() / a_error.hypot(b_error)
}

#[test]
fn photons_agree_with_the_closed_form_with_another_program_and_with_the_conservation_of_light() {
    for line in SPHERES.lines().skip(1).filter(|line| ["0.1,", "5,"].iter().any(|depth| line[2..].starts_with(depth))) {
        let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let source = Source::ALL[row[0] as usize].1;
        let told = photons(&format!(
            "--tau-radius {} --albedo {} --g {} --source {source} --photons 20000 --seed 5",
            row[1], row[2], row[3]
        ));
        let of = |key: &str| number(&told, key);
        assert!((of("unscattered") + of("scattered") + of("absorbed") - 1.0).abs() < 1e-12, "{told}");
        let passed = of("unscattered_closed_form");
        assert!(apart(of("unscattered"), of("unscattered_error"), passed, 0.0) < 4.0, "{told}");
        let theirs = row[7].max(1.0 / THEIR_PHOTONS);
        assert!(apart(of("scattered"), of("scattered_error"), row[6], theirs) < 4.0, "{line} {told}");
        // They count scatterings until a photon is fainter than theirs may be, which matters in deep dust that absorbs.
        if row[2] == 1.0 || row[1] < 1.0 {
            let theirs = of("mean_scatterings_error") * (2e4 / THEIR_PHOTONS).sqrt();
            let apart = apart(of("mean_scatterings"), of("mean_scatterings_error"), row[11], theirs + 5e-5);
            assert!(apart < 4.0, "{line} {told}");
        }
        // Their cosine is against the axis, which for light from within is no first direction.
        if row[0] < 2.0 {
            let theirs = of("mean_cosine_error") * (2e4 / THEIR_PHOTONS).sqrt();
            assert!(apart(of("mean_cosine"), of("mean_cosine_error"), row[10], theirs) < 4.0, "{line} {told}");
        }
    }
}

#[test]
fn light_that_is_never_absorbed_scatters_four_thirds_of_the_depth_whatever_g_is() {
    for g in ["-0.9", "0", "0.6", "0.999999"] {
        for depth in [0.2, 3.0, 40.0] {
            let told = photons(&format!("--tau-radius {depth} --albedo 1 --g {g} --source beam --photons 10000"));
            let (mean, error) = (number(&told, "mean_scatterings"), number(&told, "mean_scatterings_error"));
            assert!(apart(mean, error, 4.0 * depth / 3.0, 0.0) < 4.0, "g {g}, depth {depth}: {mean} +- {error}");
            assert!((number(&told, "unscattered") + number(&told, "scattered") - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn black_dust_scatters_nothing_and_says_no_cosine() {
    let told = photons("--tau-radius 2 --albedo 0 --source uniform --photons 5000");
    assert_eq!((number(&told, "scattered"), number(&told, "scattered_error")), (0.0, 0.0));
    assert!(told["mean_cosine"].is_null());
}

#[test]
fn a_photon_that_scatters_for_ever_is_given_up_and_told() {
    let output = scotopic(
        &"nebula photons --tau-radius 1000 --albedo 1 --source centre --photons 3000 --most-scatterings 500 --most-events 1e5 --json --quiet"
            .split_whitespace()
            .collect::<Vec<_>>(),
        "2",
    );
    let told: Value = serde_json::from_slice(&output.stdout).unwrap();
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(words.contains("of 3000 photons") && words.contains("still under way"), "{words}");
    assert!(number(&told, "unfinished") > 0.99 && number(&told, "photons") < 3000.0);
}

#[test]
fn what_cannot_be_is_refused_with_its_value() {
    for (line, word) in [
        ("photons --tau-radius NaN", "NaN"),
        ("photons --tau-radius -1", "-1"),
        ("photons --tau-radius 1 --albedo 1.5", "1.5"),
        ("photons --tau-radius 1 --g -2", "-2"),
        ("photons --tau-radius 1 --threshold 0.1", "1e-10"),
        ("photons --tau-radius 1 --photons 0", "0"),
        ("photons --tau-radius 1 --source lamp", "lamp"),
        ("table --out t.csv --albedo -0.1", "-0.1"),
        ("table --out t.csv --depths 1", "1 depths"),
        ("table --out t.csv --tau-max -3", "-3"),
        ("table --out t.csv --relative-error 0", "0"),
        ("table --out t.csv --source centre", "outside"),
        ("table --out t.csv --spacing wide", "wide"),
        ("table --out t.bmp", ".csv"),
        ("table", "--out"),
    ] {
        let words: Vec<&str> = ["nebula"].into_iter().chain(line.split_whitespace()).collect();
        let output = scotopic(&words, "1");
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {told}");
        assert!(told.contains(word), "{line}: {told}");
    }
}

#[test]
fn one_thread_and_three_give_the_same_bits() {
    let line: Vec<&str> = "nebula photons --tau-radius 2 --photons 30001 --seed 8 --json --quiet".split(' ').collect();
    assert_eq!(scotopic(&line, "1").stdout, scotopic(&line, "3").stdout);
    let folder = folder("threads");
    for method in ["shared", "plain"] {
        let table = |threads: &str| {
            let path = folder.join(format!("{method}-{threads}.csv"));
            let line = format!(
                "nebula table --depths 4 --directions 9 --photons 20000 --method {method} --quiet --no-cache --out"
            );
            let words: Vec<&str> = line.split(' ').chain([path.to_str().unwrap()]).collect();
            assert!(scotopic(&words, threads).status.success());
            std::fs::read(path).unwrap()
        };
        assert_eq!(table("1"), table("3"), "{method}");
    }
}

#[test]
fn a_table_is_kept_under_its_parameters_and_both_files_say_the_same() {
    let folder = folder("kept");
    let cache = folder.join("cache");
    let _ = std::fs::remove_dir_all(&cache);
    let make = |more: &str, name: &str| {
        let path = folder.join(name);
        let line = format!(
            "nebula table --json --quiet --depths 5 --directions 8 --relative-error 0.05 {more} --cache {} --out {}",
            cache.display(),
            path.display()
        );
        (json(&line.split_whitespace().collect::<Vec<_>>()), std::fs::read(path).unwrap())
    };
    let (first, text) = make("", "a.csv");
    let (again, same) = make("", "b.csv");
    let (other, different) = make("--g 0.5", "c.csv");
    assert_eq!((&first["cached"], &again["cached"], &other["cached"]), (&false.into(), &true.into(), &false.into()));
    assert_eq!((first["photons"].as_u64(), &text), (again["photons"].as_u64(), &same));
    assert_ne!(text, different);
    assert!(number(&first, "worst_relative_error") <= 0.05);

    let table = file::read(std::str::from_utf8(&text).unwrap()).unwrap();
    let (_, array) = make("", "d.npy");
    let numbers: Vec<f32> = array[array.len() - 2 * 5 * 9 * 4..]
        .chunks(4)
        .map(|four| f32::from_le_bytes(four.try_into().unwrap()))
        .collect();
    for row in 0..5 {
        assert_eq!(numbers[row * 9], table.unscattered(row)[0] as f32);
        for bin in 0..8 {
            assert_eq!(numbers[row * 9 + 1 + bin], table.bins(row)[bin] as f32);
            assert_eq!(numbers[45 + row * 9 + 1 + bin], table.errors(row)[bin] as f32);
        }
    }
    // A kept table that was damaged is made again.
    for entry in std::fs::read_dir(&cache).unwrap() {
        let path = entry.unwrap().path();
        let kept = std::fs::read_to_string(&path).unwrap();
        std::fs::write(&path, kept.replace("e-", "x-")).unwrap();
    }
    let (mended, bytes) = make("", "a.csv");
    assert_eq!((&mended["cached"], bytes), (&false.into(), text));
}

/// Chi squared for each bin of a table's last row against the other program's.
fn chi_squared(source: Source, depth: f64, seed: u64) -> f64 {
    let parameters = Parameters {
        spacing: Spacing::Angle,
        length: Length::Diameter,
        source,
        depths: 2,
        deepest: 2.0 * depth,
        ..Parameters::thesis().unwrap()
    };
    let accuracy = Accuracy { relative: None, photons: Some(16_384), most_events: u64::MAX };
    let table = shared::make(&parameters, &accuracy, seed, &mut |_| {}).unwrap().table;
    let mode = Source::ALL.iter().position(|(each, _)| *each == source).unwrap();
    let begin = format!("{mode},{depth},");
    let mut sum = 0.0;
    let rows: Vec<&str> = ANGLES.lines().filter(|line| line.starts_with(&begin)).collect();
    assert_eq!(rows.len(), 72);
    for (bin, line) in rows.iter().enumerate() {
        let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        // Where they caught a few photons, these tell their own error badly: ours tells it, a photon weighing up to the albedo.
        let theirs = row[8].max((0.6 * table.bins(1)[bin] / THEIR_PHOTONS).sqrt());
        sum += apart(table.bins(1)[bin], table.errors(1)[bin], row[7], theirs).powi(2);
    }
    sum / 72.0
}

#[test]
fn a_table_agrees_with_another_programs_photons_in_every_direction() {
    for source in [Source::Beam, Source::Pencil] {
        for depth in [0.01, 1.0, 5.0] {
            let chi_squared = chi_squared(source, depth, 3);
            // 72 bins: one standard deviation of chi squared for each is 0.17.
            assert!((0.3..1.6).contains(&chi_squared), "{source:?}, depth {depth}: {chi_squared}");
        }
    }
}

#[test]
fn the_shared_method_and_the_plain_one_agree_for_every_law() {
    for (albedo, g, line) in
        [(1.0, 0.0, "--albedo 1 --g 0"), (0.9, -0.7, "--albedo 0.9 --g -0.7"), (0.6, 0.9, "--albedo 0.6 --g 0.9")]
    {
        let path = folder("plain").join("table.csv");
        let line = format!(
            "nebula table --depths 2 --tau-max 3 --directions 18 {line} --method plain --photons 60000 --json --quiet --no-cache --out {}",
            path.display()
        );
        json(&line.split_whitespace().collect::<Vec<_>>());
        let plain = file::read(&std::fs::read_to_string(&path).unwrap()).unwrap();
        let parameters = *plain.parameters();
        assert_eq!((parameters.albedo, parameters.phase), (albedo, HenyeyGreenstein::new(g).unwrap()));
        let accuracy = Accuracy { relative: None, photons: Some(8192), most_events: u64::MAX };
        let shared = shared::make(&parameters, &accuracy, 4, &mut |_| {}).unwrap().table;
        let bins = (0..18)
            .map(|j| apart(shared.bins(1)[j], shared.errors(1)[j], plain.bins(1)[j], plain.errors(1)[j]).powi(2));
        let chi_squared = bins.sum::<f64>() / 18.0;
        assert!((0.1..2.2).contains(&chi_squared), "albedo {albedo}, g {g}: {chi_squared}");
        let [passed, error] = plain.unscattered(1);
        assert!(apart(passed, error, shared.unscattered(1)[0], 0.0) < 4.0);
    }
}

#[test]
fn what_is_printed_is_the_row_of_extinction_read_as_scattering() {
    let thesis = Parameters { depths: 4, directions: 6, deepest: 3.0, ..Parameters::thesis().unwrap() };
    let accuracy = Accuracy { relative: None, photons: Some(1024), most_events: u64::MAX };
    let of = |depth| shared::make(&Parameters { depth, ..thesis }, &accuracy, 1, &mut |_| {}).unwrap().table;
    let (extinction, scattering, printed) = (of(Depth::Extinction), of(Depth::Scattering), of(Depth::Printed));
    for row in 0..4 {
        assert_eq!(printed.bins(row), extinction.bins(row));
    }
    // A row of scattering depth 3 has the extinction depth 5, and the printed one keeps that of 3.
    assert!((scattering.unscattered(3)[0] / extinction.unscattered(3)[0].powf(1.0 / 0.6) - 1.0).abs() < 1e-12);
    assert!((printed.deepest() - 5.0).abs() < 1e-12 && (scattering.deepest() - 5.0).abs() < 1e-12);
}
