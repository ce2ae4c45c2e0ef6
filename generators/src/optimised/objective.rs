//! The measures that an optimised set of points can make small.

use paracosm_coverage::dispersion::LargestEmptyBox;
use paracosm_coverage::kwise_dispersion::kwise_dispersion;
use paracosm_coverage::star::star_discrepancy;
use paracosm_coverage::{Bracket, Deadline, Measure, PointSet, dispersion};
use paracosm_space::rules::Rules;
use paracosm_space::{Point, nearest};
use std::str::FromStr;
use thiserror::Error;

/// The measure that an optimised set of points makes small.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Objective {
    /// The star discrepancy.
    Star,
    /// The dispersion, which is the volume of the largest empty box.
    Dispersion,
    /// The k-wise dispersion, which is the largest dispersion over all choices of this number of coordinates.
    KwiseDispersion(usize),
}

/// The reason why a set of points cannot be optimised.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ObjectiveError {
    /// No measure of this name can be made small.
    #[error("no set of points can be optimised for the measure `{name}`{}; the measures are {}", paracosm_space::did_you_mean(.nearest), names().join(", "))]
    Unknown {
        /// The name that was given.
        name: String,
        /// The name that was perhaps meant; `None` if no name is similar.
        nearest: Option<&'static str>,
    },
    /// The number of coordinates of the k-wise dispersion does not fit the points.
    #[error("k is {k}, expected a number from 1 to {dims}, the number of dimensions")]
    Strength {
        /// The number of coordinates that are looked at together.
        k: usize,
        /// The number of dimensions.
        dims: usize,
    },
}

impl Objective {
    /// All objectives, with the default strength of the k-wise dispersion.
    pub const ALL: [Self; 3] = [Self::Star, Self::Dispersion, Self::KwiseDispersion(2)];

    /// Returns the measure that becomes small.
    pub fn measure(self) -> Measure {
        match self {
            Self::Star => Measure::STAR,
            Self::Dispersion => Measure::DISPERSION,
            Self::KwiseDispersion(_) => Measure::K_WISE_DISPERSION,
        }
    }

    /// Returns the objective for points of this number of dimensions, with the strength `k` if it has one.
    ///
    /// # Errors
    /// `k` is 0 or more than the number of dimensions.
    pub fn for_points(self, dims: usize, k: Option<usize>) -> Result<Self, ObjectiveError> {
        let Self::KwiseDispersion(usual) = self else { return Ok(self) };
        let k = k.unwrap_or(usual.min(dims));
        if (1..=dims).contains(&k) { Ok(Self::KwiseDispersion(k)) } else { Err(ObjectiveError::Strength { k, dims }) }
    }

    /// Measures points.
    ///
    /// # Panics
    /// The strength is 0 or more than the number of dimensions.
    pub fn measured(self, points: &PointSet, deadline: Deadline) -> Bracket {
        self.found(points, deadline).value
    }

    /// Measures points, and finds a box that shows the value.
    pub(super) fn found(self, points: &PointSet, deadline: Deadline) -> Found {
        match self {
            Self::Star => Found { value: star_discrepancy(points, deadline), hole: None },
            Self::Dispersion => {
                let found = dispersion::dispersion(points, deadline);
                let hole = Hole { axes: (0..points.dims()).collect(), empty: found.witness };
                Found { value: found.volume, hole: Some(hole) }
            }
            Self::KwiseDispersion(k) => {
                let none = Rules::new(&[], &[]).expect("there is no parameter");
                let tests: Vec<Point> =
                    points.iter().map(|point| Point { continuous: point.to_vec(), discrete: Vec::new() }).collect();
                let found =
                    kwise_dispersion(points.dims(), &none, None, &tests, k, deadline).expect("k fits the points");
                let hole = found.witness.map(|empty| Hole { axes: found.axes, empty });
                Found { value: found.volume, hole }
            }
        }
    }

    /// Returns true if it is certain that the measure is at most a level.
    pub(super) fn is_at_most(self, points: &PointSet, level: f64, deadline: Deadline) -> bool {
        match self {
            Self::Dispersion => dispersion::is_at_most(points, level, deadline) == Some(true),
            Self::Star | Self::KwiseDispersion(_) => self.measured(points, deadline).upper <= level,
        }
    }
}

impl FromStr for Objective {
    type Err = ObjectiveError;

    fn from_str(name: &str) -> Result<Self, ObjectiveError> {
        let found = Self::ALL.into_iter().find(|objective| objective.measure().name() == name);
        found.ok_or_else(|| ObjectiveError::Unknown { name: name.to_owned(), nearest: nearest(name, names()) })
    }
}

fn names() -> [&'static str; 3] {
    Objective::ALL.map(|objective| objective.measure().name())
}

/// The value of a measure, with a place that shows it.
pub(super) struct Found {
    pub value: Bracket,
    /// An empty box, for measures of empty boxes.
    pub hole: Option<Hole>,
}

/// An empty box over some of the coordinates.
pub(super) struct Hole {
    pub axes: Vec<usize>,
    pub empty: LargestEmptyBox,
}
