//! The picture of the low Sun as a user asks for it.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::PathBuf;

#[path = "common/script.rs"]
mod script;

use script::{json, scotopic};

/// A folder of this test's own, empty.
fn folder(name: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// Width of the lit part of each row.
fn widths(file: &std::path::Path) -> Vec<usize> {
    let picture = image::open(file).unwrap().to_rgb8();
    picture.rows().map(|row| row.filter(|pixel| pixel.0[0] > 40).count()).collect()
}

#[test]
fn an_omega_sun_has_a_waist_and_a_foot() {
    let out = folder("omega").join("omega.png");
    let told = json(&["sun", "render", "--preset", "omega", "--size", "128", "--out", out.to_str().unwrap(), "--json"]);
    assert_eq!((told["width"].as_u64(), told["files"].as_array().unwrap().len()), (Some(128), 2));
    let rows: Vec<usize> = widths(&out).into_iter().filter(|width| *width > 0).collect();
    let widest = rows.iter().take(rows.len() * 3 / 4).max().unwrap();
    let waist = rows[rows.len() / 2..].iter().take(rows.len() / 2 - 3).min().unwrap();
    let foot = rows[rows.len() - 4..].iter().max().unwrap();
    assert!(waist + 6 < *widest && waist + 4 < *foot, "{rows:?}");

    // The linear light lies beside it, the top row last.
    let fits = scotopic::picture::fits::Fits::read(&std::fs::read(out.with_extension("fits")).unwrap()).unwrap();
    assert_eq!((fits.width, fits.planes.len(), fits.text("BUNIT")), (128, 3, Some("cd/m2")));
    let brightest = fits.planes[1].iter().copied().fold(0.0, f32::max);
    assert!((f64::from(brightest) / told["brightest_cd_m2"].as_f64().unwrap() - 1.0).abs() < 1e-5);
}

#[test]
fn the_red_flash_hangs_below_the_disc_apart_from_it() {
    let out = folder("red").join("red.png");
    let arguments = ["sun", "render", "--preset", "red-flash", "--size", "200", "--no-fits", "--out"];
    assert!(scotopic(&[&arguments[..], &[out.to_str().unwrap()]].concat()).status.success());
    let rows = widths(&out);
    let first = rows.iter().position(|width| *width > 0).unwrap();
    let gap = first + rows[first..].iter().position(|width| *width == 0).unwrap();
    let flash: Vec<usize> = rows[gap..].iter().copied().filter(|width| *width > 0).collect();
    assert!(!flash.is_empty() && flash.iter().all(|width| *width < 60), "{rows:?}");
}

#[test]
fn a_scene_file_says_what_flags_say_and_flags_go_first() {
    let folder = folder("scene");
    let (file, out) = (folder.join("scene.toml"), folder.join("a.png"));
    std::fs::write(
        &file,
        "name = 'mine'\nsun_altitude_arcmin = -25.5\nsize = '24x20'\nwavelengths = 9\n[profile]\nobserver_height_m = 7\n\
         row = [{ height_m = 0, temperature_k = 288 }, { height_m = 11000, temperature_k = 216 }]\n",
    )
    .unwrap();
    let told = json(&[
        "sun",
        "render",
        "--scene",
        file.to_str().unwrap(),
        "--wavelengths",
        "8",
        "--no-fits",
        "--out",
        out.to_str().unwrap(),
        "--json",
    ]);
    for (key, value) in [
        ("width", 24.0),
        ("height", 20.0),
        ("sun_altitude_arcmin", -25.5),
        ("observer_height_m", 7.0),
        ("wavelengths", 8.0),
    ] {
        assert!((told[key].as_f64().unwrap() - value).abs() < 1e-9, "{key}: {told}");
    }
    std::fs::write(&file, "wavelength = 9\n").unwrap();
    let refused = scotopic(&["sun", "render", "--scene", file.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    let words = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(refused.status.code() == Some(2) && words.contains("line 1") && words.contains("'wavelengths'"), "{words}");
}

#[test]
fn a_sequence_is_a_folder_of_frames_or_an_animated_png() {
    let folder = folder("sequence");
    let (frames, animated) = (folder.join("frames"), folder.join("sunset.apng"));
    for out in [&frames, &animated] {
        let told = json(&[
            "sun",
            "sequence",
            "--frames",
            "3",
            "--size",
            "16",
            "--to-arcmin",
            "-30",
            "--out",
            out.to_str().unwrap(),
            "--json",
        ]);
        assert_eq!((told["frames"].as_u64(), told["to_arcmin"].as_f64().map(f64::round)), (Some(3), Some(-30.0)));
    }
    assert_eq!(std::fs::read_dir(&frames).unwrap().count(), 3);
    let bytes = std::fs::read(&animated).unwrap();
    assert_eq!(bytes.windows(4).filter(|window| *window == b"fcTL").count(), 3);
}

#[test]
fn what_was_left_out_is_explained_and_everything_agrees() {
    let out = folder("everything").join("a.png");
    let base = ["sun", "render", "--size", "12", "--wavelengths", "8", "--no-fits", "--out", out.to_str().unwrap()];
    let words = scotopic(&[&base[..], &["--explain"]].concat());
    let words = String::from_utf8_lossy(&words.stdout).into_owned();
    for part in ["wavelengths", "rays", "Error of place reached", "Time, ms"] {
        assert!(words.contains(part), "{words}");
    }
    let told = json(&[&base[..], &["--everything", "--json"]].concat());
    assert!(told["everything_worst_code"].as_u64().unwrap() <= 1, "{told}");
}

#[test]
fn wrong_questions_end_with_2_and_say_what_to_do() {
    for (arguments, word) in [
        (&["--size", "0"][..], "8192"),
        (&["--preset", "nowhere"], "us76"),
        (&["--sun-altitude-arcmin", "-9000"], "-90 to 90"),
        (&["--observer-height-m", "-1"], "-1"),
        (&["--humidity", "50"], "--climate"),
        (&["--tolerance-arcsec", "0"], "0.001"),
        (&["--layers", "300"], "lehn"),
        (&["--white", "bright"], "auto"),
    ] {
        let output = scotopic(&[&["sun", "render", "--out", "/nowhere/a.png"][..], arguments].concat());
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && words.contains(word), "{arguments:?}: {words}");
    }
}

/// The thesis' law stands beside the plain one.
#[test]
fn a_ray_tells_its_depth_by_both_laws() {
    let base = ["sun", "trace", "--climate", "urban", "--humidity", "50", "--json"];
    let (plain, less) = (json(&base), json(&[&base[..], &["--less-forward"]].concat()));
    let key = "aerosol_optical_depth_less_forward";
    let [a, b] = [&plain, &less].map(|told| told[key].as_f64().unwrap());
    assert!((a / b - 1.0).abs() < 1e-6 && b == less["aerosol_optical_depth"].as_f64().unwrap(), "{a} {b}");
    assert!(a < 0.5 * plain["aerosol_optical_depth"].as_f64().unwrap());
}
