//! The discrete part of a set of tests: rows of level indices that cover the combinations of any k parameters.
//!
//! Rows of random families and of all combinations are computed when they are asked for, so that they take no memory.
//! The rows of a covering array are a list.

use crate::covering::{CoveringRequest, covering_array};
use crate::seeded::{Purpose, seeded};
use crate::{DiscreteFamily, GeneratorError, Request};
use paracosm_coverage::theory::rows::RandomRows;
use paracosm_space::Point;
use paracosm_space::rules::{Rules, UniformTests};
use rand::Rng;
use std::collections::{BTreeSet, HashMap, HashSet};

/// The greatest number of rows: a larger family is a mistake rather than a plan.
const MOST_ROWS: u64 = 10_000_000;

/// The greatest number of possible rows for which each row gets a bit that says whether it is there.
const MOST_BITS: u64 = 1 << 28;

impl Request<'_> {
    /// Returns the strength of the discrete family, which is the number of discrete parameters in a combination. It is
    /// `k`, or the number of discrete parameters if this number is less than `k`.
    ///
    /// # Errors
    /// `k` is 0 or more than the number of all parameters, or it is given for a space without discrete parameters.
    pub fn discrete_strength(&self) -> Result<usize, GeneratorError> {
        let discrete = self.space.levels().len();
        let parameters = discrete + self.space.dims();
        match self.k {
            None => Ok(discrete.min(2)),
            Some(k) if discrete == 0 || k == 0 => Err(GeneratorError::Strength { k, parameters: discrete }),
            Some(k) if k > parameters => Err(GeneratorError::AllStrength { k, parameters }),
            Some(k) => Ok(k.min(discrete)),
        }
    }
}

/// A family of rows, each of which has a level for each discrete parameter. A space without discrete parameters has one
/// empty row.
pub(crate) struct Family {
    levels: Vec<usize>,
    len: u64,
    rows: Source,
}

/// The source of the rows.
enum Source {
    /// Random rows of this seed.
    Random { tests: UniformTests, seed: u64 },
    /// All combinations of levels, in order.
    Cross,
    /// The rows of this list.
    Listed(Vec<Vec<usize>>),
}

impl Family {
    /// Makes the discrete family that a request demands.
    pub(crate) fn new(rules: &Rules, request: &Request) -> Result<Self, GeneratorError> {
        let levels = rules.levels();
        let parameters = levels.len();
        let seed = request.seed.unwrap_or(0);
        let k = request.discrete_strength()?;
        if let Some(rows) = request.rows {
            return Ok(Self::listed(levels, rows.to_vec()));
        }
        let too_large = |rows, advice| Err(GeneratorError::FamilyTooLarge { rows, advice });
        let is_free = rules.groups() == 0;
        match request.discrete {
            DiscreteFamily::Random { delta } if !(delta > 0.0 && delta < 1.0) => Err(GeneratorError::Delta(delta)),
            DiscreteFamily::Random { delta } if parameters > 0 => {
                let tests = rules.uniform().ok_or(GeneratorError::RandomUnderConstraints)?;
                let rows = RandomRows::new(rules, k).ok_or(GeneratorError::RandomUnderConstraints)?;
                match rows.family_size(delta) {
                    len if len > MOST_ROWS => too_large(len.to_string(), "use a smaller k, or the family ipog"),
                    len => Ok(Self { levels: levels.to_vec(), len, rows: Source::Random { tests, seed } }),
                }
            }
            DiscreteFamily::Ipog if parameters > 0 => {
                let existing: BTreeSet<Vec<Option<usize>>> =
                    request.existing.iter().map(|test| test.discrete.iter().copied().map(Some).collect()).collect();
                let existing: Vec<Vec<Option<usize>>> = existing.into_iter().collect();
                let array = covering_array(&CoveringRequest {
                    groups: request.groups,
                    existing: &existing,
                    seed,
                    ..CoveringRequest::new(rules, k)
                })?;
                Ok(Self::listed(levels, array.rows))
            }
            // Without levels the product is the one empty row.
            _ => match combinations(levels) {
                None => too_large("over 10^19".to_owned(), "use the family ipog"),
                Some(len) if len > MOST_ROWS => too_large(len.to_string(), "use the family ipog"),
                Some(len) if is_free => Ok(Self { levels: levels.to_vec(), len, rows: Source::Cross }),
                Some(len) => {
                    let all = (0..len).map(|index| digits(index, levels));
                    Ok(Self::listed(levels, all.filter(|row| rules.allows(row)).collect()))
                }
            },
        }
    }

