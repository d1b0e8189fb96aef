//! `scotopic eye` as a script sees it, held against tables of an independent implementation.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "common/script.rs"]
mod script;

use script::{json, scotopic};
use serde_json::Value;

fn number(answer: &Value, key: &str) -> f64 {
    answer[key].as_f64().unwrap()
}

/// Rows of a table, a few of them: each starts the program once.
fn rows(text: &'static str, every: usize) -> impl Iterator<Item = Vec<&'static str>> {
    text.lines().skip(1).step_by(every).map(|row| row.split(',').collect())
}

#[test]
fn contrast_answers_with_the_tables_numbers_for_both_models() {
    for row in rows(include_str!("../fixtures/reference/eye/odm_check.csv"), 17) {
        let asked = |model| {
            json(&[
                "eye",
                "contrast",
                "--v-mag",
                row[1],
                "--major-arcmin",
                row[2],
                "--minor-arcmin",
                row[3],
                "--sky",
                row[5],
                "--aperture-mm",
                "254",
                "--magnification",
                row[6],
                "--transmission",
                "0.7",
                "--field-factor",
                "2.83",
                "--model",
                model,
                "--json",
            ])
        };
        let n = |i: usize| row[i].parse::<f64>().unwrap();
        let (crumey, blackwell) = (asked("crumey"), asked("blackwell"));
        for (answer, threshold, reserve) in [(&crumey, 12, 13), (&blackwell, 9, 10)] {
            assert!((number(answer, "log10_contrast") - n(8)).abs() < 1e-3, "{row:?} {answer}");
            assert!((number(answer, "log10_threshold") - n(threshold)).abs() < 1e-3, "{row:?} {answer}");
            assert!((number(answer, "reserve") - n(reserve)).abs() < 1e-3, "{row:?} {answer}");
        }
    }
}

#[test]
fn an_object_by_name_is_the_catalogues_and_numbers_take_its_place() {
    // Published for V 8.8 and 1.4' x 1.0': contrast 1.4825, reserve 1.883. OpenNGC has larger axes.
    let named = &["eye", "contrast", "M57", "--eyepiece", "32", "--sky", "21.5", "--model", "blackwell", "--json"];
    let catalogued = json(named);
    assert_eq!((&catalogued["name"], &catalogued["verdict"]), (&"M57".into(), &"very easy".into()));
    assert!((number(&catalogued, "log10_contrast") - 1.4825).abs() < 0.1, "{catalogued}");
    let numbers = ["--v-mag", "8.8", "--major-arcmin", "1.4", "--minor-arcmin", "1.0"];
    let published = json(&[&named[..], &numbers[..]].concat());
    assert!((number(&published, "log10_contrast") - 1.4825).abs() < 1e-4, "{published}");
    assert!((number(&published, "reserve") - 1.8826).abs() < 1e-3, "{published}");
}

#[test]
fn limits_are_the_tables_to_a_thousandth_of_a_magnitude() {
    for row in rows(include_str!("../fixtures/reference/eye/crumey_telescope_limit.csv"), 11) {
        let answer =
            json(&["eye", "limit", "--aperture-mm", row[0], "--magnification", row[2], "--sky", row[1], "--json"]);
        assert!((number(&answer, "v_limit") - row[6].parse::<f64>().unwrap()).abs() < 1e-3, "{row:?} {answer}");
    }
}

#[test]
fn tone_clamps_in_the_dark_and_says_so_and_is_the_table_elsewhere() {
    for row in rows(include_str!("../fixtures/reference/eye/tumblin_rushmeier_check.csv"), 9) {
        let answer = json(&[
            "eye",
            "tone",
            "--method",
            "tr93",
            "--adaptation-world",
            row[0],
            "--adaptation-display",
            row[1],
            "--luminance",
            row[2],
            "--json",
        ]);
        let n = |i: usize| row[i].parse::<f64>().unwrap();
        let dark = n(0) < 0.01 || n(1) < 0.01;
        assert_eq!(answer["clamped"], dark, "{row:?} {answer}");
        assert!(dark || (number(&answer, "display_luminance") / n(7) - 1.0).abs() < 1e-3, "{row:?} {answer}");
    }
    for level in ["0", "1e-8", "1e4"] {
        for method in ["tr93", "tr99", "ward", "linear"] {
            let answer = json(&[
                "eye",
                "tone",
                "--method",
                method,
                "--adaptation-world",
                level,
                "--adaptation-display",
                level,
                "--luminance",
                "1",
                "--json",
            ]);
            assert!(number(&answer, "display_luminance") >= 0.0, "{answer}");
        }
    }
}

#[test]
fn recovery_is_the_tables_loss_and_minutes() {
    let text = include_str!("../fixtures/reference/eye/adaptation_check.csv");
    let mut compared = 0;
    for row in rows(text, 5) {
        let light = match row[0] {
            "white D65-like" => "white",
            "LCD red primary" => "lcd-red",
            "LED 635 nm" => "led635",
            _ => continue,
        };
        let answer = json(&["eye", "recovery", "--light", light, "--luminance", row[2], "--seconds", row[3], "--json"]);
        for (key, column) in [("loss_magnitudes", 10), ("minutes_to_0_1_dex", 12)] {
            let (ours, theirs) = (number(&answer, key), row[column].parse::<f64>().unwrap());
            assert!((ours - theirs).abs() <= f64::max(5.01e-3, 1e-3 * theirs), "{row:?} {key}: {ours}");
        }
        compared += 1;
    }
    assert!(compared > 8);
}

#[test]
fn what_makes_no_sense_is_asked_wrongly_and_what_is_unknown_fails() {
    for arguments in [
        &["eye", "contrast", "--v-mag", "9"][..],
        &["eye", "limit", "--sky", "99"],
        &["eye", "limit", "--aperture-mm", "-5"],
        &["eye", "tone", "--adaptation-world", "-1", "--adaptation-display", "1", "--luminance", "1"],
        &["eye", "tone", "--adaptation-world", "nan", "--adaptation-display", "1", "--luminance", "1"],
        &["eye", "recovery", "--light", "green", "--luminance", "1", "--seconds", "1"],
    ] {
        let output = scotopic(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    }
    let output = scotopic(&["eye", "contrast", "Vega"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("scotopic eye limit"));
}

#[test]
fn tonight_ranks_what_stands_high_enough_and_can_be_seen() {
    let answer = json(&[
        "tonight",
        "--site",
        "60.17,24.94,30",
        "--at",
        "2026-11-22T20:00:00Z",
        "--sky",
        "20.8",
        "--minimum-altitude",
        "25",
        "--most",
        "40",
        "--json",
    ]);
    let rows = answer.as_array().unwrap();
    assert_eq!(rows.len(), 40);
    for row in rows {
        assert!(number(row, "alt_deg") >= 25.0 && number(row, "reserve") > 0.0, "{row}");
        assert!(number(row, "v_mag") < 15.0 && row["best_eyepiece_mm"].is_number(), "{row}");
    }
    // The Moon is up: what is listed risen or not is the telescope's, not the night's.
    let site = ["tonight", "--site", "60.17,24.94,30", "--at", "2026-11-22T20:00:00Z", "--sky", "20.8", "--json"];
    let all = json(&[&site[..], &["--minimum-altitude", "-90"]].concat());
    assert!(all.as_array().unwrap().len() >= 611, "the thesis had 611");
    assert!(rows.iter().any(|row| row["name"] == "Saturn") && rows.iter().all(|row| row["name"] != "Sun"));
    let nowhere = scotopic(&["tonight"]);
    assert_eq!(nowhere.status.code(), Some(2), "{}", String::from_utf8_lossy(&nowhere.stderr));
}
