//! The index of Stellarium's photographs: JSON as people write it, names of files, corners.

use scotopic::overlay::photograph::stellarium;

/// Whatever the text is: what is taken names files and no paths, its plates are finite, and no sentence commands a terminal.
///
/// # Panics
/// One of these does not hold.
pub fn check(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let (tiles, notes) = match stellarium::index(text) {
        Ok(found) => found,
        Err(error) => return super::assert_harmless(&error.to_string()),
    };
    notes.iter().for_each(|note| super::assert_harmless(note));
    for tile in tiles {
        assert!(!tile.file.contains(['/', '\\']) && !tile.file.starts_with('.'), "a path: {:?}", tile.file);
        [Some(&tile.file), tile.credit.as_ref(), tile.url.as_ref()]
            .into_iter()
            .flatten()
            .for_each(|text| super::assert_harmless(text));
        if let Ok((plate, miss)) = tile.plate(512, 512) {
            assert!(plate.matrix.is_finite() && plate.reference.is_finite() && miss.is_finite(), "{plate:?}");
        }
        if let Ok((_, radius)) = tile.circle() {
            assert!(radius.is_finite(), "{radius:?}");
        }
    }
}
