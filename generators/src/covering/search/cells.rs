//! Numbers the combinations of t levels without a table of the choices of parameters.
//!
//! The combinations whose last parameter is the j-th come after all combinations of earlier parameters. They are
//! ordered by that parameter's level, then by the t - 1 other levels by the same rule. So a combination's number is a
//! sum with a term for each of its levels (the combinatorial number system, for levels in place of elements).

use std::collections::BTreeSet;

/// The largest strength of a covering array that the search can handle.
pub(super) const MOST_STRENGTH: usize = 8;

/// The largest number of cells.
const MOST_CELLS: usize = 1 << 26;

/// The places of the parameters of a cell among the members. Only the first `strength` places count.
pub(super) type Chosen = [u16; MOST_STRENGTH];

/// A numbering of the combinations of levels of t of the given parameters.
#[derive(Debug, Clone)]
pub(crate) struct Cells {
    pub(super) members: Vec<usize>,
    pub(super) strength: usize,
    /// For the s-th smallest place of a combination, from 1, the number that each member adds, by its place.
    start: Vec<Vec<usize>>,
    /// The number that each level adds, by `s` and the place of its member.
    step: Vec<Vec<usize>>,
    count: usize,
    orbits: Option<Orbits>,
}

/// The orbits of combinations of levels under a group of permutations. An orbit has the combinations that the
/// permutations map to each other.
#[derive(Debug, Clone)]
pub(crate) struct Orbits {
    /// The number of the orbit of each combination of t levels; the level of the smallest place is the lowest digit.
    pub(crate) of: Vec<usize>,
    /// The number of orbits of combinations.
    pub(crate) count: usize,
}

impl Cells {
    /// Numbers the combinations of levels of `strength` of the members; `None` if there are too many combinations.
    pub(crate) fn new(levels: &[usize], members: &[usize], strength: usize) -> Option<Self> {
        if strength > MOST_STRENGTH {
            return None;
        }
        let mut start = vec![vec![0usize; members.len() + 1]; strength + 1];
        start[0].fill(1);
        for s in 1..=strength {
            for place in 0..members.len() {
                let below = start[s - 1][place].checked_mul(levels[members[place]])?;
                start[s][place + 1] =
                    start[s][place].checked_add(below).filter(|&count| count <= MOST_CELLS || s < strength)?;
            }
        }
        let step = start.iter().map(|start| start[..members.len()].to_vec());
        let step = std::iter::once(Vec::new()).chain(step).take(strength + 1).collect();
        let count = start[strength][members.len()];
        Some(Self { members: members.to_vec(), strength, start, step, count, orbits: None })
    }

    /// Numbers the orbits of the combinations of levels of `strength` of `parameters` parameters, with `v` levels each.
    pub(crate) fn of_orbits(parameters: usize, v: usize, strength: usize, orbits: Orbits) -> Self {
        let mut choices = vec![vec![0; parameters + 1]; strength + 1];
        choices[0].fill(1);
        for s in 1..=strength {
            for place in 0..parameters {
                choices[s][place + 1] = choices[s][place] + choices[s - 1][place];
            }
        }
        let count = choices[strength][parameters] * orbits.count;
        let tuples = orbits.of.len();
        let start = choices.iter().map(|row| row.iter().map(|choices| choices * tuples).collect()).collect();
        let digit = |s: usize| (1..s).fold(1, |power, _| power * v);
        let step = (0..=strength).map(|s| vec![digit(s); parameters]).collect();
        Self { members: (0..parameters).collect(), strength, start, step, count, orbits: Some(orbits) }
    }

    /// Returns the number of cells, which are combinations of levels or orbits of combinations.
    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// Returns the number of parameters that are members.
    pub(crate) fn members(&self) -> usize {
        self.members.len()
    }

    /// Returns the number of parameters in a cell.
    pub(crate) fn strength(&self) -> usize {
        self.strength
    }

    /// Returns the number of cells that a row covers.
    pub(crate) fn in_row(&self) -> usize {
        (0..self.strength).fold(1, |choices, i| choices * (self.members.len() - i) / (i + 1))
    }

    /// Returns `true` if each cell is a single combination of levels and not an orbit.
    pub(super) fn are_combinations(&self) -> bool {
        self.orbits.is_none()
    }

    #[inline(always)]
    fn term(&self, s: usize, place: usize, row: &[usize]) -> usize {
        self.start[s][place] + row[self.members[place]] * self.step[s][place]
    }

    #[inline(always)]
    fn cell(&self, number: usize) -> usize {
        match &self.orbits {
            None => number,
            Some(orbits) => number / orbits.of.len() * orbits.count + orbits.of[number % orbits.of.len()],
        }
    }

