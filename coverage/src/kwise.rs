//! How many of the combinations of discrete values the tests contain.
//!
//! A set of tests covers k-wise if every choice of k parameters shows every combination of their levels in
//! some test. The sets of k parameters are looked at one after the other, each with a bitmap over the mixed-
//! radix numbers of its combinations: memory stays at one bit per combination of the largest set, and the
//! missing ones come out in order.

use thiserror::Error;

/// How many missing combinations are listed at most.
pub const MISSING_LISTED: usize = 20;

/// The largest number of k-wise combinations that is counted: 2^33, a gibibyte of bits were they all of one
/// set of parameters.
const MOST_TUPLES: u128 = 1 << 33;

/// What a set of tests covers k-wise.
#[derive(Debug, Clone, PartialEq)]
pub struct KwiseCoverage {
    /// All combinations of levels of k parameters.
    pub valid: u64,
    /// Those of them that some test contains.
    pub covered: u64,
    /// The first [`MISSING_LISTED`] that no test contains, as (parameter, level) indices: sets of parameters in
    /// lexicographic order, then levels in lexicographic order.
    pub missing: Vec<Vec<(usize, usize)>>,
    /// The share of all combinations of *all* parameters that are tested.
    pub combinations: f64,
}

impl KwiseCoverage {
    /// The share of the combinations that some test contains, 1 for a k-wise covering family.
    pub fn ratio(&self) -> f64 {
        self.covered as f64 / self.valid as f64
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
    /// More combinations than can be counted.
    #[error("there are {found} combinations of {k} parameters, more than the {MOST_TUPLES} that can be counted")]
    TooMany {
        /// The k asked for.
        k: usize,
        /// The number of combinations; `u128::MAX` stands for at least as many.
        found: u128,
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

/// Counts the combinations of levels of `k` parameters that the tests contain.
///
/// `levels` holds the number of levels of each parameter; a test is a level index for each.
///
/// ```
/// use paracosm_coverage::kwise::kwise_coverage;
/// let tests: [&[usize]; 3] = [&[0, 0, 0], &[0, 1, 1], &[1, 0, 1]];
/// let coverage = kwise_coverage(&[2, 2, 2], 2, tests.into_iter())?;
/// assert_eq!((coverage.covered, coverage.valid), (9, 12));
/// assert_eq!(coverage.missing[0], [(0, 1), (1, 1)]);
/// # Ok::<(), paracosm_coverage::kwise::KwiseError>(())
/// ```
///
/// # Errors
/// `k` is 0 or more than there are parameters, a parameter has no level, there are more than 2^33 combinations,
/// or a test is none of this space.
pub fn kwise_coverage<'a>(
    levels: &[usize],
    k: usize,
    tests: impl Iterator<Item = &'a [usize]>,
) -> Result<KwiseCoverage, KwiseError> {
    let parameters = levels.len();
    if k == 0 || k > parameters {
        return Err(KwiseError::Strength { k, parameters });
    }
    if let Some(parameter) = levels.iter().position(|&v| v == 0) {
        return Err(KwiseError::NoLevel(parameter));
    }
    let found = tuples(levels, k);
    if found > MOST_TUPLES {
        return Err(KwiseError::TooMany { k, found });
    }
    let mut tests = tests.enumerate().map(|(i, test)| check(levels, i, test)).collect::<Result<Vec<_>, _>>()?;
    tests.sort_unstable();
    tests.dedup();

    let all: f64 = levels.iter().map(|&v| v as f64).product();
    let combinations = if tests.is_empty() { 0.0 } else { tests.len() as f64 / all };
    let mut coverage = KwiseCoverage { valid: found as u64, covered: 0, missing: Vec::new(), combinations };
    let mut set: Vec<usize> = (0..k).collect();
    let mut seen = Vec::new();
    loop {
        let size = set.iter().map(|&p| levels[p]).product();
        seen.clear();
        seen.resize(usize::div_ceil(size, 64), 0u64);
        for test in &tests {
            let index = set.iter().fold(0, |index, &p| index * levels[p] + test[p]);
            seen[index / 64] |= 1 << (index % 64);
        }
        coverage.covered += seen.iter().map(|word| u64::from(word.count_ones())).sum::<u64>();
        let missing = (0..size).filter(|index| seen[index / 64] >> (index % 64) & 1 == 0);
        let room = MISSING_LISTED - coverage.missing.len();
        coverage.missing.extend(missing.take(room).map(|index| tuple(levels, &set, index)));
        if !advance(&mut set, parameters) {
            return Ok(coverage);
        }
    }
}

fn check<'a>(levels: &[usize], index: usize, test: &'a [usize]) -> Result<&'a [usize], KwiseError> {
    if test.len() != levels.len() {
        return Err(KwiseError::Ragged { index, found: test.len(), expected: levels.len() });
    }
    match test.iter().zip(levels).position(|(level, levels)| level >= levels) {
        None => Ok(test),
        Some(parameter) => {
            Err(KwiseError::Level { index, parameter, found: test[parameter], levels: levels[parameter] })
        }
    }
}

/// The number of combinations of levels of k parameters: the k-th elementary symmetric polynomial of the
/// numbers of levels, saturating.
fn tuples(levels: &[usize], k: usize) -> u128 {
    let mut chosen = vec![0u128; k + 1];
    chosen[0] = 1;
    for &v in levels {
        for size in (1..=k).rev() {
            chosen[size] = chosen[size].saturating_add(chosen[size - 1].saturating_mul(v as u128));
        }
    }
    chosen[k]
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
