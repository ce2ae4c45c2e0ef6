//! The errors of a world during its simulation.

use crate::object::InputError;
use crate::vehicle::VehicleState;
use nalgebra::Vector2;
use paracosm_road::Pose;
use thiserror::Error;

/// The reason why the simulation of a world cannot go on.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Upset {
    /// A signal is NaN or absent. No comparison with NaN holds, so it would satisfy every `never`.
    #[error("the signal `{signal}` is absent or NaN")]
    NoValue {
        /// The name of the signal.
        signal: String,
    },
    /// A condition of the world, such as fog or friction, is out of its range.
    #[error("the {what} is {value}, expected {expected}")]
    Condition {
        /// The name of the condition.
        what: &'static str,
        /// The value of the condition.
        value: f64,
        /// The possible values of the condition, in words.
        expected: &'static str,
    },
    /// A control of the driver is out of its range.
    #[error("the driver's {what} is {value}, expected -1 to 1")]
    Control {
        /// The name of the control, which is throttle or steering.
        what: &'static str,
        /// The value of the control.
        value: f64,
    },
    /// An object cannot go on with the values of its inputs.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The state of the ego vehicle is not finite.
    #[error("the state of the car has a number that is not finite: {0:?}")]
    Car(Box<VehicleState>),
    /// The pose of an object is not finite.
    #[error("the pose of {object} has a number that is not finite: {pose:?}")]
    Place {
        /// The name of the object.
        object: String,
        /// The pose that is not finite.
        pose: Pose,
    },
    /// The velocity of an object is not finite.
    #[error("the velocity of {object} has a number that is not finite: {velocity:?}")]
    Velocity {
        /// The name of the object.
        object: String,
        /// The velocity that is not finite.
        velocity: Vector2<f64>,
    },
}
