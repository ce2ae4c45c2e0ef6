//! Lets `cargo fuzz` call the parser `percepts` of the table in `src/parsers.rs`.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| paracosm_fuzz_targets::read("percepts", data));
