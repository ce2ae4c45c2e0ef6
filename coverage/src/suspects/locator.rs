//! Finds the guilty combination in a failing test by asking for few more tests.
//!
//! The method is that of Zhang and Zhang, "Characterizing failure-causing parameter interactions by adaptive testing"
//! (ISSTA 2011). Between a failing test and a passing test that keeps some of its values, a guilty value is found by
//! halving the values in which they differ. Then the guilty values are kept and all others are changed. If that test
//! passes, another guilty value is searched in the same way. If one combination of k of the N values is guilty, each
//! of the k values takes at most ceil(log2 N) tests to be found, and one test for the question whether it was the
//! last.
//!
//! A value is either kept or changed; it does not matter to which level it is changed. That leaves room for
//! constraints, which every test satisfies. If the constraints allow no test that halves the values in doubt, the
//! test with the most even division is used. If they allow no test that divides the values at all, the values stay
//! together.

use super::Located;
use super::partial::Partial;
use crate::kwise::{KwiseError, check};
use paracosm_space::rules::Rules;
use thiserror::Error;

/// The reason why a search for the combination that makes a test fail cannot begin.
#[derive(Debug, Error, PartialEq)]
pub enum LocateError {
    /// The failing or the passing test does not belong to the space. Test 0 is the failing test, test 1 the passing
    /// test.
    #[error(transparent)]
    Test(#[from] KwiseError),
    /// The failing or the passing test violates a constraint.
    #[error("the {role} test violates a constraint")]
    Invalid {
        /// The role of the test that violates a constraint, `failing` or `passing`.
        role: &'static str,
    },
    /// The failing test and the passing test have the same levels.
    #[error("the failing test and the passing test are the same")]
    Same,
}

/// The state of knowledge about a value of the failing test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// The value is not guilty, because some failing test does not have it.
    Cleared,
    /// The value is in doubt. At least one such value is guilty, because a test without them passed.
    Doubted,
    /// The value may be guilty. The passing test without the doubted values kept it.
    Waiting,
    /// The value is guilty.
    Guilty,
}

/// A test to be run.
#[derive(Debug, Clone)]
struct Question {
    test: Vec<usize>,
    /// The values in doubt that the test changes.
    changed: Vec<usize>,
    /// The values in doubt that the test keeps.
    kept: Vec<usize>,
}

/// A search for the combination of values that makes a test fail, which requests one test after the other and learns
/// the results.
///
/// ```
/// use paracosm_space::rules::Rules;
/// use paracosm_coverage::suspects::Locator;
/// let rules = Rules::free(&[3; 8]);
/// let mut locator = Locator::new(&rules, &[1; 8], &[0; 8])?;
/// while let Some(test) = locator.question() {
///     let failed = test[2] == 1 && test[5] == 1; // what nobody knows
///     locator.tell(failed);
/// }
/// let located = locator.located().unwrap();
/// assert_eq!(located.values, [(2, 1), (5, 1)]);
/// assert!(located.tests <= 2 * (3 + 1));
/// # Ok::<(), paracosm_coverage::suspects::LocateError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Locator<'r> {
    rules: &'r Rules,
    /// The failing test whose values are in question.
    accused: Vec<usize>,
    /// For each parameter, the levels that its value may be changed to; the level of the passing test comes first.
    others: Vec<Vec<usize>>,
    /// The last test that failed.
    failing: Vec<usize>,
    roles: Vec<Role>,
    undivided: Vec<usize>,
    question: Option<Question>,
    tests: usize,
    /// `true` if all questions so far took as few tests as promised.
    as_promised: bool,
}

impl<'r> Locator<'r> {
    /// Begins a search for a guilty combination with a failing test and a passing test.
    ///
    /// # Errors
    /// A test does not belong to this space or violates a constraint, or both tests are the same.
    pub fn new(rules: &'r Rules, failing: &[usize], passing: &[usize]) -> Result<Self, LocateError> {
        Self::cautious(rules, failing, passing, |_, _| true)
    }

