//! Every framing, worn keypads, and bytes of any kind.

use proptest::prelude::*;

use super::*;
use crate::hw::handbox::Pressed;
use crate::hw::handbox::sim::{Faults, Handset};

fn ms(ms: u64) -> Duration {
    Duration::from_millis(ms)
}

fn map(framing: &str, keys: &[(&str, &str, &str)]) -> KeyMap {
    let mut text = format!("name = \"test\"\nignore = [\"AA 55\"]\n[framing]\n{framing}\n");
    for (name, press, release) in keys {
        text += &format!("[[key]]\nname = \"{name}\"\npress = \"{press}\"\n");
        if !release.is_empty() {
            text += &format!("release = \"{release}\"\n");
        }
    }
    KeyMap::from_toml(&text).unwrap()
}

/// What is pressed, in words, of chunks with their milliseconds, time passing between.
fn pressed(decoder: &mut Decoder, chunks: &[(u64, &[u8])]) -> Vec<String> {
    let mut heard = Vec::new();
    for (at, bytes) in chunks {
        while let Some(due) = decoder.wake_at().filter(|due| *due < ms(*at)) {
            heard.extend(decoder.tick(due));
        }
        heard.extend(decoder.feed(bytes, ms(*at)));
    }
    while let Some(due) = decoder.wake_at() {
        heard.extend(decoder.tick(due));
    }
    words(&heard)
}

fn words(heard: &[Heard]) -> Vec<String> {
    let word = |heard: &Heard| match heard {
        Heard::Pressed(Pressed { key, long, .. }) => Some(format!("{key}{}", if *long { "~" } else { "" })),
        Heard::Unknown { hex, .. } => Some(format!("({hex})")),
        Heard::Noise { bytes, .. } => Some(format!("({bytes} bytes)")),
        Heard::Stuck { key, .. } => Some(format!("{key}!")),
        Heard::Released { .. } => None,
    };
    heard.iter().filter_map(word).collect()
}

#[test]
fn single_bytes_are_keys_and_others_are_shown() {
    let mut decoder = Decoder::new(map("mode = \"single\"", &[("?", "3F", ""), ("UP", "75", "")]));
    assert_eq!(pressed(&mut decoder, &[(0, b"?u"), (200, b"xyz?")]), ["?", "UP", "(78 79 7A)", "?"]);
    assert_eq!(pressed(&mut decoder, &[(1000, &[0xAA, 0x55, 0x01])]), ["(01)"], "ignored bytes are not shown");
    assert_eq!(pressed(&mut decoder, &[(2000, &[0x80; 100])]), ["(100 bytes)"]);
}

#[test]
fn text_for_the_display_holds_no_keys() {
    let mut decoder = Decoder::new(KeyMap::shipped("lx200-classic").unwrap());
    let text: &[u8] = b"\x1B1NEWS 0123456789 \x1B2DMG";
    assert_eq!(
        pressed(&mut decoder, &[(0, text), (10, b"N"), (100, b"N"), (200, b"\xCE")]),
        ["N"],
        "silence ends the text"
    );
    let lamps: &[u8] = b"\x1BD\x01\x1BL\x08\x1BBM\xCD";
    assert_eq!(pressed(&mut decoder, &[(1000, lamps)]), ["MODE"]);
}

#[test]
fn frames_of_one_length_find_their_beginning_again() {
    let framing = "mode = \"fixed\"\nlength = 3\nlead = \"02\"";
    let mut decoder = Decoder::new(map(framing, &[("?", "02 3F ??", "02 BF ??"), ("UP", "02 41 ??", "02 C1 ??")]));
    assert_eq!(
        pressed(&mut decoder, &[(0, &[0x3F, 0x03, 0x02, 0x3F, 0x02]), (100, &[0x02, 0xBF, 0x00])]),
        ["(3F 03)", "?"]
    );
    assert_eq!(pressed(&mut decoder, &[(1000, &[0x02, 0x02, 0x41, 0x07])]), ["(02)", "UP"], "a lead that was none");
    assert_eq!(
        pressed(&mut decoder, &[(2000, &[0x02, 0x3F]), (2100, &[0x02, 0x3F, 0x00])]),
        ["(02 3F)", "?"],
        "half a frame"
    );
}

#[test]
fn frames_that_end_with_silence_may_come_in_pieces_or_two_at_once() {
    let framing = "mode = \"gap\"\ngap_ms = 25";
    let keys = [("?", "10 3F 20", "10 BF 20"), ("UP", "11 ?? 33 44", "")];
    let mut decoder = Decoder::new(map(framing, &keys));
    assert_eq!(pressed(&mut decoder, &[(0, &[0x10]), (16, &[0x3F, 0x20]), (100, &[0x10, 0xBF, 0x20])]), ["?"]);
    assert_eq!(
        pressed(&mut decoder, &[(1000, &[0x10, 0x3F, 0x20, 0x10, 0xBF, 0x20, 0x11, 0, 0x33, 0x44])]),
        ["?", "UP"]
    );
    assert_eq!(
        pressed(&mut decoder, &[(2000, &[0x10, 0x3F]), (2100, &[0x20])]),
        ["(10 3F)", "(20)"],
        "a silence inside"
    );
    assert_eq!(pressed(&mut decoder, &[(3000, &[0xAA, 0x55, 0x10, 0x3F, 0x20])]), ["?"], "idle traffic before it");
}

