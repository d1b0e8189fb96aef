//! Feeds [`scotopic_fuzz::settings`] what libFuzzer thinks up.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scotopic_fuzz::settings::check(data));
