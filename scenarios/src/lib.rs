//! The catalogue of scenario programs, by name.

mod pedestrian_crossing;

use paracosm_coverage::{did_you_mean, nearest};
use paracosm_engine::Program;
use thiserror::Error;

/// Every scenario there is.
pub const ALL: [&Program; 1] = [&pedestrian_crossing::PROGRAM];

/// A name that no scenario has.
#[derive(Debug, Error, PartialEq)]
#[error("no scenario is called `{name}`{}", did_you_mean(.nearest))]
pub struct UnknownScenario {
    /// The name.
    pub name: String,
    /// A name that was perhaps meant.
    pub nearest: Option<&'static str>,
}

/// The scenario of that name.
///
/// # Errors
/// There is none; the error suggests the nearest name.
pub fn find(name: &str) -> Result<&'static Program, UnknownScenario> {
    ALL.into_iter().find(|program| program.name == name).ok_or_else(|| UnknownScenario {
        name: name.to_owned(),
        nearest: nearest(name, ALL.map(|program| program.name)),
    })
}
