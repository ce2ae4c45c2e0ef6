//! The strategies by name: the one list from which command lines, comparisons and the conformance suite read.

use crate::{
    DiscreteFamily, Generator, GeneratorError,
    deal::Deal,
    family::Family,
    mixed::Mixed,
    sequence::{Halton, Lhs, Sequence, Sobol, Uniform},
};
use paracosm_coverage::{Space, nearest};
use std::{fmt, str::FromStr};

/// How tests are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strategy {
    /// Independent uniformly random points.
    Random,
    /// The Halton sequence, the paper's choice.
    Halton,
    /// The Owen-scrambled Sobol sequence.
    Sobol,
    /// A random Latin hypercube.
    Lhs,
}

/// What a generator is built for.
///
/// ```
/// # use paracosm_coverage::Space;
/// # use paracosm_generators::Request;
/// # let space = Space::unit_cube(2);
/// let request = Request { seed: Some(7), ..Request::new(&space, 500) };
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The parameters to vary.
    pub space: &'a Space,
    /// How many tests are wanted, at least 1. Sets that depend on their size are made for it.
    pub budget: usize,
    /// The source of all chance. None is seed 0, except that Halton without a seed is not shifted.
    pub seed: Option<u64>,
    /// The index of a sequence's first point, from 0. None is 1 for Halton, whose point 0 is the corner of the
    /// cube, and 0 for Sobol.
    pub skip: Option<u64>,
    /// How discrete parameters are covered.
    pub discrete: DiscreteFamily,
    /// Of how many discrete parameters all combinations are covered. None is 2, or as many as there are.
    pub k: Option<usize>,
}

impl<'a> Request<'a> {
    /// `budget` tests of `space`, and the default for all else.
    pub fn new(space: &'a Space, budget: usize) -> Self {
        Self { space, budget, seed: None, skip: None, discrete: DiscreteFamily::default(), k: None }
    }
}

impl Strategy {
    /// All strategies.
    pub const ALL: [Self; 4] = [Self::Random, Self::Halton, Self::Sobol, Self::Lhs];

    /// The name by which users ask for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::Halton => "halton",
            Self::Sobol => "sobol",
            Self::Lhs => "lhs",
        }
    }

    /// When to use it, in one line.
    pub fn about(self) -> &'static str {
        match self {
            Self::Random => "independent uniform points: the baseline, and what statistics assume",
            Self::Halton => "low-dispersion sequence of any length: the default for up to about ten parameters",
            Self::Sobol => {
                "Owen-scrambled sequence for many parameters; best with a power of two, at most 65,536 tests"
            }
            Self::Lhs => "Latin hypercube: each parameter on its own covered evenly, by exactly the budget of tests",
        }
    }

    /// A generator of this strategy.
    ///
    /// In a space with discrete parameters it is exhausted after the budget, or without continuous ones after
    /// all rows of the family. In a continuous space a sequence goes on.
    ///
    /// # Errors
    /// The space is empty, the budget 0, `k` or `delta` out of range, the family too large, or the strategy
    /// cannot give that many points, in that many dimensions, or skip.
    pub fn build(self, request: &Request) -> Result<Box<dyn Generator>, GeneratorError> {
        let &Request { space, budget, seed, skip, discrete, k } = request;
        if space.parameters().is_empty() {
            return Err(GeneratorError::EmptySpace);
        }
        if budget == 0 {
            return Err(GeneratorError::NoBudget);
        }
        let first = match (self.first_index(), skip) {
            (None, Some(_)) => return Err(self.cannot_skip()),
            (default, skip) => skip.or(default).unwrap_or(0),
        };
        let seed_or_0 = seed.unwrap_or(0);
        let family = Family::new(space, discrete, k, seed_or_0)?;
        let dims = space.dims();
        if dims == 0 {
            return Ok(Box::new(Mixed::discrete(family)));
        }
        let deal = Deal::new(family.len(), budget as u64);
        let end = first.saturating_add(deal.indices());
        let sequence: Box<dyn Sequence> = match self {
            Self::Random => Box::new(Uniform::new(dims, seed_or_0)),
            Self::Halton => Box::new(Halton::new(dims, seed, end)?),
            Self::Sobol => Box::new(Sobol::new(dims, seed_or_0, end)?),
            Self::Lhs => Box::new(Lhs::new(dims, seed_or_0, &deal)?),
        };
        Ok(Box::new(Mixed::new(family, sequence, deal, first)))
    }

    /// Where a sequence starts by default; None for sets of points without an order.
    fn first_index(self) -> Option<u64> {
        match self {
            Self::Halton => Some(1),
            Self::Sobol => Some(0),
            Self::Random | Self::Lhs => None,
        }
    }

    fn cannot_skip(self) -> GeneratorError {
        let sequences = Self::ALL.into_iter().filter(|s| s.first_index().is_some()).map(Self::name);
        GeneratorError::NoSequence { strategy: self.name(), sequences: sequences.collect::<Vec<_>>().join(", ") }
    }
}

impl fmt::Display for Strategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Strategy {
    type Err = GeneratorError;

    fn from_str(name: &str) -> Result<Self, GeneratorError> {
        Self::ALL.into_iter().find(|strategy| strategy.name() == name).ok_or_else(|| GeneratorError::UnknownStrategy {
            name: name.to_owned(),
            nearest: nearest(name, Self::ALL.map(Self::name)),
        })
    }
}
