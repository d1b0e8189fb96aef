//! What must hold whatever the bytes are, one module for each reader. The fuzz targets call `check` with what libFuzzer thinks
//! up; `tests/fuzz_corpus.rs` calls it with the inputs that were kept, so that no tool but cargo is needed for that.

pub mod calibration;
pub mod handbox_bytes;
pub mod i2c_answers;
pub mod key_map;
pub mod mount_replies;
pub mod photograph_index;
pub mod placement;
pub mod rig_file;
mod script;
pub mod settings;
pub mod trace;

/// Text that the program would show must not be able to command a terminal.
///
/// # Panics
/// It has a control character.
fn assert_harmless(shown: &str) {
    assert!(!shown.contains(|c: char| c.is_control() && c != '\n'), "a control character would be shown: {shown:?}");
}
