//! Describes each strategy by a descriptor: its name, its use, its abilities, and how its generator is built.
//!
//! Lists, help, figures and the conformance suite read the descriptors. The file that implements a strategy describes
//! it, and the list of that file's folder names it ([`sequence`](crate::sequence), [`adaptive`](crate::adaptive)).

mod look;

pub use look::{Look, MarkShape};

use crate::Aim;
use crate::deal::Deal;
use crate::{Generator, GeneratorError, Request};
use paracosm_space::rules::Rules;
use std::fmt;
use std::ops::RangeInclusive;

/// A method that chooses tests, as a handle to the [`Descriptor`] of a strategy. Two strategies with the same name
/// are equal.
#[derive(Clone, Copy)]
pub struct Strategy(&'static Descriptor);

/// The description of a strategy.
#[derive(Debug)]
pub struct Descriptor {
    /// The name by which users ask for the strategy. No two strategies have the same name.
    pub name: &'static str,
    /// The use of the strategy, in one line.
    pub about: &'static str,
    /// The numbers of continuous coordinates that the strategy covers, if the space has continuous coordinates.
    pub dims: RangeInclusive<usize>,
    /// The look of the strategy's curves in figures.
    pub look: Look,
    /// The method that makes the tests.
    pub method: Method,
}

/// The method by which a strategy makes tests.
#[derive(Debug, Clone, Copy)]
pub struct Method(pub(crate) MethodKind);

/// Any number of coordinates, but at least one.
pub(crate) const ANY: RangeInclusive<usize> = 1..=usize::MAX;

/// Builds the sets of all rows from the number of dimensions, a seed, and the number of tests of each row.
pub(crate) type BuildSets = fn(usize, Option<u64>, Deal) -> Result<Box<dyn Sequence>, GeneratorError>;

/// Builds a generator that learns. `Rules` are the rules of the request's space.
pub(crate) type BuildSearch = fn(&Descriptor, &Request, Rules) -> Result<Box<dyn Generator>, GeneratorError>;

/// A function that builds a custom generator, which is not of this crate.
pub type BuildOwn = fn(&Request) -> Result<Box<dyn Generator>, GeneratorError>;

/// The kind of a method.
#[derive(Debug, Clone, Copy)]
pub(crate) enum MethodKind {
    /// A sequence, which computes each point from its index.
    Sequence(Endless),
    /// Sets that are made for the number of tests of a row.
    Sets {
        /// `true` if there is a set without chance.
        plain: bool,
        /// Builds the sets of all rows, one after the other.
        build: BuildSets,
    },
    /// Points in the largest holes between the existing points.
    Holes,
    /// Tests that follow the robustness of the tests so far.
    Search {
        /// `true` if the search looks for one failure of any requirement.
        seeks_a_failure: bool,
        /// Builds the search as a generator.
        build: BuildSearch,
    },
    /// A custom generator, which is not of this crate.
    Own(BuildOwn),
}

/// A sequence without a fixed end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Endless {
    /// The default index of the first point; `None` if the sequence has no order in which points can be skipped.
    pub first: Option<u64>,
    /// `true` if there is a sequence without chance.
    pub plain: bool,
    /// `true` if enough points leave no hole.
    pub fills: bool,
    /// Builds the sequence from the number of dimensions and a seed.
    pub build: fn(usize, Option<u64>) -> Box<dyn Sequence>,
}

/// Points of `[0,1)^d`, numbered from 0.
pub(crate) trait Sequence: Send + Sync {
    /// The number of points.
    fn len(&self) -> u64;

    /// The point at `index`, which is below [`Sequence::len`].
    fn point(&self, index: u64) -> Vec<f64>;
}

impl Method {
    /// Makes the method of a custom generator, which counts as open loop. The generator must handle all parameters of
    /// a request itself, including the discrete ones.
    pub const fn own(build: BuildOwn) -> Self {
        Self(MethodKind::Own(build))
    }
}

impl Strategy {
    /// Makes the strategy of a descriptor.
    pub const fn of(descriptor: &'static Descriptor) -> Self {
        Self(descriptor)
    }

    /// Returns the name by which users ask for the strategy.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Returns one line about when to use the strategy.
    pub fn about(self) -> &'static str {
        self.0.about
    }

    /// Returns the numbers of continuous coordinates that the strategy covers, if a space has continuous coordinates.
    pub fn dims(self) -> RangeInclusive<usize> {
        self.0.dims.clone()
    }

    /// Returns the look of the strategy's curves, which is the same in every figure.
    pub fn look(self) -> Look {
        self.0.look
    }

    /// Returns `true` if the strategy has a plain set without chance, which a [`Request`] without a seed gives.
    pub fn has_plain_set(self) -> bool {
        matches!(self.kind(), MethodKind::Sequence(Endless { plain: true, .. }) | MethodKind::Sets { plain: true, .. })
    }

    /// Returns `true` if the tests of a request have rows of the discrete family. Adaptive strategies have none, and
    /// `greedy` may treat discrete and continuous parameters together instead.
    pub fn has_rows(self, request: &Request) -> bool {
        let &Request { space, k, aim, .. } = request;
        let (dims, parameters) = (space.dims(), space.levels().len());
        let default = if parameters == 0 { Aim::Dispersion } else { Aim::KwiseDispersion };
        // For all parameters together, the k-wise dispersion is the dispersion.
        let is_dispersion = parameters == 0 && k.unwrap_or(2.min(dims)) == dims;
        match self.kind() {
            MethodKind::Sequence(_) | MethodKind::Sets { .. } => true,
            MethodKind::Holes => {
                dims == 0 || request.epsilon.is_some() || is_dispersion || aim.unwrap_or(default) == Aim::Dispersion
            }
            MethodKind::Search { .. } | MethodKind::Own(_) => false,
        }
    }

    /// Returns `true` if the strategy learns from the robustness of the tests, so that it must be told the results.
    pub fn is_adaptive(self) -> bool {
        matches!(self.kind(), MethodKind::Search { .. })
    }

    /// Returns `true` if the strategy looks for a failure of any requirement. Other adaptive strategies map where
    /// tests fail.
    pub fn seeks_a_failure(self) -> bool {
        matches!(self.kind(), MethodKind::Search { seeks_a_failure: true, .. })
    }

    /// Returns `true` if the strategy puts tests into the largest holes of the existing tests, and so extends them.
    pub fn fills_holes(self) -> bool {
        matches!(self.kind(), MethodKind::Holes)
    }

    /// Returns the default index of the strategy's first point; `None` if it has no sequence in which points can be
    /// skipped.
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

    /// The strategy as a sequence without a fixed end; `None` if it makes sets of a given size or looks at existing
    /// tests.
    pub(crate) fn sequence(self, dims: usize, seed: Option<u64>) -> Option<Box<dyn Sequence>> {
        match self.kind() {
            MethodKind::Sequence(endless) => Some((endless.build)(dims, seed)),
            _ => None,
        }
    }

    /// Returns `true` if the points can be asked for one by one, without a number known beforehand, and leave no hole
    /// in the end.
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
