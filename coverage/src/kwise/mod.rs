//! How many of the valid combinations of discrete values the tests contain.
//!
//! A set of tests covers k-wise if every choice of k parameters shows every valid combination of their levels in
//! some test; tests that violate a constraint show nothing. The tests are parted by the levels of one parameter
//! after the other; those that agree in k - 1 parameters show together so many combinations with one more as
//! different levels of it, and these are counted a machine word at a time (`count`). The valid combinations are
//! counted without being listed ([`Rules::count`]). Where values are negative, each kind of tests has combinations of its
//! own ([`demand`](paracosm_space::demand)), and their numbers are added up.

mod count;
mod counter;
mod missing;

pub use counter::KwiseCounter;

use crate::measure::{Compare, Computation, Descriptor, Measure};
use paracosm_space::demand::TestKind;
use paracosm_space::rules::Rules;
use std::cmp::Ordering;
use thiserror::Error;

impl Measure {
    /// The share of combinations of k discrete parameters that are covered, and for which epsilon the tests are
    /// (k, epsilon)-covering.
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

/// How many missing combinations are listed at most.
pub const MISSING_LISTED: usize = 20;

/// The largest number of k-wise combinations that is counted: 2^33, a gibibyte of bits.
const MOST_TUPLES: u128 = 1 << 33;

/// What a set of tests covers k-wise.
#[derive(Debug, Clone, PartialEq)]
pub struct KwiseCoverage {
    /// All valid combinations of levels of k parameters.
    pub valid: u64,
    /// Those of them that some test contains.
    pub covered: u64,
    /// The first [`MISSING_LISTED`] valid ones that no test contains, as (parameter, level) indices: sets of
    /// parameters in lexicographic order, then levels in lexicographic order.
    pub missing: Vec<Vec<(usize, usize)>>,
    /// The share of the valid combinations of *all* parameters that are tested; none where constraints entangle
    /// too many parameters for them to be counted.
    pub combinations: Option<f64>,
    /// The positions of the tests that violate a constraint and so cover nothing.
    pub invalid: Vec<usize>,
}

impl KwiseCoverage {
    /// The share of the combinations that some test contains, 1 for a k-wise covering family.
    pub fn ratio(&self) -> f64 {
        if self.valid == 0 { 1.0 } else { self.covered as f64 / self.valid as f64 }
    }
}

/// Why k-wise coverage cannot be counted.
#[derive(Debug, Error, PartialEq)]
pub enum KwiseError {
    /// There are no sets of k parameters.
    #[error("k is {k}, expected 1 to {parameters}, the number of parameters")]
    Strength {
        /// The k asked for.
        k: usize,
        /// The number of parameters.
        parameters: usize,
    },
    /// A parameter that no test can have.
    #[error("parameter {0} has no level")]
    NoLevel(usize),
    /// More valid combinations than can be counted.
    #[error("there are {found} valid combinations of {k} parameters, more than the {MOST_TUPLES} that can be counted")]
    TooMany {
        /// The k asked for.
        k: usize,
        /// The number of combinations; `u128::MAX` stands for at least as many.
        found: u128,
    },
    /// More valid combinations than a counter keeps.
    #[error("to keep count of the combinations of {k} parameters takes {mebibytes} MiB, more than 64")]
    Memory {
        /// The k asked for.
        k: usize,
        /// The memory needed.
        mebibytes: u128,
    },
    /// A test with too many or too few levels.
    #[error("test {index} has {found} levels, expected {expected}")]
    Ragged {
        /// The test's position, from 0.
        index: usize,
        /// How many levels it has.
        found: usize,
        /// The number of parameters.
        expected: usize,
    },
    /// A level that the parameter does not have.
    #[error("test {index}, parameter {parameter}: level {found}, expected one below {levels}")]
    Level {
        /// The test's position, from 0.
        index: usize,
        /// The parameter's position, from 0.
        parameter: usize,
        /// The level found.
        found: usize,
        /// How many levels the parameter has.
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
/// `k` is 0 or more than there are parameters, a parameter has no level, there are more than 2^33 valid
/// combinations, or a test is none of this space.
pub fn kwise_coverage<'a>(
    rules: &Rules,
    k: usize,
    tests: impl Iterator<Item = &'a [usize]>,
) -> Result<KwiseCoverage, KwiseError> {
    let all: Vec<usize> = (0..rules.levels().len()).collect();
    coverage_of_kinds(&[TestKind::of(rules)], &all, k, tests)
}

/// Counts the valid combinations of levels of `k` of some parameters that tests of several kinds contain. A combination
/// counts where a test of its kind has it.
///
/// # Errors
/// As [`kwise_coverage`].
///
/// # Panics
/// There is no kind, the kinds are of different spaces, or the parameters are not some of them in ascending order.
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

/// Sets of parameters in lexicographic order, then levels.
fn by_parameters(a: &[(usize, usize)], b: &[(usize, usize)]) -> Ordering {
    let parameters = |tuple: &[(usize, usize)]| tuple.iter().map(|pair| pair.0).collect::<Vec<_>>();
    parameters(a).cmp(&parameters(b)).then_with(|| a.cmp(b))
}

/// The number of combinations of levels of `k` of the members that the tests contain; no test comes twice.
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

/// The number of valid combinations of k of some parameters, where it can be worked with.
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

/// Whether a test is one of the space.
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

/// The combination with that mixed-radix number; the last parameter's level is its lowest digit.
pub(crate) fn tuple(levels: &[usize], set: &[usize], mut index: usize) -> Vec<(usize, usize)> {
    let mut tuple: Vec<_> = set.iter().map(|&p| (p, 0)).collect();
    for (parameter, level) in tuple.iter_mut().rev() {
        *level = index % levels[*parameter];
        index /= levels[*parameter];
    }
    tuple
}

/// Moves on to the next set of as many parameters in lexicographic order; false after the last.
pub(crate) fn advance(set: &mut [usize], parameters: usize) -> bool {
    let k = set.len();
    let Some(i) = (0..k).rev().find(|&i| set[i] < parameters - k + i) else { return false };
    set[i] += 1;
    for j in i + 1..k {
        set[j] = set[j - 1] + 1;
    }
    true
}
