//! The request for a generator: the space, the budget, the seed, and the demands on the tests.

use crate::{Aim, DiscreteFamily, Generator, GeneratorError};
use paracosm_coverage::Deadline;
use paracosm_space::{Point, Space};
use std::fmt;
use std::sync::Arc;

/// A request for a generator of tests, with the space, the budget, the seed and further options.
///
/// ```
/// # use paracosm_space::Space;
/// # use paracosm_generators::Request;
/// # let space = Space::unit_cube(2);
/// let request = Request { seed: Some(7), ..Request::new(&space, 500) };
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The space of the tests, which has the parameters to vary.
    pub space: &'a Space,
    /// The number of tests to generate, at least 1. Sets that depend on their size are made for this number. With an
    /// epsilon it is the greatest number of tests; `usize::MAX` sets no limit.
    pub budget: usize,
    /// The seed of all random numbers. `None` gives the plain set if the strategy has one (`halton sobol kronecker
    /// hammersley fibonacci lattice best`), and seed 0 for everything else, such as the copies of a plain set for further rows.
    pub seed: Option<u64>,
    /// The index, from 0, of the first point of the sequence that the tests use. `None` means 0, but 1 for `halton`,
    /// because point 0 of Halton is the corner of the cube.
    pub skip: Option<u64>,
    /// The method that makes the rows of discrete values, which together cover the discrete parameters.
    pub discrete: DiscreteFamily,
    /// The strength k, which is the number of parameters in a combination that the tests cover. A family of rows covers
    /// the discrete parameters; `greedy` covers all parameters if it aims at k-wise dispersion. `None` means 2, or the
    /// number of parameters if there are fewer. If there are fewer discrete parameters than k, all their combinations
    /// are covered.
    pub k: Option<usize>,
    /// The greatest allowed volume of an empty box among the tests of each row of the discrete family. As few tests as
    /// possible are added until this volume is reached. If the budget is too small, the tests are divided so that the
    /// largest empty box of any row is as small as possible. `None` gives every row an equal share of the budget.
    pub epsilon: Option<f64>,
    /// The deadline of the search for tests that reach epsilon. After the deadline the search ends with its best tests.
    pub deadline: Deadline,
    /// The measure that the strategy `greedy` makes small. `None` means the dispersion in a continuous space, and the
    /// k-wise dispersion if there are discrete parameters.
    pub aim: Option<Aim>,
    /// The existing tests that the new tests complete.
    pub existing: &'a [Point],
    /// The groups of discrete parameters that the family `ipog` covers with a strength above k. Each group has the
    /// positions of its parameters among the discrete parameters, and its strength.
    pub groups: &'a [(Vec<usize>, usize)],
    /// The strategy that the program brings, for [`Strategy::OWN`](crate::Strategy::OWN).
    pub own: Option<&'a OwnStrategy>,
    /// The rows of discrete values to use instead of the family's rows; `None` uses the family's rows.
    pub rows: Option<&'a [Vec<usize>]>,
}

impl<'a> Request<'a> {
    /// Makes a request for `budget` tests of `space`, with defaults for all further options.
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
            own: None,
            rows: None,
        }
    }
}

/// A function that makes the generator of a request.
type Make = dyn Fn(&Request) -> Result<Box<dyn Generator>, GeneratorError> + Send + Sync;

/// A strategy that a program brings: its name, and the function that makes its generator. A [`Request`] for the strategy
/// [`Strategy::OWN`](crate::Strategy::OWN) has it.
#[derive(Clone)]
pub struct OwnStrategy {
    name: String,
    /// `None` if a file names the strategy: the program has to give it again.
    make: Option<Arc<Make>>,
}

impl OwnStrategy {
    /// Makes a strategy of a function. The same request has to give a generator that proposes the same tests after the same results; otherwise
    /// a campaign cannot be continued.
    pub fn new(
        name: &str,
        make: impl Fn(&Request) -> Result<Box<dyn Generator>, GeneratorError> + Send + Sync + 'static,
    ) -> Self {
        Self { name: name.to_owned(), make: Some(Arc::new(make)) }
    }

    /// Returns the strategy that a file names, which can propose no tests.
    pub fn named(name: &str) -> Self {
        Self { name: name.to_owned(), make: None }
    }

    /// Returns the name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Builds the generator of a request.
    pub(crate) fn build(&self, request: &Request) -> Result<Box<dyn Generator>, GeneratorError> {
        let make = self.make.as_ref().ok_or_else(|| GeneratorError::OwnIsMissing { name: Some(self.name.clone()) })?;
        make(request)
    }
}

impl fmt::Debug for OwnStrategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("OwnStrategy").field(&self.name).finish()
    }
}

/// Two strategies with the same name are equal, because a file has only the name.
impl PartialEq for OwnStrategy {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}
