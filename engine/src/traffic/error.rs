//! Why traffic cannot begin.

use thiserror::Error;

/// Why traffic cannot begin. Cars are counted from 0.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum TrafficError {
    /// A number that cannot be.
    #[error("car {car} has {value} as its {what}, expected {least} to {most}")]
    Value {
        /// Its index.
        car: usize,
        /// Which number.
        what: &'static str,
        /// The number.
        value: f64,
        /// The least that may be.
        least: f64,
        /// The greatest that may be.
        most: f64,
    },
    /// A lane of another network.
    #[error("car {car} is to drive on lane {lane} of a network with {lanes}")]
    UnknownLane {
        /// Its index.
        car: usize,
        /// The index of the lane.
        lane: usize,
        /// How many lanes there are.
        lanes: usize,
    },
    /// A route with two lanes of which the second neither follows the first nor lies beside it on a road.
    #[error(
        "the route of car {car} leads from lane {from} to lane {to}, neither its successor nor beside it on a road"
    )]
    Route {
        /// Its index.
        car: usize,
        /// The index of the first lane.
        from: usize,
        /// The index of the second lane.
        to: usize,
    },
    /// Two cars in the same place.
    #[error("cars {first} and {second} are in the same place at the start")]
    Overlap {
        /// The index of one.
        first: usize,
        /// The index of the other.
        second: usize,
    },
}