#[test]
fn a_long_press_is_told_by_its_pattern_or_by_time() {
    let mut decoder = Decoder::new(KeyMap::shipped("autostar2-guess").unwrap());
    assert_eq!(pressed(&mut decoder, &[(0, &[0x09]), (500, &[0x0B]), (600, &[0x8B])]), ["MODE~"]);
    assert_eq!(pressed(&mut decoder, &[(2000, &[0x09]), (2100, &[0x89])]), ["MODE"]);
    assert_eq!(pressed(&mut decoder, &[(4000, &[0x3F]), (6000, &[0xBF])]), ["?"], "nobody asked for its long press");
    let mut decoder = decoder.with_long(["?".to_owned()]);
    assert_eq!(pressed(&mut decoder, &[(8000, &[0x3F]), (10_000, &[0xBF])]), ["?~"]);
}

#[test]
fn a_worn_keypad_on_a_noisy_shared_wire_is_heard_key_by_key() {
    for (faults, seed) in [
        (Faults { bounce: 1.0, ..Faults::default() }, 1),
        (Faults { bounce: 0.5, display: true, noise: 0.2, missing: 0.0 }, 2),
    ] {
        let map = KeyMap::shipped("lx200-classic").unwrap();
        let names: Vec<String> = map.keys().iter().map(|key| key.name.clone()).collect();
        let mut handset = Handset::new(map.clone(), faults, seed);
        let mut decoder = Decoder::new(map);
        let (mut wanted, mut heard, mut now) = (Vec::new(), Vec::new(), ms(100));
        for name in names.iter().cycle().take(200) {
            handset.press(name, now, ms(120)).unwrap();
            wanted.push(name.clone());
            let until = now + ms(400);
            while now < until {
                now += ms(1);
                heard.extend(decoder.feed(&handset.drain(now), now));
            }
        }
        let keys: Vec<String> = words(&heard).into_iter().filter(|word| !word.starts_with('(')).collect();
        // A byte of noise may happen to be a key's: then there is one more.
        let extra = keys.len().abs_diff(wanted.len());
        assert!(extra <= if faults.noise > 0.0 { 8 } else { 0 }, "{extra} more or fewer, seed {seed}");
        let mut heard = keys.iter();
        assert!(wanted.iter().all(|key| heard.any(|h| h == key)), "every press in its order, seed {seed}");
    }
}

#[test]
fn a_stuck_key_falls_silent_and_the_others_are_heard() {
    let mut handset = Handset::new(KeyMap::shipped("autostar2-guess").unwrap(), Faults::default(), 1);
    let mut decoder = Decoder::new(handset.map().clone());
    handset.stick("?", ms(0), ms(5000)).unwrap();
    handset.press("UP", ms(3000), ms(100)).unwrap();
    handset.press("?", ms(7000), ms(100)).unwrap();
    let mut heard = Vec::new();
    for now in (0..8000).map(ms) {
        heard.extend(decoder.feed(&handset.drain(now), now));
    }
    assert_eq!(words(&heard), ["?", "?!", "UP", "?"]);
}

fn maps() -> impl Strategy<Value = KeyMap> {
    prop_oneof![
        Just(KeyMap::shipped("lx200-classic").unwrap()),
        Just(KeyMap::shipped("autostar2-guess").unwrap()),
        Just(KeyMap::shipped("ascii").unwrap()),
        Just(map("mode = \"fixed\"\nlength = 3\nlead = \"02\"", &[("?", "02 3F ??", "02 BF ??")])),
        Just(map("mode = \"gap\"", &[("?", "10 3F", "10 BF"), ("UP", "11 ?? 33", "")])),
    ]
}

/// Bytes that are often those of keys.
fn bytes() -> impl Strategy<Value = Vec<u8>> {
    let likely = prop::sample::select(vec![0x3F, 0xBF, 0x02, 0x10, 0x11, 0x33, 0x1B, 0x31, 0x4E, 0xCE, 0xFF]);
    prop::collection::vec(prop_oneof![likely, any::<u8>()], 0..200)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn bytes_of_any_kind_at_any_time_do_no_harm(map in maps(), chunks in prop::collection::vec((bytes(), 0..2000_u64), 0..12)) {
        let mut decoder = Decoder::new(map);
        for (bytes, at) in chunks {
            let heard = decoder.feed(&bytes, ms(at));
            prop_assert!(heard.len() <= 2 * bytes.len() + 80);
            prop_assert!(decoder.frame.len() <= LONGEST_FRAME && decoder.unknown.is_empty());
            let _ = decoder.tick(ms(at / 2));
        }
    }

    #[test]
    fn it_does_not_matter_how_the_bytes_are_cut(map in maps(), bytes in bytes(), cut in 0..200_usize) {
        let cut = cut.min(bytes.len());
        let keys = |heard: Vec<Heard>| heard.into_iter().filter(|h| !matches!(h, Heard::Unknown { .. } | Heard::Noise { .. })).collect::<Vec<_>>();
        let (mut whole, mut halves) = (Decoder::new(map.clone()), Decoder::new(map));
        let mut once = whole.feed(&bytes, ms(5));
        once.extend(whole.tick(ms(2000)));
        let mut twice = halves.feed(&bytes[..cut], ms(5));
        twice.extend(halves.feed(&bytes[cut..], ms(5)));
        twice.extend(halves.tick(ms(2000)));
        prop_assert_eq!(keys(once), keys(twice));
    }

    #[test]
    fn text_of_any_kind_is_a_key_map_or_refused(text in "(name = \"a\"\n)?(\\[framing\\]\nmode = \"(gap|fixed|bit7)\"\n)?(\\[\\[key\\]\\]\nname = \"[a-c~]\"\npress = \"[0-9A-F? ]{0,6}\"\n){0,4}.{0,20}") {
        if let Ok(map) = KeyMap::from_toml(&text) {
            prop_assert_eq!(KeyMap::from_toml(&map.to_toml().unwrap()), Ok(map));
        }
    }
}
