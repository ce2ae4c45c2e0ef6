//! The reasons why a road network cannot be built. Points are named as `element.point`.

use paracosm_space::{did_you_mean, nearest};
use thiserror::Error;

/// The largest gap in metres at which a loop counts as closed.
pub(super) const GAP: f64 = 0.01;
/// The largest angle in degrees at which a loop counts as closed.
pub(super) const ANGLE: f64 = 0.1;

/// The reason why a road network cannot be built, or why a query of a road network has no result.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum RoadError {
    /// The description of a road element is not valid, or an operation needs a road element of another kind.
    #[error("`{element}` {problem}")]
    Element {
        /// The name of the road element with the mistake.
        element: String,
        /// The description of the mistake, with the values that were expected.
        problem: String,
    },
    /// Two road elements have the same name.
    #[error("two road elements are called `{name}`: give each element a name of its own")]
    NameTaken {
        /// The name that both road elements have.
        name: String,
    },
    /// No road element has the given name.
    #[error("no road element is called `{name}`{}", did_you_mean(.nearest))]
    UnknownElement {
        /// The unknown name, which does not belong to any road element.
        name: String,
        /// The most similar name of a road element; `None` if no name is similar.
        nearest: Option<String>,
    },
    /// A road element has no point with the given name.
    #[error("`{element}` has no point `{point}`{}; its points are {}", did_you_mean(.nearest), points.join(", "))]
    UnknownPoint {
        /// The name of the road element without the point.
        element: String,
        /// The name of the unknown point.
        point: String,
        /// The most similar name of a point of the element; `None` if no name is similar.
        nearest: Option<&'static str>,
        /// The names of the points that the element has.
        points: Vec<&'static str>,
    },
    /// A point of a road element is already connected to another point.
    #[error("`{point}` cannot be connected to `{to}`: it is connected to `{taken_by}` already")]
    PointTaken {
        /// The name of the point that is already connected.
        point: String,
        /// The name of the point to which `point` is already connected.
        taken_by: String,
        /// The name of the point to which `point` should have been connected.
        to: String,
    },
    /// Two points cannot be connected because their roads have different numbers of lanes.
    #[error("`{a}` with {} lanes cannot be connected to `{b}` with {} lanes, expected equal numbers", lanes.0, lanes.1)]
    DifferentLanes {
        /// The name of the first point of the connection.
        a: String,
        /// The name of the second point of the connection.
        b: String,
        /// The numbers of lanes at the first and the second point.
        lanes: (i32, i32),
    },
    /// Two points cannot be connected because the lanes of their roads have different widths.
    #[error("`{a}` with lanes of {} m cannot be connected to `{b}` with lanes of {} m", widths.0, widths.1)]
    DifferentWidths {
        /// The name of the first point of the connection.
        a: String,
        /// The name of the second point of the connection.
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
        /// The name of the first point that should close the loop.
        a: String,
        /// The name of the second point that should close the loop.
        b: String,
        /// The distance between the two points, in metres.
        gap: f64,
        /// The angle in degrees by which the directions of the points deviate from opposite directions.
        angle: f64,
    },
    /// Two road elements cover the same ground.
    #[error("the road elements `{a}` and `{b}` overlap at ({:.1}, {:.1})", at.0, at.1)]
    Overlap {
        /// The name of the first road element.
        a: String,
        /// The name of the second road element.
        b: String,
        /// The coordinates of a point on both elements, in metres.
        at: (f64, f64),
    },
    /// A road element has no lane with the given number.
    #[error("`{element}` has no lane {lane}{}; it has {has}", from_to(.between))]
    UnknownLane {
        /// The name of the road element without the lane.
        element: String,
        /// The number of the unknown lane.
        lane: i32,
        /// The names of the points from and to which the lane should lead; `None` if the caller gave no points.
        between: Option<(String, String)>,
        /// The lanes that the element has, in words.
        has: String,
    },
    /// A place lies beyond the ends of a road.
    #[error("there is no place {at} m along `{element}`, which is {length} m long")]
    Beyond {
        /// The name of the road element that is too short.
        element: String,
        /// The place that does not exist, in metres along the road element.
        at: f64,
        /// The length of the road element, in metres.
        length: f64,
    },
    /// No path without a lane change leads from one place to another place.
    #[error("no path leads from {from} to {to} without a lane change")]
    NoWay {
        /// The place at which the path should begin, in words.
        from: String,
        /// The place at which the path should end, in words.
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
