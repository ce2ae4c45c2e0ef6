//! The open-loop generator: the discrete rows joined with the continuous points.
//!
//! A test is computed from its number alone, by [`Deal`]. The generator only remembers the number of the next test.

use crate::{Generator, deal::Deal, family::Family, sequence::Sequence};
use paracosm_space::Point;

/// The open-loop generator, which joins the rows of a family with the points of a sequence.
pub(crate) struct Mixed {
    family: Family,
    /// The sequence of points; `None` in a space without continuous parameters.
    sequence: Option<Box<dyn Sequence>>,
    deal: Deal,
    /// The index of the sequence's first point.
    first: u64,
    /// The next test.
    next: u64,
    /// The number after that of the last test.
    end: u64,
}

impl Mixed {
    /// Makes a generator that gives every row its own block of the sequence, from index `first` on.
    ///
    /// With a single row the sequence goes on beyond the budget, as far as it reaches. With several rows the blocks
    /// cannot grow.
    pub(crate) fn new(family: Family, sequence: Box<dyn Sequence>, deal: Deal, first: u64) -> Self {
        let end = if deal.rows == 1 { sequence.len() - first } else { deal.budget };
        Self { family, sequence: Some(sequence), deal, first, next: 0, end }
    }

    /// Makes a generator of the rows of the family without continuous points; the family may be empty.
    pub(crate) fn discrete(family: Family) -> Self {
        let end = family.len();
        Self { deal: Deal::new(end.max(1), end), family, sequence: None, first: 0, next: 0, end }
    }

    fn test(&self, number: u64) -> Point {
        let (row, index) = self.deal.of(number);
        let continuous = self.sequence.as_ref().map(|sequence| sequence.point(self.first + index));
        Point { continuous: continuous.unwrap_or_default(), discrete: self.family.row(row) }
    }
}

impl Generator for Mixed {
    fn ask(&mut self, n: usize) -> Vec<Point> {
        let from = self.next;
        self.next = self.end.min(from.saturating_add(n as u64));
        (from..self.next).map(|number| self.test(number)).collect()
    }
}
