//! Covering arrays: few tests that contain every valid combination of levels of any k parameters.
//!
//! The array grows by IPOG, column by column, and keeps entries open as long as nothing needs them. [`Rules`] decides
//! exactly which combinations are valid and which rows can still be completed. The same request gives the same array
//! on every machine.
//!
//! ```
//! use paracosm_space::rules::Rules;
//! use paracosm_generators::covering::{CoveringRequest, covering_array};
//!
//! let rules = Rules::free(&[3, 3, 3, 3]);
//! let array = covering_array(&CoveringRequest::new(&rules, 2))?;
//! assert_eq!((array.rows.len(), array.lower_bound), (9, 9));
//! # Ok::<(), paracosm_generators::covering::CoveringError>(())
//! ```

mod error;
mod field;
mod fill;
mod front;
mod grow;
mod halves;
mod open_rows;
mod optimise;
mod order;
mod orthogonal;
mod rows;
mod search;
mod symmetric;
mod task;

pub use error::CoveringError;
pub use optimise::optimise;

use paracosm_coverage::Deadline;
use paracosm_space::demand::TestKind;
use paracosm_space::rules::Rules;
use task::Task;

/// A request for a covering array, with parameters, strength, existing tests and limits.
#[derive(Debug, Clone)]
pub struct CoveringRequest<'a> {
    /// The discrete parameters with their levels, and the constraints on the parameters.
    pub rules: &'a Rules,
    /// The kinds of tests, if negative values divide the tests into kinds. Tests of one kind do not cover the
    /// combinations of another kind. Empty if all tests are of one kind.
    pub kinds: &'a [TestKind],
    /// The strength k of the array, whose tests contain all valid combinations of levels of any k parameters.
    pub k: usize,
    /// The groups of parameters with a higher strength, each with the positions of its parameters and its strength.
    pub groups: &'a [(Vec<usize>, usize)],
    /// Existing tests that the array keeps, with a level or `None` for each parameter. These tests come first in the
    /// array, completed.
    pub existing: &'a [Vec<Option<usize>>],
    /// The seed of the random decisions in the construction.
    pub seed: u64,
    /// The deadline at which the construction ends without an array.
    pub deadline: Deadline,
}

impl<'a> CoveringRequest<'a> {
    /// Makes a request for a covering array of strength `k`, without existing tests and without a deadline.
    pub fn new(rules: &'a Rules, k: usize) -> Self {
        Self { rules, kinds: &[], k, groups: &[], existing: &[], seed: 0, deadline: Deadline::never() }
    }
}

/// A covering array, whose tests contain every valid combination of levels that a request demands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CoveringArray {
    /// The tests of the array, with a level for each parameter. The existing tests that can be kept come first. All
    /// satisfy the constraints.
    pub rows: Vec<Vec<usize>>,
    /// The number of existing tests among the tests of the array.
    pub kept: usize,
    /// The positions of the existing tests that violate a constraint, and therefore are not in the array.
    pub invalid: Vec<usize>,
    /// A lower bound on the number of tests of every array for the same request. It is the largest number of valid
    /// combinations that any k parameters, or the parameters of a group, have among themselves, or the bound that
    /// [`fewest_rows`](paracosm_coverage::theory::covering::fewest_rows) proves for parameters without constraints. The
    /// bounds of several kinds of tests are added up.
    pub lower_bound: u64,
}

/// Constructs a covering array for a request.
///
/// # Errors
/// A strength is 0 or more than the number of parameters that it combines, a parameter has no level, a group names a
/// parameter that does not exist or names a parameter twice, an existing test does not belong to this space, the
/// array would be too large, or the deadline passed before the array was complete.
pub fn covering_array(request: &CoveringRequest) -> Result<CoveringArray, CoveringError> {
    request.check()?;
    let (tasks, invalid) = Task::all(request);
    let lower_bound = bound(&tasks);
    if lower_bound > CoveringError::MOST_ROWS {
        return Err(CoveringError::TooLarge { rows: lower_bound });
    }
    let parts = tasks.iter().map(|task| Ok((task.rows(request.deadline)?, task.existing.len())));
    let (rows, kept) = joined(&tasks, parts.collect::<Result<_, CoveringError>>()?);
    Ok(CoveringArray { rows, kept, invalid, lower_bound: lower_bound as u64 })
}

/// The number of tests that all tasks need at least. It is a sum, because no test is of two kinds.
fn bound(tasks: &[Task]) -> u128 {
    tasks.iter().map(Task::lower_bound).fold(0, u128::saturating_add)
}

/// The rows of all tasks, in order. Each part has the rows of a task, the existing ones first, and their number.
fn joined(tasks: &[Task], parts: Vec<(Vec<Vec<usize>>, usize)>) -> (Vec<Vec<usize>>, usize) {
    let (mut rows, mut new) = (Vec::new(), Vec::new());
    for (mut part, kept) in parts {
        new.append(&mut part.split_off(kept));
        rows.append(&mut part);
    }
    let kept = rows.len();
    rows.append(&mut new);
    (order::order(tasks, rows, kept), kept)
}

impl CoveringRequest<'_> {
    fn check(&self) -> Result<(), CoveringError> {
        let levels = self.rules.levels();
        let parameters = levels.len();
        if self.k == 0 || self.k > parameters {
            return Err(CoveringError::Strength { k: self.k, parameters });
        }
        if let Some(parameter) = levels.iter().position(|&levels| levels == 0) {
            return Err(CoveringError::NoLevel(parameter));
        }
        for (group, (members, strength)) in self.groups.iter().enumerate() {
            if *strength == 0 || *strength > members.len() {
                return Err(CoveringError::GroupStrength { group, strength: *strength, parameters: members.len() });
            }
            for (i, &member) in members.iter().enumerate() {
                if member >= parameters || members[..i].contains(&member) {
                    return Err(CoveringError::GroupMember { group, found: member, parameters });
                }
            }
        }
        for (index, test) in self.existing.iter().enumerate() {
            if test.len() != parameters {
                return Err(CoveringError::Ragged { index, found: test.len(), expected: parameters });
            }
            for (parameter, level) in test.iter().enumerate() {
                if let Some(found) = level.filter(|&level| level >= levels[parameter]) {
                    return Err(CoveringError::Level { index, parameter, found, levels: levels[parameter] });
                }
            }
        }
        Ok(())
    }

    /// Computes a lower bound on the number of tests of a covering array, without constructing the array. It is the
    /// number in [`CoveringArray::lower_bound`]. A number beyond `u128` saturates.
    ///
    /// # Errors
    /// As [`covering_array`], except for the size.
    pub fn lower_bound(&self) -> Result<u128, CoveringError> {
        self.check()?;
        Ok(bound(&Task::all(self).0))
    }

    /// Computes the number of combinations of levels that the tests of a covering array must contain. A number beyond
    /// `u128` saturates.
    ///
    /// # Errors
    /// As [`covering_array`], except for the size.
    pub fn combinations(&self) -> Result<u128, CoveringError> {
        self.check()?;
        let (tasks, _) = Task::all(self);
        Ok(tasks.iter().map(Task::combinations).fold(0, u128::saturating_add))
    }
}
