//! The rows of a search, and its steps.

use super::cells::Cells;
use super::having::Having;
use super::table::Table;
use super::tally::{Families, Missing, Tally, Turn};
use crate::seeded::mix;
use paracosm_space::rules::Rules;

/// One of so many steps takes any change that covers the combination.
const WANDER: usize = 500;

/// An entry stays unchanged after a change for this number of steps, and up to as many more.
const TENURE: usize = 2;

/// For how long entries stay unchanged after a change. No choice is best for every model: on models with many
/// parameters (gcc, apache) a search with growing times needs fewer rows, on smaller models (spinv) a search with
/// short times.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tenure {
    /// The times stay as at first, so that the search examines the neighbourhood thoroughly.
    Short,
    /// The times double after each [`PATIENCE`] steps without progress, which frees a trapped search. After
    /// [`DOUBLINGS`] doublings they are as short as at first.
    Growing,
}

/// The number of steps without progress after which growing times become twice as long.
const PATIENCE: u64 = 3000;

/// The number of lengths of growing times.
const DOUBLINGS: u64 = 4;

/// The number of missing cells that are examined to rate a change.
const LOOKED_AT: usize = 256;

/// The state of a search for a smaller covering array, with the rows, the covered cells and the missing cells.
#[derive(Debug, Clone)]
pub(crate) struct Annealing<T = Table> {
    rules: Rules,
    families: Families,
    rows: Vec<Vec<usize>>,
    kept: usize,
    /// The rows that exist and may change.
    active: Vec<usize>,
    having: Having,
    tally: T,
    tenure: Tenure,
    /// The step from which each entry may change again.
    free_at: Vec<Vec<u64>>,
    step: u64,
    chance: u64,
    /// The least number of missing cells since the last row was dropped, and the step at which it was reached.
    fewest: usize,
    progressed: u64,
}

/// A change of one entry.
#[derive(Debug, Clone, Copy)]
struct Change {
    row: usize,
    parameter: usize,
    level: usize,
}

impl Annealing {
    /// Demands that the rows cover all cells.
    pub(crate) fn demand_all(&mut self) {
        self.tally.demand_all(&self.families, self.rules.levels());
        self.fewest = self.missing();
    }
}

impl<T: Tally> Annealing<T> {
    /// Makes a search from fewer than 2^16 rows that satisfy the constraints. The first `kept` rows never change.
    /// Combinations that the rows do not cover are not demanded.
    pub(crate) fn new(rules: &Rules, families: Vec<Cells>, rows: &[Vec<usize>], kept: usize, seed: u64) -> Self {
        assert!(rows.len() < 1 << 16, "rows are numbered in 16 bits");
        let parameters = rules.levels().len();
        let families = Families::new(families, parameters);
        let mut having = Having::new(rules.levels(), rows.len());
        for (index, row) in rows.iter().enumerate() {
            row.iter().enumerate().for_each(|(parameter, &level)| having.flip(index, parameter, level));
            if index >= kept {
                having.flip_present(index);
            }
        }
        Self {
            rules: rules.clone(),
            tally: T::new(&families, rows, &having),
            families,
            rows: rows.to_vec(),
            kept,
            active: (kept..rows.len()).collect(),
            having,
            tenure: Tenure::Growing,
            free_at: vec![vec![0; parameters]; rows.len()],
            step: 0,
            chance: mix(seed),
            fewest: 0,
            progressed: 0,
        }
    }

    /// Sets the tenure, which is [`Tenure::Growing`] by default.
    pub(crate) fn with_tenure(self, tenure: Tenure) -> Self {
        Self { tenure, ..self }
    }

    /// Returns the present rows of the search.
    pub(crate) fn rows(&self) -> Vec<Vec<usize>> {
        let indices = (0..self.kept).chain(self.active.iter().copied());
        indices.map(|index| self.rows[index].clone()).collect()
    }

    /// Returns the present number of rows.
    pub(crate) fn len(&self) -> usize {
        self.kept + self.active.len()
    }

    /// Returns the number of demanded cells that no row covers.
    pub(crate) fn missing(&self) -> usize {
        self.tally.missing().len()
    }

    fn draw(&mut self, below: usize) -> usize {
        self.chance = self.chance.wrapping_add(1);
        ((u128::from(mix(self.chance)) * below as u128) >> 64) as usize
    }

