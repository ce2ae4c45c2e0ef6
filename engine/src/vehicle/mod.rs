//! The car: its parameters, and two models of its motion that take the same inputs and give the same outputs.
//!
//! [`SingleTrack`] is a dynamic bicycle model: fast, and exact on a straight line. [`Jointed`] is a chassis and four
//! wheels on joints, which a physics engine integrates. Both implement [`Dynamics`]; [`VehicleModel`] names them. (The
//! ray-cast vehicle of the physics engine is not used, because it brakes with twice the friction force.)
//!
//! The force of a tyre is at most `mu N`, and acceleration shifts load between the axles (`N_f = m (g l_r - a h) / L`,
//! `N_r = m (g l_f + a h) / L`). The brakes act on all wheels in proportion to their loads, as a stability control
//! does, so that the whole car decelerates at up to `mu g`. The engine acts on the driven wheels. There is no reverse
//! gear. Drag and rolling resistance are settings ([`Resistance`]), and are off unless a study sets them.
//!
//! The quality of the models, which the tests of this module check (with a [`Vehicle::BMW_320I`], steps of 2 to 10 ms):
//!
//! | | `single-track` | `jointed` | expected |
//! | --- | --- | --- | --- |
//! | full brakes from 30 to 120 km/h, mu 0.2 to 0.8 | exact | at most 0.9 % longer | v²/(2 mu g) |
//! | the same, dependence on the step | exact | at most 0.4 % | no change |
//! | 6 m/s² commanded from 50 km/h | 16.08 m | 16.08 m | 16.07 to 16.94 m over the CommonRoad models |
//! | radius of the path of the middle at 0.03 rad, 5 to 20 m/s, mu 1.05 | 85.9 to 86.4 m | 85.9 to 86.7 m | 85.9 m |
//! | the same, mu 0.6 | 85.9 to 87.2 m | 85.9 to 87.1 m | |
//! | understeer gradient over these speeds, mu 1.05 | 0.014 mrad s²/m | 0.040 mrad s²/m | nearly neutral |
//! | greatest side acceleration at 20 m/s, mu 0.2 to 0.8 | 0.983 to 0.999 mu g | 0.990 to 0.999 mu g | mu g |
//! | drift in 60 s at rest | none | less than 1 nm | none |
//! | time to 40, 60, 80, 100 km/h, mu 0.6 to 1.05 | at most 0.1 % longer | 0.4 to 1.6 % longer | traction, then constant power |
//!
//! In degrees per g of side acceleration, the understeer gradients are 0.008 and 0.023. Real cars have about 1 to 3.
//! The tyres of the source have the same stiffness by load on both axles, which makes the car neutral. The small rest
//! comes from the slip angle: a part of the side acceleration is along the car and loads the rear axle.

mod flaw;
mod jointed;
mod motion;
mod parameters;
mod setup;
mod single_track;
mod tyre;

pub use flaw::VehicleFlaw;
pub use jointed::Jointed;
pub use motion::Motion;
pub use parameters::{Drive, Vehicle};
pub use setup::{Resistance, VehicleSetting, VehicleSettingFlaw, VehicleSetup};
pub use single_track::SingleTrack;

use nalgebra::Vector2;
use paracosm_road::Pose;
use serde::{Deserialize, Serialize};
use std::fmt;
use thiserror::Error;

/// The standard acceleration of gravity in m/s².
pub const GRAVITY: f64 = 9.80665;

/// The positions of pedals and steering wheel, which the driver chooses.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pedals {
    /// The position of the pedals, from -1 (full brakes) to 1 (full power).
    pub throttle: f64,
    /// The position of the steering wheel, from -1 (front wheels fully to the right) to 1 (fully to the left).
    pub steering: f64,
}

/// The position and motion of a car.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleState {
    /// The position of the middle of the car's box, in metres.
    pub position: Vector2<f64>,
    /// The heading of the car in radians, counter-clockwise from x; not wrapped.
    pub heading: f64,
    /// The velocity of the middle of the car's box in m/s, as seen from the car, with x ahead and y to the left.
    pub velocity: Vector2<f64>,
    /// The yaw rate of the car in radians per second, counter-clockwise.
    pub yaw_rate: f64,
    /// The angle of the front wheels to the left in radians, or of an imagined wheel midway if the angles differ.
    pub steering_angle: f64,
    /// The acceleration of the centre of gravity in m/s² over the last step, with x ahead and y to the left of the car.
    pub acceleration: Vector2<f64>,
    /// The distance that the car has travelled, in metres.
    pub travelled: f64,
}

/// The state of a wheel on the road.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wheel {
    /// The difference of the speeds of the tread and of the road under the wheel, divided by the greater speed. It is
    /// -1 for a locked wheel, 0 for a rolling wheel, 1 for a wheel that spins on the spot.
    pub slip_ratio: f64,
    /// The angle in radians from the wheel's direction to the wheel's motion; positive if the wheel slips to its left.
    pub slip_angle: f64,
    /// The load on the wheel, in newtons.
    pub load: f64,
    /// `true` if the wheel touches the road.
    pub contact: bool,
}

