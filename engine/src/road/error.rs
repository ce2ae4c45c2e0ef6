//! The reasons why a road network cannot be built. Points are named as `element.point`.

use paracosm_space::{did_you_mean, nearest};
use thiserror::Error;

/// The largest gap in metres at which a loop counts as closed.
pub(super) const GAP: f64 = 0.01;
/// The largest angle in degrees at which a loop counts as closed.
pub(super) const ANGLE: f64 = 0.1;

/// The reason why a road network cannot be built, or why it cannot answer a question.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum RoadError {
    /// The description of an element is not valid, or the element is of the wrong kind.
    #[error("`{element}` {problem}")]
    Element {
        /// The name of the element.
        element: String,
        /// The mistake, with the values that were expected.
        problem: String,
    },
    /// Two elements have the same name.
    #[error("two road elements are called `{name}`: give each element a name of its own")]
    NameTaken {
        /// The name of the elements.
        name: String,
    },
    /// No element has this name.
    #[error("no road element is called `{name}`{}", did_you_mean(.nearest))]
    UnknownElement {
        /// The name that was looked for.
        name: String,
        /// A similar name that exists, if there is one.
        nearest: Option<String>,
    },
    /// The element does not have this point.
    #[error("`{element}` has no point `{point}`{}; its points are {}", did_you_mean(.nearest), points.join(", "))]
    UnknownPoint {
        /// The name of the element.
        element: String,
        /// The name of the point.
        point: String,
        /// A similar name of a point that exists, if there is one.
        nearest: Option<&'static str>,
        /// The points that the element has.
        points: Vec<&'static str>,
    },
    /// A point is already connected to another point.
    #[error("`{point}` cannot be connected to `{to}`: it is connected to `{taken_by}` already")]
    PointTaken {
        /// The point that is already connected.
        point: String,
        /// The point that it is connected to.
        taken_by: String,
        /// The point that it should have been connected to.
        to: String,
    },
    /// Two points cannot be connected because their roads have different numbers of lanes.
    #[error("`{a}` with {} lanes cannot be connected to `{b}` with {} lanes, expected equal numbers", lanes.0, lanes.1)]
    DifferentLanes {
        /// The first point.
        a: String,
        /// The second point.
        b: String,
        /// The numbers of lanes at the first and the second point.
        lanes: (i32, i32),
    },
    /// Two points cannot be connected because the lanes of their roads have different widths.
    #[error("`{a}` with lanes of {} m cannot be connected to `{b}` with lanes of {} m", widths.0, widths.1)]
    DifferentWidths {
        /// The first point.
        a: String,
        /// The second point.
        b: String,
        /// The widths of the lanes at the first and the second point, in metres.
        widths: (f64, f64),
    },
    /// Two points that should close a loop do not meet.
    #[error(
        "the loop does not close: `{a}` and `{b}` are {gap:.3} m and {angle:.2} degrees apart, at most {} m and {} \
         degrees are allowed",
        GAP,
        ANGLE
    )]
    OpenLoop {
        /// The first point.
        a: String,
        /// The second point.
        b: String,
        /// The distance between the points, in metres.
        gap: f64,
        /// The angle between the headings, in degrees.
        angle: f64,
    },
    /// Two elements cover the same ground.
    #[error("the road elements `{a}` and `{b}` overlap at ({:.1}, {:.1})", at.0, at.1)]
    Overlap {
        /// The first element.
        a: String,
        /// The second element.
        b: String,
        /// A point on both elements, in metres.
        at: (f64, f64),
    },
    /// The element does not have this lane.
    #[error("`{element}` has no lane {lane}{}; it has {has}", from_to(.between))]
    UnknownLane {
        /// The name of the element.
        element: String,
        /// The number of the lane.
        lane: i32,
        /// The points where the lane should have begun and ended, if the lane was asked for by its points.
        between: Option<(String, String)>,
        /// The lanes that the element has, in words.
        has: String,
    },
    /// A place lies beyond the ends of a road.
    #[error("there is no place {at} m along `{element}`, which is {length} m long")]
    Beyond {
        /// The name of the element.
        element: String,
        /// The place, in metres along the element.
        at: f64,
        /// The length of the element, in metres.
        length: f64,
    },
    /// There is no connection between two places without a lane change.
    #[error("no path leads from {from} to {to} without a lane change")]
    NoWay {
        /// The place where the path should have begun.
        from: String,
        /// The place where the path should have ended.
        to: String,
    },
}

impl RoadError {
    pub(super) fn unknown_element<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> Self {
        Self::UnknownElement { name: name.to_owned(), nearest: nearest(name, names).map(str::to_owned) }
    }

    pub(super) fn unknown_point(element: &str, point: &str, points: Vec<&'static str>) -> Self {
        let nearest = nearest(point, points.iter().copied());
        // The string from the list has the lifetime that the error needs.
        let nearest = points.iter().copied().find(|name| nearest == Some(name));
        Self::UnknownPoint { element: element.to_owned(), point: point.to_owned(), nearest, points }
    }
}

fn from_to(between: &Option<(String, String)>) -> String {
    between.as_ref().map(|(from, to)| format!(" from `{from}` to `{to}`")).unwrap_or_default()
}
