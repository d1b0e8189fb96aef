//! Feeds [`scotopic_fuzz::mount_replies`] what libFuzzer thinks up.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scotopic_fuzz::mount_replies::check(data));
