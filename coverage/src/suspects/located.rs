//! The result of a search for the guilty combination, and its comparison with all other tests.

use super::JudgedTest;
use super::partial::Partial;
use paracosm_space::rules::Rules;

/// The result of a search for the combination of values that makes a test fail, without needless values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Located {
    /// The (parameter, level) pairs of the combination, in ascending order of parameters.
    pub values: Vec<(usize, usize)>,
    /// The values of the combination that no valid test can separate, because constraints tie the values to each other.
    /// It is unknown which of these values are needed.
    pub undivided: Vec<(usize, usize)>,
    /// A failing test that contains the located combination. Its other values differ from those of the first failing
    /// test, except for values that follow by the constraints or were cleared.
    pub witness: Vec<usize>,
    /// The number of tests that the search for the combination requested.
    pub tests: usize,
    /// The greatest number of tests that the search requests for a combination of this size, if no other is guilty. For
    /// k of N values it is k (ceil(log2 N) + 1). `None` if constraints kept the questions from halving the values in
    /// doubt, so that no number is promised.
    pub bound: Option<usize>,
}

/// The agreement of a located combination with the results of further tests. Positions are positions among the further
/// tests.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Standing {
    /// Every test with the combination failed, and every test without the combination passed.
    Sole,
    /// All tests with the combination failed, but the tests at the listed positions failed without the combination.
    /// There is more than one cause.
    OneOfSeveral(Vec<usize>),
    /// The tests at the listed positions contain the combination and passed, so that the combination alone is not the
    /// cause. Several causes misled the search, or failures depend on something else.
    Refuted(Vec<usize>),
}

impl Located {
    /// Makes a valid test from the test `other` by replacing levels by the located values. Further levels change only
    /// if constraints demand this. If the other test passes, a pass of the new test refutes the values, and a failure
    /// speaks for them.
    ///
    /// # Panics
    /// The values were not located under these rules, or the other test has too few levels.
    pub fn put_into(&self, rules: &Rules, other: &[usize]) -> Vec<usize> {
        let mut partial = Partial::new(rules);
        for &(parameter, level) in &self.values {
            assert!(partial.choose(parameter, level), "the witness has all of the values");
        }
        partial.complete(other)
    }

    /// Compares the located combination with the results of further tests.
    ///
    /// # Panics
    /// A test has too few levels.
    pub fn standing(&self, tests: &[JudgedTest]) -> Standing {
        let positions = |wanted: &dyn Fn(&JudgedTest) -> bool| -> Vec<usize> {
            (0..tests.len()).filter(|&position| wanted(&tests[position])).collect()
        };
        let refuting = positions(&|test| !test.failed && test.contains(&self.values));
        if !refuting.is_empty() {
            return Standing::Refuted(refuting);
        }
        let others = positions(&|test| test.failed && !test.contains(&self.values));
        if others.is_empty() { Standing::Sole } else { Standing::OneOfSeveral(others) }
    }
}
