//! Counts how many of the valid combinations of discrete values the tests contain.
//!
//! A set of tests covers k-wise if, for every choice of k parameters, every valid combination of their levels occurs
//! in some test. Tests that violate a constraint do not count. The tests are divided by the levels of one parameter
//! after the other. Tests that agree in k - 1 parameters show as many combinations with one more parameter as they
//! have different levels of it. These levels are counted a machine word at a time (`count`). The valid combinations
//! are counted without being listed ([`Rules::count`]). If some values are negative, each kind of tests has its own
//! combinations ([`demand`](paracosm_space::demand)), and their numbers are added up.

mod count;
mod counter;
mod missing;

pub use counter::KwiseCounter;

use crate::measure::{Compare, Computation, Descriptor, Measure};
use paracosm_space::demand::TestKind;
use paracosm_space::plural;
use paracosm_space::rules::Rules;
use std::cmp::Ordering;
use thiserror::Error;

impl Measure {
    /// The measure "k-wise coverage", which is the share of combinations of k discrete values that the tests contain,
    /// with the epsilon for which the tests are (k, epsilon)-covering.
    pub const K_WISE: Self = Self::of(&Descriptor {
        name: "k-wise",
        key: "discrete",
        label: "k-wise coverage",
        title: "k-wise coverage",
        about: "the share of valid combinations of k discrete values that some test contains",
        pace: 8,
        compare: Compare::Never,
        method: Computation::Combinations,
    });
}

/// The greatest number of missing combinations that a [`KwiseCoverage`] lists.
pub const MISSING_LISTED: usize = 20;

/// The largest number of k-wise combinations that can be counted: 2^33, a gibibyte of bits.
const MOST_TUPLES: u128 = 1 << 33;

/// The k-wise coverage of a set of tests, with counts of valid combinations of levels of k parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct KwiseCoverage {
    /// The number of valid combinations of levels of k parameters.
    pub valid: u64,
    /// The number of valid combinations that at least one test contains.
    pub covered: u64,
    /// The first [`MISSING_LISTED`] valid combinations that no test contains, as (parameter, level) indices. They are
    /// ordered by their sets of parameters, then by their levels, both lexicographically.
    pub missing: Vec<Vec<(usize, usize)>>,
    /// The share of the valid combinations of levels of *all* parameters that the tests contain. `None` if constraints
    /// join too many parameters, so that these combinations cannot be counted.
    pub combinations: Option<f64>,
    /// The positions of the tests that violate a constraint and therefore cover no combination.
    pub invalid: Vec<usize>,
}

impl KwiseCoverage {
    /// Returns the share of the valid combinations that the tests contain. It is 1 for a k-wise covering family.
    pub fn ratio(&self) -> f64 {
        if self.valid == 0 { 1.0 } else { self.covered as f64 / self.valid as f64 }
    }
}

/// The reason why k-wise coverage cannot be counted.
#[derive(Debug, Error, PartialEq)]
pub enum KwiseError {
    /// The number k of parameters in a combination is 0 or exceeds the number of parameters.
    #[error("k is {k}, expected a number from 1 to {parameters}, the number of parameters")]
    Strength {
        /// The requested number k of parameters in a combination.
        k: usize,
        /// The number of parameters from which k parameters are chosen.
        parameters: usize,
    },
    /// The parameter at the given position has no level, so that no test exists.
    #[error("parameter {0} has no level, expected at least one")]
    NoLevel(usize),
    /// There are more valid combinations of levels than can be counted.
    #[error("{found} combinations of {k} parameters are valid; at most {MOST_TUPLES} can be counted; use a smaller k")]
    TooMany {
        /// The requested number k of parameters in a combination.
        k: usize,
        /// The number of valid combinations; `u128::MAX` also stands for any greater number.
        found: u128,
    },
    /// A counter would need too much memory for the valid combinations.
    #[error("counting the combinations of {k} parameters takes {mebibytes} MiB, more than 64; use a smaller k")]
    Memory {
        /// The requested number k of parameters in a combination.
        k: usize,
        /// The memory that the counter needs, in MiB.
        mebibytes: u128,
    },
    /// The number of levels of a test differs from the number of parameters.
    #[error("test {index} has {}, expected {expected}", plural(*found, "level"))]
    Ragged {
        /// The position of the wrong test among the tests, from 0.
        index: usize,
        /// The number of levels of the wrong test.
        found: usize,
        /// The number of parameters, which is the expected number of levels of the test.
        expected: usize,
    },
    /// A test has a level that does not exist for its parameter.
    #[error("test {index}, parameter {parameter}: found level {found}, expected a level below {levels}")]
    Level {
        /// The position of the wrong test among the tests, from 0.
        index: usize,
        /// The position of the parameter with the wrong level, from 0.
        parameter: usize,
        /// The wrong level in the test, which the parameter does not have.
        found: usize,
        /// The number of levels of the parameter.
        levels: usize,
    },
}

