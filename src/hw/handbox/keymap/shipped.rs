//! The key maps that are built into the program.

/// A built-in key map.
#[derive(Debug, Clone, Copy)]
pub struct Shipped {
    /// What it is called.
    pub name: &'static str,
    /// Its TOML text.
    pub text: &'static str,
}

/// All of them.
pub const SHIPPED: &[Shipped] = &[
    Shipped { name: "lx200-classic", text: include_str!("../profiles/lx200-classic.toml") },
    Shipped { name: "autostar2-guess", text: include_str!("../profiles/autostar2-guess.toml") },
    Shipped { name: "ascii", text: include_str!("../profiles/ascii.toml") },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hw::handbox::keymap::KeyMap;

    #[test]
    fn every_built_in_key_map_is_right_is_called_as_it_is_listed_and_is_written_as_it_is_read() {
        for shipped in SHIPPED {
            let map = KeyMap::from_toml(shipped.text).unwrap_or_else(|error| panic!("{}: {error}", shipped.name));
            assert_eq!(map.name(), shipped.name);
            assert_eq!(KeyMap::from_toml(&map.to_toml().unwrap()), Ok(map.clone()));
            assert_eq!(map.is_guess(), shipped.name.contains("guess"));
        }
    }

    /// The table of MAPUG message 17012 and of mbucknel/Lx200ClassicHandset, file `handsetprotocol`.
    #[test]
    fn the_classic_map_has_the_published_codes() {
        let map = KeyMap::shipped("lx200-classic").unwrap();
        let published = [
            ("ENTER", 0x0D, 0x8D),
            ("MODE", 0x4D, 0xCD),
            ("GOTO", 0x47, 0xC7),
            ("PREV", 0x2E, 0xAE),
            ("NEXT", 0x44, 0xC4),
            ("N", 0x4E, 0xCE),
            ("S", 0x53, 0xD3),
            ("E", 0x45, 0xC5),
            ("W", 0x57, 0xD7),
            ("0", 0x30, 0xB0),
            ("9", 0x39, 0xB9),
        ];
        assert_eq!(map.keys().len(), 19);
        for (name, press, release) in published {
            let key = map.keys().iter().find(|key| key.name == name).unwrap_or_else(|| panic!("no key {name}"));
            assert!(key.press.is(&[press]), "{name}");
            assert!(map.releases(key).all(|pattern| pattern.is(&[release])), "{name}");
        }
        assert!(map.keys().iter().all(|key| key.name != "?"), "the Classic has no such key");
    }
}
