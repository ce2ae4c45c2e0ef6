//! The two programs `paracosm-fuzz` and `paracosm-cover`, which the package puts on the path.

use crate::world::catalogue;
use paracosm::cli;
use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the program `paracosm-fuzz` and returns its exit status. The first of the words is the name of the program.
#[pyfunction]
#[pyo3(signature = (words, /))]
pub fn fuzz(py: Python, words: Vec<OsString>) -> u8 {
    cli::called_with(words);
    py.detach(|| cli::fuzz_in_process(&catalogue()))
}

/// Runs the program `paracosm-cover` and returns its exit status. The first of the words is the name of the program.
#[pyfunction]
#[pyo3(signature = (words, /))]
pub fn cover(py: Python, words: Vec<OsString>) -> u8 {
    cli::called_with(words);
    py.detach(|| cli::cover_in_process(&catalogue()))
}
