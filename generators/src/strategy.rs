//! The strategies by name: the one list from which command lines, comparisons and the conformance suite read.

use crate::{
    Generator, GeneratorError, Request,
    adaptive::Adaptive,
    deal::Deal,
    existing::check_existing,
    family::Family,
    greedy::{Aim, GreedyRows, KwiseGreedy},
    mixed::Mixed,
    seeded::{Purpose, seeded},
    sequence::{
        Fibonacci, Halton, HaltonScrambled, Hammersley, Kronecker, Lhs, MOST_HALTON_SCRAMBLED_DIMS, MOST_SOBOL_DIMS,
        PerRow, Place, RandomCorners, Sequence, Sobol, Uniform,
    },
    spread::Spread,
};
use paracosm_coverage::nearest;
use std::{fmt, ops::RangeInclusive, str::FromStr};

/// In how many dimensions greedy points take seconds at most.
const MOST_GREEDY_DIMS: usize = 1_000;

/// How tests are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Strategy {
    /// Independent uniformly random points.
    Random,
    /// Independent random corners of the cube, which repeat: a control.
    RandomCorners,
    /// The Halton sequence, the paper's choice; with a seed the shifted one.
    Halton,
    /// The Halton sequence, shifted modulo 1 by a random vector.
    HaltonShifted,
    /// The Halton sequence with random permutations of its digits.
    HaltonScrambled,
    /// The Sobol sequence; with a seed digitally shifted.
    Sobol,
    /// The Sobol sequence with Owen's nested uniform scrambling.
    SobolOwen,
    /// The R-sequence, a Kronecker sequence; with a seed from a random point.
    Kronecker,
    /// The Hammersley set; with a seed shifted.
    Hammersley,
    /// The Fibonacci lattice in two dimensions; with a seed shifted.
    Fibonacci,
    /// Every point where it breaks the largest empty boxes.
    Greedy,
    /// A random Latin hypercube.
    Lhs,
    /// A Latin hypercube of points at the centres of their cells.
    LhsCentred,
    /// Simulated annealing on the robustness.
    Anneal,
    /// Particle swarms on the robustness.
    Pso,
    /// Nelder and Mead's simplices on the robustness.
    NelderMead,
    /// CMA-ES with restarts (BIPOP) on the robustness.
    Cmaes,
    /// CMA-ES whose samples a Gaussian process chooses from.
    GpCmaes,
    /// Bayesian optimisation of the robustness in a trust region.
    Bayes,
    /// The boundary between passing and failing, by a Gaussian process.
    Boundary,
    /// Several of these side by side: what to use where nothing is known.
    Auto,
}

impl Strategy {
    /// All strategies.
    pub const ALL: [Self; 21] = [
        Self::Random,
        Self::RandomCorners,
        Self::Halton,
        Self::HaltonShifted,
        Self::HaltonScrambled,
        Self::Sobol,
        Self::SobolOwen,
        Self::Kronecker,
        Self::Hammersley,
        Self::Fibonacci,
        Self::Greedy,
        Self::Lhs,
        Self::LhsCentred,
        Self::Anneal,
        Self::Pso,
        Self::NelderMead,
        Self::Cmaes,
        Self::GpCmaes,
        Self::Bayes,
        Self::Boundary,
        Self::Auto,
    ];

