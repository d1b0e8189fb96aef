//! `scotopic sky` as a script sees it.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "common/script.rs"]
mod script;

use script::{json, scotopic};
use serde_json::Value;

/// Row 309 of the reference: ERFA's Sirius from Helsinki.
#[test]
fn show_answers_with_every_key_and_erfas_numbers() {
    let shown =
        json(&["sky", "show", "Sirius", "--at", "1990-03-14T20:00:00Z", "--site", "60.1699,24.9384,30", "--json"]);
    let mut keys: Vec<&String> = shown.as_object().unwrap().keys().collect();
    keys.sort();
    let mut wanted = [
        "ra_j2000_deg",
        "dec_j2000_deg",
        "ra_apparent_deg",
        "dec_apparent_deg",
        "alt_deg",
        "alt_refracted_deg",
        "az_deg",
        "parallactic_deg",
        "v_mag",
        "surface_brightness_mag_arcsec2",
        "size_arcmin",
        "type",
        "constellation",
        "names",
        "distance_pc",
        "absolute_v_mag",
        "hand_controllers_place",
        "field_rotation_deg_per_h",
    ];
    wanted.sort_unstable();
    assert_eq!(keys, wanted);
    for (key, erfa) in
        [("ra_apparent_deg", 101.183488), ("dec_apparent_deg", -16.704103), ("az_deg", 214.56462), ("alt_deg", 7.84219)]
    {
        let ours = shown[key].as_f64().unwrap();
        assert!((ours - erfa).abs() < 1.0 / 3600.0, "{key}: {ours} is not {erfa}");
    }
    assert!((shown["alt_refracted_deg"].as_f64().unwrap() - 7.954).abs() < 0.005);
    assert_eq!(
        (&shown["v_mag"], &shown["type"], &shown["constellation"]),
        (&(-1.44).into(), &"star".into(), &"CMa".into())
    );
    assert_eq!(shown["size_arcmin"], Value::Null);
}

#[test]
fn without_a_site_the_horizon_is_null_and_no_error() {
    let shown = json(&["sky", "show", "M31", "--at", "2026-11-22T20:00:00Z", "--json"]);
    for key in ["alt_deg", "alt_refracted_deg", "az_deg", "parallactic_deg"] {
        assert_eq!(shown[key], Value::Null, "{key}");
    }
    assert_eq!(shown["v_mag"], 3.44);
    assert_eq!(shown["size_arcmin"], serde_json::json!([177.83, 69.66]));
    assert!((shown["surface_brightness_mag_arcsec2"].as_f64().unwrap() - 22.3).abs() < 0.05);
    assert!(shown["names"].as_array().unwrap().contains(&"Andromeda Galaxy".into()));
}

#[test]
fn a_bare_position_and_negative_numbers_are_taken() {
    let shown = json(&[
        "sky",
        "show",
        "--ra",
        "83.82",
        "--dec",
        "-5.4",
        "--at",
        "2026-11-22T20:00:00Z",
        "--site",
        "-24.6,-70.4,2635",
        "--delta-t",
        "-3",
        "--json",
    ]);
    assert_eq!(shown["dec_j2000_deg"].as_f64().unwrap().to_string()[..4], *"-5.4");
    assert_eq!((&shown["constellation"], &shown["type"]), (&"Ori".into(), &Value::Null));
    assert!(shown["alt_deg"].is_f64());
}

#[test]
fn delta_t_moves_what_it_should() {
    let sidereal = |delta_t: &str| {
        json(&[
            "sky",
            "show",
            "Arcturus",
            "--at",
            "2026-11-22T20:00:00Z",
            "--site",
            "60,25,0",
            "--delta-t",
            delta_t,
            "--json",
        ])
    };
    let (a, b) = (sidereal("69"), sidereal("86469"));
    // A day of TT is some hundredths of an arcsecond of precession and up to a third of aberration.
    let moved = (a["dec_apparent_deg"].as_f64().unwrap() - b["dec_apparent_deg"].as_f64().unwrap()).abs() * 3600.0;
    assert!(moved > 0.001 && moved < 1.0, "{moved}");
}