    /// Removes the row whose removal leaves the fewest cells uncovered. Returns `false` if no row may be dropped.
    pub(crate) fn drop_row(&mut self) -> bool {
        let place = (0..self.active.len()).min_by_key(|&place| self.tally.alone().in_all(self.active[place]));
        let Some(place) = place else { return false };
        self.drop_at(place);
        true
    }

    /// Removes all rows after the first `rows`. It must be called before any other row is dropped.
    pub(crate) fn keep_first(&mut self, rows: usize) {
        while self.len() > rows {
            self.drop_at(self.active.len() - 1);
        }
    }

    fn drop_at(&mut self, place: usize) {
        let index = self.active.swap_remove(place);
        let Self { families, having, rows, tally, .. } = self;
        let row = &rows[index];
        tally.leave_all(Turn { families, having, index, row });
        having.flip_present(index);
        row.iter().enumerate().for_each(|(parameter, &level)| having.flip(index, parameter, level));
        self.fewest = self.missing();
        self.progressed = self.step;
    }

    /// Gives entries of a row other levels.
    fn change(&mut self, index: usize, changes: &[(usize, usize)]) {
        let Self { families, having, rows, tally, .. } = self;
        tally.leave(Turn { families, having, index, row: &rows[index] }, changes);
        for &(parameter, level) in changes {
            having.flip(index, parameter, rows[index][parameter]);
            rows[index][parameter] = level;
            having.flip(index, parameter, level);
        }
        tally.enter(Turn { families, having, index, row: &rows[index] }, changes);
        for &(parameter, _) in changes {
            let tenure = match self.tenure {
                Tenure::Short => TENURE,
                Tenure::Growing => TENURE << ((self.step - self.progressed) / PATIENCE % DOUBLINGS),
            };
            let tenure = tenure + self.draw(tenure + 1);
            self.free_at[index][parameter] = self.step + tenure as u64;
        }
        if self.missing() < self.fewest {
            self.fewest = self.missing();
            self.progressed = self.step;
        }
    }

    /// Takes `steps` steps of the search, or fewer steps if no cell is missing any more.
    pub(crate) fn steps(&mut self, steps: usize) {
        for _ in 0..steps {
            if self.missing() == 0 {
                return;
            }
            self.step();
        }
    }

