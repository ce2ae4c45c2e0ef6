//! The combinations with a level of the newest column that no row contains yet.
//!
//! While an array grows column by column, it needs to remember only the combinations of the newest column with
//! earlier columns. Of the other columns, the last t - 2 are the *head*, whose levels have a mixed-radix number. For
//! each head, level of the newest column and level of an earlier column there is a bit. Since the levels of all
//! earlier columns stand side by side, the combinations that a row would cover are counted a machine word at a time.

use super::rows::{Columns, OPEN};
use paracosm_coverage::Deadline;
use paracosm_space::rules::Companions;

/// A set of columns with a strength, so that all combinations of `strength` of the columns have to be covered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Family {
    /// The columns of the family, in ascending order.
    pub(super) members: Vec<usize>,
    pub(super) strength: usize,
}

/// The heads of one choice of columns.
#[derive(Debug)]
struct Block {
    /// The columns, in ascending order.
    head: Vec<usize>,
    /// The position of the block's bits, and the number of words that each head has for each level.
    begin: usize,
    words: usize,
    /// The number of combinations of the block that are left.
    left: u64,
}

impl Block {
    /// The number of a row's head; `None` if an entry of the head is open.
    #[inline(always)]
    fn at(&self, row: &[u32], columns: &Columns) -> Option<usize> {
        let mut head = 0;
        for &column in &self.head {
            if row[column] == OPEN {
                return None;
            }
            head = head * columns.levels[column] + row[column] as usize;
        }
        Some(head)
    }
}

/// The entries of a row before the newest column, as pairs of a word's position and the bits in the word.
pub(super) type Bits = Vec<(u32, u64)>;

/// The uncovered combinations of one family that contain a level of the newest column.
#[derive(Debug)]
pub(super) struct Front {
    column: usize,
    levels: usize,
    strength: usize,
    /// The other columns of the family before the newest column.
    others: Vec<usize>,
    first: Vec<usize>,
    blocks: Vec<Block>,
    /// For each block, head and word of bits, a word for each level.
    bits: Vec<u64>,
    /// The number of combinations that are left for each level.
    left: Vec<u64>,
}

impl Front {
    /// Makes the front of a family at a column of the family; `None` if too few columns come before this column. After
    /// the deadline the front is incomplete and must not be used.
    pub(super) fn new(
        columns: &Columns,
        companions: &mut Companions,
        family: &Family,
        column: usize,
        deadline: Deadline,
    ) -> Option<Self> {
        let others: Vec<usize> = family.members.iter().copied().filter(|&other| other < column).collect();
        if others.len() + 1 < family.strength {
            return None;
        }
        let first: Vec<usize> = columns.order.iter().map(|&parameter| companions.first(parameter)).collect();
        let levels = columns.levels[column];
        let strength = family.strength;
        let mut front = Self {
            column,
            levels,
            strength,
            others,
            first,
            blocks: Vec::new(),
            bits: Vec::new(),
            left: vec![0; levels],
        };
        let heads = if strength == 1 { vec![Vec::new()] } else { choices(&front.others, strength - 2) };
        for head in heads {
            if deadline.passed() {
                break;
            }
            front.open(columns, companions, head);
        }
        Some(front)
    }

    /// Adds the valid combinations of a head.
    fn open(&mut self, columns: &Columns, companions: &mut Companions, head: Vec<usize>) {
        // The bits are the columns before the head. Strength 1 has a single bit, which every row has.
        let mut mask = vec![1u64];
        if self.strength > 1 {
            let end = head.first().copied().unwrap_or(self.column);
            mask = vec![0; self.first[end].div_ceil(64)];
            for &other in self.others.iter().take_while(|&&other| other < end) {
                let bits = self.first[other]..self.first[other] + columns.levels[other];
                bits.for_each(|bit| mask[bit / 64] |= 1 << (bit % 64));
            }
        }
        if mask.iter().all(|&word| word == 0) {
            return;
        }
        let words = mask.len();
        let begin = self.bits.len();
        let mut block = Block { head, begin, words, left: 0 };
        let mut levels = vec![0; block.head.len()];
        let mut fixed: Vec<(usize, usize)> = block.head.iter().map(|&other| (columns.order[other], 0)).collect();
        fixed.push((columns.order[self.column], 0));
        loop {
            let at = self.bits.len();
            self.bits.resize(at + words * self.levels, 0);
            fixed.iter_mut().zip(&levels).for_each(|(fixed, &level)| fixed.1 = level);
            for level in 0..self.levels {
                fixed[levels.len()].1 = level;
                let valid = companions.with(&fixed).map(|bits| if self.strength == 1 { &[1] } else { bits });
                for (i, (mask, valid)) in valid.into_iter().flat_map(|valid| mask.iter().zip(valid)).enumerate() {
                    self.bits[at + i * self.levels + level] = mask & valid;
                    self.left[level] += u64::from((mask & valid).count_ones());
                    block.left += u64::from((mask & valid).count_ones());
                }
            }
            let more = (0..levels.len()).rev().find(|&i| levels[i] + 1 < columns.levels[block.head[i]]);
            let Some(i) = more else { break };
            levels[i] += 1;
            levels[i + 1..].fill(0);
        }
        self.blocks.push(block);
    }

