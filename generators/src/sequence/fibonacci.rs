//! The Fibonacci lattice, for two coordinates.
//!
//! Let f' < f be two consecutive Fibonacci numbers. Point i of f points is (i/f, i f'/f modulo 1). No set of f points
//! has a smaller dispersion on the torus, where boxes go on across the border (Breneis and Hinrichs, "Fibonacci
//! lattices have minimal dispersion on the two-dimensional torus", 2020).
//!
//! Users ask for n points, not for Fibonacci numbers. They get (i/n, i f'/f modulo 1), where f is the first Fibonacci
//! number that is at least n: the first n points of a lattice, widened to fill the cube. For n = f that is the
//! lattice itself. For other n there are exactly n points, about as even, because f'/f hardly differs from the golden
//! section.

use super::per_row::PerRow;
use super::{per_row::RowSet, radical::ratio, shift::Shift};
use crate::strategy::{Descriptor, Look, MarkShape, Method, MethodKind, Strategy};

impl Strategy {
    /// The strategy "fibonacci", which takes the Fibonacci lattice in two dimensions; a seed shifts the lattice.
    pub const FIBONACCI: Self = Self::of(&Descriptor {
        name: "fibonacci",
        about: "the most even lattice for exactly two parameters, made for exactly the budget",
        dims: 2..=2,
        look: Look::hollow(0x8c_510a, MarkShape::Tip),
        method: Method(MethodKind::Sets {
            plain: true,
            in_a_part: None,
            build: |_, seed, deal| Ok(Box::new(PerRow::new(deal, Fibonacci::new(seed)))),
        }),
    });
}

/// The Fibonacci lattice, with both axes shifted or unshifted.
pub(crate) struct Fibonacci {
    seed: Option<u64>,
}

impl Fibonacci {
    /// Makes the Fibonacci lattices of all rows. The lattice of the first row is unshifted without a seed; all other
    /// lattices are shifted.
    pub(crate) fn new(seed: Option<u64>) -> Self {
        Self { seed }
    }
}

impl RowSet for Fibonacci {
    fn point(&self, row: u64, size: u64, index: u64) -> Vec<f64> {
        let (before, number) = around(size);
        let (index, size) = (u128::from(index), u128::from(size));
        let point = [ratio(index, size), ratio(index * before % number, number)];
        Shift::of_row(2, self.seed, row).apply(point)
    }
}

/// The first Fibonacci number that is at least `size`, preceded by the Fibonacci number before it.
fn around(size: u64) -> (u128, u128) {
    let (mut before, mut number) = (1, 1);
    while number < u128::from(size) {
        (before, number) = (number, before + number);
    }
    (before, number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_meets_the_fibonacci_number_that_is_no_smaller() {
        assert_eq!([1, 2, 3, 4, 54, 55, 56].map(around).map(|pair| pair.1), [1, 2, 3, 5, 55, 55, 89]);
        assert_eq!(around(55), (34, 55));
    }
}