    /// Covers a missing cell.
    fn step(&mut self) {
        self.step += 1;
        let drawn = self.draw(self.missing());
        let missing = self.tally.missing()[drawn];
        let wanders = self.draw(WANDER) == 0;
        let mut best: Option<(i64, u64, Change)> = None;
        let mut ties = 0;
        let changes = self.changes_to(&missing);
        let covers = self.would_cover(&missing, &changes);
        for (change, covers) in changes.into_iter().zip(covers) {
            let Change { row, parameter, level } = change;
            let uncovers = i64::from(self.tally.alone().with(row, parameter));
            let cost = if wanders { 0 } else { uncovers - covers };
            let free_at = self.free_at[row][parameter];
            let leads = (self.missing() as i64 + cost) < self.fewest as i64;
            if free_at > self.step && !leads && !wanders {
                continue;
            }
            let better = match &best {
                None => true,
                Some((least, ..)) if cost != *least => cost < *least,
                Some(_) => {
                    ties += 1;
                    self.draw(ties + 1) == 0
                }
            };
            if better && self.keeps(row, parameter, level) {
                if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
                    ties = 0;
                }
                best = Some((cost, free_at, change));
            }
        }
        match best {
            Some((.., change)) => self.change(change.row, &[(change.parameter, change.level)]),
            None => self.force(&missing),
        }
    }

    /// Returns `true` if a row with another level satisfies the constraints.
    fn keeps(&mut self, row: usize, parameter: usize, level: usize) -> bool {
        let row = &mut self.rows[row];
        let before = std::mem::replace(&mut row[parameter], level);
        let keeps = self.rules.allows_at(parameter, row);
        row[parameter] = before;
        keeps
    }

    /// The changes of single entries that cover a cell.
    fn changes_to(&self, missing: &Missing) -> Vec<Change> {
        let cells = &self.families.cells[missing.family as usize];
        let mut changes = Vec::new();
        if cells.are_combinations() {
            let wanted = wanted(cells, missing);
            // The rows with all entries of the combination but one.
            for (word, &present) in self.having.present().iter().enumerate() {
                let (mut all, mut all_but_one) = (present, 0);
                for &(parameter, level) in &wanted {
                    let having = self.having.rows(parameter, level)[word];
                    all_but_one = (all_but_one & having) | (all & !having);
                    all &= having;
                }
                while all_but_one != 0 {
                    let row = word * 64 + all_but_one.trailing_zeros() as usize;
                    all_but_one &= all_but_one - 1;
                    let other = wanted.iter().find(|&&(parameter, level)| self.rows[row][parameter] != level);
                    changes.extend(other.map(|&(parameter, level)| Change { row, parameter, level }));
                }
            }
            return changes;
        }
        let members = wanted(cells, missing);
        for &row in &self.active {
            for &(parameter, _) in &members {
                let levels = 0..self.rules.levels()[parameter];
                let covers = |&level: &usize| {
                    cells.cell_with(&missing.chosen, &self.rows[row], parameter, level) == missing.cell as usize
                };
                changes.extend(levels.filter(covers).map(|level| Change { row, parameter, level }));
            }
        }
        changes
    }

    /// The number of missing cells that each of the changes to a cell covers.
    fn would_cover(&self, missing: &Missing, changes: &[Change]) -> Vec<i64> {
        let others = self.tally.missing().iter().take(LOOKED_AT);
        let cells = &self.families.cells[missing.family as usize];
        if !cells.are_combinations() {
            let covers = |change: &Change, other: &&Missing| {
                let (cells, row) = (&self.families.cells[other.family as usize], &self.rows[change.row]);
                cells.cell_with(&other.chosen, row, change.parameter, change.level) == other.cell as usize
            };
            return changes
                .iter()
                .map(|change| others.clone().filter(|it| covers(change, it)).count() as i64)
                .collect();
        }
        // No row has two changes, since it has all entries of the combination but one.
        let mut change_of = vec![usize::MAX; self.rows.len()];
        changes.iter().enumerate().for_each(|(i, change)| change_of[change.row] = i);
        let mut covers = vec![0; changes.len()];
        for other in others {
            let entries = &other.entries[..self.families.cells[other.family as usize].strength];
            for entry in missing.entries[..cells.strength].iter().filter(|entry| entries.contains(entry)) {
                for (word, &present) in self.having.present().iter().enumerate() {
                    let rest = entries.iter().filter(|&other| other != entry);
                    let having = rest.map(|rest| self.having.rows(rest.0 as usize, rest.1 as usize)[word]);
                    let mut rows = having.fold(present, |rows, having| rows & having);
                    while rows != 0 {
                        let change = change_of[word * 64 + rows.trailing_zeros() as usize];
                        rows &= rows - 1;
                        if changes.get(change).is_some_and(|change| change.parameter == entry.0 as usize) {
                            covers[change] += 1;
                        }
                    }
                }
            }
        }
        covers
    }

    /// Puts a combination of a cell into some row, and changes other entries as the constraints then demand.
    fn force(&mut self, missing: &Missing) {
        if self.active.is_empty() {
            return;
        }
        let drawn = self.draw(self.active.len());
        let mut wanted = wanted(&self.families.cells[missing.family as usize], missing);
        let index = self.active[drawn];
        let row = &self.rows[index];
        let mut groups: Vec<usize> = wanted.iter().filter_map(|pair| self.rules.group_of(pair.0)).collect();
        groups.sort_unstable();
        groups.dedup();
        for group in groups {
            for &member in self.rules.members(group) {
                if wanted.iter().any(|pair| pair.0 == member) {
                    continue;
                }
                let first = row[member];
                let levels =
                    std::iter::once(first).chain((0..self.rules.levels()[member]).filter(|&level| level != first));
                for level in levels {
                    wanted.push((member, level));
                    let fixed = |parameter: usize| wanted.iter().find(|pair| pair.0 == parameter).map(|pair| pair.1);
                    if self.rules.holds(group, fixed) {
                        break;
                    }
                    wanted.pop();
                }
            }
        }
        wanted.retain(|&(parameter, level)| row[parameter] != level);
        self.change(index, &wanted);
    }
}

/// The parameters of a combination of a cell with their levels.
fn wanted(cells: &Cells, missing: &Missing) -> Vec<(usize, usize)> {
    missing.entries[..cells.strength].iter().map(|&(parameter, level)| (parameter as usize, level as usize)).collect()
}