    /// Begins a search as [`Locator::new`] does, but changes values only to levels of the passing test and to levels
    /// for which `safe` returns `true`. `safe` receives a parameter and a level of the parameter. It is not asked about
    /// levels that constraints force.
    ///
    /// This helps if several combinations are guilty: a value may be part of one combination, and the level that it
    /// is changed to part of another. A value without a safe level is kept, and is not reported as guilty.
    ///
    /// # Errors
    /// As [`Locator::new`].
    pub fn cautious(
        rules: &'r Rules,
        failing: &[usize],
        passing: &[usize],
        safe: impl Fn(usize, usize) -> bool,
    ) -> Result<Self, LocateError> {
        for (index, (name, test)) in [("failing", failing), ("passing", passing)].into_iter().enumerate() {
            check(rules.levels(), index, test)?;
            if !rules.allows(test) {
                return Err(LocateError::Invalid { role: name });
            }
        }
        if failing == passing {
            return Err(LocateError::Same);
        }
        let role = |(a, b)| if a == b { Role::Waiting } else { Role::Doubted };
        let mut locator = Self {
            rules,
            accused: failing.to_vec(),
            others: (0..passing.len())
                .map(|parameter| {
                    let safe = (0..rules.levels()[parameter]).filter(|&level| safe(parameter, level));
                    std::iter::once(passing[parameter]).chain(safe).collect()
                })
                .collect(),
            failing: failing.to_vec(),
            roles: failing.iter().zip(passing).map(role).collect(),
            undivided: Vec::new(),
            question: None,
            tests: 0,
            as_promised: true,
        };
        locator.advance();
        Ok(locator)
    }

    /// Returns the levels of the test that the search needs next; `None` when the search is over.
    pub fn question(&self) -> Option<&[usize]> {
        self.question.as_ref().map(|question| question.test.as_slice())
    }

    /// Takes the result of the test that [`Locator::question`] returned.
    ///
    /// # Panics
    /// The search is over.
    pub fn tell(&mut self, failed: bool) {
        let question = self.question.take().expect("a question was asked");
        self.tests += 1;
        let was_last = self.with(Role::Doubted).is_empty();
        if failed {
            question.changed.iter().for_each(|&value| self.roles[value] = Role::Cleared);
            self.failing = question.test;
        } else {
            question.kept.iter().for_each(|&value| self.roles[value] = Role::Waiting);
            question.changed.iter().for_each(|&value| self.roles[value] = Role::Doubted);
        }
        self.advance();
        // This test was to be the last, but constraints had kept it from changing all values that can be changed.
        self.as_promised &= !(failed && was_last && self.question.is_some());
    }

    /// Returns the guilty combination; `None` before the search is over.
    pub fn located(&self) -> Option<Located> {
        if self.question.is_some() {
            return None;
        }
        let pair = |parameter: usize| (parameter, self.accused[parameter]);
        let guilty = self.with(Role::Guilty);
        let parameters = self.accused.len();
        let bound = guilty.len() * (parameters.next_power_of_two().ilog2() as usize + 1);
        Some(Located {
            values: guilty.into_iter().map(pair).collect(),
            undivided: self.undivided.iter().copied().map(pair).collect(),
            witness: self.failing.clone(),
            tests: self.tests,
            bound: self.as_promised.then_some(bound),
        })
    }

    fn with(&self, role: Role) -> Vec<usize> {
        (0..self.roles.len()).filter(|&value| self.roles[value] == role).collect()
    }

    /// Draws conclusions until a test is needed.
    fn advance(&mut self) {
        loop {
            let doubted = self.with(Role::Doubted);
            self.question = match doubted.len() {
                0 => self.without_waiting(),
                1 => None,
                _ => self.parting(&doubted),
            };
            if let Some(question) = &self.question {
                self.as_promised &= doubted.is_empty() || question.is_even();
                return;
            }
            if doubted.is_empty() {
                return;
            }
            if doubted.len() > 1 {
                self.undivided.extend(&doubted);
                self.as_promised = false;
            }
            doubted.into_iter().for_each(|value| self.roles[value] = Role::Guilty);
        }
    }

