//! Key maps, files that a person edits: one that is taken is one that works, key by key.

use std::time::Duration;

use scotopic::hw::handbox::keymap::Key;
use scotopic::hw::handbox::pattern::Pattern;
use scotopic::hw::handbox::{Decoder, Heard, KeyMap};

use super::assert_harmless;

/// Checks one input.
///
/// # Panics
/// Something does not hold.
pub fn check(data: &[u8]) {
    let Ok(text) = str::from_utf8(data) else { return };
    let map = match KeyMap::from_toml(text) {
        Ok(map) => map,
        Err(error) => return assert_harmless(&error.to_string()),
    };
    assert_harmless(map.name());
    let written = map.to_toml();
    assert!(written.is_ok(), "{map:?} cannot be written");
    let again = KeyMap::from_toml(&written.unwrap_or_default());
    assert_eq!(again.as_ref(), Ok(&map), "it is not read as it was written");
    for key in map.keys() {
        is_heard(&map, key);
    }
}

/// Pressed and let go, a key is told once, by its name.
fn is_heard(map: &KeyMap, key: &Key) {
    let mut decoder = Decoder::new(map.clone());
    let mut heard = decoder.feed(&any(&key.press), Duration::from_secs(1));
    heard.extend(decoder.tick(Duration::from_millis(2300)));
    if let Some(release) = map.releases(key).next() {
        heard.extend(decoder.feed(&any(&release), Duration::from_millis(2400)));
    }
    heard.extend(decoder.tick(Duration::from_secs(9)));
    let told: Vec<&str> = heard
        .iter()
        .filter_map(|heard| match heard {
            Heard::Pressed(pressed) => Some(pressed.key.as_str()),
            _ => None,
        })
        .collect();
    assert_eq!(told, [key.name.as_str()], "'{}' of {}", key.name, map.to_toml().unwrap_or_default());
}

/// Bytes that fit a pattern.
fn any(pattern: &Pattern) -> Vec<u8> {
    pattern.places().iter().map(|place| place.unwrap_or(0)).collect()
}
