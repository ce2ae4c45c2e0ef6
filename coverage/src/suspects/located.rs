//! What a search for the guilty ends with, held against all other tests.

use super::JudgedTest;
use super::partial::Partial;
use paracosm_space::rules::Rules;

/// A combination whose values are all needed for a failing test to fail.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Located {
    /// Its (parameter, level) pairs, parameters in ascending order.
    pub values: Vec<(usize, usize)>,
    /// Those of its values that the constraints tie to others of them, so that no valid test could tell which of them
    /// are needed.
    pub undivided: Vec<(usize, usize)>,
    /// A failing test that has these values of the first failing test and, but for values that follow from them by the
    /// constraints or were cleared, no others.
    pub witness: Vec<usize>,
    /// How many tests were asked for.
    pub tests: usize,
    /// How many tests are enough for one guilty combination of that size, k (ceil(log2 N) + 1) for k of N values; none
    /// where constraints kept the questions from halving what was in doubt, so that nothing was promised.
    pub bound: Option<usize>,
}

/// How a located combination stands before other tests. Positions are among those.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Standing {
    /// It explains all of them: every one that contains it failed, every other one passed.
    Sole,
    /// All that contain it failed, but so did these, which do not: there is more than one cause.
    OneOfSeveral(Vec<usize>),
    /// These contain it and passed: it is not the cause by itself. Several causes misled the search, or failures depend
    /// on something else.
    Refuted(Vec<usize>),
}

impl Located {
    /// A valid test that has these values and otherwise, as far as constraints allow, the levels of another test. Where
    /// that one passes, a pass of this one refutes the values, and a failure speaks for them.
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

    /// Whether other tests agree with it.
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
