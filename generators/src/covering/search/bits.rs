//! A tally without a table. Each visit of a cell computes the other rows that cover it, from the bits of the rows that
//! have its levels.
//!
//! A model with many parameters has so many cells that a table of them does not fit into the caches. The bits do: with 150 rows, a
//! level has 20 bytes. The rows that cover a cell are the intersection of the rows of its levels, and only cells that
//! none or one of the other rows covers matter. Most cells are covered by many rows: folded to 32 bits, their
//! intersection has at least two bits, which a few vector instructions see for many cells at once.

use super::cells::{Cells, Chosen, MOST_STRENGTH};
use super::having::Having;
use super::tally::{Alone, Families, Missing, Tally, Turn};
use std::collections::BTreeMap;

/// The number of places that are looked at together.
const LANES: usize = 16;

/// The largest number of half words of a level.
const MOST_HALVES: usize = 8;

/// The tally of rows by their bits.
#[derive(Debug, Clone)]
pub(crate) struct Bits {
    missing: Vec<Missing>,
    /// The place of each missing cell among the missing cells, by its family and its number.
    places: BTreeMap<(u16, u32), usize>,
    alone: Alone,
    visit: Visit,
}

/// The rows, other than the row of a turn, that cover a cell; only if there is at most one such row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Others {
    None,
    One(usize),
}

/// Buffers for the visits of the cells of rows.
#[derive(Debug, Clone, Default)]
struct Visit {
    /// The places of the members that are not fixed.
    places: Vec<u16>,
    /// For each of these places, the rows that have its level.
    all: Vec<u64>,
    /// The same rows as half words, in blocks of [`LANES`] places: the first half word of each, then the second.
    blocks: Vec<u32>,
    /// For each number of chosen places, the rows that have the levels of all of them.
    chosen: Vec<u64>,
}

impl Tally for Bits {
    fn new(families: &Families, rows: &[Vec<usize>], having: &Having) -> Self {
        assert!(rows.len() <= Self::MOST_ROWS, "levels have at most {MOST_HALVES} half words");
        let alone = Alone::new(rows.len(), families.of.len());
        let mut bits = Self { missing: Vec::new(), places: BTreeMap::new(), alone, visit: Visit::default() };
        for (index, row) in rows.iter().enumerate() {
            let turn = Turn { families, having, index, row };
            let Self { alone, visit, .. } = &mut bits;
            for (family, cells) in families.cells.iter().enumerate() {
                visit.each(turn, family, None, &[], &mut |chosen, others| {
                    if others == Others::None {
                        alone.begin(index, cells, chosen);
                    }
                });
            }
        }
        bits
    }

    fn missing(&self) -> &[Missing] {
        &self.missing
    }

    fn alone(&self) -> &Alone {
        &self.alone
    }

    fn leave(&mut self, turn: Turn, changed: &[(usize, usize)]) {
        for (i, &(parameter, _)) in changed.iter().enumerate() {
            for &(family, place) in &turn.families.of[parameter] {
                self.leave_cells(turn, family, Some(place), &changed[..i]);
            }
        }
    }

    fn enter(&mut self, turn: Turn, changed: &[(usize, usize)]) {
        for (i, &(parameter, _)) in changed.iter().enumerate() {
            for &(family, place) in &turn.families.of[parameter] {
                let cells = &turn.families.cells[family];
                let Self { missing, places, alone, visit } = self;
                visit.each(turn, family, Some(place), &changed[..i], &mut |chosen, others| match others {
                    Others::None => {
                        remove_missing(missing, places, family, cell(cells, turn.row, chosen).0);
                        alone.begin(turn.index, cells, chosen);
                    }
                    Others::One(row) => alone.end(row, cells, chosen),
                });
            }
        }
    }

    fn leave_all(&mut self, turn: Turn) {
        for family in 0..turn.families.cells.len() {
            self.leave_cells(turn, family, None, &[]);
        }
    }
}

impl Bits {
    /// The largest number of rows. With more rows, a table is faster.
    pub(crate) const MOST_ROWS: usize = 32 * MOST_HALVES;

    fn leave_cells(&mut self, turn: Turn, family: usize, place: Option<usize>, without: &[(usize, usize)]) {
        let cells = &turn.families.cells[family];
        let Self { missing, places, alone, visit } = self;
        visit.each(turn, family, place, without, &mut |chosen, others| match others {
            Others::None => {
                alone.end(turn.index, cells, chosen);
                let (cell, chosen) = cell(cells, turn.row, chosen);
                places.insert((family as u16, cell as u32), missing.len());
                missing.push(Missing::new(family, cells, turn.row, cell, &chosen));
            }
            Others::One(row) => alone.begin(row, cells, chosen),
        });
    }
}

fn half_word(rows: &[u64], half: usize) -> u32 {
    (rows[half / 2] >> (half % 2 * 32)) as u32
}

