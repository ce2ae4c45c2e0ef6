//! Defines the result of the search for the guilty combination of one failing test.

use paracosm_oracles::Verdict;
use paracosm_space::Values;
use serde::Serialize;

/// A further test that the search for a guilty combination ran, with the verdict of the test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TestOfLocation {
    /// The values of the open parameters in the test.
    pub test: Values,
    /// The verdict of the further test.
    pub verdict: Verdict,
}

/// The conclusion that further tests allow about a failing test.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Conclusion {
    /// The located values are the cause of the failure, because no test with these values passed.
    Guilty,
    /// The located values alone are not the cause of the failure, because tests with these values passed.
    Refuted {
        /// The indices of the campaign's tests that have the located values and passed.
        trials: Vec<usize>,
        /// The number of further tests that have the located values and passed.
        further: usize,
    },
    /// The failing test also fails with the discrete values of the passing trials with these indices. The discrete
    /// values of those trials are not the reason why they passed.
    NoStart(Vec<usize>),
    /// All passing trials have the same discrete values as the failing test.
    NoPassingTest,
    /// A further test had a verdict other than pass or fail.
    Undecided(Verdict),
    /// The search reached the greatest number of further tests.
    LimitReached,
}

/// The result of the search for the guilty combination of one failing test.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Location {
    /// The index of the failing trial.
    pub failing: usize,
    /// The conclusion of the search for the guilty combination.
    pub conclusion: Conclusion,
    /// The discrete values that the search located as the cause; empty if there is no conclusion about values.
    pub values: Values,
    /// The located values that constraints tie together, so that tests cannot show whether each value is needed.
    pub undivided: Values,
    /// The indices of the failing trials that have the located values; empty if the values are not guilty.
    pub explains: Vec<usize>,
    /// The number of tests that were run to find a passing test from which the search starts. It is 0 if there are no
    /// continuous parameters.
    pub starting: usize,
    /// The number of tests that were run to confirm that the located values are guilty. It is 0 if the values explain
    /// all failures.
    pub confirming: usize,
    /// The number of times that the search began again because tests refuted the located values. This happens if
    /// several combinations are guilty.
    pub restarts: usize,
    /// The number of tests that suffices to locate a single guilty combination, without the tests for the start and for
    /// confirmation. It is k (ceil(log2 N) + 1) for k of N values. `None` if constraints or combinations found before
    /// kept the search from halving, if several combinations misled it, or if nothing was located.
    pub bound: Option<usize>,
    /// The further tests that the search ran, in the order of the runs.
    pub tests: Vec<TestOfLocation>,
}
