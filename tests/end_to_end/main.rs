//! The product from outside: its programs as users call them, and campaigns as users of the library run them.

mod adaptive;
mod after_failure;
mod appearances;
mod bad_input;
mod bench;
mod blame;
mod cameras;
mod campaign;
mod certificate;
mod commands;
mod common;
mod comparison;
mod covering;
mod documents;
mod earlier_versions;
mod extend;
mod external_drivers;
mod generate;
mod guilty;
#[cfg(unix)]
mod interrupt;
mod k_epsilon;
mod kills;
mod library;
mod likelihood;
mod maps;
mod mixed_space;
mod monitor;
mod networks;
#[cfg(unix)]
mod outputs;
mod pedestrian_study;
mod pict;
mod pictures;
mod plan;
mod python;
mod races;
mod reference_drivers;
mod requirements;
mod signals;
mod spec;
mod strength;
mod surroundings;
mod system;
mod trust;
mod worked_examples;
