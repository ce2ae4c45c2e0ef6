//! Finding the guilty combination in a failing test by asking for few more tests.
//!
//! As in Zhang and Zhang, "Characterizing failure-causing parameter interactions by adaptive testing" (ISSTA 2011):
//! between a failing test and a passing one that keeps some of its values, a guilty value is found by halving the
//! values in which they differ; then what was found is kept and everything else changed, and if that passes, another
//! guilty value is looked for in the same way. If one combination of k of the N values is guilty, each of k values
//! takes at most ceil(log2 N) tests to be found, and one for the question whether it was the last.
//!
//! A value counts as kept or changed, whatever it is changed to; that leaves room for constraints. Every test that is
//! asked for keeps them. Where they leave no test that halves the values in doubt, the most even part is asked about,
//! and where they leave none that parts them at all, the values stay together.

use super::Located;
use super::partial::Partial;
use crate::kwise::{KwiseError, check};
use paracosm_space::rules::Rules;
use thiserror::Error;

/// Why nothing can be located.
#[derive(Debug, Error, PartialEq)]
pub enum LocateError {
    /// A test is none of this space; the failing one is test 0, the passing one test 1.
    #[error(transparent)]
    Test(#[from] KwiseError),
    /// A test that violates a constraint.
    #[error("the {role} test violates a constraint")]
    Invalid {
        /// The test: `failing` or `passing`.
        role: &'static str,
    },
    /// A test cannot both fail and pass.
    #[error("the failing test and the passing test are the same")]
    Same,
}

/// What is known of a value of the failing test.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// Some failing test is without it: not guilty.
    Cleared,
    /// Some of these are guilty: a test without them passed.
    Doubted,
    /// Perhaps guilty: the test without the doubted ones kept it.
    Waiting,
    /// Guilty.
    Guilty,
}

/// A test to be run.
#[derive(Debug, Clone)]
struct Question {
    test: Vec<usize>,
    /// The values in doubt that it changes.
    changed: Vec<usize>,
    /// The values in doubt that it keeps.
    kept: Vec<usize>,
}

/// Finds the guilty combination: asks for a test, is told how it went, and asks again.
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
    /// The levels that values may be changed to, those of the passing test first.
    others: Vec<Vec<usize>>,
    /// The last test that failed.
    failing: Vec<usize>,
    roles: Vec<Role>,
    undivided: Vec<usize>,
    question: Option<Question>,
    tests: usize,
    /// Whether all questions so far took as few tests as promised.
    as_promised: bool,
}

impl<'r> Locator<'r> {
    /// Begins with a failing test and a passing one.
    ///
    /// # Errors
    /// One of them is none of this space or violates a constraint, or they are the same.
    pub fn new(rules: &'r Rules, failing: &[usize], passing: &[usize]) -> Result<Self, LocateError> {
        Self::cautious(rules, failing, passing, |_, _| true)
    }

    /// [`Locator::new`], with values changed only to those of the passing test and to levels that are `safe`: `safe` is
    /// asked with a parameter and a level of it. What constraints force is not asked about.
    ///
    /// Where several combinations are guilty, a value may be part of one and the level it is changed to of another. A
    /// value that has no safe level to be changed to is kept, and not held to be guilty.
    ///
    /// # Errors
    /// As `new`.
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

    /// The test to be run next; none when the search is over.
    pub fn question(&self) -> Option<&[usize]> {
        self.question.as_ref().map(|question| question.test.as_slice())
    }

    /// How the test in question went.
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
        // That was to be the end, but constraints had kept it from changing all that can be changed.
        self.as_promised &= !(failed && was_last && self.question.is_some());
    }

    /// The guilty combination, when the search is over.
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

    /// A test that keeps the guilty values and changes all waiting ones that can be changed; none if none can be.
    fn without_waiting(&self) -> Option<Question> {
        let mut partial = self.keeping(&[Role::Guilty]);
        let change = |&value: &usize| partial.choose_other(value, self.accused[value], &self.others[value]);
        let (changed, kept): (Vec<usize>, Vec<usize>) = self.with(Role::Waiting).into_iter().partition(change);
        // What cannot be changed is completed as it is: it has no other level.
        (!changed.is_empty()).then(|| Question { test: partial.complete(&self.failing), changed, kept })
    }

    /// A test that keeps guilty and waiting values and changes half of the doubted ones, or nearly; none if every
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
        // If any two can be parted, one of these questions does it.
        best.or_else(|| {
            let pairs = doubted.iter().flat_map(|&keep| doubted.iter().map(move |&change| (keep, change)));
            pairs.filter(|(keep, change)| keep != change).find_map(|(keep, change)| {
                let others = doubted.iter().copied().filter(|value| ![keep, change].contains(value));
                let order: Vec<usize> = std::iter::once(change).chain(others).collect();
                self.change_first(keeping.clone(), &order, Some(keep))
            })
        })
    }

    /// A test that changes the first half of the doubted values in this order, and of the others as few as possible;
    /// `keep` is kept before anything is changed. None if it parts nothing.
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
        // What could not be chosen has no other level to be completed to.
        let parts = !changed.is_empty() && !kept.is_empty();
        parts.then(|| Question { test: partial.complete(&self.failing), changed, kept })
    }

    /// The levels of the values in these roles.
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

    /// Whether either answer leaves no more in doubt than halving does.
    fn is_even(&self) -> bool {
        self.larger_part() <= (self.changed.len() + self.kept.len()).next_power_of_two() / 2
    }
}