/// A model of the motion of a car, which moves the car on step by step.
pub trait Dynamics: Send {
    /// Moves the car on by `dt` seconds with these pedals on a road with this friction coefficient.
    ///
    /// Pedals out of their range count as the end of the range. An invalid input makes the state NaN, and it stays NaN:
    /// the caller has to check [`VehicleState::is_finite`].
    fn step(&mut self, pedals: Pedals, friction: f64, dt: f64);

    /// Returns the present position and motion of the car.
    fn state(&self) -> &VehicleState;

    /// Returns the states of the wheels in the order front left, front right, rear left, rear right.
    fn wheels(&self) -> [Wheel; 4];
}

/// A model of the motion of a car, by its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VehicleModel {
    /// The model [`SingleTrack`], in which one wheel stands for the two wheels of an axle.
    #[default]
    SingleTrack,
    /// The model [`Jointed`], in which the car is a chassis with four wheels on joints.
    Jointed,
}

impl VehicleModel {
    /// All models of the motion of a car.
    pub const ALL: [VehicleModel; 2] = [VehicleModel::SingleTrack, VehicleModel::Jointed];

    /// Returns the name by which users refer to the model.
    pub fn name(self) -> &'static str {
        match self {
            VehicleModel::SingleTrack => "single-track",
            VehicleModel::Jointed => "jointed",
        }
    }

    /// Returns the model with a given name.
    ///
    /// # Errors
    /// There is no model with this name.
    pub fn find(name: &str) -> Result<Self, UnknownModel> {
        Self::ALL.into_iter().find(|model| model.name() == name).ok_or_else(|| UnknownModel { name: name.to_owned() })
    }

    /// Makes a car with this motion model and without resistances. Its middle has the pose `start`, and it goes straight
    /// ahead at `speed` m/s.
    ///
    /// # Panics
    /// The vehicle has a [`Vehicle::flaw`].
    pub fn build(self, vehicle: &Vehicle, start: Pose, speed: f64) -> Box<dyn Dynamics> {
        VehicleSetup::from(self).build(vehicle, start, speed)
    }
}

impl VehicleSetup {
    /// Makes a car with this model and these resistances. Its middle has the pose `start`, and it goes straight ahead at
    /// `speed` m/s.
    ///
    /// # Panics
    /// The vehicle has a [`Vehicle::flaw`].
    pub fn build(self, vehicle: &Vehicle, start: Pose, speed: f64) -> Box<dyn Dynamics> {
        let resistance = self.resistance;
        match self.model {
            VehicleModel::SingleTrack => Box::new(SingleTrack::new(vehicle, start, speed).against(resistance)),
            VehicleModel::Jointed => Box::new(Jointed::new(vehicle, start, speed).against(resistance)),
        }
    }
}

/// The error that no model of the motion of a car has the given name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no vehicle model is called `{name}`, expected `single-track` or `jointed`")]
pub struct UnknownModel {
    /// The unknown name, which no model has.
    pub name: String,
}

impl fmt::Display for VehicleModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Pedals {
    /// Returns the same pedals, limited to their range.
    fn clamped(self) -> Self {
        Self { throttle: self.throttle.clamp(-1.0, 1.0), steering: self.steering.clamp(-1.0, 1.0) }
    }
}

impl VehicleState {
    /// Makes the state of a car that goes straight ahead.
    fn new(start: Pose, speed: f64) -> Self {
        Self {
            position: start.position,
            heading: start.heading,
            velocity: Vector2::new(speed, 0.0),
            yaw_rate: 0.0,
            steering_angle: 0.0,
            acceleration: Vector2::zeros(),
            travelled: 0.0,
        }
    }

    /// Returns the position and the heading of the car.
    pub fn pose(&self) -> Pose {
        Pose { position: self.position, heading: self.heading }
    }

    /// Returns the speed of the car's middle in m/s.
    pub fn speed(&self) -> f64 {
        self.velocity.norm()
    }

    /// Returns `true` if all values of the state are finite.
    pub fn is_finite(&self) -> bool {
        let motion = self.velocity.sum() + self.acceleration.sum() + self.yaw_rate + self.steering_angle;
        (self.position.sum() + self.heading + self.travelled + motion).is_finite()
    }

    /// Returns `true` if the state and the inputs of a step are valid. Otherwise, it sets the state to NaN.
    fn accepts(&mut self, pedals: Pedals, friction: f64, dt: f64) -> bool {
        let inputs = pedals.throttle + pedals.steering + friction;
        let accepted = inputs.is_finite() && friction >= 0.0 && dt > 0.0 && self.is_finite();
        if !accepted {
            self.lose();
        }
        accepted
    }

    /// Sets position, heading and motion to NaN.
    fn lose(&mut self) {
        let nothing = Vector2::repeat(f64::NAN);
        (self.position, self.velocity, self.acceleration) = (nothing, nothing, nothing);
        (self.heading, self.yaw_rate, self.travelled) = (f64::NAN, f64::NAN, f64::NAN);
    }

    /// Turns the front wheels towards the angle that the driver wants.
    fn steer(&mut self, vehicle: &Vehicle, steering: f64, dt: f64) {
        let most = vehicle.max_steering_rate * dt;
        self.steering_angle += (steering * vehicle.max_steering_angle - self.steering_angle).clamp(-most, most);
    }
}

#[cfg(test)]
mod tests;
