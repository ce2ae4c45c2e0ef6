//! Bits that say which rows have which level, one for each row.

/// The rows that have each level of each parameter.
#[derive(Debug, Clone)]
pub(crate) struct Having {
    /// The number of words of 64 rows.
    words: usize,
    /// The number of half words of 32 rows.
    halves: usize,
    /// The position of the first level of each parameter among all levels.
    first: Vec<usize>,
    /// For each level, the rows that have it.
    rows: Vec<u64>,
    /// All rows of the search that may change.
    present: Vec<u64>,
}

impl Having {
    /// Makes the bits for a number of rows, none of which is present.
    pub(super) fn new(levels: &[usize], rows: usize) -> Self {
        let first = levels.iter().scan(0, |end, levels| {
            *end += levels;
            Some(*end - levels)
        });
        let (words, entries) = (rows.div_ceil(64), levels.iter().sum::<usize>());
        Self {
            words,
            halves: rows.div_ceil(32),
            first: first.collect(),
            rows: vec![0; words * entries],
            present: vec![0; words],
        }
    }

    /// Returns the number of words of 64 rows.
    pub(super) fn words(&self) -> usize {
        self.words
    }

    /// Returns the number of half words of 32 rows.
    pub(super) fn halves(&self) -> usize {
        self.halves
    }

    /// Returns the rows that have a level of a parameter.
    #[inline(always)]
    pub(super) fn rows(&self, parameter: usize, level: usize) -> &[u64] {
        &self.rows[(self.first[parameter] + level) * self.words..][..self.words]
    }

    /// Returns the rows that may change.
    pub(super) fn present(&self) -> &[u64] {
        &self.present
    }

    /// Notes that a row may change, or no longer may.
    pub(super) fn flip_present(&mut self, index: usize) {
        self.present[index / 64] ^= 1 << (index % 64);
    }

    /// Notes that a row gets a level, or no longer has it.
    pub(super) fn flip(&mut self, index: usize, parameter: usize, level: usize) {
        let entry = self.first[parameter] + level;
        self.rows[entry * self.words + index / 64] ^= 1 << (index % 64);
    }
}
