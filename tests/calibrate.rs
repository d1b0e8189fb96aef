//! `scotopic calibrate` as a script sees it: files of photographs and of nudges, made by what shares nothing with their reader.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use scotopic::report::registration::photograph::{Face, Photographed};
use serde_json::Value;

/// A folder of its own, with nothing kept in it.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("scotopic-calibrate-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn calibrate(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_scotopic"))
        .arg("calibrate")
        .args(arguments)
        .current_dir(folder)
        .env("XDG_CONFIG_HOME", folder.join("config"))
        .env("XDG_STATE_HOME", folder.join("state"))
        .env("XDG_DATA_DIRS", folder.join("data"))
        .env("HOME", folder)
        .output()
        .unwrap()
}

fn told(folder: &Path, arguments: &[&str]) -> Value {
    let output = calibrate(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// What is said on standard error, with the exit status.
fn refused(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let output = calibrate(folder, arguments);
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

fn save(path: &Path, side: u32, values: &[f32]) {
    let grey = values.iter().map(|value| (value * 255.0).round() as u8).collect();
    image::GrayImage::from_raw(side, side, grey).unwrap().save(path).unwrap();
}

/// The seen Moon and the drawn one, of 0.8 times its size, 20 pixels further right and 6 up.
fn photographs(folder: &Path) {
    let face = Face::of(7);
    let seen = Photographed { radius: 190.0, middle: (220.0, 232.0), noise: 0.02, ..Photographed::default() };
    let drawn = Photographed { radius: 152.0, middle: (240.0, 226.0), relief_arcsec: 0.0, ..seen };
    save(&folder.join("seen.png"), 460, &face.photographed(&seen, 460, 460, 1));
    save(&folder.join("drawn.png"), 460, &face.photographed(&drawn, 460, 460, 2));
}

#[test]
fn two_files_give_scale_and_offset_and_what_is_kept_obeys_the_flags() {
    let folder = folder("moon");
    photographs(&folder);
    let both = ["moon", "seen.png", "drawn.png", "--json"];
    let with = |more: &[&str]| told(&folder, &[&both[..], more].concat());
    let measured = with(&["--measure-only"]);
    let number = |value: &Value, key: &str| value[key].as_f64().unwrap();
    let (scale, error) = (number(&measured, "scale"), number(&measured, "scale_error"));
    assert!((scale - 0.8).abs() < (3.0 * error).min(0.003), "{scale} ± {error}");
    let [right, down] = [0, 1].map(|k| measured["offset_px"][k].as_f64().unwrap());
    assert!((right - 20.0).abs() < 0.5 && (down + 6.0).abs() < 0.5, "{right} {down}");
    assert!(measured["kept"].is_null() && measured["moon"].is_null() && measured["mirrored"] == Value::Bool(false));
    assert!(measured["notes"][0].as_str().unwrap().contains("--at"), "{measured}");
    assert!(told(&folder, &["show", "--json"]).is_null(), "--measure-only keeps nothing");

    let kept = &with(&["--without-offset"])["kept"];
    assert_eq!((number(kept, "right_px"), number(kept, "down_px")), (0.0, 0.0));
    assert!((number(kept, "scale") - 0.8).abs() < 0.003);
    let kept = &with(&["--anew"])["kept"];
    assert!(number(kept, "right_px") < 0.0 && number(kept, "down_px") > 0.0, "drawn back to where it is seen: {kept}");
    assert_eq!(told(&folder, &["show", "--json"])["now"]["scale"], kept["scale"]);

    // Four degrees high in the east of Helsinki: flattened, by so much less across as `--up` says.
    let low = ["--measure-only", "--at", "2026-11-22T12:45:00Z", "--site", "60.17,24.94,30"];
    let upright = with(&[&low[..], &["--up", "0"]].concat());
    let lying = with(&[&low[..], &["--up", "-90"]].concat());
    let flat = number(&upright["moon"], "flattening");
    assert!(flat > 0.003, "{}", upright["moon"]);
    let (upright, lying) = (number(&upright["telescope"], "radius_px"), number(&lying["telescope"], "radius_px"));
    assert!((upright / lying - 1.0).abs() > 0.2 * flat, "{upright} {lying} {flat}");
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_photograph_without_moon_and_numbers_out_of_range_are_refused_with_what_to_do() {
    let folder = folder("refused");
    photographs(&folder);
    save(&folder.join("dark.png"), 300, &[0.02; 300 * 300]);
    let (status, words) = refused(&folder, &["moon", "dark.png", "drawn.png"]);
    assert!(
        status == Some(1) && words.contains("Moon through the telescope") && words.contains("expose longer"),
        "{words}"
    );
    let (status, words) = refused(&folder, &["moon", "seen.png", "nowhere.png"]);
    assert!(status == Some(1) && words.contains("nowhere.png"), "{words}");
    let low = ["--at", "2026-11-22T12:45:00Z", "--site", "60.17,24.94,30"];
    let (status, words) = refused(&folder, &[&["moon", "seen.png", "drawn.png", "--up", "-400"], &low[..]].concat());
    assert!(status == Some(2) && words.contains("--up is -400: give -360 to 360"), "{words}");
    std::fs::write(folder.join("nudges.csv"), worm_night(3)).unwrap();
    let (status, words) = refused(&folder, &["periodic", "--nudges", "nudges.csv", "--amplitude", "-5"]);
    assert!(status == Some(2) && words.contains("peak to peak") && words.contains("give 1 to 200"), "{words}");
    std::fs::write(folder.join("few.csv"), "1.0,2.0,3.0\n").unwrap();
    let (status, words) = refused(&folder, &["periodic", "--nudges", "few.csv"]);
    assert!(status == Some(1) && words.contains("too few"), "{words}");
    std::fs::remove_dir_all(&folder).unwrap();
}

/// The drive of a worm that runs out of true and whose flank is worn: a sine whose phase lags with itself, and a tooth's tent once in
/// a turn; no sum of a few waves.
fn worm(at_s: f64) -> f64 {
    let turn = at_s / 480.0;
    let lagging = (std::f64::consts::TAU * turn + 0.25 * (std::f64::consts::TAU * turn).cos()).sin();
    let worn = 1.0 - ((turn.fract() - 0.6).abs() / 0.15).min(1.0);
    8.0 * lagging + 3.0 * worn
}

/// A night at the eyepiece: the star wanders, and whoever watches pushes it back, to a step of the keys of half an arcsecond, when
/// it is 2" off; each push is up to 3" wrong.
fn worm_night(turns: u32) -> String {
    let (mut text, mut stood) = (String::new(), 0.0);
    for second in (0..turns * 480).step_by(10) {
        let at = f64::from(second);
        let off: f64 = worm(at) + 20.0 * at / 3600.0 - stood;
        if off.abs() > 2.0 {
            let wrong = 6.0 * (f64::from(second / 10 * 37 % 101) / 100.0 - 0.5);
            stood += ((off + wrong) * 2.0).round() / 2.0;
            text += &format!("{:.1},{stood:.2},0.30\n", 1.7e9 + at);
        }
    }
    text
}

#[test]
fn nudges_of_an_observer_show_the_worm_s_curve_with_its_error() {
    let folder = folder("worm");
    let night = worm_night(4);
    std::fs::write(folder.join("nudges.csv"), &night).unwrap();
    let begin: f64 = night.split(',').next().unwrap().parse::<f64>().unwrap() - 1.7e9;
    let learned = told(&folder, &["periodic", "--nudges", "nudges.csv", "--json"]);
    let list = |key: &str| learned[key].as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect::<Vec<f64>>();
    let (curve, errors) = (list("curve_arcsec"), list("curve_error_arcsec"));
    let truth: Vec<f64> = (0..200).map(|bin| worm(begin + 2.4 * f64::from(bin))).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    // The steady part of the error is the alignment's, not the worm's.
    let level = mean(&curve) - mean(&truth);
    let off: Vec<f64> = curve.iter().zip(&truth).map(|(found, there)| found - there - level).collect();
    let rms = mean(&off.iter().map(|off| off * off).collect::<Vec<_>>()).sqrt();
    let inside = off.iter().zip(&errors).filter(|(off, error)| off.abs() < 2.0 * **error).count();
    assert!(
        rms < 0.8 && mean(&errors) < 1.0,
        "the curve is off by {rms:.2} arcseconds of its 17, stated {:.2}",
        mean(&errors)
    );
    assert!(inside >= 180, "{inside} of 200 bins within two standard deviations");
    assert!((learned["drift_arcsec_h"].as_f64().unwrap() - 20.0).abs() < 6.0, "{}", learned["drift_arcsec_h"]);
    let text = String::from_utf8(calibrate(&folder, &["periodic", "--nudges", "nudges.csv"]).stdout).unwrap();
    assert!(text.contains("peak to peak") && text.matches('*').count() == 64, "{text}");
    std::fs::remove_dir_all(&folder).unwrap();
}
