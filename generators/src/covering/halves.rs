//! Columns of parameters of two levels without constraints, added to an array of all other parameters.
//!
//! Only the other parameters, the *core*, need a search in all rows. A column of two levels is then a set of rows, which must contain some but not
//! all of the rows of each combination of k - 1 levels of the columns before. This is a colouring of a hypergraph with two colours, and a walk
//! finds it: it takes a combination whose rows all have one level, and changes the row for which the fewest other combinations become such
//! (Selman, Kautz, Cohen, *Noise strategies for improving local search*, AAAI 1994).
//!
//! For pairs, the columns follow from a theorem. Take all sets of half of the rows, rounded down, that contain one given row. Any two of them
//! show all four pairs of levels (Katona, *Two applications of Sperner type theorems*, Periodica Mathematica Hungarica 3, 1973; Kleitman,
//! Spencer, *Families of k-independent sets*, Discrete Mathematics 6, 1973). With 15 rows there are 3,003 sets.

use super::search::Cells;
use super::task::Task;
use crate::seeded::mix;
use paracosm_space::rules::Rules;
use std::collections::BTreeSet;

/// The number of sets that are drawn for each given row.
const DRAWS: u64 = 20_000;

/// The number of steps of a walk, and the number of walks for a column.
const STEPS: usize = 600;
const WALKS: u64 = 3;

/// The largest number of rows.
const MOST_ROWS: usize = 64 * WORDS;
const WORDS: usize = 4;

/// The largest number of combinations that a column has to divide.
const MOST_COMBINATIONS: usize = 1 << 21;

/// A set of rows.
type Set = [u64; WORDS];

/// The parameters of a task, divided into the core and the parameters whose columns are added.
pub(super) struct Halves<'a> {
    rules: &'a Rules,
    strength: usize,
    core: Vec<usize>,
    free: Vec<usize>,
    seed: u64,
}

impl<'a> Halves<'a> {
    /// Divides the parameters of a task whose arrays have at most `rows` rows. Returns `None` if the task has several families, if either part
    /// has fewer parameters than a combination, or if there are too many rows.
    pub(super) fn of(task: &'a Task, rows: usize) -> Option<Self> {
        let [(members, strength)] = &task.families[..] else { return None };
        let levels = task.rules.levels();
        let is_free = |parameter: &usize| levels[*parameter] == 2 && task.rules.group_of(*parameter).is_none();
        let (free, core): (Vec<usize>, Vec<usize>) = members.iter().partition(|parameter| is_free(parameter));
        let is_divided = rows <= MOST_ROWS && *strength >= 2 && core.len() >= *strength && free.len() >= *strength;
        is_divided.then_some(Self { rules: &task.rules, strength: *strength, core, free, seed: task.seed })
    }

    /// Returns the number of parameters whose columns are added.
    pub(super) fn free(&self) -> usize {
        self.free.len()
    }

    /// Returns the combinations of the core and of the first `known` other parameters; `None` if there are too many.
    pub(super) fn cells(&self, known: usize) -> Option<Cells> {
        let mut members = [&self.core, &self.free[..known]].concat();
        members.sort_unstable();
        Cells::new(self.rules.levels(), &members, self.strength)
    }

    /// Adds columns to rows that cover the combinations of the core and of the first `known` other parameters. Returns the number of other
    /// parameters whose combinations the rows cover then. The next column is as good as a walk made it.
    pub(super) fn fill(&self, rows: &mut [Vec<usize>], known: usize, ended: &dyn Fn() -> bool) -> usize {
        if self.strength == 2 && self.fill_by_theorem(rows) {
            return self.free.len();
        }
        let mut divided = Divided { strength: self.strength, columns: Vec::new(), sets: Vec::new() };
        for &parameter in self.core.iter().chain(&self.free[..known]) {
            divided.add(self.levels_of(parameter, rows));
        }
        for (added, &parameter) in self.free.iter().enumerate().skip(known) {
            if divided.sets.len() > MOST_COMBINATIONS || ended() {
                return added;
            }
            let (column, is_complete) = divided.column(rows.len(), mix(self.seed ^ mix(added as u64)));
            rows.iter_mut().enumerate().for_each(|(i, row)| row[parameter] = usize::from(contains(&column, i)));
            if !is_complete {
                return added;
            }
            divided.add(self.levels_of(parameter, rows));
        }
        self.free.len()
    }

    /// Returns the set of rows of each level of a parameter, without levels that no row has.
    fn levels_of(&self, parameter: usize, rows: &[Vec<usize>]) -> Vec<Set> {
        let having = |level: usize| {
            let mut set = [0; WORDS];
            rows.iter().enumerate().for_each(|(i, row)| set[i / 64] |= u64::from(row[parameter] == level) << (i % 64));
            set
        };
        (0..self.rules.levels()[parameter]).map(having).filter(|set| *set != [0; WORDS]).collect()
    }

