//! The rows of a search, and its steps.

use super::cells::{Cells, Chosen};
use super::tally::{Missing, Tally};
use crate::seeded::mix;
use paracosm_space::rules::Rules;

/// One of so many steps takes any change that covers the combination.
const WANDER: usize = 500;

/// An entry stays unchanged after a change for this number of steps, and up to as many more.
const TENURE: usize = 2;

/// After this number of steps without progress, entries stay unchanged twice as long. After `DOUBLINGS` doublings
/// they stay as short as at first. Long times free a trapped search, short times search the neighbourhood more
/// thoroughly.
const PATIENCE: u64 = 3000;
const DOUBLINGS: u64 = 4;

/// The number of missing cells that are examined to rate a change.
const LOOKED_AT: usize = 256;

/// The state of a search for a smaller covering array, with the rows, the covered cells and the missing cells.
#[derive(Debug, Clone)]
pub(crate) struct Annealing {
    rules: Rules,
    families: Vec<Cells>,
    /// For each parameter, the families that contain it, and its place in each.
    families_of: Vec<Vec<(usize, usize)>>,
    rows: Vec<Vec<usize>>,
    kept: usize,
    /// The rows that exist and may change.
    active: Vec<usize>,
    /// For each level, the rows of `active` that have it, a bit each. `first` has the position of each parameter's
    /// levels.
    having: Vec<Vec<u64>>,
    present: Vec<u64>,
    first: Vec<usize>,
    tally: Tally,
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
    /// Makes a search from fewer than 2^16 rows that satisfy the constraints. The first `kept` rows never change.
    /// Combinations that the rows do not cover are not demanded.
    pub(crate) fn new(rules: &Rules, families: Vec<Cells>, rows: &[Vec<usize>], kept: usize, seed: u64) -> Self {
        assert!(rows.len() < 1 << 16, "rows are numbered in 16 bits");
        let levels = rules.levels();
        let parameters = levels.len();
        let first = levels.iter().scan(0, |end, levels| {
            *end += levels;
            Some(*end - levels)
        });
        let mut families_of = vec![Vec::new(); parameters];
        for (index, family) in families.iter().enumerate() {
            for (place, &member) in family.members.iter().enumerate() {
                families_of[member].push((index, place));
            }
        }
        let mut search = Self {
            rules: rules.clone(),
            tally: Tally::new(&families, rows.len(), parameters),
            families,
            families_of,
            rows: rows.to_vec(),
            kept,
            active: (kept..rows.len()).collect(),
            having: vec![vec![0; rows.len().div_ceil(64)]; levels.iter().sum()],
            present: vec![0; rows.len().div_ceil(64)],
            first: first.collect(),
            free_at: vec![vec![0; parameters]; rows.len()],
            step: 0,
            chance: mix(seed),
            fewest: 0,
            progressed: 0,
        };
        let Self { families, rows, tally, .. } = &mut search;
        for (index, row) in rows.iter().enumerate() {
            for (family, cells) in families.iter().enumerate() {
                cells.each(row, None, &mut |cell, _| tally.count(family, index, cell));
            }
        }
        for (index, row) in rows.iter().enumerate() {
            for (family, cells) in families.iter().enumerate() {
                cells.each(row, None, &mut |cell, chosen| tally.claim(family, cells, index, cell, chosen));
            }
        }
        for index in kept..search.rows.len() {
            search.present[index / 64] |= 1 << (index % 64);
            for parameter in 0..parameters {
                search.flip(index, parameter);
            }
        }
        search
    }

    /// Notes that a row gets an entry, or no longer has it.
    fn flip(&mut self, index: usize, parameter: usize) {
        let entry = self.first[parameter] + self.rows[index][parameter];
        self.having[entry][index / 64] ^= 1 << (index % 64);
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
        self.tally.missing.len()
    }

    /// Demands that the rows cover all cells.
    pub(crate) fn demand_all(&mut self) {
        let Self { families, tally, rules, fewest, .. } = self;
        for (family, cells) in families.iter().enumerate() {
            cells.each_cell(rules.levels(), &mut |row, cell, chosen| {
                if tally.is_missing(family, cell) {
                    tally.add_missing(family, cells, row, cell, chosen);
                }
            });
        }
        *fewest = tally.missing.len();
    }

    fn draw(&mut self, below: usize) -> usize {
        self.chance = self.chance.wrapping_add(1);
        ((u128::from(mix(self.chance)) * below as u128) >> 64) as usize
    }

