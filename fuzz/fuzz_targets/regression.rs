#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| paracosm_fuzz_targets::read("regression", data));