    /// The name by which users ask for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::RandomCorners => "random-corners",
            Self::Halton => "halton",
            Self::HaltonShifted => "halton-shifted",
            Self::HaltonScrambled => "halton-scrambled",
            Self::Sobol => "sobol",
            Self::SobolOwen => "sobol-owen",
            Self::Kronecker => "kronecker",
            Self::Hammersley => "hammersley",
            Self::Fibonacci => "fibonacci",
            Self::Greedy => "greedy",
            Self::Lhs => "lhs",
            Self::LhsCentred => "lhs-centred",
            Self::Anneal => "anneal",
            Self::Pso => "pso",
            Self::NelderMead => "nelder-mead",
            Self::Cmaes => "cmaes",
            Self::GpCmaes => "gp-cmaes",
            Self::Bayes => "bayes",
            Self::Boundary => "boundary",
            Self::Auto => "auto",
        }
    }

    /// When to use it, in one line.
    pub fn about(self) -> &'static str {
        match self {
            Self::Random => "independent uniform points: the baseline, and what statistics assume",
            Self::RandomCorners => {
                "every parameter at a random end: the control that a search for failures should beat"
            }
            Self::Halton => "low-dispersion sequence of any length: the default for up to about ten parameters",
            Self::HaltonShifted => "halton moved by a random vector: repetitions that are as even as halton",
            Self::HaltonScrambled => "halton with random digits: without its stripes in ten parameters and more",
            Self::Sobol => "digital sequence for many parameters; best with a power of two of tests",
            Self::SobolOwen => "sobol with Owen's nested scrambling: repetitions that are as even as sobol",
            Self::Kronecker => "golden steps on every axis: a sequence of any length, for few parameters",
            Self::Hammersley => "halton with one axis evenly spaced: more even than halton, by exactly the budget",
            Self::Fibonacci => "the most even lattice for just two parameters, by exactly the budget of tests",
            Self::Greedy => "every test into the largest holes: the lowest dispersion, at some milliseconds a test",
            Self::Lhs => "Latin hypercube: each parameter on its own covered evenly, by exactly the budget of tests",
            Self::LhsCentred => "Latin hypercube with tests in the middle of their cells: no two close on any axis",
            Self::Anneal => "random walks towards failures, uphill now and then: rough robustness, cheap tests",
            Self::Pso => "swarms drawn to the worst tests so far: rough robustness, many tests at a time",
            Self::NelderMead => "simplices downhill to a failure: few parameters and a robustness that slopes",
            Self::Cmaes => "a distribution that learns where failures lie: hundreds of tests, narrow valleys",
            Self::GpCmaes => {
                "cmaes with a model that chooses from its samples: the fewest tests to a failure nearly everywhere"
            }
            Self::Bayes => "a model of the robustness says which test is likely to fail: few, costly tests",
            Self::Boundary => "a model says where passing turns into failing: maps the border instead of one failure",
            Self::Auto => {
                "gp-cmaes, bayes and nelder-mead side by side, learning from each other: where nothing is known"
            }
        }
    }

    /// How many continuous coordinates it can cover, if a space has any.
    pub fn dims(self) -> RangeInclusive<usize> {
        match self {
            Self::HaltonScrambled => 1..=MOST_HALTON_SCRAMBLED_DIMS,
            Self::Sobol | Self::SobolOwen => 1..=MOST_SOBOL_DIMS,
            Self::Fibonacci => 2..=2,
            // A box has 2d parts with 2d faces each.
            Self::Greedy => 1..=MOST_GREEDY_DIMS,
            _ => 1..=usize::MAX,
        }
    }

    /// Whether it has a plain set, which takes no chance: what a [`Request`] without a seed gives.
    pub fn has_plain_set(self) -> bool {
        matches!(self, Self::Halton | Self::Sobol | Self::Kronecker | Self::Hammersley | Self::Fibonacci)
    }

    /// Whether the tests of a request have rows of the discrete family; `greedy` may look at discrete and continuous
    /// parameters together instead, and adaptive strategies do.
    pub fn has_rows(self, request: &Request) -> bool {
        let &Request { space, k, aim, .. } = request;
        let (dims, parameters) = (space.dims(), space.levels().len());
        let default = if parameters == 0 { Aim::Dispersion } else { Aim::KwiseDispersion };
        // Of all parameters together, the k-wise dispersion is the dispersion.
        let is_dispersion = parameters == 0 && k.unwrap_or(2.min(dims)) == dims;
        let greedy_has =
            || dims == 0 || request.epsilon.is_some() || is_dispersion || aim.unwrap_or(default) == Aim::Dispersion;
        !self.is_adaptive() && (self != Self::Greedy || greedy_has())
    }

    /// Whether it learns from the robustness of the tests, and so has to be told how they went.
    pub fn is_adaptive(self) -> bool {
        matches!(
            self,
            Self::Anneal
                | Self::Pso
                | Self::NelderMead
                | Self::Cmaes
                | Self::GpCmaes
                | Self::Bayes
                | Self::Boundary
                | Self::Auto
        )
    }

    /// Whether it is after a failure, whatever it violates; an adaptive strategy that is not maps where tests fail.
    pub fn seeks_a_failure(self) -> bool {
        self.is_adaptive() && self != Self::Boundary
    }

    /// A generator of this strategy.
    ///
    /// In a space with discrete parameters it is exhausted after the budget, or without continuous ones after
    /// all rows of the family. In a continuous space a sequence goes on. An adaptive strategy goes on in every space, in
    /// one without continuous parameters until every row that the constraints allow has been tested; the family's rows
    /// are those that it begins with.
    ///
    /// # Errors
    /// The space is empty, the budget 0, `k` or `delta` out of range, the family too large, an existing test none of
    /// the space, or the strategy cannot give that many points, in that many dimensions, skip, extend, or aim.
    pub fn build(self, request: &Request) -> Result<Box<dyn Generator>, GeneratorError> {
        let &Request { space, budget, seed, skip, k, aim, existing, .. } = request;
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
        if aim.is_some() && self != Self::Greedy {
            return Err(GeneratorError::NoAim { strategy: self.name() });
        }
        let seed_or_0 = seed.unwrap_or(0);
        let dims = space.dims();
        let rules = space.rules()?;
        check_existing(space, existing)?;
        if self.is_adaptive() {
            return Ok(Box::new(Adaptive::new(self, request, rules)?));
        }
        if !self.has_rows(request) {
            let k = k.unwrap_or(2.min(dims + rules.levels().len()));
            let rng = seeded(seed_or_0, Purpose::Greedy, 0);
            return Ok(Box::new(KwiseGreedy::new(dims, &rules, k, rng, existing)?));
        }
        let family = Family::new(&rules, request)?;
        if dims == 0 {
            // Once each: repeating a row would be the same test again.
            return Ok(Box::new(Mixed::discrete(family.without(existing))));
        }
        if !self.dims().contains(&dims) {
            return Err(self.cannot_cover(dims));
        }
        if let Some(epsilon) = request.epsilon {
            return Ok(Box::new(Spread::new(self, request, &family.without(&[]), first, epsilon)?));
        }
        if self != Self::Greedy && !existing.is_empty() {
            return Err(GeneratorError::NoExtension { strategy: self.name() });
        }
        let deal = Deal::new(family.len(), budget as u64);
        let sequence: Box<dyn Sequence> = match self {
            Self::Hammersley => Box::new(PerRow::new(deal, Hammersley::new(dims, seed))),
            Self::Fibonacci => Box::new(PerRow::new(deal, Fibonacci::new(seed))),
            Self::Greedy => {
                Box::new(PerRow::new(deal, GreedyRows::new(dims, seed_or_0, family.points_of_rows(existing))))
            }
            Self::Lhs => Box::new(PerRow::new(deal, Lhs::new(dims, seed_or_0, &deal, Place::Random)?)),
            Self::LhsCentred => Box::new(PerRow::new(deal, Lhs::new(dims, seed_or_0, &deal, Place::Centre)?)),
            _ => self.sequence(dims, seed).expect("adaptive strategies were built above"),
        };
        let (end, len) = (first.saturating_add(deal.indices()), sequence.len());
        if end > len {
            return Err(GeneratorError::IndexLimit { strategy: self.name(), len, last: end - 1 });
        }
        Ok(Box::new(Mixed::new(family, sequence, deal, first)))
    }

    /// The strategy as a sequence that goes on; none where it makes sets of their size, or looks at what is there.
    pub(crate) fn sequence(self, dims: usize, seed: Option<u64>) -> Option<Box<dyn Sequence>> {
        let seed_or_0 = seed.unwrap_or(0);
        Some(match self {
            Self::Random => Box::new(Uniform::new(dims, seed_or_0)),
            Self::RandomCorners => Box::new(RandomCorners::new(dims, seed_or_0)),
            Self::Halton => Box::new(Halton::new(dims, seed)),
            Self::HaltonShifted => Box::new(Halton::new(dims, Some(seed_or_0))),
            Self::HaltonScrambled => Box::new(HaltonScrambled::new(dims, seed_or_0)),
            Self::Sobol => Box::new(Sobol::new(dims, seed)),
            Self::SobolOwen => Box::new(Sobol::owen(dims, seed_or_0)),
            Self::Kronecker => Box::new(Kronecker::new(dims, seed)),
            _ => return None,
        })
    }

    /// Whether its points can be asked for one by one, without saying beforehand how many there will be, and leave no
    /// hole in the end.
    pub(crate) fn goes_on(self) -> bool {
        let fills = self != Self::RandomCorners;
        fills
            && !self.is_adaptive()
            && !matches!(self, Self::Hammersley | Self::Fibonacci | Self::Lhs | Self::LhsCentred)
    }

    /// Where a sequence starts by default; None for sets of points without an order.
    fn first_index(self) -> Option<u64> {
        match self {
            Self::Halton | Self::HaltonShifted => Some(1),
            Self::HaltonScrambled | Self::Sobol | Self::SobolOwen | Self::Kronecker => Some(0),
            _ => None,
        }
    }

    fn cannot_cover(self, dims: usize) -> GeneratorError {
        let (least, most) = self.dims().into_inner();
        let made_for = if least == most { format!("exactly {most}") } else { format!("at most {most}") };
        // Whatever has such a limit, an alternative is needed in few dimensions, in many, or in very many.
        let instead = match dims {
            ..10 => Self::Kronecker,
            10..=MOST_SOBOL_DIMS => Self::SobolOwen,
            _ => Self::Halton,
        };
        GeneratorError::Dimensions { strategy: self.name(), made_for, dims, instead: instead.name() }
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
