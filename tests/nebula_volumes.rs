//! Volumes of dust, and flights through them, as a user asks for them.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;

fn nebula(arguments: &[&str], folder: &Path) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_scotopic"));
    // What is kept is kept with the test.
    program.env("XDG_CACHE_HOME", folder.join("cache-of-all"));
    program.arg("nebula").args(arguments).current_dir(folder).output().unwrap()
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

/// A folder with a small cloud and an orbit around it.
fn small(name: &str) -> PathBuf {
    let folder = folder(name);
    json(&["generate", "--size", "8", "--out", "v.npy"], &folder);
    std::fs::write(folder.join("orbit.toml"), "[orbit]\nradius = 4\nelevation_deg = 20\n").unwrap();
    folder
}

/// An accurate flight of three small frames.
const ACCURATE: &[&str] = &[
    "fly",
    "v.npy",
    "--path",
    "orbit.toml",
    "--frames",
    "3",
    "--size",
    "6x4",
    "--tolerance",
    "0.05",
    "--flights",
    "3000",
    "--quiet",
];

#[test]
fn accurate_frames_shared_out_are_those_of_one_run_bit_for_bit() {
    let folder = small("nebula-accurate");
    let fly = |out: &str, more: &[&str]| {
        json(&[ACCURATE, &["--format", "npy", "--through", "--out", out], more].concat(), &folder)
    };
    let read = |out: &str, name: &str| std::fs::read(folder.join(out).join(name)).unwrap();
    let whole = fly("whole", &["--no-cache"]);
    assert_eq!((&whole["made"], &whole["light_from_cache"]), (&3.into(), &false.into()));
    assert!(whole["worst_believed_error"].as_f64().unwrap() > 0.0);
    // The second machine finds what the first has gathered.
    let (first, second) = (["--shard", "1/2", "--cache", "c"], ["--shard", "2/2", "--cache", "c"]);
    let (one, two) = (fly("shared", &first), fly("shared", &second));
    assert_eq!((&one["made"], &one["missing"], &one["light_from_cache"]), (&2.into(), &1.into(), &false.into()));
    assert_eq!((&two["made"], &two["missing"], &two["light_from_cache"]), (&1.into(), &0.into(), &true.into()));
    for frame in 0..3 {
        for name in [format!("frame-{frame:05}.npy"), format!("frame-{frame:05}-through.npy")] {
            assert!(read("shared", &name) == read("whole", &name), "{name}");
        }
    }
    assert!(read("whole", "frame-00000.npy") != read("whole", "frame-00001.npy"));
    // Begun again, there is nothing to do; of a lost frame only it is made.
    assert_eq!(fly("shared", &first)["made"], 0);
    std::fs::remove_file(folder.join("shared/frame-00002.npy")).unwrap();
    let again = fly("shared", &first);
    assert_eq!((&again["made"], &again["left_alone"]), (&1.into(), &1.into()));
    assert!(read("shared", "frame-00002.npy") == read("whole", "frame-00002.npy"));
    // A kept field that is torn is gathered again.
    let kept = std::fs::read_dir(folder.join("c")).unwrap().next().unwrap().unwrap().path();
    let mut bytes = std::fs::read(&kept).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&kept, bytes).unwrap();
    std::fs::remove_file(folder.join("shared/frame-00001.npy")).unwrap();
    assert_eq!(fly("shared", &second)["light_from_cache"], false);
    assert!(read("shared", "frame-00001.npy") == read("whole", "frame-00001.npy"));
}

