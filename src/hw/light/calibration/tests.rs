use super::*;

const FINE: &str = r#"
module = "dlpc34xx"
id = 6
note = "LS-150, 2026-11-20"

[optics]
meter = "fixed-nd"
fixed_nd = 0.0001
beam_splitter = 0.1

[[filter]]
name = "10 %"
transmission = 0.1

[[row]]
code = 12
cd_m2 = 0.6

[[row]]
code = 300
cd_m2 = 9.0
black_cd_m2 = 0.01

[[row]]
code = 775
cd_m2 = 18.0
"#;

#[test]
fn a_calibration_is_read_and_written_alike() {
    let calibration = Calibration::from_toml(FINE).unwrap();
    assert_eq!(Calibration::from_toml(&calibration.to_toml().unwrap()), Ok(calibration));
}

#[test]
fn a_calibration_that_is_not_right_is_refused_with_the_row() {
    for (from, to, words) in [
        (
            "cd_m2 = 18.0",
            "cd_m2 = 9.0",
            "row 3 of the calibration is not monotone: code 775 gave 9 cd/m2 after 9 cd/m2",
        ),
        ("cd_m2 = 9.0", "cd_m2 = 0.5", "row 2 of the calibration is not monotone"),
        ("cd_m2 = 9.0", "cd_m2 = nan", "row 2 of the calibration: cd_m2 = NaN makes no sense"),
        ("cd_m2 = 0.6", "cd_m2 = -0.6", "row 1 of the calibration: cd_m2 = -0.6"),
        ("cd_m2 = 0.6", "cd_m2 = 0.0", "row 1"),
        ("cd_m2 = 18.0", "cd_m2 = inf", "row 3"),
        ("code = 300", "code = 12", "row 2 of the calibration has code 12 after 12"),
        ("code = 775", "code = 1024", "row 3 of the calibration: code = 1024"),
        ("black_cd_m2 = 0.01", "black_cd_m2 = 9.5", "black_cd_m2 = 9.5"),
        ("id = 6", "id = 13", "id = 13"),
        ("beam_splitter = 0.1", "beam_splitter = 10", "optics.beam_splitter = 10"),
        ("fixed_nd = 0.0001", "fixed_nd = 0.0", "optics.fixed_nd = 0"),
        ("transmission = 0.1", "transmission = 1.0", "the filter '10 %'"),
        ("[optics]", "ceiling_cd_m2 = 2.0\n[optics]", "at most 1.8 cd/m2"),
        ("[optics]", "ceiling_cd_m2 = nan\n[optics]", "ceiling_cd_m2 = NaN"),
        ("[optics]", "leds = 8\n[optics]", "leds = 8"),
        ("[optics]", "balance = [1.0, 0.0, 1.0]\n[optics]", "balance = 0"),
        ("[optics]", "inverted = true\n[optics]", "row 2 of the calibration is not monotone"),
        ("[optics]", "luminance = 3\n[optics]", "luminance"),
        ("dlpc34xx", "dlpc9999", "'dlpc9999' is no module"),
    ] {
        let text = FINE.replacen(from, to, 1);
        assert_ne!(text, FINE, "{from}");
        let error = Calibration::from_toml(&text).unwrap_err().to_string();
        assert!(error.contains(words), "{to}: {error}");
    }
    let error = Calibration::from_toml(FINE.split("[[row]]").next().unwrap()).unwrap_err();
    assert!(error.to_string().contains("has 0 measured steps"), "{error}");
}

#[test]
fn a_falling_table_is_believed_only_when_it_says_so() {
    let falling = FINE.replace("cd_m2 = 0.6", "cd_m2 = 21.0").replace("\ncd_m2 = 18.0", "\ncd_m2 = 1.0");
    let error = Calibration::from_toml(&falling).unwrap_err();
    assert!(error.to_string().contains("inverted = true"), "{error}");
    assert!(Calibration::from_toml(&falling.replacen("[optics]", "inverted = true\n[optics]", 1)).is_ok());
}