/// Returns the cell of a row at the chosen places, with the places in ascending order.
fn cell(cells: &Cells, row: &[usize], chosen: &Chosen) -> (usize, Chosen) {
    let mut sorted = *chosen;
    sorted[..cells.strength].sort_unstable();
    (cells.cell_with(&sorted, row, usize::MAX, 0), sorted)
}

fn remove_missing(missing: &mut Vec<Missing>, places: &mut BTreeMap<(u16, u32), usize>, family: usize, cell: usize) {
    let Some(place) = places.remove(&(family as u16, cell as u32)) else { return };
    missing.swap_remove(place);
    if let Some(moved) = missing.get(place) {
        places.insert((moved.family, moved.cell), place);
    }
}

impl Visit {
    /// Calls `call` with each cell of a row that at most one other row covers. With a `place`, only the cells that
    /// contain the place count, and the place is the last of the chosen places, which otherwise ascend. Cells with one
    /// of the parameters of `without` do not count.
    fn each(
        &mut self,
        turn: Turn,
        family: usize,
        place: Option<usize>,
        without: &[(usize, usize)],
        call: &mut impl FnMut(&Chosen, Others),
    ) {
        let cells = &turn.families.cells[family];
        let words = turn.having.words();
        self.places.clear();
        self.all.clear();
        for (other, &member) in cells.members.iter().enumerate() {
            if Some(other) != place && without.iter().all(|change| change.0 != member) {
                let rows = turn.having.rows(member, turn.row[member]);
                self.places.push(other as u16);
                self.all.extend_from_slice(rows);
            }
        }
        let halves = turn.having.halves();
        self.blocks.clear();
        self.blocks.resize(self.places.len().div_ceil(LANES) * LANES * halves, 0);
        for (at, rows) in self.all.chunks_exact(words).enumerate() {
            for half in 0..halves {
                self.blocks[(at / LANES * halves + half) * LANES + at % LANES] = half_word(rows, half);
            }
        }
        let strength = cells.strength - usize::from(place.is_some());
        self.chosen.resize((strength + 1) * words, 0);
        let begin = &mut self.chosen[strength * words..][..words];
        match place.map(|place| cells.members[place]) {
            Some(member) => begin.copy_from_slice(turn.having.rows(member, turn.row[member])),
            None => begin.fill(u64::MAX),
        }
        begin[turn.index / 64] &= !(1 << (turn.index % 64));
        let Self { places, all, blocks, chosen } = self;
        let mut picked = [0; MOST_STRENGTH];
        if let Some(place) = place {
            picked[strength] = place as u16;
        }
        Choice { places, all, blocks, words, halves }.choose(strength, places.len(), chosen, &mut picked, call);
    }
}

/// The places that a visit chooses from.
struct Choice<'a> {
    places: &'a [u16],
    all: &'a [u64],
    blocks: &'a [u32],
    words: usize,
    halves: usize,
}

impl Choice<'_> {
    /// Chooses the `s` smallest places, all among the first `end`. The rows that have the levels of the places chosen
    /// so far are the `s`-th of `chosen`.
    fn choose(
        &self,
        s: usize,
        end: usize,
        chosen: &mut [u64],
        picked: &mut Chosen,
        call: &mut impl FnMut(&Chosen, Others),
    ) {
        let words = self.words;
        if s == 0 {
            if let Some(others) = others(chosen[..words].iter().copied(), 64) {
                call(picked, others);
            }
            return;
        }
        if s == 1 {
            let rows = &chosen[words..][..words];
            let found = &mut |at: usize, others| {
                picked[0] = self.places[at];
                call(picked, others);
            };
            match self.halves {
                1 => self.few::<1>(rows, end, found),
                2 => self.few::<2>(rows, end, found),
                3 => self.few::<3>(rows, end, found),
                4 => self.few::<4>(rows, end, found),
                5 => self.few::<5>(rows, end, found),
                6 => self.few::<6>(rows, end, found),
                7 => self.few::<7>(rows, end, found),
                _ => self.few::<MOST_HALVES>(rows, end, found),
            }
            return;
        }
        for at in s - 1..end {
            let (below, rows) = chosen.split_at_mut(s * words);
            let level = &self.all[at * words..][..words];
            for ((below, rows), level) in below[(s - 1) * words..].iter_mut().zip(&*rows).zip(level) {
                *below = rows & level;
            }
            picked[s - 1] = self.places[at];
            self.choose(s - 1, at, chosen, picked, call);
        }
    }
}