    /// A test that keeps the guilty values and changes all waiting values that can be changed; `None` if no value can
    /// be changed.
    fn without_waiting(&self) -> Option<Question> {
        let mut partial = self.keeping(&[Role::Guilty]);
        let change = |&value: &usize| partial.choose_other(value, self.accused[value], &self.others[value]);
        let (changed, kept): (Vec<usize>, Vec<usize>) = self.with(Role::Waiting).into_iter().partition(change);
        // A value that cannot be changed is completed unchanged: it has no other level.
        (!changed.is_empty()).then(|| Question { test: partial.complete(&self.failing), changed, kept })
    }

    /// A test that keeps guilty and waiting values and changes about half of the doubted values; `None` if every
    /// valid test changes all of them or none.
    fn parting(&self, doubted: &[usize]) -> Option<Question> {
        let keeping = self.keeping(&[Role::Guilty, Role::Waiting]);
        let rotations = (0..doubted.len()).map(|by| [&doubted[by..], &doubted[..by]].concat());
        let mut best: Option<Question> = None;
        for order in rotations {
            let question = self.change_first(keeping.clone(), &order, None);
            let Some(question) = question.filter(|q| best.as_ref().is_none_or(|b| q.larger_part() < b.larger_part()))
            else {
                continue;
            };
            if question.is_even() {
                return Some(question);
            }
            best = Some(question);
        }
        // If any two values can be separated, one of these questions does so.
        best.or_else(|| {
            let pairs = doubted.iter().flat_map(|&keep| doubted.iter().map(move |&change| (keep, change)));
            pairs.filter(|(keep, change)| keep != change).find_map(|(keep, change)| {
                let others = doubted.iter().copied().filter(|value| ![keep, change].contains(value));
                let order: Vec<usize> = std::iter::once(change).chain(others).collect();
                self.change_first(keeping.clone(), &order, Some(keep))
            })
        })
    }

    /// A test that changes the first half of the doubted values in this order, and as few as possible of the others.
    /// `keep` is kept before anything is changed. `None` if the test changes all of the values or none.
    fn change_first(&self, mut partial: Partial, order: &[usize], keep: Option<usize>) -> Option<Question> {
        let mut changed = Vec::new();
        let mut kept: Vec<usize> = keep.into_iter().collect();
        kept.iter().for_each(|&value| self.keep(&mut partial, value));
        let half = (order.len() + kept.len()) / 2;
        for &value in order {
            let level = self.accused[value];
            let change = if changed.len() < half {
                partial.choose_other(value, level, &self.others[value])
            } else {
                !partial.choose(value, level)
            };
            if change {
                changed.push(value);
            } else {
                kept.push(value);
            }
        }
        // A value that could not be chosen has no other level to be completed to.
        let parts = !changed.is_empty() && !kept.is_empty();
        parts.then(|| Question { test: partial.complete(&self.failing), changed, kept })
    }

    /// A partial test with the levels of the values in these roles.
    fn keeping(&self, roles: &[Role]) -> Partial<'r> {
        let mut partial = Partial::new(self.rules);
        for value in (0..self.roles.len()).filter(|&value| roles.contains(&self.roles[value])) {
            self.keep(&mut partial, value);
        }
        partial
    }

    /// Chooses the level of a value that is not cleared.
    fn keep(&self, partial: &mut Partial, value: usize) {
        let fits = partial.choose(value, self.accused[value]);
        assert!(fits, "the last failing test has all levels that are not cleared");
    }
}

impl Question {
    fn larger_part(&self) -> usize {
        self.changed.len().max(self.kept.len())
    }

    /// Returns `true` if either answer leaves no more values in doubt than halving does.
    fn is_even(&self) -> bool {
        self.larger_part() <= (self.changed.len() + self.kept.len()).next_power_of_two() / 2
    }
}
