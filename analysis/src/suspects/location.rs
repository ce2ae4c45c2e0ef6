//! Defines the result of the search for the guilty combination of one failing test.

use paracosm_oracles::Verdict;
use paracosm_space::Values;
use serde::Serialize;

/// A further test with its verdict.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TestOfLocation {
    /// The values of the open parameters.
    pub test: Values,
    /// The verdict of the test.
    pub verdict: Verdict,
}

/// The conclusion that further tests allow about a failing test.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Conclusion {
    /// The located values are the cause, because no test that has these values passed.
    Guilty,
    /// The located values are not the cause by themselves, because some tests that have these values passed.
    Refuted {
        /// The indices of the campaign's tests that have the values and passed.
        trials: Vec<usize>,
        /// The number of further tests that have the values and passed.
        further: usize,
    },
    /// The test fails also with the discrete values of the passing trials with these indices. The discrete values of
    /// those trials are not the reason why they passed.
    NoStart(Vec<usize>),
    /// All passing trials have the same discrete values as the failing test.
    NoPassingTest,
    /// A further test neither failed nor passed, but had this verdict.
    Undecided(Verdict),
    /// The limit of further tests was reached.
    LimitReached,
}

/// The result of the search that began with one failing test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Location {
    /// The index of the failing trial.
    pub failing: usize,
    /// The conclusion of the search.
    pub conclusion: Conclusion,
    /// The located values; empty if there is no conclusion about values.
    pub values: Values,
    /// The located values that constraints connect with other located values, so that no test can show which of them
    /// are needed.
    pub undivided: Values,
    /// The indices of the failing trials that have the values, if the values are guilty.
    pub explains: Vec<usize>,
    /// The number of tests that were run to find a start. It is 0 if there are no continuous parameters.
    pub starting: usize,
    /// The number of tests that were run to confirm the located values. It is 0 if the values explain all failures.
    pub confirming: usize,
    /// The number of times that the search began again because tests refuted the located values. This happens if
    /// several combinations are guilty.
    pub restarts: usize,
    /// The number of tests that are enough to locate a single guilty combination, without those for the start and for
    /// confirmation. It is k (ceil(log2 N) + 1) for k of N values. `None` if constraints or combinations found before
    /// kept the search from halving, if several combinations misled it, or if nothing was located.
    pub bound: Option<usize>,
    /// The tests that were run, in order.
    pub tests: Vec<TestOfLocation>,
}
