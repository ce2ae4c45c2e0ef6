//! What a generator is built for: the space, the budget, the seed, and what is asked of the tests.

use crate::{Aim, DiscreteFamily};
use paracosm_coverage::Deadline;
use paracosm_space::{Point, Space};

/// What a generator is built for.
///
/// ```
/// # use paracosm_space::Space;
/// # use paracosm_generators::Request;
/// # let space = Space::unit_cube(2);
/// let request = Request { seed: Some(7), ..Request::new(&space, 500) };
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The parameters to vary.
    pub space: &'a Space,
    /// How many tests are wanted, at least 1. Sets that depend on their size are made for it. With an epsilon it is the
    /// most there may be; `usize::MAX` is as many as it takes.
    pub budget: usize,
    /// The source of all chance. None is the plain set where a strategy has one (`halton sobol kronecker
    /// hammersley fibonacci`) and seed 0 in all else, such as the copies of a plain set for further rows.
    pub seed: Option<u64>,
    /// The index of a sequence's first point, from 0. None is 0, but 1 for `halton`: point 0
    /// of Halton is the corner of the cube.
    pub skip: Option<u64>,
    /// How discrete parameters are covered.
    pub discrete: DiscreteFamily,
    /// How many parameters are covered together: the discrete ones by a family of rows, all of them by `greedy` where
    /// it aims at k-wise dispersion. None is 2, or as many as there are; of fewer discrete ones than k all combinations
    /// are covered.
    pub k: Option<usize>,
    /// Go on until the points of every row of the discrete family leave no empty box above this volume, with as few
    /// tests as that takes; where the budget is too small, spread the tests so that the largest empty box of any row is
    /// as small as can be. None is equal shares of the budget.
    pub epsilon: Option<f64>,
    /// When the search for tests that reach epsilon ends, whatever it has found.
    pub deadline: Deadline,
    /// What `greedy` is to make small. None is the dispersion in a continuous space, and the k-wise dispersion where
    /// there are discrete parameters too.
    pub aim: Option<Aim>,
    /// Tests that are there already, which new ones complete.
    pub existing: &'a [Point],
    /// Groups of discrete parameters of which the family `ipog` covers more than k together: positions among the
    /// discrete parameters, and how many.
    pub groups: &'a [(Vec<usize>, usize)],
    /// Rows to use instead of the family's.
    pub rows: Option<&'a [Vec<usize>]>,
}

impl<'a> Request<'a> {
    /// `budget` tests of `space`, and the default for all else.
    pub fn new(space: &'a Space, budget: usize) -> Self {
        Self {
            space,
            budget,
            seed: None,
            skip: None,
            discrete: DiscreteFamily::default(),
            k: None,
            epsilon: None,
            deadline: Deadline::never(),
            aim: None,
            existing: &[],
            groups: &[],
            rows: None,
        }
    }
}
