//! Recorded conversations: JSON lines that may have been damaged, or written by somebody else.

use std::time::Duration;

use scotopic::hw::handbox::capture;
use scotopic::hw::port::Port;
use scotopic::hw::trace::Replay;

use super::assert_harmless;

/// Checks one input.
///
/// # Panics
/// Something does not hold.
pub fn check(data: &[u8]) {
    let Ok(text) = str::from_utf8(data) else { return };
    if let Err(error) = capture::read(text) {
        assert_harmless(&error.to_string());
    }
    let mut replay = match Replay::parse(text) {
        Ok(replay) => replay,
        Err(error) => return assert_harmless(&error.to_string()),
    };
    let mut buffer = [0; 7];
    for second in 0..32 {
        replay.set_now(Duration::from_secs(1 << second));
        assert!(replay.receive(&mut buffer).is_ok_and(|count| count <= buffer.len()));
        if let Err(error) = replay.send(&data[..data.len().min(2)]) {
            assert_harmless(&error.to_string());
        }
    }
    if let Err(error) = replay.finish() {
        assert_harmless(&error.to_string());
    }
}
