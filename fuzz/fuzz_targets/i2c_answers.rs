//! Feeds [`scotopic_fuzz::i2c_answers`] what libFuzzer thinks up.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| scotopic_fuzz::i2c_answers::check(data));
