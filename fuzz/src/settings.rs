//! The observer's settings, a file that a person edits.

use scotopic::cli::settings::Settings;

use super::assert_harmless;

/// Checks one input: it is taken, or the line and what to do are told.
///
/// # Panics
/// Something does not hold.
pub fn check(data: &[u8]) {
    let Ok(text) = str::from_utf8(data) else { return };
    match Settings::from_toml(text) {
        Ok(settings) => assert!(settings.sky_brightness_mag_arcsec2.is_finite(), "{settings:?}"),
        Err(wrong) => {
            assert_harmless(&wrong.what);
            let lines = text.lines().count().max(1);
            assert!(wrong.line.is_none_or(|line| (1..=lines + 1).contains(&line)), "{wrong:?} of {lines} lines");
        }
    }
}
