//! Searches for arrays that permutations of the levels map to themselves.
//!
//! If all parameters have the same levels, permute the levels of all of them at once. An array then consists of a few
//! rows, the *starters*, and their images. It covers everything if, for each choice of parameters, the starters show
//! every *orbit* of combinations (Chateauneuf, Colbourn, Kreher, *Covering arrays of strength three*, Designs, Codes
//! and Cryptography 16, 1999; Meagher, Stevens, *Group construction of covering arrays*, Journal of Combinatorial
//! Designs 13, 2005). There are far fewer starters than rows, so that the same local search finds arrays that it
//! would not find row by row. Rows of a single level, which have few images, are added if they cost less than a
//! starter.

use super::field::Field;
use super::search::{Annealing, Cells, Orbits};
use super::task::Task;
use crate::seeded::mix;
use paracosm_space::rules::Rules;
use std::collections::BTreeSet;

/// A group of permutations of levels.
type Group = Vec<Vec<usize>>;

/// The largest number of combinations of t levels that is sorted into orbits.
const MOST_COMBINATIONS: usize = 1 << 16;

/// A search for a symmetric covering array, whose rows are images of few starter rows.
pub(super) struct Symmetric {
    group: Group,
    rules: Rules,
    strength: usize,
    /// The rows of a single level, one of each orbit.
    constant: Vec<Vec<usize>>,
    /// The number of these rows with their images.
    constants: usize,
    seed: u64,
    search: Option<Annealing>,
}

/// Makes a search for symmetric arrays for each suitable group of permutations; none if the parameters differ.
pub(super) fn symmetric_searches(task: &Task) -> Vec<Symmetric> {
    let levels = task.rules.levels();
    let v = levels[0];
    let [(_, strength)] = task.families[..] else { return Vec::new() };
    let combinations = (0..strength).fold(1usize, |product, _| product.saturating_mul(v));
    let uniform = levels.iter().all(|&levels| levels == v) && task.rules.groups() == 0;
    if !uniform || strength < 2 || v < 2 || combinations > MOST_COMBINATIONS {
        return Vec::new();
    }
    let groups = groups(v).into_iter().enumerate();
    groups.map(|(i, group)| Symmetric::new(task, strength, group, mix(task.seed ^ mix(i as u64)))).collect()
}

/// Groups of permutations of `v` levels: the shifts of all levels or of all but one or two, and the affine maps if
/// all levels, or all but one, are a field.
fn groups(v: usize) -> Vec<Group> {
    let with_fixed = |permutation: Vec<usize>| {
        let moved = permutation.len();
        permutation.into_iter().chain(moved..v).collect::<Vec<_>>()
    };
    let mut groups = Vec::new();
    for moved in (v.saturating_sub(2).max(2)..=v).rev() {
        groups.push(
            (0..moved).map(|shift| with_fixed((0..moved).map(|level| (level + shift) % moved).collect())).collect(),
        );
    }
    for field in (v - 1..=v).filter_map(Field::new).filter(|field| field.order() > 2) {
        let q = field.order();
        let affine = |(factor, shift)| (0..q).map(|level| field.sum(field.product(factor, level), shift)).collect();
        let maps = (1..q).flat_map(|factor| (0..q).map(move |shift| (factor, shift)));
        groups.push(maps.map(|map| with_fixed(affine(map))).collect());
    }
    groups
}

/// The orbits of the combinations of t of `v` levels.
fn orbits(group: &Group, v: usize, t: usize) -> Orbits {
    let combinations = (0..t).fold(1, |product, _| product * v);
    let mut of = vec![usize::MAX; combinations];
    let mut count = 0;
    for combination in 0..combinations {
        if of[combination] != usize::MAX {
            continue;
        }
        for permutation in group {
            let digit = |i: usize| combination / (0..i).fold(1, |power, _| power * v) % v;
            let image = (0..t).rev().fold(0, |image, i| image * v + permutation[digit(i)]);
            of[image] = count;
        }
        count += 1;
    }
    Orbits { of, count }
}

impl Symmetric {
    fn new(task: &Task, strength: usize, group: Group, seed: u64) -> Self {
        let levels = task.rules.levels();
        let mut constant = Vec::new();
        let mut constants = 0;
        let mut seen = BTreeSet::new();
        for level in 0..levels[0] {
            let orbit: BTreeSet<usize> = group.iter().map(|permutation| permutation[level]).collect();
            if !seen.contains(&level) && orbit.len() < group.len() {
                constants += orbit.len();
                constant.push(vec![level; levels.len()]);
            }
            seen.extend(orbit);
        }
        Self { group, rules: task.rules.clone(), strength, constant, constants, seed, search: None }
    }

    /// Drops starter rows until the array is smaller than `size`, or begins with few enough starter rows. Returns
    /// `false` if that is impossible.
    pub(super) fn shrink_below(&mut self, size: usize) -> bool {
        let starters = size.saturating_sub(self.constants + 1) / self.group.len();
        let goal = self.constant.len() + starters;
        if let Some(search) = &mut self.search {
            while search.len() > goal && search.drop_row() {}
        } else if starters > 0 && goal < 1 << 16 {
            let (parameters, v) = (self.rules.levels().len(), self.rules.levels()[0]);
            let cells = Cells::of_orbits(parameters, v, self.strength, orbits(&self.group, v, self.strength));
            let entry = |i: usize| ((u128::from(mix(self.seed ^ mix(i as u64))) * v as u128) >> 64) as usize;
            let row = |row: usize| (0..parameters).map(|i| entry(row * parameters + i)).collect();
            let rows: Vec<Vec<usize>> = self.constant.iter().cloned().chain((0..starters).map(row)).collect();
            let mut search = Annealing::new(&self.rules, vec![cells], &rows, self.constant.len(), self.seed);
            search.demand_all();
            self.search = Some(search);
        }
        starters > 0
    }

    /// Takes `steps` steps of the search. Returns the rows of an array if one is found.
    pub(super) fn steps(&mut self, steps: usize) -> Option<Vec<Vec<usize>>> {
        let search = self.search.as_mut()?;
        search.steps(steps);
        if search.missing() > 0 {
            return None;
        }
        let starters = search.rows();
        let image = |row: &Vec<usize>, permutation: &Vec<usize>| row.iter().map(|&level| permutation[level]).collect();
        let images = starters.iter().flat_map(|row| self.group.iter().map(move |permutation| image(row, permutation)));
        Some(images.collect::<BTreeSet<Vec<usize>>>().into_iter().collect())
    }
}
