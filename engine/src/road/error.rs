//! Why a road network cannot be. Points are named as `element.point`.

use paracosm_space::{did_you_mean, nearest};
use thiserror::Error;

/// The largest gap in metres over which a loop closes.
pub(super) const GAP: f64 = 0.01;
/// The largest angle in degrees at which a loop closes.
pub(super) const ANGLE: f64 = 0.1;

/// Why a road network cannot be built, or what it was asked for in vain.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum RoadError {
    /// An element that cannot be as it is described.
    #[error("`{element}` {problem}")]
    Element {
        /// Its name.
        element: String,
        /// What is wrong with it, and what was expected.
        problem: String,
    },
    /// Two elements of one name.
    #[error("two road elements are called `{name}`")]
    NameTaken {
        /// The name.
        name: String,
    },
    /// A name that no element has.
    #[error("no road element is called `{name}`{}", did_you_mean(.nearest))]
    UnknownElement {
        /// The name.
        name: String,
        /// A name that was perhaps meant.
        nearest: Option<String>,
    },
    /// A point that an element does not have.
    #[error("`{element}` has no point `{point}`{}; it has {}", did_you_mean(.nearest), points.join(", "))]
    UnknownPoint {
        /// The element.
        element: String,
        /// The point.
        point: String,
        /// A point that was perhaps meant.
        nearest: Option<&'static str>,
        /// Those that it has.
        points: Vec<&'static str>,
    },
    /// A point that is to be connected though it is already.
    #[error("`{point}` cannot be connected to `{to}`: it is connected to `{taken_by}` already")]
    PointTaken {
        /// The point.
        point: String,
        /// What it is connected to.
        taken_by: String,
        /// What it was to be connected to.
        to: String,
    },
    /// Two points of roads with different numbers of lanes.
    #[error("`{a}` with {} lanes cannot be connected to `{b}` with {}", lanes.0, lanes.1)]
    DifferentLanes {
        /// A point.
        a: String,
        /// The other point.
        b: String,
        /// The number of lanes at either.
        lanes: (i32, i32),
    },
    /// Two points of roads with lanes of different widths.
    #[error("`{a}` with lanes of {} m cannot be connected to `{b}` with lanes of {} m", widths.0, widths.1)]
    DifferentWidths {
        /// A point.
        a: String,
        /// The other point.
        b: String,
        /// The width of the lanes at either, in metres.
        widths: (f64, f64),
    },
    /// Two points of a composite that do not meet.
    #[error(
        "the loop does not close: `{a}` and `{b}` are {gap:.3} m and {angle:.2} degrees apart, at most {} m and {} \
         degrees are allowed",
        GAP,
        ANGLE
    )]
    OpenLoop {
        /// A point.
        a: String,
        /// The other point.
        b: String,
        /// Metres between them.
        gap: f64,
        /// Degrees between their headings.
        angle: f64,
    },
    /// Two elements in the same place.
    #[error("`{a}` and `{b}` overlap at ({:.1}, {:.1})", at.0, at.1)]
    Overlap {
        /// An element.
        a: String,
        /// The other element.
        b: String,
        /// A point of both, in metres.
        at: (f64, f64),
    },
    /// A lane that an element does not have.
    #[error("`{element}` has no lane {lane}{}; it has {has}", from_to(.between))]
    UnknownLane {
        /// The element.
        element: String,
        /// The lane.
        lane: i32,
        /// The points that it was to lead from and to, in an intersection.
        between: Option<(String, String)>,
        /// Those that it has.
        has: String,
    },
    /// A place beyond the ends of a road.
    #[error("a place {at} m along `{element}` is asked for, which is {length} m long")]
    Beyond {
        /// The element.
        element: String,
        /// The place.
        at: f64,
        /// The length of the element in metres.
        length: f64,
    },
    /// Two places between which there is no way without a change of lanes.
    #[error("no way leads from {from} to {to} without a change of lanes")]
    NoWay {
        /// Where it was to begin.
        from: String,
        /// Where it was to end.
        to: String,
    },
}

impl RoadError {
    pub(super) fn unknown_element<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> Self {
        Self::UnknownElement { name: name.to_owned(), nearest: nearest(name, names).map(str::to_owned) }
    }

    pub(super) fn unknown_point(element: &str, point: &str, points: Vec<&'static str>) -> Self {
        let nearest = nearest(point, points.iter().copied());
        // The very name, which lives longer than the list.
        let nearest = points.iter().copied().find(|name| nearest == Some(name));
        Self::UnknownPoint { element: element.to_owned(), point: point.to_owned(), nearest, points }
    }
}

fn from_to(between: &Option<(String, String)>) -> String {
    between.as_ref().map(|(from, to)| format!(" from `{from}` to `{to}`")).unwrap_or_default()
}
