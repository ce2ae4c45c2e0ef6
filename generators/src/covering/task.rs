//! The combinations that tests of one kind have to cover, and the array that covers them.

use super::front::Family;
use super::grow::Growth;
use super::rows::{Columns, OPEN, Rows};
use super::search::{Annealing, Cells};
use super::{CoveringError, CoveringRequest, fill, orthogonal};
use paracosm_coverage::Deadline;
use paracosm_coverage::theory::covering::fewest_rows;
use paracosm_space::demand::TestKind;
use paracosm_space::rules::{Companions, Rules};

/// The number of rows beyond which only one way to begin is tried.
const MANY_ROWS: usize = 500;

/// The work of a step apart from its visits of cells and its examination of the rows.
const STEP_WORK: usize = 300;

/// The work of polishing, in visits of cells: well below 0.1 s.
const POLISH_WORK: usize = 3_800_000;

/// The part of a request for a covering array that concerns the tests of one kind.
#[derive(Debug)]
pub(super) struct Task<'a> {
    pub(super) rules: Rules,
    /// The families to cover, each with its parameters in ascending order and its strength.
    pub(super) families: Vec<(Vec<usize>, usize)>,
    /// The existing tests of this kind, which can be completed to valid tests.
    pub(super) existing: Vec<&'a [Option<usize>]>,
    pub(super) seed: u64,
}

impl<'a> Task<'a> {
    /// Returns the tasks of a request, and the positions of the existing tests that fit no kind.
    pub(super) fn all(request: &CoveringRequest<'a>) -> (Vec<Self>, Vec<usize>) {
        let whole = [TestKind::of(request.rules)];
        let kinds = if request.kinds.is_empty() { &whole } else { request.kinds };
        let mut tasks: Vec<Self> = kinds.iter().map(|kind| Self::of(request, kind)).collect();
        let mut invalid = Vec::new();
        for (index, test) in request.existing.iter().enumerate() {
            let fits = |task: &&mut Self| {
                (0..task.rules.groups()).all(|group| task.rules.holds(group, |parameter| test[parameter]))
            };
            match tasks.iter_mut().find(fits) {
                Some(task) => task.existing.push(test),
                None => invalid.push(index),
            }
        }
        (tasks, invalid)
    }

    /// Returns the position of the task to which a row belongs.
    pub(super) fn of_row(tasks: &[Self], row: &[usize]) -> usize {
        tasks.iter().position(|task| task.rules.allows(row)).expect("every row is of some kind")
    }

    /// The task of a kind. A group whose strength is at most that of all parameters adds nothing.
    fn of(request: &CoveringRequest, kind: &TestKind) -> Self {
        let all: Vec<usize> = (0..request.rules.levels().len()).collect();
        let groups = request.groups.iter().filter(|(_, strength)| *strength > request.k);
        let asked = std::iter::once((&all, request.k)).chain(groups.map(|(members, strength)| (members, *strength)));
        let shares = asked.filter_map(|(members, strength)| kind.share(members, strength));
        let families = shares.map(|(mut members, strength)| match kind.negative() {
            // The negative value without other values: only that value is demanded.
            Some((own, _)) if strength == 0 => (vec![own], 1),
            _ => {
                members.sort_unstable();
                (members, strength)
            }
        });
        let (rules, families) = (kind.rules().clone(), families.collect());
        Self { rules, families, existing: Vec::new(), seed: request.seed }
    }

    /// Returns a lower bound on the number of rows of the task. It is the largest number of valid combinations of one
    /// choice of parameters, or the bound that theory proves for the parameters without constraints, if this bound is
    /// larger.
    pub(super) fn lower_bound(&self) -> u128 {
        let needed = |(members, strength): &(Vec<usize>, usize)| {
            let free = members.iter().filter(|&&member| self.rules.group_of(member).is_none());
            let levels: Vec<usize> = free.map(|&member| self.rules.levels()[member]).collect();
            let proved = if levels.len() < *strength { 0 } else { fewest_rows(&levels, *strength) };
            proved.max(self.rules.count(members, *strength).largest)
        };
        self.families.iter().map(needed).fold(0, u128::max)
    }

