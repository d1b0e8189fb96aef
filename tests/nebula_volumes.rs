//! Volumes of dust, and flights through them, as a user asks for them.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn nebula(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_scotopic")).arg("nebula").args(arguments).current_dir(folder).output().unwrap()
}

fn json(arguments: &[&str], folder: &Path) -> Value {
    let output = nebula(&[arguments, &["--json"]].concat(), folder);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The exit code and what was said of a command that fails.
fn refused(arguments: &[&str], folder: &Path) -> (Option<i32>, String) {
    let output = nebula(arguments, folder);
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

/// A folder of this test's own, empty.
fn folder(name: &str) -> PathBuf {
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

#[test]
fn one_volume_is_the_same_in_every_kind_of_file() {
    let folder = folder("nebula-formats");
    let shown = |name: &str| {
        let made =
            json(&["generate", "--size", "20,16,12", "--edge", "2,1.6,0.6", "--seed", "5", "--out", name], &folder);
        assert_eq!(made["size"], serde_json::json!([20, 16, 12]));
        json(&["show", name], &folder)
    };
    let fits = shown("v.fits");
    assert!(fits["filled"].as_f64().unwrap() > 0.2 && fits["most"].as_f64().unwrap() > 0.3);
    assert_eq!((&shown("v.nrrd"), &shown("v.nhdr")), (&fits, &fits));
    // NumPy's files know nothing of edges: voxels are cubes there.
    let npy = shown("v.npy");
    assert_eq!((&npy["mean"], &npy["filled"], &npy["most"]), (&fits["mean"], &fits["filled"], &fits["most"]));
    let has_edges = |told: &Value, edges: [f64; 3]| {
        let told = told["edges"].as_array().unwrap().iter().map(|edge| edge.as_f64().unwrap());
        told.zip(edges).all(|(told, edge)| (told - edge).abs() < 1e-12)
    };
    assert!(has_edges(&npy, [2.0, 1.6, 1.2]) && has_edges(&fits, [2.0, 1.6, 0.6]), "{npy} {fits}");
    assert!(folder.join("v.raw").metadata().unwrap().len() == 20 * 16 * 12 * 4);
}

#[test]
fn dust_that_cannot_be_is_refused_by_name_and_index() {
    let folder = folder("nebula-refused");
    let mut bytes = b"NRRD0004\ntype: float\ndimension: 3\nsizes: 3 2 2\nendian: little\nencoding: raw\n\n".to_vec();
    let values = [0.0, 1.0, 2.0, 3.0, 4.0, f32::NAN, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0];
    bytes.extend(values.iter().flat_map(|value: &f32| value.to_le_bytes()));
    std::fs::write(folder.join("bad.nrrd"), bytes).unwrap();
    let (code, said) = refused(&["show", "bad.nrrd"], &folder);
    assert_eq!(code, Some(2));
    assert!(said.contains("bad.nrrd") && said.contains("x 2, y 1, z 0") && said.contains("NaN"), "{said}");
    assert!(refused(&["show", "v.vdb"], &folder).1.contains(".fits, .npy"));
    assert_eq!(refused(&["generate", "--size", "0", "--out", "v.fits"], &folder).0, Some(2));
    assert_eq!(refused(&["generate", "--cavity", "-1", "--out", "v.fits"], &folder).0, Some(2));
}

#[test]
fn slices_and_columns_are_written_as_pictures() {
    let folder = folder("nebula-planes");
    json(&["generate", "--size", "20,16,12", "--out", "v.npy"], &folder);
    let told = json(&["show", "v.npy", "--slice", "z=3", "--column", "x", "--out", "planes"], &folder);
    assert_eq!(told["pictures"], serde_json::json!(["planes/slice-z-0003.png", "planes/column-x.png"]));
    let sides = |name: &str| image::image_dimensions(folder.join("planes").join(name)).unwrap();
    assert_eq!((sides("slice-z-0003.png"), sides("column-x.png")), ((20, 16), (12, 16)));
    assert!(refused(&["show", "v.npy", "--slice", "z=12", "--out", "planes"], &folder).1.contains("0 to 11"));
}

/// The bytes of each frame that is there.
fn frames(folder: &Path) -> Vec<Option<Vec<u8>>> {
    (0..5).map(|i| std::fs::read(folder.join(format!("frame-{i:05}.png"))).ok()).collect()
}

#[test]
fn machines_share_out_a_flight_and_finished_frames_are_left_alone() {
    let folder = folder("nebula-flight");
    json(&["generate", "--size", "16", "--out", "v.npy"], &folder);
    std::fs::write(folder.join("orbit.toml"), "[orbit]\nradius = 4\nelevation_deg = 20\n").unwrap();
    let fly = |out: &str, more: &[&str]| {
        let usual = ["fly", "v.npy", "--path", "orbit.toml", "--frames", "5", "--size", "24x16", "--preview"];
        json(
            &[&usual[..], &["--model", "single", "--quiet", "--background", "stars", "--out", out], more].concat(),
            &folder,
        )
    };
    let whole = fly("whole", &["--apng", "all.png"]);
    assert_eq!((&whole["made"], &whole["missing"]), (&5.into(), &0.into()));
    let animated = std::fs::read(folder.join("all.png")).unwrap();
    assert_eq!(animated.windows(4).filter(|window| window == b"fcTL").count(), 5);

    let first = fly("shared", &["--shard", "1/2"]);
    assert_eq!((&first["made"], &first["missing"]), (&3.into(), &2.into()));
    assert_eq!(fly("shared", &["--shard", "2/2"])["made"], 2);
    assert_eq!(frames(&folder.join("shared")), frames(&folder.join("whole")));
    assert!(frames(&folder.join("whole"))[0] != frames(&folder.join("whole"))[2]);

    // One frame is lost, another was changed by hand: only the lost one is made again.
    let path = |i: usize| folder.join("whole").join(format!("frame-{i:05}.png"));
    let lost = std::fs::read(path(3)).unwrap();
    std::fs::remove_file(path(3)).unwrap();
    std::fs::write(path(1), b"by hand").unwrap();
    let again = fly("whole", &[]);
    assert_eq!((&again["made"], &again["left_alone"]), (&1.into(), &4.into()));
    assert_eq!((std::fs::read(path(3)).unwrap(), std::fs::read(path(1)).unwrap()), (lost, b"by hand".to_vec()));

    let other = ["fly", "v.npy", "--path", "orbit.toml", "--frames", "6", "--preview", "--out", "whole"];
    let (code, said) = refused(&other, &folder);
    assert!(code == Some(2) && said.contains("frames 5 there, frames 6 now"), "{said}");
}
