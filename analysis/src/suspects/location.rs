//! What the search behind one failing test came to.

use paracosm_oracles::Verdict;
use paracosm_space::Values;
use serde::Serialize;

/// A further test and how it ended.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TestOfLocation {
    /// The values of the open parameters.
    pub test: Values,
    /// How it ended.
    pub verdict: Verdict,
}

/// What further tests say about a failing test.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Conclusion {
    /// The located values are the cause: no test that has them passed.
    Guilty,
    /// Some tests have the located values too and passed: those are not the cause by themselves.
    Refuted {
        /// The indices of the campaign's tests that did.
        trials: Vec<usize>,
        /// How many further tests did.
        further: usize,
    },
    /// The test fails with the discrete values of passing trials as well, those of these indices; their discrete values
    /// are not what saved them.
    NoStart(Vec<usize>),
    /// All passing trials have the discrete values of the failing test.
    NoPassingTest,
    /// A test ended neither in a failure nor in a pass.
    Undecided(Verdict),
    /// There were to be no more further tests.
    LimitReached,
}

/// The search that began with one failing test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Location {
    /// The index of the failing trial.
    pub failing: usize,
    /// What the search ended with.
    pub conclusion: Conclusion,
    /// The located values; none where there is no conclusion about values.
    pub values: Values,
    /// Those of them that constraints tie to others of them, so that no test could tell which are needed.
    pub undivided: Values,
    /// The indices of the failing trials that have the values, if these are guilty.
    pub explains: Vec<usize>,
    /// How many of the tests were needed to begin: none where there are no continuous parameters.
    pub starting: usize,
    /// How many of the tests were to confirm what was located: none where it explains all failures.
    pub confirming: usize,
    /// How often the search began anew because tests refuted what it had located: several combinations are guilty.
    pub restarts: usize,
    /// How many tests besides those to begin and to confirm are enough for one guilty combination, k (ceil(log2 N) + 1)
    /// for k of N values; `None` where constraints or combinations found before kept the search from halving, where
    /// several combinations misled it, or where nothing was located.
    pub bound: Option<usize>,
    /// The tests that were run, in order.
    pub tests: Vec<TestOfLocation>,
}
