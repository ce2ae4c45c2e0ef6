//! Orthogonal arrays, which contain every combination of t levels exactly once.
//!
//! The rows are the polynomials of degree below t over a finite field of q elements. The columns are the polynomials'
//! values at all points, and their highest coefficient: any t columns determine the polynomial (Bush, *Orthogonal
//! arrays of index unity*, Annals of Mathematical Statistics 23, 1952). If t is 3 and q is even, the middle
//! coefficient is another column.

use super::field::Field;
use super::rows::{Columns, OPEN, Rows};

/// The largest field that is tried.
const LARGEST_FIELD: usize = 64;

/// The greatest size of a useful orthogonal array, as a multiple of the rows that t columns need at least.
const MOST_TIMES: usize = 3;

/// An orthogonal array for the first columns, whose rows cover all combinations of any t of the first columns.
pub(super) struct Base {
    pub(super) rows: Rows,
    pub(super) columns: usize,
}

/// Lists the orthogonal arrays for the first columns, which have equally many levels. Each array has more of these
/// columns than the array before. An entry beyond the levels of its column is left open.
pub(super) fn bases(columns: &Columns, t: usize) -> Vec<Base> {
    let alike = |&column: &usize| columns.group(column).is_none() && columns.levels[column] == columns.levels[0];
    let free = (0..columns.len()).take_while(alike).count();
    if t < 2 || free <= t {
        return Vec::new();
    }
    let needed: usize = columns.levels[..t].iter().fold(1, |needed, &levels| needed.saturating_mul(levels));
    let mut bases = Vec::new();
    for field in (columns.levels[0].max(2)..=LARGEST_FIELD).filter_map(Field::new) {
        let q = field.order();
        let rows = (0..t).fold(1usize, |rows, _| rows.saturating_mul(q));
        if rows > needed.saturating_mul(MOST_TIMES) {
            break;
        }
        let width = if t == 3 && q.is_multiple_of(2) { q + 2 } else { q + 1 };
        let width = width.min(free);
        if width <= bases.last().map_or(t, |base: &Base| base.columns) {
            continue;
        }
        let mut base = Base { rows: Rows::new(columns.len()), columns: width };
        let mut entries = vec![OPEN; columns.len()];
        for polynomial in 0..rows {
            let coefficients: Vec<usize> =
                (0..t).scan(polynomial, |rest, _| Some(std::mem::replace(rest, *rest / q) % q)).collect();
            let value = |point: usize| coefficients.iter().rev().fold(0, |v, &c| field.sum(field.product(v, point), c));
            for (column, entry) in entries[..width].iter_mut().enumerate() {
                let level = match column.checked_sub(q) {
                    None => value(column),
                    Some(0) => coefficients[t - 1],
                    Some(_) => coefficients[1],
                };
                *entry = if level < columns.levels[column] { level as u32 } else { OPEN };
            }
            if entries.iter().filter(|entry| **entry != OPEN).count() >= t {
                base.rows.push(&entries);
            }
        }
        bases.push(base);
        if width == free {
            break;
        }
    }
    bases
}