    /// Removes the row whose removal leaves the fewest cells uncovered. Returns `false` if no row may be dropped.
    pub(crate) fn drop_row(&mut self) -> bool {
        let place = (0..self.active.len()).min_by_key(|&place| self.tally.all_alone(self.active[place]));
        let Some(place) = place else { return false };
        let index = self.active.swap_remove(place);
        self.present[index / 64] ^= 1 << (index % 64);
        for parameter in 0..self.first.len() {
            self.flip(index, parameter);
        }
        let Self { families, rows, tally, .. } = self;
        for (family, cells) in families.iter().enumerate() {
            let row = &rows[index];
            cells.each(row, None, &mut |cell, chosen| tally.leave(family, cells, index, row, cell, chosen));
        }
        self.fewest = self.missing();
        self.progressed = self.step;
        true
    }

    /// Gives entries of a row other levels.
    fn change(&mut self, index: usize, changes: &[(usize, usize)]) {
        for &(parameter, _) in changes {
            self.flip(index, parameter);
        }
        let Self { families, families_of, rows, tally, .. } = self;
        let row = &mut rows[index];
        // A cell with several of the entries is visited only for the first of them.
        let is_first = |cells: &Cells, chosen: &Chosen, i: usize| {
            i == 0 || {
                let mut members = chosen[..cells.strength].iter().map(|&place| cells.members[place as usize]);
                !members.any(|member| changes[..i].iter().any(|change| change.0 == member))
            }
        };
        for (i, &(parameter, _)) in changes.iter().enumerate() {
            for &(family, place) in &families_of[parameter] {
                let cells = &families[family];
                cells.each(row, Some(place), &mut |cell, chosen| {
                    if is_first(cells, chosen, i) {
                        tally.leave(family, cells, index, row, cell, chosen);
                    }
                });
            }
        }
        for &(parameter, level) in changes {
            row[parameter] = level;
        }
        for (i, &(parameter, _)) in changes.iter().enumerate() {
            for &(family, place) in &families_of[parameter] {
                let cells = &families[family];
                cells.each(row, Some(place), &mut |cell, chosen| {
                    if is_first(cells, chosen, i) {
                        tally.enter(family, cells, index, cell, chosen);
                    }
                });
            }
        }
        for &(parameter, _) in changes {
            self.flip(index, parameter);
            let tenure = TENURE << ((self.step - self.progressed) / PATIENCE % DOUBLINGS);
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
        let missing = self.tally.missing[drawn];
        let wanders = self.draw(WANDER) == 0;
        let mut best: Option<(i64, u64, Change)> = None;
        let mut ties = 0;
        for change in self.changes_to(&missing) {
            let Change { row, parameter, level } = change;
            let uncovers = i64::from(self.tally.alone(row, parameter));
            let covers = self.would_cover(change);
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
        let cells = &self.families[missing.family as usize];
        let members = missing.chosen[..cells.strength].iter().map(|&place| cells.members[place as usize]);
        let mut changes = Vec::new();
        if cells.are_combinations() {
            let wanted: Vec<(usize, usize)> = members.zip(missing.levels.map(|level| level as usize)).collect();
            // The rows with all entries of the combination but one.
            for word in 0..self.rows.len().div_ceil(64) {
                let (mut all, mut all_but_one) = (self.present[word], 0);
                for &(parameter, level) in &wanted {
                    let having = self.having[self.first[parameter] + level][word];
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
        let members: Vec<usize> = members.collect();
        for &row in &self.active {
            for &parameter in &members {
                let levels = 0..self.rules.levels()[parameter];
                let covers = |&level: &usize| {
                    cells.cell_with(&missing.chosen, &self.rows[row], parameter, level) == missing.cell as usize
                };
                changes.extend(levels.filter(covers).map(|level| Change { row, parameter, level }));
            }
        }
        changes
    }

    /// The number of missing cells that a change covers.
    fn would_cover(&self, change: Change) -> i64 {
        let row = &self.rows[change.row];
        let covers = |missing: &&Missing| {
            let cells = &self.families[missing.family as usize];
            if cells.are_combinations() {
                let members = missing.chosen[..cells.strength].iter().map(|&place| cells.members[place as usize]);
                return members.zip(missing.levels).all(|(member, level)| {
                    level as usize == if member == change.parameter { change.level } else { row[member] }
                });
            }
            cells.cell_with(&missing.chosen, row, change.parameter, change.level) == missing.cell as usize
        };
        self.tally.missing.iter().take(LOOKED_AT).filter(covers).count() as i64
    }

    /// Puts a combination of a cell into some row, and changes other entries as the constraints then demand.
    fn force(&mut self, missing: &Missing) {
        if self.active.is_empty() {
            return;
        }
        let drawn = self.draw(self.active.len());
        let cells = &self.families[missing.family as usize];
        let members = missing.chosen[..cells.strength].iter().map(|&place| cells.members[place as usize]);
        let mut wanted: Vec<(usize, usize)> = members.zip(missing.levels.map(|level| level as usize)).collect();
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