#[test]
fn a_frame_of_linear_light_is_the_picture_that_render_writes() {
    let folder = small("nebula-linear");
    std::fs::write(
        folder.join("scene.toml"),
        "model = 'single'\nalbedo = 0.7\nsize = '7x5'\ntolerance = 0.05\nseed = 3\n",
    )
    .unwrap();
    std::fs::write(
        folder.join("still.toml"),
        "fov_deg = 30\n[[key]]\ntime = 0\neye = [1, 2, 4]\n[[key]]\ntime = 1\neye = [1, 2, 4]\n",
    )
    .unwrap();
    for kind in ["npy", "fits", "exr"] {
        let fly = ["fly", "v.npy", "--scene", "scene.toml", "--path", "still.toml", "--frames", "1", "--quiet"];
        json(&[&fly[..], &["--format", kind, "--through", "--out", kind]].concat(), &folder);
        let (one, through) = (format!("one.{kind}"), format!("through.{kind}"));
        let render = [
            "render",
            "v.npy",
            "--scene",
            "scene.toml",
            "--view",
            "perspective",
            "--eye",
            "1,2,4",
            "--fov-deg",
            "30",
            "--quiet",
        ];
        json(&[&render[..], &["--out", &one, "--through", &through]].concat(), &folder);
        let read = |name: String| std::fs::read(folder.join(name)).unwrap();
        assert!(read(format!("{kind}/frame-00000.{kind}")) == read(one), "{kind}");
        assert!(read(format!("{kind}/frame-00000-through.{kind}")) == read(through), "{kind}");
    }
    // Codes for a display are not linear light.
    let linear = ["fly", "v.npy", "--path", "still.toml", "--format", "exr", "--out", "x"];
    for wrong in [&["--gamma", "2"][..], &["--background", "stars"], &["--apng", "x.png"]] {
        let (code, said) = refused(&[&linear[..], wrong].concat(), &folder);
        assert!(code == Some(2) && said.contains("--format png"), "{said}");
    }
    let literal = ["fly", "v.npy", "--path", "still.toml", "--model", "single", "--literal", "depth", "--out", "x"];
    assert!(refused(&literal, &folder).1.contains("--model table"));
    assert!(!folder.join("x").exists());
}

#[test]
fn a_folder_with_frames_of_another_volume_scene_or_background_is_refused() {
    let folder = small("nebula-another");
    std::fs::write(folder.join("scene.toml"), "model = 'single'\n[[star]]\nposition = [0, 0, 0]\n").unwrap();
    image::RgbImage::from_pixel(4, 4, image::Rgb([90, 60, 30])).save(folder.join("sky.png")).unwrap();
    let fly = [ACCURATE, &["--scene", "scene.toml", "--background", "sky.png", "--out", "frames"]].concat();
    assert_eq!(json(&fly, &folder)["made"], 3);
    let frame = std::fs::read(folder.join("frames/frame-00001.png")).unwrap();
    // Each file becomes another under its old name, and then is what it was.
    let another = |name: &str, change: &dyn Fn(), word: &str| {
        let old = std::fs::read(folder.join(name)).unwrap();
        change();
        let (code, said) = refused(&fly, &folder);
        assert!(code == Some(2) && said.contains(word) && said.contains("another folder"), "{said}");
        std::fs::write(folder.join(name), old).unwrap();
        assert_eq!(json(&fly, &folder)["made"], 0);
    };
    another("v.npy", &|| drop(json(&["generate", "--size", "8", "--seed", "2", "--out", "v.npy"], &folder)), "digest");
    let scene = "model = 'single'\n[[star]]\nposition = [0, 0.1, 0]\n";
    another("scene.toml", &|| std::fs::write(folder.join("scene.toml"), scene).unwrap(), "stars");
    let sky = || image::RgbImage::from_pixel(4, 4, image::Rgb([90, 60, 31])).save(folder.join("sky.png")).unwrap();
    another("sky.png", &sky, "photograph");
    assert_eq!(std::fs::read(folder.join("frames/frame-00001.png")).unwrap(), frame);
    // A scene file that says the same in other words is the same.
    std::fs::write(folder.join("scene.toml"), "# the star\nmodel = \"single\"\n[[star]]\nposition = [0.0, 0.0, 0.0]\n")
        .unwrap();
    assert_eq!(json(&fly, &folder)["left_alone"], 3);
}

/// The codes of a PNG.
fn codes(path: &Path) -> Vec<[u8; 3]> {
    image::open(path).unwrap().into_rgb8().pixels().map(|pixel| pixel.0).collect()
}

