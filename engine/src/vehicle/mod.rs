//! The car: what it is made of, and two models of how it moves that take the same inputs and answer the same questions.
//!
//! [`SingleTrack`] is a dynamic bicycle model, fast, and exact on a straight way; [`Jointed`] is a chassis and four
//! wheels on joints, which a physics engine integrates. Both are [`Dynamics`], and [`VehicleModel`] knows them by name. (The
//! ray-cast vehicle of that engine is not used: it brakes with twice the friction force.)
//!
//! No tyre pushes harder than `mu N`, and acceleration shifts load between the axles (`N_f = m (g l_r - a h) / L`,
//! `N_r = m (g l_f + a h) / L`). The brakes act on all wheels in the proportion of their loads, as a stability control
//! makes them, so that the whole car decelerates at up to `mu g`; the engine acts on the driven wheels. There is neither
//! drag nor rolling resistance, and no reverse gear.
//!
//! How good the models are, as tests.rs holds them to (a [`Vehicle::BMW_320I`], steps of 2 to 10 ms):
//!
//! | | `single-track` | `jointed` | expected |
//! | --- | --- | --- | --- |
//! | full brakes from 30 to 120 km/h, mu 0.2 to 0.8 | exact | at most 0.9 % longer | v²/(2 mu g) |
//! | the same by the step | exact | at most 0.4 % | no change |
//! | 6 m/s² commanded from 50 km/h | 16.08 m | 16.08 m | 16.07 to 16.94 m over the CommonRoad models |
//! | radius of the middle's way at 0.03 rad, 5 to 20 m/s, mu 1.05 | 85.9 to 86.4 m | 85.9 to 86.7 m | 85.9 m |
//! | the same, mu 0.6 | 85.9 to 87.2 m | 85.9 to 87.1 m | |
//! | understeer gradient over these speeds, mu 1.05 | 0.014 mrad s²/m | 0.040 mrad s²/m | nearly neutral |
//! | greatest side acceleration at 20 m/s, mu 0.2 to 0.8 | 0.983 to 0.999 mu g | 0.990 to 0.999 mu g | mu g |
//! | drift in 60 s at rest | none | less than 1 nm | none |
//! | time to 40, 60, 80, 100 km/h, mu 0.6 to 1.05 | at most 0.1 % longer | 0.4 to 1.6 % longer | traction, then constant power |
//!
//! In degrees per g of side acceleration the understeer gradients are 0.008 and 0.023. Cars have some 1 to 3, but the
//! tyres of the source, which are as stiff by load on one axle as on the other, make a neutral car of it. What is left
//! comes with the slip angle: a part of the side acceleration is along the car, and loads the rear axle.

mod flaw;
mod jointed;
mod motion;
mod parameters;
mod single_track;
mod tyre;

pub use flaw::VehicleFlaw;
pub use jointed::Jointed;
pub use motion::Motion;
pub use parameters::{Drive, Vehicle};
pub use single_track::SingleTrack;

use crate::geometry::Pose;
use nalgebra::Vector2;
use serde::{Deserialize, Serialize};
use std::fmt;
use thiserror::Error;

/// Standard gravity in m/s².
pub const GRAVITY: f64 = 9.80665;

/// What the one who drives does with hands and feet.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Pedals {
    /// From -1, full brakes, to 1, full power.
    pub throttle: f64,
    /// From -1, the front wheels turned to the right as far as they go, to 1, to the left.
    pub steering: f64,
}

/// How the car stands and moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VehicleState {
    /// The middle of its box, in metres.
    pub position: Vector2<f64>,
    /// Radians, counter-clockwise from x; not wrapped.
    pub heading: f64,
    /// Of the middle of its box in m/s, as seen from the car: x ahead, y to the left.
    pub velocity: Vector2<f64>,
    /// Radians per second, counter-clockwise.
    pub yaw_rate: f64,
    /// How far the front wheels are turned to the left, in radians; where they differ, what a wheel between them would have.
    pub steering_angle: f64,
    /// Of the centre of gravity in m/s² over the last step, as seen from the car: x ahead, y to the left.
    pub acceleration: Vector2<f64>,
    /// The length of the way it has come, in metres.
    pub travelled: f64,
}

