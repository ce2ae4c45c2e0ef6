//! Describes each measure by a descriptor: its names, its meaning, when it is taken, and how it is computed.
//!
//! Reports, tables, figures, comparisons and help read the descriptors. The file that computes a measure describes
//! it, and `MEASURES` in the crate's `lib.rs` lists all measures.

use crate::valid::ValidPart;
use crate::witness::{Dispersion, Fill};
use crate::{Bracket, Deadline, PointSet};
use paracosm_space::{did_you_mean, nearest};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A measure of the coverage of a space by tests, as a handle to the measure's [`Descriptor`]. Two measures with the
/// same name are equal.
#[derive(Clone, Copy)]
pub struct Measure(&'static Descriptor);

/// The description of a measure, with the names, the meaning and the computation of the measure.
#[derive(Debug)]
pub struct Descriptor {
    /// The name by which users ask for the measure. No two measures have the same name.
    pub name: &'static str,
    /// The key of the measure in `coverage.json`.
    pub key: &'static str,
    /// The label of the measure in a report.
    pub label: &'static str,
    /// The name of the measure in a figure or a sentence.
    pub title: &'static str,
    /// The meaning of the measure, in one line.
    pub about: &'static str,
    /// The rank of the measure in the order in which several measures are taken. A measure with a lower pace is taken
    /// first, and leaves the rest of its time to the later measures.
    pub pace: u8,
    /// The condition under which a comparison of strategies takes the measure.
    pub compare: Compare,
    /// The method that computes the measure.
    pub method: Computation,
}

/// The condition under which a comparison of strategies takes a measure.
#[derive(Debug, Clone, Copy)]
pub enum Compare {
    /// The comparison always takes the measure.
    Always,
    /// The comparison takes the measure if the user names the measure, or if the function returns `true` for the
    /// numbers of dimensions and points.
    WhereQuick(fn(usize, usize) -> bool),
    /// The comparison takes the measure only if the user names the measure.
    WhereNamed,
    /// The comparison takes the measure if the sets of points have more than k dimensions.
    BeyondK,
    /// The comparison never takes the measure, because the measure does not depend on points of the cube.
    Never,
}

/// The type of a function that finds the largest empty box of a set of points.
pub type FindHole = fn(&PointSet, Option<&ValidPart>, Deadline, &mut dyn FnMut(Bracket)) -> Dispersion;

/// The kind of result of a measure, with the function that computes the result.
#[derive(Debug, Clone, Copy)]
pub enum Computation {
    /// A function for a number in closed form; `None` if there are no points or the deadline passes first.
    Number(fn(&PointSet, Deadline) -> Option<f64>),
    /// A function for a number that is exact unless the deadline cuts the search short.
    Bracket(fn(&PointSet, Deadline) -> Bracket),
    /// A function that finds the largest empty box within the valid part, if constraints leave only a part. A callback receives
    /// the bracket of the volume while the bracket narrows.
    Hole(FindHole),
    /// A function that finds the largest empty ball; `None` if there are no points.
    Ball(fn(&PointSet, Deadline) -> Option<Fill>),
    /// The measure counts the combinations of discrete values that the tests contain.
    Combinations,
    /// The measure finds the largest hole in the space of any k parameters, discrete and continuous parameters
    /// together.
    KwiseHole,
}

/// The result of a measure that depends on the continuous parameters only.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// A number that is the result of a measure; `None` if there were no points or the deadline passed first.
    Number(Option<f64>),
    /// A number that is the result of a measure, as a bracket with a lower and an upper bound.
    Bracket(Bracket),
    /// The largest empty box, as the result of a measure.
    Hole(Dispersion),
    /// The largest empty ball, as the result of a measure; `None` if there were no points.
    Ball(Option<Fill>),
}

impl Measure {
    /// Makes a measure from its descriptor.
    pub const fn of(descriptor: &'static Descriptor) -> Self {
        Self(descriptor)
    }

    /// Iterates over all measures of this crate, in the order in which reports show the measures.
    pub fn all() -> impl Iterator<Item = Self> {
        crate::MEASURES.iter().copied()
    }

    /// Returns the name by which users ask for the measure.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// Returns the descriptor of the measure.
    pub fn descriptor(self) -> &'static Descriptor {
        self.0
    }

    /// Computes the measure for `points`; returns `None` if the measure needs more than continuous coordinates. `valid` is the
    /// valid part of the cube if constraints leave only a part; see [`Measure::is_of_the_valid_part`]. `watch` receives the
    /// bracket while the bracket narrows.
    pub fn take(
        self,
        points: &PointSet,
        valid: Option<&ValidPart>,
        deadline: Deadline,
        watch: &mut dyn FnMut(Bracket),
    ) -> Option<Finding> {
        match self.0.method {
            Computation::Number(number) => Some(Finding::Number(number(points, deadline))),
            Computation::Bracket(bracket) => Some(Finding::Bracket(bracket(points, deadline))),
            Computation::Hole(hole) => Some(Finding::Hole(hole(points, valid, deadline, watch))),
            Computation::Ball(ball) => Some(Finding::Ball(ball(points, deadline))),
            Computation::Combinations | Computation::KwiseHole => None,
        }
    }

    /// Returns `true` if the measure takes account of the valid part of the space. The other measures compare the tests with the
    /// whole cube.
    pub fn is_of_the_valid_part(self) -> bool {
        !matches!(self.0.method, Computation::Number(_) | Computation::Bracket(_) | Computation::Ball(_))
    }

    /// Returns `true` if the measure depends on the continuous parameters only.
    pub fn is_of_points(self) -> bool {
        !matches!(self.0.method, Computation::Combinations | Computation::KwiseHole)
    }
}

impl PartialEq for Measure {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

impl Eq for Measure {}

impl fmt::Debug for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Measure").field(&self.name()).finish()
    }
}

impl fmt::Display for Measure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// The error for a name that no measure has.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no measure is called `{name}`{}; the measures are {}", did_you_mean(.nearest), names().join(", "))]
pub struct UnknownMeasure {
    /// The given name, which no measure has.
    pub name: String,
    /// The name of the measure that the user perhaps meant; `None` if no measure has a similar name.
    pub nearest: Option<&'static str>,
}

fn names() -> Vec<&'static str> {
    Measure::all().map(Measure::name).collect()
}

impl FromStr for Measure {
    type Err = UnknownMeasure;

    fn from_str(name: &str) -> Result<Self, UnknownMeasure> {
        let unknown = || UnknownMeasure { name: name.to_owned(), nearest: nearest(name, names()) };
        Self::all().find(|measure| [measure.0.name, measure.0.key].contains(&name)).ok_or_else(unknown)
    }
}
