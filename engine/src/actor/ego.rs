//! The car under test: as programs place it and read it, and as it moves.

use crate::object::{Body, BodyState, Class, Output, Outputs};
use crate::observation::{Briefing, Control};
use crate::scenario::{Line, Place, Pose, Scenario};
use crate::stream::Stream;
use crate::vehicle::{Motion, Vehicle};
use nalgebra::Vector2;

/// The car that the system under test drives, not placed yet: a [`Vehicle::BMW_320I`].
#[derive(Debug, Clone, Copy)]
pub struct AutonomousVehicle {
    vehicle: Vehicle,
    start: Pose,
    speed: f64,
}

/// What a run needs of the placed car.
#[derive(Debug, Clone)]
pub(crate) struct EgoSetup {
    car: AutonomousVehicle,
    shown: Shown,
}

/// Its outputs.
#[derive(Debug, Clone)]
struct Shown {
    position: Output<Vector2<f64>>,
    x: Output<f64>,
    y: Output<f64>,
    speed: Output<f64>,
    acceleration: Output<f64>,
    throttle: Output<f64>,
    travelled: Output<f64>,
    clearance: Output<f64>,
}

/// The placed car: its outputs.
#[derive(Debug, Clone)]
pub struct Car {
    vehicle: Vehicle,
    shown: Shown,
}

/// The car in motion.
#[derive(Debug)]
pub(crate) struct Ego {
    car: AutonomousVehicle,
    shown: Shown,
    pub motion: Motion,
    pub control: Control,
}

impl AutonomousVehicle {
    /// A car that stands at `start`, which is where its middle is.
    pub fn at(start: Pose) -> Self {
        Self { vehicle: Vehicle::BMW_320I, start, speed: 0.0 }
    }

    /// The speed in m/s at which it starts, and which its driver is told to keep.
    pub fn speed(mut self, speed: f64) -> Self {
        self.speed = speed;
        self
    }
}

impl Place for AutonomousVehicle {
    type Handle = Car;

    fn place(self, scenario: &mut Scenario) -> Car {
        let (speed, most) = (self.speed, self.vehicle.max_speed);
        let mut draft = scenario.object("car");
        if !(0.0..=most).contains(&speed) {
            draft.problem(&format!("has the speed {speed} m/s, expected 0 to {most}"));
        }
        let shown = Shown {
            position: draft.output("position"),
            x: draft.signal("x"),
            y: draft.signal("y"),
            speed: draft.signal("speed"),
            acceleration: draft.signal("acceleration"),
            throttle: draft.signal("throttle"),
            travelled: draft.signal("travelled"),
            clearance: draft.signal("clearance"),
        };
        scenario.cars.push(EgoSetup { car: self, shown: shown.clone() });
        Car { vehicle: self.vehicle, shown }
    }
}

impl Car {
    /// Where its middle is.
    pub fn position(&self) -> Stream<Vector2<f64>> {
        self.shown.position.stream()
    }

    /// Its speed in m/s.
    pub fn speed(&self) -> Stream<f64> {
        self.shown.speed.stream()
    }

    /// The length of the way it has come, in metres.
    pub fn travelled(&self) -> Stream<f64> {
        self.shown.travelled.stream()
    }

    /// Metres of free space to the nearest other body. Once it touches one: minus the braking distance that
    /// was missing, max(v²/(2 μ g), 0.001) with v the speed of one body relative to the other.
    pub fn clearance(&self) -> Stream<f64> {
        self.shown.clearance.stream()
    }

    /// Whether it touches another body.
    pub fn collides(&self) -> Stream<bool> {
        self.clearance().at_most(0.0)
    }

    /// How far the line is ahead of its front bumper, in metres.
    pub fn gap_along(&self, line: &Line) -> Stream<f64> {
        self.position().distance_to(line) - 0.5 * self.vehicle.length
    }
}

impl Ego {
    pub fn new(setup: &EgoSetup) -> Self {
        let motion = Motion { speed: setup.car.speed, ..Motion::default() };
        Self { car: setup.car, shown: setup.shown.clone(), motion, control: Control::default() }
    }

    /// What its driver has to know beforehand.
    pub fn briefing(&self) -> Briefing {
        Briefing { cruise_speed: self.car.speed, vehicle: self.car.vehicle }
    }

    /// Its body where it starts.
    pub fn body(&self) -> BodyState {
        let Vehicle { length, width, height, .. } = self.car.vehicle;
        let velocity = self.car.start.forward() * self.motion.speed;
        let body = Body::block(Class::Car, length, width, height);
        BodyState { velocity, ..BodyState::at_rest(body, self.car.start) }
    }

    pub fn pose(&self) -> Pose {
        let start = self.car.start;
        Pose { position: start.position + start.forward() * self.motion.travelled, ..start }
    }

    /// Its velocity over the ground in m/s.
    pub fn velocity(&self) -> Vector2<f64> {
        self.car.start.forward() * self.motion.speed
    }

    /// Shows its outputs; `clearance` as [`Car::clearance`] says.
    pub fn show(&self, clearance: f64, outputs: &mut Outputs<'_>) {
        let position = self.pose().position;
        outputs.set(&self.shown.position, position);
        outputs.set(&self.shown.x, position.x);
        outputs.set(&self.shown.y, position.y);
        outputs.set(&self.shown.speed, self.motion.speed);
        outputs.set(&self.shown.acceleration, self.motion.acceleration);
        outputs.set(&self.shown.throttle, self.control.throttle);
        outputs.set(&self.shown.travelled, self.motion.travelled);
        outputs.set(&self.shown.clearance, clearance);
    }

    /// Moves on by a tick over ground of this friction.
    pub fn step(&mut self, friction: f64, dt: f64) -> Result<(), String> {
        let throttle = self.control.throttle;
        if !(-1.0..=1.0).contains(&throttle) {
            return Err(format!("the driver's throttle is {throttle}, expected -1 to 1"));
        }
        let demand = self.car.vehicle.acceleration(throttle, self.motion.speed, friction);
        self.motion = self.motion.after(demand, dt);
        Ok(())
    }
}
