//! Additions to a suite: few tests that kill the mutants which the suite misses, and a test in its hole.
//!
//! The tests come from the screen, where each mutant is noticed by some test. To choose the fewest of them is a set cover.

use super::bout::Tried;
use super::cover::Cover;
use super::{Screen, Witness};
use paracosm_space::Values;
use serde::Serialize;

/// Tests that kill all mutants which a suite misses, and its witness.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Additions {
    /// The number of mutants that the suite misses.
    pub missed: usize,
    /// The tests: first those of the screen, then the failing test of the witness, if there is a witness.
    pub tests: Vec<Values>,
    /// A lower bound on the number of tests of the screen that kill all missed mutants.
    pub at_least: usize,
}

impl Additions {
    /// Chooses tests of a screen for a suite, which is named by its position.
    pub(super) fn of(screen: &Screen, tried: &[Tried], suite: usize, witness: Option<&Witness>) -> Self {
        let missed = screen.mutants.iter().zip(tried).filter(|(_, tried)| tried.kills[suite].is_none());
        let missed: Vec<&[usize]> = missed.map(|(noticed, _)| &noticed.tests[..]).collect();
        let Cover { tests, at_least } = Cover::of(&missed, screen.values.len());
        let chosen = tests.into_iter().map(|test| screen.values[test].clone());
        let tests = chosen.chain(witness.map(|witness| witness.fails_at.clone())).collect();
        Self { missed: missed.len(), tests, at_least }
    }
}
