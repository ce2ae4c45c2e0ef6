//! Why a vehicle cannot be.

use thiserror::Error;

/// Why a vehicle cannot be.
#[derive(Debug, Clone, Copy, Error, PartialEq)]
pub enum VehicleFlaw {
    /// A parameter that has to be above 0.
    #[error("the vehicle's {parameter} is {value}, expected a number above 0")]
    NotPositive {
        /// The field of [`Vehicle`](super::Vehicle).
        parameter: &'static str,
        /// Its value, in the unit of the field.
        value: f64,
    },
    /// A parameter outside of its range.
    #[error("the vehicle's {parameter} is {value}, expected 0 to less than {most}")]
    OutOfRange {
        /// The field of [`Vehicle`](super::Vehicle).
        parameter: &'static str,
        /// Its value, in the unit of the field.
        value: f64,
        /// The end of the range.
        most: f64,
    },
    /// An axle that carries less than its wheels.
    #[error("the vehicle's {axle} axle carries {carried:.1} kg, expected more than its {wheels} kg of wheels")]
    Axle {
        /// `front` or `rear`.
        axle: &'static str,
        /// In kg.
        carried: f64,
        /// The mass of its two wheels, in kg.
        wheels: f64,
    },
    /// Wheels with more yaw inertia than the whole car.
    #[error("the vehicle's yaw_inertia is {whole}, expected more than its wheels' {wheels:.1}")]
    YawInertia {
        /// In kg m².
        whole: f64,
        /// In kg m².
        wheels: f64,
    },
}
