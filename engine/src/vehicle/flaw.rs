//! The reasons why the description of a vehicle is not valid.

use thiserror::Error;

/// The reason why the description of a vehicle is not valid.
#[derive(Debug, Clone, Copy, Error, PartialEq)]
pub enum VehicleFlaw {
    /// A parameter of the vehicle is not a finite number above 0.
    #[error("the vehicle's {parameter} is {value}, expected a number above 0")]
    NotPositive {
        /// The name of the parameter, which is a field of [`Vehicle`](super::Vehicle).
        parameter: &'static str,
        /// The value of the parameter, in the unit of the field.
        value: f64,
    },
    /// A parameter of the vehicle is out of range.
    #[error("the vehicle's {parameter} is {value}, expected a number from 0 to less than {most}")]
    OutOfRange {
        /// The name of the parameter, which is a field of [`Vehicle`](super::Vehicle).
        parameter: &'static str,
        /// The value of the parameter, in the unit of the field.
        value: f64,
        /// The upper end of the range, which does not belong to the range.
        most: f64,
    },
    /// An axle carries no more than the mass of its wheels.
    #[error("the vehicle's {axle} axle carries {carried:.1} kg, expected more than the {wheels} kg of its wheels")]
    Axle {
        /// The name of the axle, `front` or `rear`.
        axle: &'static str,
        /// The mass that the axle carries, in kg.
        carried: f64,
        /// The mass of the axle's two wheels, in kg.
        wheels: f64,
    },
    /// The wheels have at least as much yaw inertia as the whole car.
    #[error("the vehicle's yaw_inertia is {whole} kg m², expected more than the {wheels:.1} kg m² of its wheels")]
    YawInertia {
        /// The yaw inertia of the whole car, in kg m².
        whole: f64,
        /// The yaw inertia of the wheels, in kg m².
        wheels: f64,
    },
}
