//! Latin hypercubes (McKay, Beckman, Conover, Technometrics 21, 1979).
//!
//! If every axis is divided into n equal cells, n points have exactly one point in each cell of every axis. So each
//! single parameter is covered as evenly as n points can. The point is anywhere in its cell, or in the middle. The
//! set depends on its size: it is made as a whole, for the whole budget.

use super::Sequence;
use super::lhs_search::{Centered, Criterion, Maximin, improve};
use super::per_row::PerRow;
use super::per_row::RowSet;
use crate::strategy::{ANY, Descriptor, Look, MOST_COORDINATES, MarkShape, Method, MethodKind, Strategy};
use crate::{
    GeneratorError,
    deal::Deal,
    seeded::{Purpose, seeded},
};
use rand::{Rng, seq::SliceRandom};

impl Strategy {
    /// The strategy "lhs", which takes a random Latin hypercube with random points in its cells.
    pub const LHS: Self = Self::of(&Descriptor {
        name: "lhs",
        about: "Latin hypercube: covers each single parameter evenly, made for exactly the budget",
        dims: ANY,
        look: Look::filled(0x99_9999, MarkShape::Square),
        method: Method(MethodKind::Sets {
            plain: false,
            in_a_part: None,
            build: |dims, seed, deal| cells(Self::LHS, dims, seed, deal, Place::Random),
        }),
    });
}

impl Strategy {
    /// The strategy "lhs-centred", which takes a random Latin hypercube with points at the centres of its cells.
    pub const LHS_CENTRED: Self = Self::of(&Descriptor {
        name: "lhs-centred",
        about: "Latin hypercube with tests in the middle of their cells: no two tests are close on any axis",
        dims: ANY,
        look: Look::filled(0x99_9999, MarkShape::Diamond),
        method: Method(MethodKind::Sets {
            plain: false,
            in_a_part: None,
            build: |dims, seed, deal| cells(Self::LHS_CENTRED, dims, seed, deal, Place::Centre),
        }),
    });
}

impl Strategy {
    /// The strategy "lhs-maximin", which takes a Latin hypercube whose points are far apart.
    pub const LHS_MAXIMIN: Self = Self::of(&Descriptor {
        name: "lhs-maximin",
        about: "Latin hypercube after a search that moves points apart: no two tests are alike",
        dims: ANY,
        look: Look::hollow(0x99_9999, MarkShape::Square),
        method: Method(MethodKind::Sets {
            plain: false,
            in_a_part: Some(Self::LHS),
            build: |dims, seed, deal| improved::<Maximin>(Self::LHS_MAXIMIN, dims, seed, deal),
        }),
    });
}

impl Strategy {
    /// The strategy "lhs-discrepancy", which takes a Latin hypercube with a low centered discrepancy.
    pub const LHS_DISCREPANCY: Self = Self::of(&Descriptor {
        name: "lhs-discrepancy",
        about: "Latin hypercube after a search for a low centered discrepancy: even for means over the space",
        dims: ANY,
        look: Look::hollow(0x99_9999, MarkShape::Diamond),
        method: Method(MethodKind::Sets {
            plain: false,
            in_a_part: Some(Self::LHS),
            build: |dims, seed, deal| improved::<Centered>(Self::LHS_DISCREPANCY, dims, seed, deal),
        }),
    });
}

fn cells(
    strategy: Strategy,
    dims: usize,
    seed: Option<u64>,
    deal: Deal,
    place: Place,
) -> Result<Box<dyn Sequence>, GeneratorError> {
    Ok(Box::new(PerRow::new(deal, Lhs::new(strategy, dims, seed.unwrap_or(0), &deal, place)?)))
}

fn improved<C: Criterion>(
    strategy: Strategy,
    dims: usize,
    seed: Option<u64>,
    deal: Deal,
) -> Result<Box<dyn Sequence>, GeneratorError> {
    let seed = seed.unwrap_or(0);
    let mut lhs = Lhs::new(strategy, dims, seed, &deal, Place::Random)?;
    let rows = deal.rows.min(deal.budget);
    for (row, block) in lhs.coordinates.chunks_mut(deal.block as usize * dims).enumerate() {
        let row = row as u64;
        let size = deal.tests_of(row) as usize;
        improve::<C>(&mut block[..size * dims], dims, rows, &mut seeded(seed, Purpose::Swaps, deal.from + row));
    }
    Ok(Box::new(PerRow::new(deal, lhs)))
}

/// The place of a point in its cell of a Latin hypercube.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    Random,
    Centre,
}

/// The Latin hypercubes of all rows, one hypercube for each row.
struct Lhs {
    dims: usize,
    /// The number of points from the start of one hypercube to the start of the next.
    block: u64,
    /// The number of the first row.
    from: u64,
    coordinates: Vec<f64>,
}

impl Lhs {
    /// Makes Latin hypercubes of exactly the sizes that the rows need. A larger hypercube with a missing point would
    /// leave a cell of every axis empty.
    fn new(strategy: Strategy, dims: usize, seed: u64, deal: &Deal, place: Place) -> Result<Self, GeneratorError> {
        let points = deal.indices();
        if points.saturating_mul(dims as u64) > MOST_COORDINATES {
            return Err(GeneratorError::SetLimit { strategy: strategy.name(), points, dims });
        }
        let mut coordinates = vec![0.0; points as usize * dims];
        for (row, block) in coordinates.chunks_mut(deal.block as usize * dims).enumerate() {
            let mut rng = seeded(seed, Purpose::Cells, deal.from + row as u64);
            let size = deal.tests_of(row as u64);
            for axis in 0..dims {
                let mut cells: Vec<u64> = (0..size).collect();
                cells.shuffle(&mut rng);
                for (point, cell) in block.chunks_exact_mut(dims).zip(cells) {
                    point[axis] = match place {
                        Place::Random => inside(cell, size, rng.random()),
                        Place::Centre => (cell as f64 + 0.5) / size as f64,
                    };
                }
            }
        }
        Ok(Self { dims, block: deal.block, from: deal.from, coordinates })
    }
}

impl RowSet for Lhs {
    fn point(&self, row: u64, _size: u64, index: u64) -> Vec<f64> {
        let number = (row - self.from) * self.block + index;
        self.coordinates[number as usize * self.dims..][..self.dims].to_vec()
    }
}

/// A number strictly inside cell `cell` of `size` cells, `jitter / 2^32` of the way through the cell.
///
/// Only 24 bits of the jitter count, and half a step is added. The position is then exact, and at least 2^-25 of a
/// cell from the cell's ends. That is more than the division by at most 10^7 < 2^24 cells can round away.
fn inside(cell: u64, size: u64, jitter: u32) -> f64 {
    let within = (f64::from(jitter >> 8) + 0.5) / f64::from(1 << 24);
    (cell as f64 + within) / size as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_never_leaves_its_cell_however_large_the_jitter() {
        for size in [1, 3, 10, 49, 4_999_999, MOST_COORDINATES] {
            for cell in [0, size / 3, size / 2, size - 1] {
                for jitter in [0, u32::MAX] {
                    let x = inside(cell, size, jitter);
                    assert!(x < 1.0);
                    assert_eq!((x * size as f64).floor(), cell as f64);
                }
            }
        }
    }
}