/// Counts the valid combinations of levels of `k` parameters that the tests contain.
///
/// A test is a level index for each parameter.
///
/// ```
/// use paracosm_coverage::kwise::kwise_coverage;
/// use paracosm_space::rules::Rules;
/// let tests: [&[usize]; 3] = [&[0, 0, 0], &[0, 1, 1], &[1, 0, 1]];
/// let coverage = kwise_coverage(&Rules::free(&[2, 2, 2]), 2, tests.into_iter())?;
/// assert_eq!((coverage.covered, coverage.valid), (9, 12));
/// assert_eq!(coverage.missing[0], [(0, 1), (1, 1)]);
/// # Ok::<(), paracosm_coverage::kwise::KwiseError>(())
/// ```
///
/// # Errors
/// `k` is 0 or more than the number of parameters, a parameter has no level, there are more than 2^33 valid
/// combinations, or a test does not belong to this space.
pub fn kwise_coverage<'a>(
    rules: &Rules,
    k: usize,
    tests: impl Iterator<Item = &'a [usize]>,
) -> Result<KwiseCoverage, KwiseError> {
    let all: Vec<usize> = (0..rules.levels().len()).collect();
    coverage_of_kinds(&[TestKind::of(rules)], &all, k, tests)
}

/// Counts the valid combinations of levels of `k` of the given parameters that tests of several kinds contain. A
/// combination counts if a test of its kind contains it.
///
/// # Errors
/// As [`kwise_coverage`].
///
/// # Panics
/// There is no kind, the kinds belong to different spaces, or `parameters` are not positions of parameters in
/// ascending order.
pub fn coverage_of_kinds<'a>(
    kinds: &[TestKind],
    parameters: &[usize],
    k: usize,
    tests: impl Iterator<Item = &'a [usize]>,
) -> Result<KwiseCoverage, KwiseError> {
    if k == 0 {
        return Err(KwiseError::Strength { k, parameters: parameters.len() });
    }
    let share = |kind: &TestKind| {
        let share = kind.share(parameters, k);
        share.map(|(members, k)| valid(kind.rules(), &members, k).map(|valid| (members, k, valid))).transpose()
    };
    let shares = kinds.iter().map(share).collect::<Result<Vec<_>, _>>()?;
    let mut kept: Vec<Vec<&[usize]>> = vec![Vec::new(); kinds.len()];
    let mut invalid = Vec::new();
    for (index, test) in tests.enumerate() {
        check(kinds[0].rules().levels(), index, test)?;
        match kinds.iter().position(|kind| kind.rules().allows(test)) {
            Some(kind) => kept[kind].push(test),
            None => invalid.push(index),
        }
    }
    let mut coverage = KwiseCoverage { valid: 0, covered: 0, missing: Vec::new(), combinations: None, invalid };
    let (mut shown, mut all) = (0, Some(0.0));
    for ((kind, share), kept) in kinds.iter().zip(shares).zip(&mut kept) {
        kept.sort_unstable();
        kept.dedup();
        shown += kept.len();
        all = all.zip(kind.rules().tests()).map(|(all, tests)| all + tests);
        let Some((members, k, valid)) = share else { continue };
        let covered = covered(kind.rules().levels(), &members, k, kept);
        coverage.valid += valid;
        coverage.covered += covered;
        if covered < valid {
            let missing = missing::first_missing(kind.rules(), &members, k, kept);
            coverage.missing.extend(missing.into_iter().map(|mut tuple| {
                tuple.extend(kind.negative());
                tuple.sort_unstable();
                tuple
            }));
        }
    }
    coverage.missing.sort_by(|a, b| by_parameters(a, b));
    coverage.missing.truncate(MISSING_LISTED);
    coverage.combinations = all.map(|all| shown as f64 / all);
    Ok(coverage)
}