impl Choice<'_> {
    /// Chooses the last place of a cell. Looks at a block of places at once, so that the compiler uses vectors, and
    /// first at the union of all half words: if the union has two bits, there are two rows.
    fn few<const HALVES: usize>(&self, rows: &[u64], end: usize, found: &mut impl FnMut(usize, Others)) {
        let halves: [u32; HALVES] = std::array::from_fn(|half| half_word(rows, half));
        let blocks = self.blocks.chunks_exact(HALVES * LANES).take(end.div_ceil(LANES));
        for (block, levels) in blocks.enumerate() {
            let mut union = [0u32; LANES];
            for (half, levels) in halves.iter().zip(levels.as_chunks::<LANES>().0) {
                for (union, level) in union.iter_mut().zip(levels) {
                    *union |= half & level;
                }
            }
            let mut few = 0u32;
            for (lane, union) in union.into_iter().enumerate() {
                few |= u32::from(union & union.wrapping_sub(1) == 0) << lane;
            }
            while few != 0 {
                let lane = few.trailing_zeros() as usize;
                few &= few - 1;
                let at = block * LANES + lane;
                if at >= end {
                    break;
                }
                let both = halves.iter().zip(levels.as_chunks::<LANES>().0).map(|(half, levels)| half & levels[lane]);
                if let Some(others) = others(both.map(u64::from), 32) {
                    found(at, others);
                }
            }
        }
    }
}

/// Returns the rows of some words, of so many bits each, if there is at most one row.
#[inline(always)]
fn others(words: impl Iterator<Item = u64>, bits: usize) -> Option<Others> {
    let mut found = Others::None;
    for (i, word) in words.enumerate() {
        if word != 0 {
            if found != Others::None || word & (word - 1) != 0 {
                return None;
            }
            found = Others::One(i * bits + word.trailing_zeros() as usize);
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::super::table::Table;
    use super::*;
    use rand::Rng;
    use rand::SeedableRng;
    use rand_pcg::Pcg64;

    /// Returns the missing cells, in any order, and the cells of single rows. Two tallies must agree on them.
    fn seen(tally: &impl Tally, rows: usize, parameters: usize) -> (Vec<String>, Vec<u32>) {
        let missing = tally.missing().iter();
        let mut missing: Vec<String> = missing.map(|missing| format!("{missing:?}")).collect();
        missing.sort_unstable();
        let alone = (0..rows).flat_map(|row| (0..=parameters).map(move |parameter| (row, parameter)));
        (missing, alone.map(|(row, parameter)| tally.alone().with(row, parameter)).collect())
    }

    #[test]
    fn bits_see_what_a_table_sees_after_any_changes() {
        for seed in 0..30 {
            let mut rng = Pcg64::seed_from_u64(seed);
            let parameters = rng.random_range(4..20);
            let levels: Vec<usize> = (0..parameters).map(|_| rng.random_range(1..5)).collect();
            let all: Vec<usize> = (0..parameters).collect();
            let strength = rng.random_range(1..=4);
            let mut cells = vec![Cells::new(&levels, &all, strength).unwrap()];
            if seed % 2 == 0 {
                cells.push(Cells::new(&levels, &all[parameters / 2..], strength.min(parameters / 2).max(1)).unwrap());
            }
            let families = Families::new(cells, parameters);
            let count = rng.random_range(2..=Bits::MOST_ROWS >> (seed % 7));
            let row = |rng: &mut Pcg64| levels.iter().map(|&levels| rng.random_range(0..levels)).collect();
            let mut rows: Vec<Vec<usize>> = (0..count).map(|_| row(&mut rng)).collect();
            let mut having = Having::new(&levels, count);
            for (index, row) in rows.iter().enumerate() {
                row.iter().enumerate().for_each(|(parameter, &level)| having.flip(index, parameter, level));
            }
            let mut table = Table::new(&families, &rows, &having);
            let mut bits = Bits::new(&families, &rows, &having);
            for _ in 0..40 {
                let index = rng.random_range(0..count);
                let mut changes: Vec<(usize, usize)> = Vec::new();
                for _ in 0..rng.random_range(1..=3) {
                    let parameter = rng.random_range(0..parameters);
                    if changes.iter().all(|change| change.0 != parameter) {
                        changes.push((parameter, rng.random_range(0..levels[parameter])));
                    }
                }
                let turn = Turn { families: &families, having: &having, index, row: &rows[index] };
                table.leave(turn, &changes);
                bits.leave(turn, &changes);
                for &(parameter, level) in &changes {
                    having.flip(index, parameter, rows[index][parameter]);
                    rows[index][parameter] = level;
                    having.flip(index, parameter, level);
                }
                let turn = Turn { families: &families, having: &having, index, row: &rows[index] };
                table.enter(turn, &changes);
                bits.enter(turn, &changes);
                assert_eq!(seen(&bits, count, parameters), seen(&table, count, parameters), "seed {seed}");
            }
            let turn = Turn { families: &families, having: &having, index: 0, row: &rows[0] };
            table.leave_all(turn);
            bits.leave_all(turn);
            assert_eq!(seen(&bits, count, parameters), seen(&table, count, parameters), "seed {seed}");
        }
    }
}
