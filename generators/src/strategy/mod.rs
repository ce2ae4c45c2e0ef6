//! Describes each strategy by a descriptor: its name, its use, its abilities, and how its generator is built.
//!
//! Lists, help, figures and the conformance suite read the descriptors. The file that implements a strategy describes
//! it, and the list of that file's folder names it ([`sequence`](crate::sequence), [`adaptive`](crate::adaptive)).

mod look;

pub use look::{Look, MarkShape};

use crate::Aim;
use crate::deal::Deal;
use crate::point_sets::PointSets;
use crate::{Generator, GeneratorError, Request};
use paracosm_coverage::PointSetError;
use paracosm_coverage::empty_boxes::EmptyBoxes;
use paracosm_space::rules::Rules;
use std::fmt;
use std::ops::RangeInclusive;

/// A strategy that chooses tests, as a handle to the strategy's [`Descriptor`]. Two strategies with the same name are
/// equal.
#[derive(Clone, Copy)]
pub struct Strategy(&'static Descriptor);

/// The description of a strategy, with the name, the use, the abilities, the look and the method of the strategy.
#[derive(Debug)]
pub struct Descriptor {
    /// The name by which users ask for the strategy. No two strategies have the same name.
    pub name: &'static str,
    /// The use of the strategy, described in one line.
    pub about: &'static str,
    /// The range of the number of continuous coordinates that the strategy can cover. It does not count if the space
    /// has no continuous coordinates.
    pub dims: RangeInclusive<usize>,
    /// The look of the strategy's curves in figures.
    pub look: Look,
    /// The method by which the strategy makes tests.
    pub method: Method,
}

/// The method by which a strategy makes tests, such as a sequence, a search, or a generator of another crate.
#[derive(Debug, Clone, Copy)]
pub struct Method(pub(crate) MethodKind);

/// The range of all numbers of coordinates, from one coordinate on.
pub(crate) const ANY: RangeInclusive<usize> = 1..=usize::MAX;

/// The most coordinates of a set that is made as a whole.
pub(crate) const MOST_COORDINATES: u64 = 10_000_000;

/// A function that builds the sets of all rows from the number of dimensions, a seed, and the number of tests of each
/// row.
pub(crate) type BuildSets = fn(usize, Option<u64>, Deal) -> Result<Box<dyn Sequence>, GeneratorError>;

/// A function that makes the empty boxes without points, from the number of dimensions and the greatest number of boxes.
pub(crate) type MakeBoxes = fn(usize, usize) -> Result<EmptyBoxes, PointSetError>;

/// A function that builds a generator that learns from results. `Rules` are the rules of the request's space.
pub(crate) type BuildSearch = fn(&Descriptor, &Request, Rules) -> Result<Box<dyn Generator>, GeneratorError>;

/// A function that builds a custom generator of another crate from a request.
pub type BuildOwn = fn(&Request) -> Result<Box<dyn Generator>, GeneratorError>;

/// The kind of a method by which a strategy makes tests.
#[derive(Debug, Clone, Copy)]
pub(crate) enum MethodKind {
    /// The method is a sequence, which computes each point from its index.
    Sequence(Endless),
    /// The method makes a set of points for each row, with as many points as the row has tests.
    Sets {
        /// `true` if the method makes a set without random numbers when there is no seed.
        plain: bool,
        /// The function that builds the sets of all rows, one set after the other.
        build: BuildSets,
        /// The strategy that takes the place of this one if constraints leave a part of the space, because its sets are made for the whole space alone and take long.
        in_a_part: Option<Strategy>,
    },
    /// The method puts points into the largest holes between the existing points. The function makes the kind of holes
    /// that count.
    Holes(MakeBoxes),
    /// The method is a search, which follows the robustness of the tests so far.
    Search {
        /// `true` if the search looks for a single failure of any requirement.
        seeks_a_failure: bool,
        /// The function that builds the search as a generator.
        build: BuildSearch,
    },
    /// The method is a custom generator of another crate.
    Own(BuildOwn),
    /// The method hands out sets that another program has made.
    Given(&'static PointSets),
}

/// The description of a sequence of points without a fixed end.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Endless {
    /// The default index of the first point of the sequence; `None` if the points of the sequence cannot be skipped.
    pub first: Option<u64>,
    /// `true` if the sequence uses no random numbers when there is no seed.
    pub plain: bool,
    /// `true` if every hole between points shrinks to nothing as the number of points grows.
    pub fills: bool,
    /// The function that builds the sequence from the number of dimensions and a seed.
    pub build: fn(usize, Option<u64>) -> Box<dyn Sequence>,
}

/// A sequence of points of `[0,1)^d`, numbered from 0.
pub(crate) trait Sequence: Send + Sync {
    /// Returns the number of points of the sequence.
    fn len(&self) -> u64;

    /// Returns the point at `index`, which must be below [`Sequence::len`].
    fn point(&self, index: u64) -> Vec<f64>;
}

impl Method {
    /// Makes a method from a function that builds a custom generator, which counts as not adaptive. The generator must
    /// handle all parameters of a request itself, including the discrete ones.
    pub const fn own(build: BuildOwn) -> Self {
        Self(MethodKind::Own(build))
    }
}

impl Strategy {
    /// Makes a strategy from its descriptor.
    pub const fn of(descriptor: &'static Descriptor) -> Self {
        Self(descriptor)
    }

    /// Returns the name by which users ask for the strategy.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Returns a line of text about the use of the strategy.
    pub fn about(self) -> &'static str {
        self.0.about
    }

    /// Returns the range of the number of continuous coordinates that the strategy can cover. It does not count if a
    /// space has no continuous coordinates.
    pub fn dims(self) -> RangeInclusive<usize> {
        self.0.dims.clone()
    }

    /// Returns the look of the strategy's curves in figures, which is the same in every figure.
    pub fn look(self) -> Look {
        self.0.look
    }

    /// Returns `true` if the strategy uses no random numbers for a [`Request`] without a seed.
    pub fn has_plain_set(self) -> bool {
        matches!(self.kind(), MethodKind::Sequence(Endless { plain: true, .. }) | MethodKind::Sets { plain: true, .. })
    }

    /// Returns `true` if the strategy takes the discrete values of its tests from the rows of the discrete family.
    /// Adaptive strategies do not, and `greedy` may treat discrete and continuous parameters together instead.
    pub fn has_rows(self, request: &Request) -> bool {
        let &Request { space, k, aim, .. } = request;
        let (dims, parameters) = (space.dims(), space.levels().len());
        let default = if parameters == 0 { Aim::Dispersion } else { Aim::KwiseDispersion };
        // For all parameters together, the k-wise dispersion is the dispersion.
        let is_dispersion = parameters == 0 && k.unwrap_or(2.min(dims)) == dims;
        match self.kind() {
            MethodKind::Sequence(_) | MethodKind::Sets { .. } => true,
            MethodKind::Holes(_) => {
                dims == 0 || request.epsilon.is_some() || is_dispersion || aim.unwrap_or(default) == Aim::Dispersion
            }
            MethodKind::Search { .. } | MethodKind::Own(_) | MethodKind::Given(_) => false,
        }
    }

    /// Returns `true` if the strategy learns from the robustness of the tests, and so needs the results.
    pub fn is_adaptive(self) -> bool {
        matches!(self.kind(), MethodKind::Search { .. })
    }

    /// Returns `true` if the strategy looks for a single failure of any requirement. Other adaptive strategies map
    /// where tests fail.
    pub fn seeks_a_failure(self) -> bool {
        matches!(self.kind(), MethodKind::Search { seeks_a_failure: true, .. })
    }

    /// Returns `true` if the strategy puts new tests into the largest holes between the existing tests.
    pub fn fills_holes(self) -> bool {
        matches!(self.kind(), MethodKind::Holes(_))
    }

    /// Returns the default index of the strategy's first point; `None` if the strategy cannot skip points.
    pub fn first_index(self) -> Option<u64> {
        match self.kind() {
            MethodKind::Sequence(endless) => endless.first,
            _ => None,
        }
    }

    /// Returns the strategy that takes the place of this one if constraints leave a part of the space; `None` if this strategy does it itself.
    pub(crate) fn in_a_part(self) -> Option<Self> {
        match self.kind() {
            MethodKind::Sets { in_a_part, .. } => in_a_part,
            _ => None,
        }
    }

    pub(crate) fn descriptor(self) -> &'static Descriptor {
        self.0
    }

    pub(crate) fn kind(self) -> MethodKind {
        self.0.method.0
    }

    /// Builds the strategy's sequence without a fixed end; `None` if the strategy has no such sequence.
    pub(crate) fn sequence(self, dims: usize, seed: Option<u64>) -> Option<Box<dyn Sequence>> {
        match self.kind() {
            MethodKind::Sequence(endless) => Some((endless.build)(dims, seed)),
            _ => None,
        }
    }

    /// Returns `true` if the strategy makes points one by one, without a known number of points, and leaves no hole in
    /// the end.
    pub(crate) fn goes_on(self) -> bool {
        matches!(self.kind(), MethodKind::Sequence(Endless { fills: true, .. }) | MethodKind::Holes(_))
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
