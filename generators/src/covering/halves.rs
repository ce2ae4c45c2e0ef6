//! Columns of parameters of two levels without constraints, added to an array of pairs of all other parameters.
//!
//! For pairs, such columns are easy to find. Take all sets of half of the rows, rounded down, that contain one given row. If a column has one
//! level in such a set and the other level elsewhere, any two different columns show all four pairs of levels (Katona, *Two applications of
//! Sperner type theorems*, Periodica Mathematica Hungarica 3, 1973; Kleitman, Spencer, *Families of k-independent sets*, Discrete Mathematics
//! 6, 1973). With 15 rows there are 3,003 columns. A set that shows both levels beside each level of the other parameters is fit for the array.
//! So only the array of the other parameters, the *core*, must be searched.

use super::search::Cells;
use super::task::Task;
use crate::seeded::mix;
use paracosm_space::rules::Rules;
use std::collections::BTreeSet;

/// The number of sets that are drawn for each given row.
const DRAWS: u64 = 20_000;

/// The parameters of a task of pairs, divided into the core and the parameters whose columns are added.
pub(super) struct Halves<'a> {
    rules: &'a Rules,
    core: Vec<usize>,
    cells: Cells,
    free: Vec<usize>,
    seed: u64,
}

impl<'a> Halves<'a> {
    /// Divides the parameters of a task. Returns `None` if the task does not ask for pairs of one family, if either part has fewer than two
    /// parameters, or if the core has too many pairs.
    pub(super) fn of(task: &'a Task) -> Option<Self> {
        let [(members, 2)] = &task.families[..] else { return None };
        let levels = task.rules.levels();
        let is_free = |parameter: &usize| levels[*parameter] == 2 && task.rules.group_of(*parameter).is_none();
        let (free, core): (Vec<usize>, Vec<usize>) = members.iter().partition(|parameter| is_free(parameter));
        if core.len() < 2 || free.len() < 2 {
            return None;
        }
        let cells = Cells::new(levels, &core, 2)?;
        Some(Self { rules: &task.rules, core, cells, free, seed: task.seed })
    }

    /// Returns the pairs of the core.
    pub(super) fn cells(&self) -> Cells {
        self.cells.clone()
    }

    /// Gives rows that cover the pairs of the core columns for all other parameters, so that the rows cover all pairs. Returns `None` if no
    /// given row has enough sets.
    pub(super) fn complete(&self, mut rows: Vec<Vec<usize>>) -> Option<Vec<Vec<usize>>> {
        if rows.len() > 64 {
            return None;
        }
        let core = self.core_levels(&rows);
        let sets = (0..rows.len()).find_map(|given| self.sets(&core, rows.len(), given))?;
        for (&parameter, set) in self.free.iter().zip(sets) {
            rows.iter_mut().enumerate().for_each(|(i, row)| row[parameter] = (set >> i & 1) as usize);
        }
        Some(rows)
    }

    /// Returns the set of rows of each level of the core, without levels that no row has.
    fn core_levels(&self, rows: &[Vec<usize>]) -> Vec<u64> {
        let levels = |&parameter: &usize| (0..self.rules.levels()[parameter]).map(move |level| (parameter, level));
        let having = |(parameter, level)| {
            rows.iter().enumerate().fold(0, |set, (i, row)| set | u64::from(row[parameter] == level) << i)
        };
        self.core.iter().flat_map(levels).map(having).filter(|set| *set != 0).collect()
    }

    /// Returns a set for each free parameter: different sets of half of the rows that contain the given row and are fit for the core.
    fn sets(&self, core: &[u64], rows: usize, given: usize) -> Option<BTreeSet<u64>> {
        let fits = |set: u64| core.iter().all(|level| set & level != 0 && !set & level != 0);
        let mut sets = BTreeSet::new();
        for draw in 0..DRAWS {
            let mut set: u64 = 1 << given;
            let mut chance = mix(self.seed ^ mix(draw ^ (given as u64) << 32));
            while set.count_ones() < rows as u32 / 2 {
                chance = mix(chance);
                set |= 1 << ((u128::from(chance) * rows as u128) >> 64);
            }
            if fits(set) && sets.insert(set) && sets.len() == self.free.len() {
                return Some(sets);
            }
        }
        None
    }
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
        let halves = Halves::of(&tasks[0]).unwrap();
        // The nine rows cover the pairs of four parameters of three levels: a + b and a + 2 b modulo 3.
        let nine: Vec<[usize; 4]> =
            (0..9).map(|i| [i / 3, i % 3, (i / 3 + i % 3) % 3, (i / 3 + 2 * (i % 3)) % 3]).collect();
        let core = |copies: usize| {
            let rows = nine.iter().cycle().take(copies * 9).map(|row| row.iter().copied().chain([0; 60]).collect());
            rows.collect::<Vec<Vec<usize>>>()
        };
        // Nine rows have too few sets that show both levels beside each level of the others.
        assert!(halves.complete(core(1)).is_none());
        let rows = halves.complete(core(2)).unwrap();
        let coverage = kwise_coverage(&rules, 2, rows.iter().map(Vec::as_slice)).unwrap();
        assert_eq!((rows.len(), coverage.covered), (18, coverage.valid));
    }

    #[test]
    fn only_tasks_of_pairs_with_both_kinds_of_parameters_are_divided() {
        for (levels, k, divided) in [(&[3, 3, 2, 2][..], 2, true), (&[3, 3, 2, 2], 3, false), (&[2, 2, 2], 2, false)] {
            let rules = Rules::free(levels);
            let request = CoveringRequest::new(&rules, k);
            let (tasks, _) = Task::all(&request);
            assert_eq!(Halves::of(&tasks[0]).is_some(), divided, "{levels:?} at {k}");
        }
    }
}
