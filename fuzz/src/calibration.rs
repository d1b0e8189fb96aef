//! Calibrations, files that a person measures and edits: one that is taken never asks for more light than its ceiling.

use scotopic::hw::light::calibration::{BRIGHTEST_CD_M2, Calibration};
use scotopic::hw::light::plan::{TOLERANCE, plan};

use super::assert_harmless;

/// Checks one input.
///
/// # Panics
/// Something does not hold.
pub fn check(data: &[u8]) {
    let Ok(text) = str::from_utf8(data) else { return };
    let calibration = match Calibration::from_toml(text) {
        Ok(calibration) => calibration,
        Err(error) => return assert_harmless(&error.to_string()),
    };
    let again = calibration.to_toml().ok().and_then(|text| Calibration::from_toml(&text).ok());
    assert_eq!(again.as_ref(), Some(&calibration), "it is not read as it was written");
    let sheet = calibration.sheet();
    let ceiling = sheet.ceiling_cd_m2;
    assert!(ceiling <= BRIGHTEST_CD_M2, "a ceiling of {ceiling} cd/m2");
    for fitted in [None].into_iter().chain(sheet.filters.iter().map(Some).take(4)) {
        for asked in [f64::NAN, -1.0, 0.0, 1e-5, 0.003, 0.03, 0.1, 0.3, 0.5, 1.0, 1.8, 2.0, f64::INFINITY] {
            let made = match plan(asked, &calibration, fitted) {
                Ok(made) => made,
                Err(error) => {
                    assert_harmless(&error.to_string());
                    continue;
                }
            };
            assert!((0.0..=1.0).contains(&made.pixel_gain), "{made:?}");
            assert!(made.drive.codes.iter().all(|code| *code <= sheet.module.largest_code()), "{made:?}");
            assert!(made.predicted_cd_m2 <= ceiling * (1.0 + TOLERANCE), "{made:?} above {ceiling} cd/m2");
            assert!((made.predicted_cd_m2 / asked - 1.0).abs() <= TOLERANCE + 1e-6, "{made:?}");
            assert!(made.black_cd_m2 >= 0.0 && made.contrast >= 0.0, "{made:?}");
            made.advice().iter().for_each(|advice| assert_harmless(advice));
        }
    }
}