    /// Returns the number of valid combinations of all families.
    pub(super) fn combinations(&self) -> u128 {
        let valid = self.families.iter().map(|(members, strength)| self.rules.count(members, *strength).valid);
        valid.fold(0, u128::saturating_add)
    }

    /// Returns the numbered cells that have to be covered; `None` if there are too many cells.
    pub(super) fn cells(&self) -> Option<Vec<Cells>> {
        let numbered = |(members, strength): &(Vec<usize>, usize)| Cells::new(self.rules.levels(), members, *strength);
        self.families.iter().map(numbered).collect()
    }

    /// Makes rows that cover all combinations of the task, with the existing rows first.
    ///
    /// # Errors
    /// The deadline passed before the rows were complete.
    pub(super) fn rows(&self, deadline: Deadline) -> Result<Vec<Vec<usize>>, CoveringError> {
        // After the deadline, functions leave their work unfinished.
        let in_time = || if deadline.passed() { Err(CoveringError::OutOfTime) } else { Ok(()) };
        let columns = Columns::new(&self.rules);
        let families = self.families.iter().map(|(members, strength)| {
            let mut members: Vec<usize> = members.iter().map(|&parameter| columns.column(parameter)).collect();
            members.sort_unstable();
            Family { members, strength: *strength }
        });
        let families: Vec<Family> = families.collect();
        let mut companions = Companions::new(&self.rules, &columns.order);
        let mut rows = Rows::new(columns.len());
        for test in &self.existing {
            let level = |&parameter: &usize| test[parameter].map_or(OPEN, |level| level as u32);
            rows.push(&columns.order.iter().map(level).collect::<Vec<u32>>());
        }
        let growth = Growth { columns: &columns, families: &families, seed: self.seed, deadline };
        let mut rows = grown(&growth, rows, &mut companions);
        in_time()?;
        fill::fill(&columns, &mut rows, deadline);
        in_time()?;
        let rows = (0..rows.len()).map(|index| columns.test(rows.row(index))).collect();
        let kept = self.existing.len();
        Ok(polish(self, rows, kept, kept.max(self.lower_bound() as usize)))
    }
}

/// Grows all columns, after existing rows or from an orthogonal array of the first columns.
fn grown(growth: &Growth, existing: Rows, companions: &mut Companions) -> Rows {
    let mut bases = Vec::new();
    if existing.len() == 0 && growth.families.len() == 1 {
        bases = orthogonal::bases(growth.columns, growth.families[0].strength);
    }
    // With many rows the widest array is the best beginning.
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

/// Shrinks rows with a short search by the rules of [`optimise`](super::optimise), the same on every machine. The
/// work is bounded; an array that needs more work stays as it is.
fn polish(task: &Task, rows: Vec<Vec<usize>>, kept: usize, goal: usize) -> Vec<Vec<usize>> {
    let Some(cells) = task.cells().filter(|_| rows.len() < 1 << 16) else { return rows };
    let start: usize = cells.iter().map(|cells| cells.in_row() * rows.len()).sum();
    let changed: usize = cells.iter().map(|cells| 2 * cells.in_row() * cells.strength() / cells.members()).sum();
    let step = changed + rows.len() / 2 + STEP_WORK;
    let steps = POLISH_WORK.saturating_sub(start) / step;
    if steps == 0 {
        return rows;
    }
    let mut search: Annealing = Annealing::new(&task.rules, cells, &rows, kept, task.seed);
    let mut best = rows;
    for _ in 0..steps {
        while search.missing() == 0 {
            if search.len() < best.len() {
                best = search.rows();
            }
            if search.len() <= goal || !search.drop_row() {
                return best;
            }
        }
        search.steps(1);
    }
    if search.missing() == 0 && search.len() < best.len() { search.rows() } else { best }
}
