//! Lets `cargo fuzz` read networks in ONNX files, as drivers and as networks that see.
#![no_main]

use libfuzzer_sys::fuzz_target;
use paracosm_neural::Model;
use paracosm_neural::vision::{Description, Vision};
use std::sync::LazyLock;

static DESCRIPTION: LazyLock<Description> =
    LazyLock::new(|| Description::parse(include_str!("../seeds/network/detector.toml")).expect("the seed is valid"));

fuzz_target!(
    // The library that reads networks panics on some of them. The readers catch these panics, so the program must not
    // end when a panic begins.
    init: std::panic::set_hook(Box::new(|_| ())),
    |data: &[u8]| {
        if let Err(error) = Model::read(data) {
            assert!(!error.to_string().is_empty(), "an error says something");
        }
        if let Err(error) = Vision::read(data, DESCRIPTION.clone()) {
            assert!(!error.to_string().is_empty(), "an error says something");
        }
        if let Ok(text) = std::str::from_utf8(data)
            && let Err(error) = Description::parse(text)
        {
            assert!(!error.to_string().is_empty(), "an error says something");
        }
    }
);