    fn listed(levels: &[usize], rows: Vec<Vec<usize>>) -> Self {
        Self { levels: levels.to_vec(), len: rows.len() as u64, rows: Source::Listed(rows) }
    }

    /// Returns the number of rows of the family, which is at least 1.
    pub(crate) fn len(&self) -> u64 {
        self.len
    }

    /// Returns the row at `index`, which must be below [`Family::len`].
    pub(crate) fn row(&self, index: u64) -> Vec<usize> {
        match &self.rows {
            Source::Random { tests, seed } => {
                let mut rng = seeded(*seed, Purpose::Rows, index);
                tests.draw(|levels| rng.random_range(0..levels))
            }
            Source::Cross => digits(index, &self.levels),
            Source::Listed(rows) => rows[index as usize].clone(),
        }
    }

    /// Returns the family without the rows that repeat an earlier row or an existing test.
    pub(crate) fn without(self, existing: &[Point]) -> Self {
        let existing = existing.iter().map(|test| test.discrete.clone());
        let rows = (0..self.len).map(|index| self.row(index));
        let rows = match combinations(&self.levels) {
            // For millions of rows drawn from fewer, a bit for each fits in memory where a hash table does not.
            Some(all) if all <= MOST_BITS => {
                let mut seen = vec![0_u64; all.div_ceil(64) as usize];
                let mut is_new = |row: &Vec<usize>| {
                    let number = number(row, &self.levels);
                    let (word, bit) = (&mut seen[(number / 64) as usize], 1 << (number % 64));
                    let new = *word & bit == 0;
                    *word |= bit;
                    new
                };
                for row in existing {
                    is_new(&row);
                }
                rows.filter(is_new).collect()
            }
            _ => {
                let mut seen: HashSet<Vec<usize>> = existing.collect();
                rows.filter(|row| seen.insert(row.clone())).collect()
            }
        };
        Self::listed(&self.levels, rows)
    }

    /// Returns the continuous points of the tests that have the same discrete values as a row, by the row's number. If
    /// rows are equal, the first row has the points.
    pub(crate) fn points_of_rows(&self, tests: &[Point]) -> HashMap<u64, Vec<Vec<f64>>> {
        let mut by_row: HashMap<&[usize], Vec<Vec<f64>>> = HashMap::new();
        for test in tests {
            by_row.entry(&test.discrete).or_default().push(test.continuous.clone());
        }
        if by_row.is_empty() {
            return HashMap::new();
        }
        (0..self.len).filter_map(|index| by_row.remove(&self.row(index)[..]).map(|points| (index, points))).collect()
    }
}

/// The number of rows of parameters with these numbers of levels; `None` if it does not fit in 64 bits.
fn combinations(levels: &[usize]) -> Option<u64> {
    levels.iter().try_fold(1, |rows: u64, &levels| rows.checked_mul(levels as u64))
}

/// The number whose digits are the row: the inverse of [`digits`].
fn number(row: &[usize], levels: &[usize]) -> u64 {
    row.iter().zip(levels).fold(0, |number, (&level, &levels)| number * levels as u64 + level as u64)
}

/// The digits of `index`, the last changing fastest. Each digit has as many values as `levels` says.
fn digits(mut index: u64, levels: &[usize]) -> Vec<usize> {
    let mut row = vec![0; levels.len()];
    for (digit, &levels) in row.iter_mut().zip(levels).rev() {
        *digit = (index % levels as u64) as usize;
        index /= levels as u64;
    }
    row
}