/// One wheel on the road.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Wheel {
    /// How much faster its tread goes than the road under it, by the greater of both speeds: -1 where it is locked, 0
    /// where it rolls, 1 where it spins on the spot.
    pub slip_ratio: f64,
    /// The angle in radians from where it points to where it goes: positive where it slips to its left.
    pub slip_angle: f64,
    /// What it carries, in newtons.
    pub load: f64,
    /// Whether it touches the road.
    pub contact: bool,
}

/// A model of how a car moves.
pub trait Dynamics: Send {
    /// Moves on by `dt` seconds with these pedals on a road of this friction.
    ///
    /// Pedals out of their range count as the end of the range. A state that any input has made no number stays none:
    /// whoever steps has to look at [`VehicleState::is_finite`].
    fn step(&mut self, pedals: Pedals, friction: f64, dt: f64);

    /// How the car stands and moves now.
    fn state(&self) -> &VehicleState;

    /// Its wheels: front left, front right, rear left, rear right.
    fn wheels(&self) -> [Wheel; 4];
}

/// Which model moves a car.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum VehicleModel {
    /// [`SingleTrack`].
    #[default]
    SingleTrack,
    /// [`Jointed`].
    Jointed,
}

impl VehicleModel {
    /// All there are.
    pub const ALL: [VehicleModel; 2] = [VehicleModel::SingleTrack, VehicleModel::Jointed];

    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            VehicleModel::SingleTrack => "single-track",
            VehicleModel::Jointed => "jointed",
        }
    }

    /// The model of that name.
    ///
    /// # Errors
    /// There is none.
    pub fn find(name: &str) -> Result<Self, UnknownModel> {
        Self::ALL.into_iter().find(|model| model.name() == name).ok_or_else(|| UnknownModel { name: name.to_owned() })
    }

    /// A car of this model whose middle has the pose `start`, going straight ahead at `speed` m/s.
    ///
    /// # Panics
    /// The vehicle has a [`Vehicle::flaw`].
    pub fn build(self, vehicle: &Vehicle, start: Pose, speed: f64) -> Box<dyn Dynamics> {
        match self {
            VehicleModel::SingleTrack => Box::new(SingleTrack::new(vehicle, start, speed)),
            VehicleModel::Jointed => Box::new(Jointed::new(vehicle, start, speed)),
        }
    }
}

/// No model of a car has that name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("no vehicle is called `{name}`, expected `single-track` or `jointed`")]
pub struct UnknownModel {
    /// The name that was looked for.
    pub name: String,
}

impl fmt::Display for VehicleModel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl Pedals {
    /// The same within their range.
    fn clamped(self) -> Self {
        Self { throttle: self.throttle.clamp(-1.0, 1.0), steering: self.steering.clamp(-1.0, 1.0) }
    }
}

impl VehicleState {
    /// A car that goes straight ahead.
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

    /// Where it stands, and how it is turned.
    pub fn pose(&self) -> Pose {
        Pose { position: self.position, heading: self.heading }
    }

    /// How fast its middle moves, in m/s.
    pub fn speed(&self) -> f64 {
        self.velocity.norm()
    }

    /// Whether all of it are numbers.
    pub fn is_finite(&self) -> bool {
        let motion = self.velocity.sum() + self.acceleration.sum() + self.yaw_rate + self.steering_angle;
        (self.position.sum() + self.heading + self.travelled + motion).is_finite()
    }

    /// Whether a step from here makes sense; if not, this becomes a state that is no number.
    fn accepts(&mut self, pedals: Pedals, friction: f64, dt: f64) -> bool {
        let inputs = pedals.throttle + pedals.steering + friction;
        let accepted = inputs.is_finite() && friction >= 0.0 && dt > 0.0 && self.is_finite();
        if !accepted {
            self.lose();
        }
        accepted
    }

    /// Becomes a state that is no number.
    fn lose(&mut self) {
        let nothing = Vector2::repeat(f64::NAN);
        (self.position, self.velocity, self.acceleration) = (nothing, nothing, nothing);
        (self.heading, self.yaw_rate, self.travelled) = (f64::NAN, f64::NAN, f64::NAN);
    }

    /// Turns the front wheels towards where the one who steers wants them.
    fn steer(&mut self, vehicle: &Vehicle, steering: f64, dt: f64) {
        let most = vehicle.max_steering_rate * dt;
        self.steering_angle += (steering * vehicle.max_steering_angle - self.steering_angle).clamp(-most, most);
    }
}

#[cfg(test)]
mod tests;
