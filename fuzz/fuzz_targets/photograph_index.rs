//! Feeds [`scotopic_fuzz::photograph_index`] what libFuzzer thinks up.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scotopic_fuzz::photograph_index::check(data));
