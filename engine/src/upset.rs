//! What can be wrong with a world while it is simulated.

use crate::geometry::Pose;
use crate::object::InputError;
use crate::vehicle::VehicleState;
use nalgebra::Vector2;
use thiserror::Error;

/// What can be wrong with a world at one moment.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Upset {
    /// A signal is NaN. No comparison with NaN holds, so that it would satisfy every `never`.
    #[error("the signal `{signal}` has no value")]
    NoValue {
        /// The signal.
        signal: String,
    },
    /// A condition is out of its range.
    #[error("the {what} is {value}, expected {expected}")]
    Condition {
        /// Which one.
        what: &'static str,
        /// What it is.
        value: f64,
        /// What it can be, in words.
        expected: &'static str,
    },
    /// A control is out of its range.
    #[error("the driver's {what} is {value}, expected -1 to 1")]
    Control {
        /// Which one.
        what: &'static str,
        /// What it is.
        value: f64,
    },
    /// An object cannot go on with what its inputs say.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The car under test is nowhere.
    #[error("the state of the car is no number: {0:?}")]
    Car(Box<VehicleState>),
    /// An object is nowhere.
    #[error("the place of {object} is no number: {pose:?}")]
    Place {
        /// The object.
        object: String,
        /// Where it would be.
        pose: Pose,
    },
    /// An object moves in no direction.
    #[error("the velocity of {object} is no number: {velocity:?}")]
    Velocity {
        /// The object.
        object: String,
        /// How it would move.
        velocity: Vector2<f64>,
    },
}