    /// Returns the cell of a row at the chosen places, with the level of one parameter replaced by `level`.
    #[inline(always)]
    pub(super) fn cell_with(&self, chosen: &Chosen, row: &[usize], parameter: usize, level: usize) -> usize {
        let terms = chosen[..self.strength].iter().enumerate().map(|(s, &place)| {
            let member = self.members[place as usize];
            let level = if member == parameter { level } else { row[member] };
            self.start[s + 1][place as usize] + level * self.step[s + 1][place as usize]
        });
        self.cell(terms.sum())
    }

    /// Calls `call` with each cell of a row and the chosen places in ascending order. With a `place`, only the cells
    /// that contain the place count.
    #[inline(always)]
    pub(super) fn each(&self, row: &[usize], place: Option<usize>, call: &mut impl FnMut(usize, &Chosen)) {
        let mut chosen = [0; MOST_STRENGTH];
        self.choose(self.strength, self.members.len(), 0, row, place, &mut chosen, call);
    }

    /// Calls `call` with a row that has the cell, the cell and its chosen places, for each cell.
    pub(super) fn each_cell(&self, levels: &[usize], call: &mut impl FnMut(&[usize], usize, &Chosen)) {
        let mut sets = Vec::new();
        self.each(&vec![0; levels.len()], None, &mut |_, chosen| sets.push(*chosen));
        for chosen in sets {
            let members: Vec<usize> =
                chosen[..self.strength].iter().map(|&place| self.members[place as usize]).collect();
            let mut seen = BTreeSet::new();
            let mut row = vec![0; levels.len()];
            loop {
                let cell = self.cell_with(&chosen, &row, usize::MAX, 0);
                if seen.insert(cell) {
                    call(&row, cell, &chosen);
                }
                let Some(i) = (0..members.len()).find(|&i| row[members[i]] + 1 < levels[members[i]]) else { break };
                row[members[i]] += 1;
                members[..i].iter().for_each(|&member| row[member] = 0);
            }
        }
    }

    /// Chooses the `s` smallest places, all below `end`; `forced` is one of them if given.
    #[allow(clippy::too_many_arguments)]
    fn choose(
        &self,
        s: usize,
        end: usize,
        number: usize,
        row: &[usize],
        forced: Option<usize>,
        chosen: &mut Chosen,
        call: &mut impl FnMut(usize, &Chosen),
    ) {
        if s == 1 {
            let places = forced.map_or(0..end, |place| place..place + 1);
            for place in places {
                chosen[0] = place as u16;
                call(self.cell(number + self.term(1, place, row)), chosen);
            }
            return;
        }
        let first = match forced {
            Some(place) if place + 1 >= s => {
                chosen[s - 1] = place as u16;
                self.choose(s - 1, place, number + self.term(s, place, row), row, None, chosen, call);
                place + 1
            }
            Some(place) => place + 1,
            None => 0,
        };
        for place in first.max(s - 1)..end {
            chosen[s - 1] = place as u16;
            self.choose(s - 1, place, number + self.term(s, place, row), row, forced, chosen, call);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_combination_has_its_own_number() {
        let levels = [3, 1, 2, 4, 2];
        for strength in 1..=4 {
            let cells = Cells::new(&levels, &[0, 1, 2, 3, 4], strength).unwrap();
            let mut seen = BTreeSet::new();
            for test in 0..48 {
                let row = [test % 3, 0, test / 3 % 2, test / 6 % 4, test / 24];
                let mut all = BTreeSet::new();
                cells.each(&row, None, &mut |cell, chosen| {
                    assert!(all.insert((cell, *chosen)));
                    let parameters: Vec<usize> = chosen[..strength].iter().map(|&place| place as usize).collect();
                    let tuple: Vec<(usize, usize)> = parameters.iter().map(|&p| (p, row[p])).collect();
                    seen.insert((cell, tuple));
                });
                for place in 0..5 {
                    let mut some = BTreeSet::new();
                    cells.each(&row, Some(place), &mut |cell, chosen| assert!(some.insert((cell, *chosen))));
                    let with = all.iter().filter(|(_, chosen)| chosen[..strength].contains(&(place as u16)));
                    assert_eq!(some, with.copied().collect());
                }
            }
            let numbers: BTreeSet<usize> = seen.iter().map(|(cell, _)| *cell).collect();
            assert_eq!(numbers.len(), seen.len());
            assert_eq!(numbers, (0..cells.len()).collect());
        }
    }
}
