//! Rows of an array whose entries may still be open.

use paracosm_space::rules::Rules;

/// The mark of an open entry of a row, which no combination needs yet.
pub(super) const OPEN: u32 = u32::MAX;

/// The columns of a covering array, which are the parameters in descending order of their numbers of levels.
///
/// Later columns find the rows that the earlier columns need. If columns with many levels come first, these rows are
/// almost enough.
#[derive(Debug)]
pub(super) struct Columns<'r> {
    pub(super) rules: &'r Rules,
    /// The position of the parameter of each column.
    pub(super) order: Vec<usize>,
    /// The column of each parameter.
    column: Vec<usize>,
    /// The number of levels of each column.
    pub(super) levels: Vec<usize>,
}

impl<'r> Columns<'r> {
    pub(super) fn new(rules: &'r Rules) -> Self {
        let mut order: Vec<usize> = (0..rules.levels().len()).collect();
        order.sort_by_key(|&parameter| std::cmp::Reverse(rules.levels()[parameter]));
        let mut column = vec![0; order.len()];
        order.iter().enumerate().for_each(|(i, &parameter)| column[parameter] = i);
        let levels = order.iter().map(|&parameter| rules.levels()[parameter]).collect();
        Self { rules, order, column, levels }
    }

    pub(super) fn len(&self) -> usize {
        self.order.len()
    }

    pub(super) fn column(&self, parameter: usize) -> usize {
        self.column[parameter]
    }

    /// Returns the group of joined parameters that contains a column's parameter.
    pub(super) fn group(&self, column: usize) -> Option<usize> {
        self.rules.group_of(self.order[column])
    }

    /// The levels of a row's entries by parameter; `None` for an open entry.
    fn fixed<'a>(&'a self, row: &'a [u32]) -> impl Fn(usize) -> Option<usize> + 'a {
        |parameter| Some(row[self.column[parameter]]).filter(|&level| level != OPEN).map(|level| level as usize)
    }

    /// Returns `true` if the open entries of a group in a row can be filled so that the constraints hold.
    pub(super) fn holds(&self, group: usize, row: &[u32]) -> bool {
        self.rules.holds(group, self.fixed(row))
    }

    /// Returns the levels that an open entry of a row may get; `None` if the entry may get any level.
    pub(super) fn allowed(&self, column: usize, row: &[u32]) -> Option<Vec<bool>> {
        self.group(column)?;
        Some(self.rules.supported_at(self.order[column], self.fixed(row)))
    }

    /// Returns the levels of a complete row, in the order of the parameters.
    pub(super) fn test(&self, row: &[u32]) -> Vec<usize> {
        self.column.iter().map(|&column| row[column] as usize).collect()
    }
}

/// A list of rows of the same length, stored in one allocation.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    columns: usize,
    entries: Vec<u32>,
}

impl Rows {
    pub(super) fn new(columns: usize) -> Self {
        Self { columns, entries: Vec::new() }
    }

    pub(super) fn len(&self) -> usize {
        self.entries.len() / self.columns
    }

    pub(super) fn row(&self, index: usize) -> &[u32] {
        &self.entries[index * self.columns..(index + 1) * self.columns]
    }

    pub(super) fn row_mut(&mut self, index: usize) -> &mut [u32] {
        &mut self.entries[index * self.columns..(index + 1) * self.columns]
    }

    pub(super) fn push(&mut self, row: &[u32]) {
        self.entries.extend_from_slice(row);
    }
}
