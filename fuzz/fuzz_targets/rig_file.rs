//! Feeds [`scotopic_fuzz::rig_file`] what libFuzzer thinks up.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scotopic_fuzz::rig_file::check(data));
