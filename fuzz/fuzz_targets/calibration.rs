//! Feeds [`scotopic_fuzz::calibration`] what libFuzzer thinks up.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scotopic_fuzz::calibration::check(data));
