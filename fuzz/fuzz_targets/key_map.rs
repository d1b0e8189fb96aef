//! Feeds [`scotopic_fuzz::key_map`] what libFuzzer thinks up.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scotopic_fuzz::key_map::check(data));