    /// Gives rows that cover the pairs of the core columns for all other parameters. Returns `false` if no given row has enough sets.
    fn fill_by_theorem(&self, rows: &mut [Vec<usize>]) -> bool {
        if rows.len() > 64 {
            return false;
        }
        let core: Vec<u64> =
            self.core.iter().flat_map(|&parameter| self.levels_of(parameter, rows)).map(|set| set[0]).collect();
        let Some(sets) = (0..rows.len()).find_map(|given| self.sets(&core, rows.len(), given)) else { return false };
        for (&parameter, set) in self.free.iter().zip(sets) {
            rows.iter_mut().enumerate().for_each(|(i, row)| row[parameter] = (set >> i & 1) as usize);
        }
        true
    }

    /// Returns a set for each free parameter: different sets of half of the rows that contain the given row and divide each level of the core.
    fn sets(&self, core: &[u64], rows: usize, given: usize) -> Option<BTreeSet<u64>> {
        let divides = |set: u64| core.iter().all(|level| set & level != 0 && !set & level != 0);
        let mut sets = BTreeSet::new();
        for draw in 0..DRAWS {
            let mut set: u64 = 1 << given;
            let mut chance = mix(self.seed ^ mix(draw ^ (given as u64) << 32));
            while set.count_ones() < rows as u32 / 2 {
                chance = mix(chance);
                set |= 1 << below(chance, rows);
            }
            if divides(set) && sets.insert(set) && sets.len() == self.free.len() {
                return Some(sets);
            }
        }
        None
    }
}

/// The combinations of k - 1 levels of some columns. A further column has to divide each of these combinations.
struct Divided {
    strength: usize,
    /// The rows of each level of each column.
    columns: Vec<Vec<Set>>,
    /// The rows of each combination that some row has.
    sets: Vec<Set>,
}

impl Divided {
    /// Adds a column with the rows of its levels.
    fn add(&mut self, levels: Vec<Set>) {
        for level in &levels {
            self.combine(*level, self.columns.len(), self.strength - 2);
        }
        self.columns.push(levels);
    }

    /// Adds the combinations of a set with `more` levels of the columns before `end`.
    fn combine(&mut self, set: Set, end: usize, more: usize) {
        if more == 0 {
            self.sets.push(set);
            return;
        }
        for column in more - 1..end {
            for level in 0..self.columns[column].len() {
                let other = self.columns[column][level];
                let both = std::array::from_fn(|word| set[word] & other[word]);
                if both != [0; WORDS] {
                    self.combine(both, column, more - 1);
                }
            }
        }
    }

    /// Returns the best column of some walks, and whether it divides all combinations.
    fn column(&self, rows: usize, seed: u64) -> (Set, bool) {
        let walks = (0..WALKS).map(|walk| self.walk(rows, mix(seed ^ walk)));
        let mut best = ([0; WORDS], usize::MAX);
        for (column, undivided) in walks {
            if undivided < best.1 {
                best = (column, undivided);
            }
            if undivided == 0 {
                break;
            }
        }
        (best.0, best.1 == 0)
    }

    /// Returns the best column of a walk, and the number of combinations that it does not divide.
    fn walk(&self, rows: usize, mut chance: u64) -> (Set, usize) {
        let mut column = [0; WORDS];
        for i in 0..rows {
            chance = mix(chance);
            column[i / 64] |= (chance & 1) << (i % 64);
        }
        let mut best = (column, usize::MAX);
        let mut free_at = vec![0; rows];
        for step in 0..STEPS {
            let (undivided, alone) = self.seen(&column, rows);
            if undivided.len() < best.1 {
                best = (column, undivided.len());
            }
            if undivided.is_empty() {
                break;
            }
            chance = mix(chance);
            let chosen = &self.sets[undivided[below(chance, undivided.len())]];
            let members = (0..rows).filter(|i| contains(chosen, *i));
            // A row that was changed lately may change only if no other row may.
            let row = members.min_by_key(|&i| (free_at[i] > step, alone[i], mix(chance ^ i as u64)));
            let row = row.expect("a combination has a row");
            column[row / 64] ^= 1 << (row % 64);
            free_at[row] = step + 3 + below(mix(chance), 5);
        }
        best
    }

