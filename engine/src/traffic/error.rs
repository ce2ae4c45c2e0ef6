//! The reasons why traffic cannot begin.

use thiserror::Error;

/// The reason why traffic cannot begin. Cars are counted from 0.
#[derive(Debug, Clone, Error, PartialEq)]
pub enum TrafficError {
    /// A value of a car is out of range.
    #[error("car {car} has {value} as its {what}, expected {least} to {most}")]
    Value {
        /// The index of the car.
        car: usize,
        /// The name and unit of the value.
        what: &'static str,
        /// The value that was found.
        value: f64,
        /// The smallest allowed value.
        least: f64,
        /// The greatest allowed value.
        most: f64,
    },
    /// A lane of a car belongs to another network.
    #[error("car {car} should drive on lane {lane}, but the network has only {lanes} lanes, counted from 0")]
    UnknownLane {
        /// The index of the car.
        car: usize,
        /// The index of the lane.
        lane: usize,
        /// The number of lanes in the network.
        lanes: usize,
    },
    /// A lane of a route neither follows the lane before it nor lies beside it on a road.
    #[error(
        "the route of car {car} leads from lane {from} to lane {to}, which neither follows nor is beside it on a road"
    )]
    Route {
        /// The index of the car.
        car: usize,
        /// The index of the first lane.
        from: usize,
        /// The index of the second lane.
        to: usize,
    },
    /// Two cars overlap at the start.
    #[error("cars {first} and {second} are in the same place at the start")]
    Overlap {
        /// The index of the first car.
        first: usize,
        /// The index of the second car.
        second: usize,
    },
}