#[test]
fn a_field_is_listed_nearest_first_with_the_promised_keys() {
    let rows =
        json(&["sky", "field", "--ra", "83.82", "--dec", "-5.4", "--radius-arcmin", "30", "--faintest", "9", "--json"]);
    let rows = rows.as_array().unwrap();
    assert!(rows.len() > 10);
    let separations: Vec<f64> = rows.iter().map(|row| row["separation_arcmin"].as_f64().unwrap()).collect();
    assert!(separations.is_sorted() && separations.iter().all(|separation| *separation <= 30.0));
    for row in rows {
        let mut keys: Vec<&String> = row.as_object().unwrap().keys().collect();
        keys.sort();
        assert_eq!(keys, ["dec_j2000_deg", "name", "ra_j2000_deg", "separation_arcmin", "type", "v_mag"]);
        assert!(row["v_mag"].as_f64().is_none_or(|v| v <= 9.0));
    }
    assert!(rows.iter().any(|row| row["name"] == "M42"));
}

#[test]
fn failures_are_one_sentence_and_the_exit_code_says_whose_fault_it_was() {
    for (arguments, code, word) in [
        (&["sky", "show", "Xyzzy"][..], 1, "Xyzzy"),
        (&["sky", "show", "polrais", "--json"], 1, "Polaris"),
        (&["sky", "show", "M31", "--site", "91,0,0"], 2, "91"),
        (&["sky", "show", "M31", "--at", "tonight"], 2, "tonight"),
        (&["sky", "show", "--ra", "10", "--dec", "95"], 2, "95"),
        (&["sky", "show", "--ra", "NaN", "--dec", "5"], 2, "NaN"),
        (&["sky", "show"], 2, "NAME"),
        (&["sky", "field", "--ra", "10", "--dec", "5", "--radius-arcmin", "-1"], 2, "-1"),
        (&["catalogue", "pack", "--from", "/nowhere", "--out", "."], 1, "/nowhere"),
    ] {
        let output = scotopic(arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {said}");
        assert!(said.contains(word), "{arguments:?}: {said}");
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn escapes_in_a_name_do_not_reach_the_terminal() {
    let output = scotopic(&["sky", "show", "\u{1b}[31mXyz\u{7}zy"]);
    assert!(!output.stderr.contains(&0x1b) && !output.stderr.contains(&7));
}

#[test]
fn a_planet_is_shown_with_its_keys_and_the_delta_t_that_was_asked_for() {
    let arguments = ["sky", "show", "saturn", "--at", "2026-11-21T22:00:00Z", "--site", "49.2567,7.0425,250", "--json"];
    let shown = json(&arguments);
    for key in [
        "ra_apparent_deg",
        "dec_apparent_deg",
        "ra_topocentric_deg",
        "dec_topocentric_deg",
        "distance_au",
        "angular_diameter_arcsec",
        "phase",
        "v_mag",
        "ring_tilt_deg",
        "pole_ra_deg",
        "pole_dec_deg",
        "pole_position_angle_deg",
        "alt_deg",
        "az_deg",
    ] {
        assert!(shown[key].is_f64(), "{key}: {}", shown[key]);
    }
    assert!(shown["libration_lon_deg"].is_null());
    assert_eq!(shown["central_meridian_deg"].as_object().unwrap().keys().collect::<Vec<_>>(), ["I", "III"]);
    // ephem: -6.1721 degrees.
    assert!((shown["ring_tilt_deg"].as_f64().unwrap() + 6.1721).abs() < 0.1);
    let moons = shown["moons"].as_array().unwrap();
    assert_eq!(moons.len(), 8);
    for key in ["name", "dx_east_arcsec", "dy_north_arcsec", "in_front", "hidden", "eclipsed"] {
        assert!(!moons[5][key].is_null(), "{key}");
    }
    assert_eq!(moons[5]["name"], "Titan");

    let moon =
        |delta_t: &str| json(&["sky", "show", "Moon", "--at", "2050-01-01T00:00:00Z", "--delta-t", delta_t, "--json"]);
    let (early, late) = (moon("74.5"), moon("108.06"));
    assert_eq!(late["delta_t_s"], 108.06);
    // The Moon moves by half an arcsecond a second.
    let moved = (late["dec_apparent_deg"].as_f64().unwrap() - early["dec_apparent_deg"].as_f64().unwrap())
        .hypot(late["ra_apparent_deg"].as_f64().unwrap() - early["ra_apparent_deg"].as_f64().unwrap());
    assert!((10.0..25.0).contains(&(moved * 3600.0)), "{} arcseconds", moved * 3600.0);
}

#[test]
fn a_date_beyond_the_ephemeris_is_refused_and_one_at_its_end_is_told_with_its_error() {
    let refused = scotopic(&["sky", "show", "Jupiter", "--at", "1400-01-01T00:00:00Z"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("1500 to 2500"));
    let widened = json(&["sky", "show", "Jupiter", "--at", "2400-01-01T00:00:00Z", "--json"]);
    assert!(widened["error_arcsec"].as_f64().unwrap() > 4.0);
}