    /// Returns the combinations that a column does not divide, and for each row the number of combinations in which it alone has its level.
    fn seen(&self, column: &Set, rows: usize) -> (Vec<usize>, Vec<u32>) {
        let (mut undivided, mut alone) = (Vec::new(), vec![0; rows]);
        for (i, set) in self.sets.iter().enumerate() {
            let ones: Set = std::array::from_fn(|word| set[word] & column[word]);
            let zeros: Set = std::array::from_fn(|word| set[word] & !column[word]);
            for part in [ones, zeros] {
                // A union with two bits is of two rows at least.
                let union = part.iter().fold(0, |union, word| union | word);
                if union & union.wrapping_sub(1) != 0 {
                    continue;
                }
                if union == 0 {
                    undivided.push(i);
                } else if part.iter().filter(|word| **word != 0).count() == 1 {
                    let word = part.iter().position(|word| *word != 0).expect("there is one");
                    alone[64 * word + part[word].trailing_zeros() as usize] += 1;
                }
            }
        }
        (undivided, alone)
    }
}

fn contains(set: &Set, row: usize) -> bool {
    set[row / 64] >> (row % 64) & 1 == 1
}

/// Returns a number below `end` for a random word.
fn below(chance: u64, end: usize) -> usize {
    ((u128::from(chance) * end as u128) >> 64) as usize
}

#[cfg(test)]
mod tests {
    use super::super::CoveringRequest;
    use super::*;
    use paracosm_coverage::kwise::kwise_coverage;

    #[test]
    fn columns_of_halves_complete_an_array_of_the_other_parameters() {
        let levels: Vec<usize> = [3; 4].into_iter().chain([2; 60]).collect();
        let rules = Rules::free(&levels);
        let request = CoveringRequest::new(&rules, 2);
        let (tasks, _) = Task::all(&request);
        let halves = Halves::of(&tasks[0], MOST_ROWS).unwrap();
        // The nine rows cover the pairs of four parameters of three levels: a + b and a + 2 b modulo 3.
        let nine: Vec<[usize; 4]> =
            (0..9).map(|i| [i / 3, i % 3, (i / 3 + i % 3) % 3, (i / 3 + 2 * (i % 3)) % 3]).collect();
        let core = |copies: usize| {
            let rows = nine.iter().cycle().take(copies * 9).map(|row| row.iter().copied().chain([0; 60]).collect());
            rows.collect::<Vec<Vec<usize>>>()
        };
        // Nine rows have too few sets that show both levels beside each level of the others.
        assert!(halves.fill(&mut core(1), 0, &|| false) < 60);
        let mut rows = core(2);
        assert_eq!(halves.fill(&mut rows, 0, &|| false), 60);
        let coverage = kwise_coverage(&rules, 2, rows.iter().map(Vec::as_slice)).unwrap();
        assert_eq!((rows.len(), coverage.covered), (18, coverage.valid));
    }

    #[test]
    fn columns_that_a_walk_adds_cover_all_combinations_with_the_columns_before() {
        for (k, copies) in [(2, 2), (3, 3), (4, 6)] {
            let levels: Vec<usize> = [vec![3; k], vec![2; k + 2]].concat();
            let rules = Rules::free(&levels);
            let request = CoveringRequest::new(&rules, k);
            let (tasks, _) = Task::all(&request);
            let halves = Halves::of(&tasks[0], MOST_ROWS).unwrap();
            // Several copies of all combinations of the first k parameters.
            let digit = |i: usize, j: usize| if j < k { i / 3usize.pow(j as u32) % 3 } else { 0 };
            let row = |i: usize| (0..levels.len()).map(|j| digit(i, j)).collect();
            let mut rows: Vec<Vec<usize>> = (0..copies * 3usize.pow(k as u32)).map(row).take(MOST_ROWS).collect();
            let added = halves.fill(&mut rows, 0, &|| false);
            assert!(added >= 2, "k = {k}: {added} columns");
            let rules = Rules::free(&levels[..k + added]);
            let coverage = kwise_coverage(&rules, k, rows.iter().map(|row| &row[..k + added])).unwrap();
            assert_eq!(coverage.covered, coverage.valid, "k = {k}");
        }
    }

    #[test]
    fn only_tasks_with_enough_parameters_of_both_kinds_are_divided() {
        for (levels, k, divided) in
            [(&[3, 3, 2, 2][..], 2, true), (&[3, 3, 2, 2], 3, false), (&[2, 2, 2], 2, false), (&[3, 3, 2, 2], 1, false)]
        {
            let rules = Rules::free(levels);
            let request = CoveringRequest::new(&rules, k);
            let (tasks, _) = Task::all(&request);
            assert_eq!(Halves::of(&tasks[0], MOST_ROWS).is_some(), divided, "{levels:?} at {k}");
        }
    }
}