#[test]
fn light_is_developed_from_fits_as_from_numpy_before_a_photograph_and_before_stars() {
    let folder = small("nebula-develop");
    let render =
        ["render", "v.npy", "--model", "single", "--size", "16x12", "--width", "2.4", "--tolerance", "0.05", "--quiet"];
    json(&[&render[..], &["--out", "light.npy", "--out", "light.fits", "--through", "t.fits"]].concat(), &folder);
    let develop = |light: &str, more: &[&str]| {
        let told = json(&[&["develop", light, "--out", "p.png"], more].concat(), &folder);
        assert_eq!((&told["width"], &told["height"]), (&16.into(), &12.into()));
        codes(&folder.join("p.png"))
    };
    let plain = develop("light.npy", &[]);
    assert_eq!(develop("light.fits", &[]), plain);
    // Turned over it would not be the same: the cloud is not level.
    assert!(plain.chunks(16).rev().flatten().ne(plain.iter()));
    // Before an even photograph: in the corner, which has no dust, the photograph's own colour at a gamma of 1; everywhere light + through x behind.
    image::RgbImage::from_pixel(32, 24, image::Rgb([255, 188, 0])).save(folder.join("sky.png")).unwrap();
    let linear = [
        "--gamma",
        "1",
        "--white",
        "0.2",
        "--background",
        "sky.png",
        "--background-light",
        "0.5",
        "--through",
        "t.fits",
    ];
    let before = develop("light.fits", &linear);
    // 188 is a linear 0.5028 (IEC 61966-2-1).
    assert_eq!(before[0], [128, 64, 0]);
    let numbers = |name: &str| {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        scotopic::picture::npy::read(&mut bytes.as_slice(), bytes.len() as u64).unwrap().values
    };
    json(&[&render[..], &["--out", "light.npy", "--through", "t.npy"]].concat(), &folder);
    let (light, through) = (numbers("light.npy"), numbers("t.npy"));
    for (pixel, code) in before.iter().enumerate() {
        for (band, behind) in [1.0, 0.5028, 0.0].into_iter().enumerate() {
            let at = band * 16 * 12 + pixel;
            let share = (light[at] / 0.2 + through[at] * 0.5 * behind).min(1.0);
            // What is brighter than white keeps its hue: held where no colour is.
            if code.iter().all(|code| *code < 255) {
                assert!((f32::from(code[band]) - 255.0 * share).abs() < 1.0, "pixel {pixel}: {code:?}, {share}");
            }
        }
    }
    assert!(through.iter().any(|share| *share < 0.5) && before.iter().any(|code| code[0] < 100));
    // Before stars: where there is no star all is as it was, and dust dims those behind it.
    let stars = develop("light.npy", &["--background", "stars:3", "--background-light", "3", "--through", "t.fits"]);
    // (What is brighter than white keeps its hue and may lose in one colour: held below it.)
    let below = |pair: &(&[u8; 3], &[u8; 3])| pair.0.iter().chain(pair.1).all(|code| *code < 255);
    let dim: Vec<_> = stars.iter().zip(&plain).filter(below).collect();
    assert!(dim.len() > 60 && dim.iter().any(|(stars, plain)| stars != plain));
    assert!(dim.iter().all(|(stars, plain)| (0..3).all(|c| stars[c] >= plain[c])));
    let (code, said) = refused(&["develop", "light.npy", "--through", "v.npy", "--out", "p.png"], &folder);
    assert!(code == Some(2) && said.contains("v.npy"), "{said}");
}

