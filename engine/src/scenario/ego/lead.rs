//! The lead of a scenario over the ego vehicle: until the scenario hands the car over, the car moves as the scenario says.
//!
//! A scenario of a file drives its ego vehicle itself, up to the moment at which the file activates the controller. An object
//! of the scenario holds a [`Lead`], says at every tick where the car is next, and hands the car over.

use crate::vehicle::{Dynamics, Pedals, VehicleState, Wheel};
use nalgebra::Vector2;
use paracosm_road::Pose;
use std::cell::Cell;
use std::rc::Rc;

/// The lead over the ego vehicle. The handle is cheap to clone; all clones lead the same car.
#[derive(Debug, Clone, Default)]
pub struct Lead(Rc<Shared>);

#[derive(Debug, Default)]
struct Shared {
    next: Cell<Option<LedMotion>>,
    handed_over: Cell<bool>,
    driven: Cell<Option<LedMotion>>,
}

/// The motion of a car that a scenario leads.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LedMotion {
    /// The position of the car's middle, and the car's heading.
    pub pose: Pose,
    /// The speed of the car in m/s along its heading; negative if the car moves backwards.
    pub speed: f64,
}

impl Lead {
    /// Makes a lead over a car that is not placed yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Says where the car is at the end of this tick. It has no effect once the driver has the car.
    pub fn to(&self, motion: LedMotion) {
        self.0.next.set(Some(motion));
    }

    /// Hands the car over to the driver from this tick on, if the run lets the driver have the car.
    pub fn hand_over(&self) {
        self.0.handed_over.set(true);
    }

    /// Returns the present motion of the car if the driver has the car; `None` while the scenario leads the car.
    pub fn driven(&self) -> Option<LedMotion> {
        self.0.driven.get()
    }

    pub(super) fn next(&self) -> Option<LedMotion> {
        self.0.next.get()
    }

    pub(super) fn is_handed_over(&self) -> bool {
        self.0.handed_over.get()
    }

    pub(super) fn show(&self, motion: LedMotion) {
        self.0.driven.set(Some(motion));
    }
}

/// The motion of a car that goes where a scenario says: its wheels roll, whatever the speed.
#[derive(Debug)]
pub(super) struct Led {
    state: VehicleState,
}

impl Led {
    pub fn new(motion: LedMotion) -> Self {
        let LedMotion { pose, speed } = motion;
        let state = VehicleState {
            position: pose.position,
            heading: pose.heading,
            velocity: Vector2::new(speed, 0.0),
            yaw_rate: 0.0,
            steering_angle: 0.0,
            acceleration: Vector2::zeros(),
            travelled: 0.0,
        };
        Self { state }
    }

    /// Moves the car to the end of a tick of `dt` seconds.
    pub fn follow(&mut self, motion: LedMotion, dt: f64) {
        let LedMotion { pose, speed } = motion;
        let before = self.state;
        let yaw_rate = paracosm_road::wrapped(pose.heading - before.heading) / dt;
        self.state = VehicleState {
            position: pose.position,
            heading: before.heading + yaw_rate * dt,
            velocity: Vector2::new(speed, 0.0),
            yaw_rate,
            steering_angle: 0.0,
            acceleration: Vector2::new((speed - before.velocity.x) / dt, speed * yaw_rate),
            travelled: before.travelled + (pose.position - before.position).norm(),
        };
    }
}

impl Dynamics for Led {
    /// Does nothing: the scenario moves the car.
    fn step(&mut self, _: Pedals, _: f64, _: f64) {}

    fn state(&self) -> &VehicleState {
        &self.state
    }

    fn wheels(&self) -> [Wheel; 4] {
        [Wheel { contact: true, ..Wheel::default() }; 4]
    }
}
