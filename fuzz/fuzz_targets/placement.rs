//! Feeds [`scotopic_fuzz::placement`] what libFuzzer thinks up.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scotopic_fuzz::placement::check(data));
