//! The tapped line: any bytes at any time, in each way of framing.

use std::collections::BTreeMap;
use std::time::Duration;

use scotopic::hw::handbox::presses::MOST_A_SECOND;
use scotopic::hw::handbox::{Decoder, Heard, KeyMap};

use super::assert_harmless;
use super::script::Script;

/// Frames of one length, and frames that a silence ends, which no shipped map has.
const OTHERS: [&str; 3] = [
    "name = \"fixed\"\nframing = { mode = \"fixed\", length = 4, lead = \"02\" }\n\
     [[key]]\nname = \"?\"\npress = \"02 01 ?? 03\"\nrelease = \"02 00 ?? 03\"\nlong = \"02 05 3F 03\"\n\
     [[key]]\nname = \"M\"\npress = \"02 02 41 ??\"\n",
    "name = \"gap\"\nignore = [\"FF FF\"]\nframing = { mode = \"gap\", gap_ms = 25 }\n\
     [[key]]\nname = \"?\"\npress = \"3F\"\nrelease = \"BF\"\n\
     [[key]]\nname = \"M\"\npress = \"02 41 03\"\nlong = \"02 42 ?? 03\"\n",
    "name = \"long\"\nframing = { mode = \"escape\", gap_ms = 40 }\n\
     [[key]]\nname = \"?\"\npress = \"3F\"\nlong = \"40\"\n[[key]]\nname = \"M\"\npress = \"4D\"\n",
];

/// Milliseconds that pass between two groups of bytes.
const PAUSES: [u64; 32] = [
    0, 1, 2, 5, 10, 15, 16, 20, 24, 25, 26, 30, 40, 49, 50, 51, 75, 99, 100, 101, 149, 150, 151, 200, 399, 400, 401,
    799, 800, 801, 1000, 5000,
];

/// Checks one input: the first byte chooses the key map and whether long presses are wanted, then come pauses and bytes.
///
/// # Panics
/// Something does not hold.
pub fn check(data: &[u8]) {
    let mut script = Script(data);
    let Some(choice) = script.byte() else { return };
    let (map, long) = (map(choice % 6), choice & 0x80 != 0);
    let keys: Vec<String> = map.keys().iter().map(|key| key.name.clone()).collect();
    let decoder = || {
        let decoder = Decoder::new(map.clone());
        if long { decoder.with_long(keys.clone()) } else { decoder }
    };
    let (mut whole, mut pieces) = (decoder(), decoder());
    let mut told = Told { keys: &keys, last: Duration::ZERO, recent: BTreeMap::new() };
    let mut now = Duration::from_secs(1);
    while let Some(turn) = script.byte() {
        now += Duration::from_millis(PAUSES[usize::from(turn >> 3)]);
        let bytes = script.bytes(usize::from(turn & 7));
        let heard = whole.feed(bytes, now);
        let apart: Vec<Heard> = bytes.chunks(1).chain([&[][..]]).flat_map(|byte| pieces.feed(byte, now)).collect();
        assert_eq!(presses(&heard), presses(&apart), "it matters how the bytes are handed over");
        heard.into_iter().for_each(|heard| told.hear(heard, now));
        assert!(whole.wake_at().is_none_or(|at| at > now), "it would wake without end");
        if turn == 0 {
            whole.reset();
            pieces.reset();
            told.recent.clear();
        }
    }
    // The end of a frame may begin a press, the end of that a silence.
    for _stage in 0..3 {
        now += Duration::from_secs(60);
        whole.tick(now).into_iter().for_each(|heard| told.hear(heard, now));
    }
    assert_eq!(whole.wake_at(), None, "a silent line is never at rest");
}

fn map(choice: u8) -> KeyMap {
    let map = match choice {
        0 => KeyMap::shipped("lx200-classic"),
        1 => KeyMap::shipped("autostar2-guess"),
        2 => KeyMap::shipped("ascii"),
        other => KeyMap::from_toml(OTHERS[usize::from(other - 3)]).ok(),
    };
    assert!(map.is_some(), "key map {choice}");
    map.unwrap_or_else(|| unreachable!())
}

/// What the session acts on.
fn presses(heard: &[Heard]) -> Vec<&Heard> {
    heard.iter().filter(|heard| !matches!(heard, Heard::Unknown { .. } | Heard::Noise { .. })).collect()
}

/// What has been told so far.
struct Told<'a> {
    keys: &'a [String],
    last: Duration,
    recent: BTreeMap<String, Vec<Duration>>,
}

impl Told<'_> {
    fn hear(&mut self, heard: Heard, now: Duration) {
        match heard {
            Heard::Pressed(pressed) => {
                assert!(self.keys.contains(&pressed.key), "{pressed:?}");
                assert!(
                    pressed.at <= now && pressed.at + Duration::from_secs(60) >= self.last,
                    "{pressed:?} at {now:?}"
                );
                let recent = self.recent.entry(pressed.key.clone()).or_default();
                recent.retain(|at| *at + Duration::from_secs(1) > pressed.at);
                recent.push(pressed.at);
                assert!(recent.len() <= MOST_A_SECOND, "{} presses of '{}' in a second", recent.len(), pressed.key);
                self.last = self.last.max(pressed.at);
            }
            Heard::Released { key, at } | Heard::Stuck { key, at } => {
                assert!(self.keys.contains(&key) && at <= now, "'{key}' at {at:?}");
            }
            Heard::Unknown { hex, at } => {
                assert_harmless(&hex);
                assert!(hex.split(' ').count() <= 32 && at <= now, "{hex}");
            }
            Heard::Noise { bytes, at } => assert!(bytes > 0 && at <= now, "{bytes} bytes of noise"),
        }
    }
}