#[test]
fn gas_that_glows_is_made_and_rendered() {
    let folder = folder("nebula-glow");
    let made = json(
        &[
            "generate",
            "--size",
            "10,8,6",
            "--edge",
            "2,1.6,1.2",
            "--star=0.2,0,0",
            "--emission",
            "e.fits",
            "--out",
            "v.fits",
        ],
        &folder,
    );
    assert_eq!(made["files"], serde_json::json!(["v.fits", "e.fits"]));
    let (dust, glow) = (json(&["show", "v.fits"], &folder), json(&["show", "e.fits"], &folder));
    assert_eq!((&glow["size"], &glow["edges"]), (&dust["size"], &dust["edges"]));
    let [filled, lit] = [&dust, &glow].map(|told| told["filled"].as_f64().unwrap());
    assert!(lit > 0.0 && lit < filled, "{lit} {filled}");
    let render = |more: &[&str]| -> Vec<f64> {
        let usual = [
            "render",
            "v.fits",
            "--star=0.2,0,0,9000",
            "--model",
            "single",
            "--size",
            "8",
            "--tolerance",
            "0.05",
            "--quiet",
            "--out",
            "p.npy",
        ];
        let told = json(&[&usual[..], more].concat(), &folder);
        told["mean_radiance"].as_array().unwrap().iter().map(|mean| mean.as_f64().unwrap()).collect()
    };
    let without = render(&[]);
    let [once, twice] = ["1,0,0.5", "2,0,1"].map(|bands| render(&["--emission", "e.fits", "--emission-bands", bands]));
    let added = |with: &[f64], band: usize| with[band] - without[band];
    assert!(added(&once, 0) > 0.2 * without[0] && added(&once, 1).abs() < 1e-3 * without[1]);
    // Twice as bright a glow adds twice as much.
    assert!(
        (added(&twice, 0) / added(&once, 0) - 2.0).abs() < 0.05
            && (added(&twice, 2) / added(&once, 2) - 2.0).abs() < 0.05
    );
    let (code, said) = refused(
        &["generate", "--size", "4", "--emission", "e.npy", "--emission-radius", "-1", "--out", "w.npy"],
        &folder,
    );
    assert!(code == Some(2) && said.contains("-1"), "{said}");
    assert_eq!(refused(&["generate", "--emission-radius", "1", "--out", "w.npy"], &folder).0, Some(2));
}

#[test]
fn voxels_of_a_fits_file_that_are_no_cubes_are_rendered_as_long_as_they_are() {
    let folder = folder("nebula-slabs");
    // Even dust in 5 x 4 x 3 voxels of 0.4 x 0.2 x 0.1: a box of 2 x 0.8 x 0.3.
    let mut bytes = Vec::new();
    scotopic::picture::fits::cube::write(&mut bytes, [5, 4, 3], [0.4, 0.2, 0.1], &[1.0; 60]).unwrap();
    std::fs::write(folder.join("slabs.fits"), bytes).unwrap();
    for (eye, up, depth) in [("5,0,0", "0,1,0", 2.0f64), ("0,5,0", "0,0,1", 0.8), ("0,0,5", "0,1,0", 0.3)] {
        let view = [
            "--view",
            "orthographic",
            "--eye",
            eye,
            "--up",
            up,
            "--width",
            "0.1",
            "--size",
            "2x1",
            "--extinction",
            "1.5",
        ];
        let more = [
            "--star=0,0,9",
            "--model",
            "single",
            "--tolerance",
            "0.05",
            "--quiet",
            "--out",
            "p.npy",
            "--through",
            "t.npy",
        ];
        json(&[&["render", "slabs.fits"][..], &view, &more].concat(), &folder);
        let bytes = std::fs::read(folder.join("t.npy")).unwrap();
        let through = scotopic::picture::npy::read(&mut bytes.as_slice(), bytes.len() as u64).unwrap().values;
        assert!(
            through.iter().all(|share| (f64::from(*share) - (-1.5 * depth).exp()).abs() < 1e-5),
            "{eye}: {through:?}"
        );
    }
}

#[test]
fn a_picture_that_no_memory_holds_is_refused_before_anything_is_done() {
    let folder = folder("nebula-large");
    json(&["generate", "--size", "4", "--out", "v.npy"], &folder);
    let five = ["render", "v.npy", "--size", "8192", "--extinction", "1,2,3,4,5", "--out", "p.npy"];
    let (code, said) = refused(&five, &folder);
    assert!(code == Some(2) && said.contains("8192 x 8192 pixels in 5 bands") && said.contains("GiB"), "{said}");
    assert!(refused(&["render", "v.npy", "--size", "8193", "--out", "p.npy"], &folder).1.contains("8193"));
}
