//! Feeds [`scotopic_fuzz::handbox_bytes`] what libFuzzer thinks up.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scotopic_fuzz::handbox_bytes::check(data));
