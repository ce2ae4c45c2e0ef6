//! The request for a generator: the space, the budget, the seed, and the demands on the tests.

use crate::{Aim, DiscreteFamily};
use paracosm_coverage::Deadline;
use paracosm_space::{Point, Space};

/// A request for a generator.
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
    /// The number of tests, at least 1. Sets that depend on their size are made for this number. With an epsilon it
    /// is the greatest number of tests; `usize::MAX` sets no limit.
    pub budget: usize,
    /// The source of all chance. `None` gives the plain set if the strategy has one (`halton sobol kronecker
    /// hammersley fibonacci`), and seed 0 for everything else, such as the copies of a plain set for further rows.
    pub seed: Option<u64>,
    /// The index of a sequence's first point, from 0. `None` means 0, but 1 for `halton`, because point 0 of Halton
    /// is the corner of the cube.
    pub skip: Option<u64>,
    /// The method that covers the discrete parameters.
    pub discrete: DiscreteFamily,
    /// The number of parameters that are covered together. A family of rows covers the discrete parameters; `greedy`
    /// covers all parameters if it aims at k-wise dispersion. `None` means 2, or the number of parameters if there
    /// are fewer. If there are fewer discrete parameters than k, all their combinations are covered.
    pub k: Option<usize>,
    /// The volume of the largest empty box that the points of any row of the discrete family may leave. Tests are
    /// added until this is reached, as few as possible. If the budget is too small, the tests are divided so that the
    /// largest empty box of any row is as small as possible. `None` gives every row an equal share of the budget.
    pub epsilon: Option<f64>,
    /// The deadline of the search for tests that reach epsilon; the search then ends with what it has found.
    pub deadline: Deadline,
    /// The measure that `greedy` makes small. `None` means the dispersion in a continuous space, and the k-wise
    /// dispersion if there are discrete parameters.
    pub aim: Option<Aim>,
    /// Existing tests, which the new tests complete.
    pub existing: &'a [Point],
    /// The groups of discrete parameters that the family `ipog` covers with a strength above k, as positions among
    /// the discrete parameters and the strength.
    pub groups: &'a [(Vec<usize>, usize)],
    /// The rows to use instead of the family's rows.
    pub rows: Option<&'a [Vec<usize>]>,
}

impl<'a> Request<'a> {
    /// Makes a request for `budget` tests of `space`, with the default for everything else.
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
