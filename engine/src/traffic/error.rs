//! The reasons why traffic cannot begin.

use thiserror::Error;

/// The reason why traffic cannot begin. Cars are counted from 0.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum TrafficError {
    /// A value of a car is out of range.
    #[error("car {car} has {value} as its {what}, expected {least} to {most}")]
    Value {
        /// The index of the car whose value is out of range.
        car: usize,
        /// The name and unit of the value that is out of range.
        what: &'static str,
        /// The value that is out of range.
        value: f64,
        /// The smallest value that is allowed.
        least: f64,
        /// The greatest value that is allowed.
        most: f64,
    },
    /// A lane of a car does not belong to the road network.
    #[error("car {car} should drive on lane {lane}, but the network has only {lanes} lanes, counted from 0")]
    UnknownLane {
        /// The index of the car with the unknown lane.
        car: usize,
        /// The index of the lane that the network does not have.
        lane: usize,
        /// The number of lanes in the network.
        lanes: usize,
    },
    /// A lane of a route neither follows the lane before it nor lies beside it on a road.
    #[error(
        "the route of car {car} leads from lane {from} to lane {to}, which neither follows nor is beside it on a road"
    )]
    Route {
        /// The index of the car with the disconnected route.
        car: usize,
        /// The index of the lane after which the route is not connected.
        from: usize,
        /// The index of the lane to which the route leads without a connection.
        to: usize,
    },
    /// Two cars overlap at the start.
    #[error("cars {first} and {second} are in the same place at the start")]
    Overlap {
        /// The index of the first car that overlaps another car.
        first: usize,
        /// The index of the second car, which overlaps the first car.
        second: usize,
    },
}
