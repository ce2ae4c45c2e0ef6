//! The discrete half of a test set: rows of level indices that cover the combinations of any k parameters.
//!
//! Rows are computed when they are asked for, so that a family costs nothing but its size.

use crate::{
    GeneratorError,
    seeded::{Purpose, seeded},
};
use paracosm_coverage::{Point, nearest, theory};
use rand::Rng;
use std::{
    collections::{HashMap, HashSet},
    str::FromStr,
};

/// Beyond it a family is a mistake rather than a plan.
const MOST_ROWS: u64 = 10_000_000;

/// How the discrete parameters are covered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DiscreteFamily {
    /// As many uniformly random rows as Proposition 3.2 of the paper asks for: all combinations of values of any
    /// k parameters are among them with probability at least `1 - delta`.
    Random {
        /// The probability, between 0 and 1, that one is missing.
        delta: f64,
    },
    /// Every combination of all parameters, the last one changing fastest.
    Cross,
}

impl DiscreteFamily {
    const NAMES: [&'static str; 2] = ["random", "cross"];
}

impl Default for DiscreteFamily {
    /// Random rows that miss a combination with probability 0.05.
    fn default() -> Self {
        Self::Random { delta: 0.05 }
    }
}

impl FromStr for DiscreteFamily {
    type Err = GeneratorError;

    fn from_str(name: &str) -> Result<Self, GeneratorError> {
        match name {
            "random" => Ok(Self::default()),
            "cross" => Ok(Self::Cross),
            _ => Err(GeneratorError::UnknownFamily { name: name.to_owned(), nearest: nearest(name, Self::NAMES) }),
        }
    }
}

/// The rows for one space. A space without discrete parameters has one empty row.
pub(crate) struct Family {
    levels: Vec<usize>,
    len: u64,
    rows: Rows,
}

/// Where the rows come from.
enum Rows {
    /// Random ones of this seed.
    Random(u64),
    /// All combinations, in order.
    Cross,
    /// These rows of the family they were chosen from.
    Chosen(Vec<u64>, Box<Family>),
}

impl Family {
    pub(crate) fn new(
        levels: &[usize],
        kind: DiscreteFamily,
        k: Option<usize>,
        seed: u64,
    ) -> Result<Self, GeneratorError> {
        let parameters = levels.len();
        if let Some(k) = k
            && !(1..=parameters).contains(&k)
        {
            return Err(GeneratorError::Strength { k, parameters });
        }
        let too_large = |rows, advice| Err(GeneratorError::FamilyTooLarge { rows, advice });
        match kind {
            DiscreteFamily::Random { delta } if !(delta > 0.0 && delta < 1.0) => Err(GeneratorError::Delta(delta)),
            DiscreteFamily::Random { delta } if parameters > 0 => {
                match theory::rows::random_family_size(levels, k.unwrap_or(parameters.min(2)), delta) {
                    len if len > MOST_ROWS => too_large(len.to_string(), "use a smaller k"),
                    len => Ok(Self { levels: levels.to_vec(), len, rows: Rows::Random(seed) }),
                }
            }
            // The product of no levels is the one empty row.
            DiscreteFamily::Random { .. } | DiscreteFamily::Cross => {
                match levels.iter().try_fold(1_u64, |rows, &n| rows.checked_mul(n as u64)) {
                    None => too_large("over 10^19".to_owned(), "use the random family"),
                    Some(len) if len > MOST_ROWS => too_large(len.to_string(), "use the random family"),
                    Some(len) => Ok(Self { levels: levels.to_vec(), len, rows: Rows::Cross }),
                }
            }
        }
    }

    /// The number of rows, at least 1.
    pub(crate) fn len(&self) -> u64 {
        self.len
    }

    /// The row at `index`, which is below [`Family::len`].
    pub(crate) fn row(&self, index: u64) -> Vec<usize> {
        match &self.rows {
            Rows::Random(seed) => {
                let mut rng = seeded(*seed, Purpose::Rows, index);
                self.levels.iter().map(|&levels| rng.random_range(0..levels)).collect()
            }
            Rows::Cross => digits(index, &self.levels),
            Rows::Chosen(chosen, family) => family.row(chosen[index as usize]),
        }
    }

    /// The family without the rows that repeat an earlier one, or one of the tests that are there already.
    pub(crate) fn without(self, existing: &[Point]) -> Self {
        if existing.is_empty() && !matches!(self.rows, Rows::Random(_)) {
            return self;
        }
        let mut seen: HashSet<Vec<usize>> = existing.iter().map(|test| test.discrete.clone()).collect();
        let chosen: Vec<u64> = (0..self.len).filter(|&index| seen.insert(self.row(index))).collect();
        Self { levels: self.levels.clone(), len: chosen.len() as u64, rows: Rows::Chosen(chosen, Box::new(self)) }
    }

    /// The continuous points that each row has among tests, by the row's number: of rows that are alike, the first.
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

/// `index` as a number whose digits, the last one changing fastest, have these many values.
fn digits(mut index: u64, levels: &[usize]) -> Vec<usize> {
    let mut row = vec![0; levels.len()];
    for (digit, &levels) in row.iter_mut().zip(levels).rev() {
        *digit = (index % levels as u64) as usize;
        index /= levels as u64;
    }
    row
}
