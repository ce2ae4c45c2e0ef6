//! Decides which discrete row, and which point of the sequence, each test gets.
//!
//! The paper's (k, ε)-coverage demands of *every* row that its own continuous points leave no hole larger than ε. To
//! deal out one sequence round-robin breaks that: every m-th index of a Halton sequence shares digits if m shares a
//! factor with a base, and so fills only part of the cube (6 rows, 500 tests: dispersion 0.67 in the worst row). A
//! contiguous stretch of a sequence is about as even as its beginning (0.060). Hence row r owns the block of indices
//! `[r * block, (r + 1) * block)`. Only the order of the tests goes round the rows, so that a campaign that is
//! stopped early has visited all rows.

/// The assignment of tests to rows and to indices of the sequence.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Deal {
    /// The number of rows of discrete values.
    pub(crate) rows: u64,
    /// The number of indices of the sequence that a row owns, which is the number of tests of the row with the most
    /// tests.
    pub(crate) block: u64,
    /// The number of tests of all rows.
    pub(crate) budget: u64,
    /// The number of the first row. Rows differ in their sets by their numbers.
    pub(crate) from: u64,
}

impl Deal {
    pub(crate) fn new(rows: u64, budget: u64) -> Self {
        Self { rows, block: budget.div_ceil(rows), budget, from: 0 }
    }

    /// Makes the deal of the one row of this number.
    pub(crate) fn of_row(row: u64, tests: u64) -> Self {
        Self { from: row, ..Self::new(1, tests) }
    }

    /// Returns the number of indices that the rows with at least one test own together.
    pub(crate) fn indices(&self) -> u64 {
        self.rows.min(self.budget).saturating_mul(self.block)
    }

    /// Returns the number of tests of a row.
    pub(crate) fn tests_of(&self, row: u64) -> u64 {
        self.budget / self.rows + u64::from(row < self.budget % self.rows)
    }

    /// Returns the row and the index of the sequence for a test.
    pub(crate) fn of(&self, test: u64) -> (u64, u64) {
        let row = test % self.rows;
        (row, row * self.block + test / self.rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_dealt_a_contiguous_block_that_no_other_row_touches() {
        for (rows, budget) in [(1, 5), (6, 500), (7, 7), (7, 3), (6, 12)] {
            let deal = Deal::new(rows, budget);
            for row in 0..rows {
                let indices: Vec<u64> =
                    (0..budget).map(|test| deal.of(test)).filter(|t| t.0 == row).map(|t| t.1).collect();
                let start = row * deal.block;
                assert_eq!(indices, (start..start + deal.tests_of(row)).collect::<Vec<_>>());
                assert!(deal.tests_of(row) <= deal.block);
                assert!(indices.iter().all(|&index| index < deal.indices()));
            }
        }
    }
}