    /// Returns the number of uncovered combinations with the given level of the newest column.
    pub(super) fn left_of(&self, level: usize) -> u64 {
        self.left[level]
    }

    /// Writes the entries of a row in the columns of the front into `bits`.
    #[inline(always)]
    pub(super) fn bits_of(&self, row: &[u32], bits: &mut Bits) {
        bits.clear();
        if self.strength == 1 {
            bits.push((0, 1));
            return;
        }
        for &other in self.others.iter().filter(|&&other| row[other] != OPEN) {
            let bit = self.first[other] + row[other] as usize;
            let (word, bit) = ((bit / 64) as u32, 1 << (bit % 64));
            match bits.last_mut() {
                Some(last) if last.0 == word => last.1 |= bit,
                _ => bits.push((word, bit)),
            }
        }
    }

    /// Adds the number of combinations that a row would cover with each level to `gains`.
    #[inline(always)]
    pub(super) fn gains(&self, columns: &Columns, row: &[u32], bits: &Bits, gains: &mut [u32]) {
        for block in self.blocks.iter().filter(|block| block.left > 0) {
            let Some(head) = block.at(row, columns) else { continue };
            let at = block.begin + head * block.words * self.levels;
            let here = &self.bits[at..at + block.words * self.levels];
            for &(word, bits) in bits.iter().take_while(|(word, _)| (*word as usize) < block.words) {
                let left = &here[word as usize * self.levels..][..self.levels];
                for (gain, left) in gains.iter_mut().zip(left) {
                    *gain += (left & bits).count_ones();
                }
            }
        }
    }

    /// Removes the combinations that a row covers with its level of the newest column.
    #[inline(always)]
    pub(super) fn cover(&mut self, columns: &Columns, row: &[u32], bits: &Bits) {
        let level = row[self.column] as usize;
        if self.left[level] == 0 {
            return;
        }
        for block in self.blocks.iter_mut().filter(|block| block.left > 0) {
            let Some(head) = block.at(row, columns) else { continue };
            let at = block.begin + head * block.words * self.levels;
            let here = &mut self.bits[at..at + block.words * self.levels];
            for &(word, bits) in bits.iter().take_while(|(word, _)| (*word as usize) < block.words) {
                let left = &mut here[word as usize * self.levels + level];
                let covered = u64::from((*left & bits).count_ones());
                *left &= !bits;
                block.left -= covered;
                self.left[level] -= covered;
            }
        }
    }

    /// Finds the first uncovered combination with a level, from a position on, and returns the position of the
    /// combination. Puts the entries of the combination before the newest column into `entries`.
    pub(super) fn next_left(
        &self,
        columns: &Columns,
        level: usize,
        from: Position,
        entries: &mut Vec<(usize, u32)>,
    ) -> Option<Position> {
        if self.left[level] == 0 {
            return None;
        }
        let mut position = from;
        while let Some(block) = self.blocks.get(position.block) {
            let end = self.blocks.get(position.block + 1).map_or(self.bits.len(), |block| block.begin);
            let words = (end - block.begin) / self.levels;
            if block.left > 0 {
                let found =
                    (position.word..words).find(|word| self.bits[block.begin + word * self.levels + level] != 0);
                if let Some(word) = found {
                    let bit = self.bits[block.begin + word * self.levels + level].trailing_zeros() as usize;
                    entries.clear();
                    let mut head = word / block.words;
                    for &column in block.head.iter().rev() {
                        entries.push((column, (head % columns.levels[column]) as u32));
                        head /= columns.levels[column];
                    }
                    if self.strength > 1 {
                        let bit = word % block.words * 64 + bit;
                        let other = self.others[self.others.partition_point(|&other| self.first[other] <= bit) - 1];
                        entries.push((other, (bit - self.first[other]) as u32));
                    }
                    return Some(Position { block: position.block, word });
                }
            }
            position = Position { block: position.block + 1, word: 0 };
        }
        None
    }
}

/// The position of an uncovered combination in a front.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Position {
    block: usize,
    word: usize,
}

/// Lists all choices of `k` of the columns, in lexicographic order.
pub(super) fn choices(columns: &[usize], k: usize) -> Vec<Vec<usize>> {
    match (k, columns) {
        (0, _) => vec![vec![]],
        (_, []) => vec![],
        (_, [first, rest @ ..]) => {
            let with = choices(rest, k - 1).into_iter().map(|tail| [&[*first], tail.as_slice()].concat());
            with.chain(choices(rest, k)).collect()
        }
    }
}