/// Orders combinations by their sets of parameters, then by their levels, both lexicographically.
fn by_parameters(a: &[(usize, usize)], b: &[(usize, usize)]) -> Ordering {
    let parameters = |tuple: &[(usize, usize)]| tuple.iter().map(|pair| pair.0).collect::<Vec<_>>();
    parameters(a).cmp(&parameters(b)).then_with(|| a.cmp(b))
}

/// The number of combinations of levels of `k` of the members that the tests contain. The tests must be distinct.
fn covered(levels: &[usize], members: &[usize], k: usize, tests: &[&[usize]]) -> u64 {
    if members.len() == levels.len() {
        return count::covered(levels, k, tests);
    }
    let levels: Vec<usize> = members.iter().map(|&member| levels[member]).collect();
    let mut parts: Vec<Vec<usize>> =
        tests.iter().map(|test| members.iter().map(|&member| test[member]).collect()).collect();
    parts.sort_unstable();
    parts.dedup();
    count::covered(&levels, k, &parts.iter().map(Vec::as_slice).collect::<Vec<_>>())
}

/// The number of valid combinations of levels of k of the given parameters, if it can be counted.
fn valid(rules: &Rules, parameters: &[usize], k: usize) -> Result<u64, KwiseError> {
    if k > parameters.len() {
        return Err(KwiseError::Strength { k, parameters: parameters.len() });
    }
    if let Some(parameter) = rules.levels().iter().position(|&v| v == 0) {
        return Err(KwiseError::NoLevel(parameter));
    }
    let found = rules.count(parameters, k).valid;
    if found > MOST_TUPLES {
        return Err(KwiseError::TooMany { k, found });
    }
    Ok(found as u64)
}

/// Checks that a test has a level for each parameter, and that every level exists.
pub(crate) fn check(levels: &[usize], index: usize, test: &[usize]) -> Result<(), KwiseError> {
    if test.len() != levels.len() {
        return Err(KwiseError::Ragged { index, found: test.len(), expected: levels.len() });
    }
    match test.iter().zip(levels).position(|(level, levels)| level >= levels) {
        None => Ok(()),
        Some(parameter) => {
            Err(KwiseError::Level { index, parameter, found: test[parameter], levels: levels[parameter] })
        }
    }
}

/// Returns the combination of levels of the parameters in `set` that has the mixed-radix number `index`. The last
/// parameter's level is the lowest digit.
pub(crate) fn tuple(levels: &[usize], set: &[usize], mut index: usize) -> Vec<(usize, usize)> {
    let mut tuple: Vec<_> = set.iter().map(|&p| (p, 0)).collect();
    for (parameter, level) in tuple.iter_mut().rev() {
        *level = index % levels[*parameter];
        index /= levels[*parameter];
    }
    tuple
}

/// Changes a set of parameters to the next set of its size, in lexicographic order. Returns `false` after the last set.
pub(crate) fn advance(set: &mut [usize], parameters: usize) -> bool {
    let k = set.len();
    let Some(i) = (0..k).rev().find(|&i| set[i] < parameters - k + i) else { return false };
    set[i] += 1;
    for j in i + 1..k {
        set[j] = set[j - 1] + 1;
    }
    true
}
