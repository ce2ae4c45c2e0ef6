//! Covering arrays: few tests that contain every valid combination of levels of any k parameters.
//!
//! The array grows by IPOG, column by column, and keeps entries open as long as nothing needs them. Which
//! combinations are valid and what can still be completed, [`Rules`] decide exactly. The same request gives the
//! same array on every machine.
//!
//! ```
//! use paracosm_coverage::rules::Rules;
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
mod open_rows;
mod optimise;
mod order;
mod orthogonal;
mod rows;
mod search;
mod symmetric;

pub use error::CoveringError;
pub use optimise::optimise;

use front::Family;
use grow::Growth;
use paracosm_coverage::Deadline;
use paracosm_coverage::rules::{Companions, Rules};
use rows::{Columns, OPEN, Rows};

/// What a covering array has to cover.
#[derive(Debug, Clone)]
pub struct CoveringRequest<'a> {
    /// The parameters and the constraints on them.
    pub rules: &'a Rules,
    /// Of how many parameters all valid combinations are covered.
    pub k: usize,
    /// Parameters among which combinations of more are covered: their positions, and of how many.
    pub groups: &'a [(Vec<usize>, usize)],
    /// Tests there are already, a level or nothing yet for each parameter. They come first, completed.
    pub existing: &'a [Vec<Option<usize>>],
    /// Where chance starts from.
    pub seed: u64,
    /// When the construction is given up.
    pub deadline: Deadline,
}

impl<'a> CoveringRequest<'a> {
    /// All valid combinations of `k` parameters, from nothing.
    pub fn new(rules: &'a Rules, k: usize) -> Self {
        Self { rules, k, groups: &[], existing: &[], seed: 0, deadline: Deadline::never() }
    }
}

/// Tests that contain every valid combination that was asked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CoveringArray {
    /// The tests, a level for each parameter: the existing ones that can be kept, then new ones. All keep the
    /// constraints.
    pub rows: Vec<Vec<usize>>,
    /// How many of the rows existed.
    pub kept: usize,
    /// The positions of existing tests that violate a constraint and so are not among the rows.
    pub invalid: Vec<usize>,
    /// A number of tests below which nothing covers as much: the largest number of valid combinations that some
    /// parameters have among themselves.
    pub lower_bound: u64,
}

/// Constructs a covering array.
///
/// # Errors
/// A strength is 0 or more than there are parameters to combine, a parameter has no level, a group names a parameter that does not exist
/// or one twice, an existing test is none of this space, the array would be too large, or the deadline has passed before
/// it was complete.
pub fn covering_array(request: &CoveringRequest) -> Result<CoveringArray, CoveringError> {
    request.check()?;
    let lower_bound = request.lower_bound();
    if lower_bound > CoveringError::MOST_ROWS {
        return Err(CoveringError::TooLarge { rows: lower_bound });
    }
    let columns = Columns::new(request.rules);
    let families = request.families(&columns);
    let mut companions = Companions::new(request.rules, &columns.order);
    let (rows, invalid) = existing(request, &columns);
    let kept = rows.len();
    let growth = Growth { columns: &columns, families: &families, seed: request.seed, deadline: request.deadline };
    // What is past the deadline leaves its work unfinished.
    let mut rows = grown(&growth, rows, &mut companions);
    request.check_time()?;
    fill::fill(&columns, &mut rows, request.deadline);
    request.check_time()?;
    let rows = (0..rows.len()).map(|index| columns.test(rows.row(index))).collect();
    let rows = optimise::polish(request, rows, kept, kept.max(lower_bound as usize));
    let rows = order::order(request.rules, request.k, rows, kept);
    Ok(CoveringArray { rows, kept, invalid, lower_bound: lower_bound as u64 })
}

/// With so many rows, only one way to begin is tried.
const MANY_ROWS: usize = 500;

/// Grows all columns, after existing rows or from an orthogonal array of the first columns.
fn grown(growth: &Growth, existing: Rows, companions: &mut Companions) -> Rows {
    let mut bases = Vec::new();
    if existing.len() == 0 && growth.families.len() == 1 {
        bases = orthogonal::bases(growth.columns, growth.families[0].strength);
    }
    // With many rows the widest serves best.
    if let Some(base) = bases.pop_if(|base| base.rows.len() > MANY_ROWS) {
        let mut rows = base.rows;
        growth.grow(&mut rows, companions, base.columns);
        return rows;
    }
    let plain = orthogonal::Base { rows: existing, columns: 0 };
    let begun = std::iter::once(plain).chain(bases);
    let grown = begun.map(|base| {
        let mut rows = base.rows;
        growth.grow(&mut rows, companions, base.columns);
        rows
    });
    grown.min_by_key(Rows::len).expect("there is one way to begin")
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

    fn check_time(&self) -> Result<(), CoveringError> {
        if self.deadline.passed() { Err(CoveringError::OutOfTime) } else { Ok(()) }
    }

    fn lower_bound(&self) -> u128 {
        let all: Vec<usize> = (0..self.rules.levels().len()).collect();
        let groups = self.groups.iter().map(|(members, strength)| self.rules.count(members, *strength).largest);
        groups.fold(self.rules.count(&all, self.k).largest, u128::max)
    }

    /// What is to be covered, in columns; groups that combine no more than all parameters do add nothing.
    fn families(&self, columns: &Columns) -> Vec<Family> {
        let mut families = vec![Family { members: (0..columns.len()).collect(), strength: self.k }];
        for (members, strength) in self.groups.iter().filter(|(_, strength)| *strength > self.k) {
            let mut members: Vec<usize> = members.iter().map(|&parameter| columns.column(parameter)).collect();
            members.sort_unstable();
            families.push(Family { members, strength: *strength });
        }
        families
    }
}

/// The existing tests that can be completed, and the positions of the others.
fn existing(request: &CoveringRequest, columns: &Columns) -> (Rows, Vec<usize>) {
    let mut rows = Rows::new(columns.len());
    let mut invalid = Vec::new();
    for (index, test) in request.existing.iter().enumerate() {
        let level = |&parameter: &usize| test[parameter].map_or(OPEN, |level| level as u32);
        let row: Vec<u32> = columns.order.iter().map(level).collect();
        if (0..request.rules.groups()).all(|group| columns.holds(group, &row)) {
            rows.push(&row);
        } else {
            invalid.push(index);
        }
    }
    (rows, invalid)
}
