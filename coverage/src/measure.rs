//! A measure is a descriptor: its names, what it says, when it is taken, and how it is computed.
//!
//! Reports, tables, figures, comparisons and help read the descriptors. A measure is described in the file that computes it,
//! and named in the list of the crate.

use crate::witness::{Dispersion, Fill};
use crate::{Bracket, Deadline, PointSet};
use paracosm_space::{did_you_mean, nearest};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A measure of how well tests cover their space: a handle to its [`Descriptor`]. Measures of the same name are equal.
#[derive(Clone, Copy)]
pub struct Measure(&'static Descriptor);

/// All that the software knows of a measure.
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
    /// When the measure is taken among others: a measure of a lower pace is taken first, and leaves the rest of its time to
    /// the others.
    pub pace: u8,
    /// When a comparison of strategies takes the measure.
    pub compare: Compare,
    /// How the measure is computed.
    pub method: Computation,
}

/// When a comparison of strategies takes a measure.
#[derive(Debug, Clone, Copy)]
pub enum Compare {
    /// Always.
    Always,
    /// Where it is quick for sets of so many dimensions and points, or where it is named.
    WhereQuick(fn(usize, usize) -> bool),
    /// Where it is named.
    WhereNamed,
    /// Where sets have more than k dimensions.
    BeyondK,
    /// Never: it says nothing about points of the cube.
    Never,
}

/// How a measure is computed.
#[derive(Debug, Clone, Copy)]
pub enum Computation {
    /// A number in closed form; none without points, or where the deadline passes first.
    Number(fn(&PointSet, Deadline) -> Option<f64>),
    /// A number that is exact unless the deadline cuts the search short.
    Bracket(fn(&PointSet, Deadline) -> Bracket),
    /// The largest empty box, while the bracket of its volume is watched.
    Hole(fn(&PointSet, Deadline, &mut dyn FnMut(Bracket)) -> Dispersion),
    /// The largest empty ball; none without points.
    Ball(fn(&PointSet, Deadline) -> Option<Fill>),
    /// The combinations of discrete values that tests contain.
    Combinations,
    /// The largest hole that any k parameters show, discrete and continuous ones.
    KwiseHole,
}

/// What a measure of the continuous half found.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// A number; none without points, or where the deadline passed first.
    Number(Option<f64>),
    /// A number that is exact, or between two bounds.
    Bracket(Bracket),
    /// The largest empty box.
    Hole(Dispersion),
    /// The largest empty ball; none without points.
    Ball(Option<Fill>),
}

impl Measure {
    /// The measure of a descriptor.
    pub const fn of(descriptor: &'static Descriptor) -> Self {
        Self(descriptor)
    }

    /// Every measure, in the order in which they are shown.
    pub fn all() -> impl Iterator<Item = Self> {
        crate::MEASURES.iter().copied()
    }

    /// The name by which it is asked for.
    pub fn name(self) -> &'static str {
        self.0.name
    }

    /// All that is known of it.
    pub fn descriptor(self) -> &'static Descriptor {
        self.0
    }

    /// What it says of points; none if it is not about the continuous half alone. `watch` sees the bracket close.
    pub fn take(self, points: &PointSet, deadline: Deadline, watch: &mut dyn FnMut(Bracket)) -> Option<Finding> {
        match self.0.method {
            Computation::Number(number) => Some(Finding::Number(number(points, deadline))),
            Computation::Bracket(bracket) => Some(Finding::Bracket(bracket(points, deadline))),
            Computation::Hole(hole) => Some(Finding::Hole(hole(points, deadline, watch))),
            Computation::Ball(ball) => Some(Finding::Ball(ball(points, deadline))),
            Computation::Combinations | Computation::KwiseHole => None,
        }
    }

    /// Whether it is about the continuous half alone.
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

/// A name that no measure has.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no measure is called `{name}`{}; there are {}", did_you_mean(.nearest), names().join(", "))]
pub struct UnknownMeasure {
    /// The name.
    pub name: String,
    /// A name that was perhaps meant.
    pub nearest: Option<&'static str>,
}

fn names() -> Vec<&'static str> {
    Measure::all().map(Measure::name).collect()
}

impl FromStr for Measure {
    type Err = UnknownMeasure;

    fn from_str(name: &str) -> Result<Self, UnknownMeasure> {
        let unknown = || UnknownMeasure { name: name.to_owned(), nearest: nearest(name, names()) };
        Self::all().find(|measure| measure.name() == name).ok_or_else(unknown)
    }
}
