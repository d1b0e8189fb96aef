//! The inputs that fuzzing has kept, replayed with the fuzzer's own assertions: what was found once is not found again.
//! `docs/fuzzing.md` says how they came to be.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::panic::catch_unwind;

#[expect(unreachable_pub, reason = "the fuzz targets, in a package of their own, use the same modules")]
#[path = "../fuzz/src/lib.rs"]
mod targets;

/// What must hold of an input.
type Check = fn(&[u8]);

/// Each target.
const TARGETS: &[(&str, Check)] = &[
    ("calibration", targets::calibration::check),
    ("handbox_bytes", targets::handbox_bytes::check),
    ("i2c_answers", targets::i2c_answers::check),
    ("key_map", targets::key_map::check),
    ("mount_replies", targets::mount_replies::check),
    ("photograph_index", targets::photograph_index::check),
    ("placement", targets::placement::check),
    ("rig_file", targets::rig_file::check),
    ("settings", targets::settings::check),
    ("trace", targets::trace::check),
];

fn inputs(target: &str) -> Vec<Vec<u8>> {
    let text = fs::read_to_string(format!("fixtures/fuzz/{target}.hex")).unwrap();
    let byte = |digits: &[u8]| u8::from_str_radix(str::from_utf8(digits).unwrap(), 16).unwrap();
    // Lines that begin with an exclamation mark were findings once.
    text.lines().map(|line| line.trim_start_matches('!').as_bytes().chunks(2).map(byte).collect()).collect()
}

#[test]
fn no_input_that_was_kept_breaks_what_must_always_hold() {
    let mut wrong = Vec::new();
    for (target, check) in TARGETS {
        for (index, input) in inputs(target).into_iter().enumerate() {
            if catch_unwind(|| check(&input)).is_err() {
                wrong.push(format!("{target}, line {}: {:?}", index + 1, String::from_utf8_lossy(&input)));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_target_has_its_corpus_and_every_corpus_its_target() {
    let names = |folder: &str, end: &str| -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter_map(|name| name.strip_suffix(end).map(str::to_owned))
            .collect();
        names.sort();
        names
    };
    let listed: Vec<_> = TARGETS.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(names("fuzz/fuzz_targets", ".rs"), listed);
    assert_eq!(names("fixtures/fuzz", ".hex"), listed);
    assert!(TARGETS.iter().all(|(target, _)| !inputs(target).is_empty()));
}
