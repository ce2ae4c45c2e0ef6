//! A strategy is a descriptor: its name, what it is for, what it can do, and how a generator of it is built.
//!
//! Lists, help, figures and the conformance suite read the descriptors. A strategy is described in the file that implements
//! it, and named in the list of that file's folder ([`sequence`](crate::sequence), [`adaptive`](crate::adaptive)).

mod look;

pub use look::{Look, MarkShape};

use crate::Aim;
use crate::deal::Deal;
use crate::{Generator, GeneratorError, Request};
use paracosm_space::rules::Rules;
use std::fmt;
use std::ops::RangeInclusive;

/// How tests are chosen: a handle to the [`Descriptor`] of a strategy. Strategies of the same name are equal.
#[derive(Clone, Copy)]
pub struct Strategy(&'static Descriptor);

/// All that the software knows of a strategy.
#[derive(Debug)]
pub struct Descriptor {
    /// The name by which users ask for the strategy. No two strategies have the same name.
    pub name: &'static str,
    /// When to use the strategy, in one line.
    pub about: &'static str,
    /// How many continuous coordinates the strategy covers, if a space has any.
    pub dims: RangeInclusive<usize>,
    /// How curves of the strategy look in figures.
    pub look: Look,
    /// How the strategy makes tests.
    pub method: Method,
}

/// How a strategy makes tests.
#[derive(Debug, Clone, Copy)]
pub struct Method(pub(crate) MethodKind);

/// Any number of coordinates.
pub(crate) const ANY: RangeInclusive<usize> = 1..=usize::MAX;

/// Builds the sets of all rows: of so many dimensions, a seed, and how many tests each row is dealt.
pub(crate) type BuildSets = fn(usize, Option<u64>, Deal) -> Result<Box<dyn Sequence>, GeneratorError>;

/// Builds a generator that learns. The rules are those of the request's space.
pub(crate) type BuildSearch = fn(&Descriptor, &Request, Rules) -> Result<Box<dyn Generator>, GeneratorError>;

/// Builds a generator of one's own.
pub type BuildOwn = fn(&Request) -> Result<Box<dyn Generator>, GeneratorError>;

/// The kinds of methods.
#[derive(Debug, Clone, Copy)]
pub(crate) enum MethodKind {
    /// Points by their index.
    Sequence(Endless),
    /// Sets that are made for the number of tests that a row is dealt.
    Sets {
        /// Whether there is a set without chance.
        plain: bool,
        /// The sets of all rows, one after the other.
        build: BuildSets,
    },
    /// Points in the largest holes of the points that are there.
    Holes,
    /// Tests that follow the robustness of the tests so far.
    Search {
        /// Whether the search is after one failure, whatever it violates.
        seeks_a_failure: bool,
        /// The search as a generator.
        build: BuildSearch,
    },
    /// A generator that is not of this crate.
    Own(BuildOwn),
}

/// A sequence that goes on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Endless {
    /// The index of the first point where nothing is said; none of a sequence that has no order to skip in.
    pub first: Option<u64>,
    /// Whether there is a sequence without chance.
    pub plain: bool,
    /// Whether enough points leave no hole.
    pub fills: bool,
    /// The sequence of so many dimensions and a seed.
    pub build: fn(usize, Option<u64>) -> Box<dyn Sequence>,
}

/// Points of `[0,1)^d`, numbered from 0.
pub(crate) trait Sequence: Send + Sync {
    /// How many points there are.
    fn len(&self) -> u64;

    /// The point at `index`, which is below [`Sequence::len`].
    fn point(&self, index: u64) -> Vec<f64>;
}

impl Method {
    /// A generator of one's own, which counts as open loop. It closes the parameters of a request itself, the discrete ones
    /// included.
    pub const fn own(build: BuildOwn) -> Self {
        Self(MethodKind::Own(build))
    }
}

impl Strategy {
    /// The strategy of a descriptor.
    pub const fn of(descriptor: &'static Descriptor) -> Self {
        Self(descriptor)
    }

    /// The name by which users ask for it.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// When to use it, in one line.
    pub fn about(self) -> &'static str {
        self.0.about
    }

    /// How many continuous coordinates it can cover, if a space has any.
    pub fn dims(self) -> RangeInclusive<usize> {
        self.0.dims.clone()
    }

    /// How curves of it look in figures: the same in every figure.
    pub fn look(self) -> Look {
        self.0.look
    }

    /// Whether it has a plain set, which takes no chance: what a [`Request`] without a seed gives.
    pub fn has_plain_set(self) -> bool {
        matches!(self.kind(), MethodKind::Sequence(Endless { plain: true, .. }) | MethodKind::Sets { plain: true, .. })
    }

    /// Whether the tests of a request have rows of the discrete family; `greedy` may look at discrete and continuous
    /// parameters together instead, and adaptive strategies do.
    pub fn has_rows(self, request: &Request) -> bool {
        let &Request { space, k, aim, .. } = request;
        let (dims, parameters) = (space.dims(), space.levels().len());
        let default = if parameters == 0 { Aim::Dispersion } else { Aim::KwiseDispersion };
        // Of all parameters together, the k-wise dispersion is the dispersion.
        let is_dispersion = parameters == 0 && k.unwrap_or(2.min(dims)) == dims;
        match self.kind() {
            MethodKind::Sequence(_) | MethodKind::Sets { .. } => true,
            MethodKind::Holes => {
                dims == 0 || request.epsilon.is_some() || is_dispersion || aim.unwrap_or(default) == Aim::Dispersion
            }
            MethodKind::Search { .. } | MethodKind::Own(_) => false,
        }
    }

    /// Whether it learns from the robustness of the tests, and so has to be told how they went.
    pub fn is_adaptive(self) -> bool {
        matches!(self.kind(), MethodKind::Search { .. })
    }

    /// Whether it is after a failure, whatever it violates; an adaptive strategy that is not maps where tests fail.
    pub fn seeks_a_failure(self) -> bool {
        matches!(self.kind(), MethodKind::Search { seeks_a_failure: true, .. })
    }

    /// Whether it puts tests where the tests that are there leave the largest holes, and so extends them.
    pub fn fills_holes(self) -> bool {
        matches!(self.kind(), MethodKind::Holes)
    }

    /// The index of its first point where nothing is said; none where there is no sequence to skip in.
    pub fn first_index(self) -> Option<u64> {
        match self.kind() {
            MethodKind::Sequence(endless) => endless.first,
            _ => None,
        }
    }

    pub(crate) fn descriptor(self) -> &'static Descriptor {
        self.0
    }

    pub(crate) fn kind(self) -> MethodKind {
        self.0.method.0
    }

    /// The strategy as a sequence that goes on; none where it makes sets of their size, or looks at what is there.
    pub(crate) fn sequence(self, dims: usize, seed: Option<u64>) -> Option<Box<dyn Sequence>> {
        match self.kind() {
            MethodKind::Sequence(endless) => Some((endless.build)(dims, seed)),
            _ => None,
        }
    }

    /// Whether its points can be asked for one by one, without saying beforehand how many there will be, and leave no
    /// hole in the end.
    pub(crate) fn goes_on(self) -> bool {
        matches!(self.kind(), MethodKind::Sequence(Endless { fills: true, .. }) | MethodKind::Holes)
    }
}

impl PartialEq for Strategy {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for Strategy {}

impl fmt::Debug for Strategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Strategy").field(&self.name()).finish()
    }
}

impl fmt::Display for Strategy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
