//! Feeds [`scotopic_fuzz::trace`] what libFuzzer thinks up.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scotopic_fuzz::trace::check(data));
