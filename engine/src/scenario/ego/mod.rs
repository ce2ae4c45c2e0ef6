//! The car under test: as programs place it and read it, and as it moves.

mod quantity;
mod right_of_way;

use super::{Place, Scenario};
use crate::flaw::ObjectFlaw;
use crate::geometry::wrapped;
use crate::geometry::{Line, Pose};
use crate::object::{Body, BodyState, Class, Output, Outputs};
use crate::observation::{Ahead, Briefing, Control, Way};
use crate::road::{LaneId, Path, RoadNetwork};
use crate::stream::Stream;
use crate::upset::Upset;
use crate::vehicle::{Dynamics, Pedals, Vehicle, VehicleModel};
use nalgebra::Vector2;
use quantity::{Asked, Quantity};
use std::rc::Rc;

/// Speed in m/s below which a car stands.
const STANDING: f64 = 0.1;

/// The car that the system under test drives, not placed yet: a [`Vehicle::BMW_320I`].
#[derive(Debug, Clone)]
pub struct AutonomousVehicle {
    vehicle: Vehicle,
    way: Path,
    /// Whether it is just to go straight on, without an end.
    endless: bool,
    start: f64,
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
    heading: Output<f64>,
    speed: Output<f64>,
    acceleration: Output<f64>,
    throttle: Output<f64>,
    steering: Output<f64>,
    travelled: Output<f64>,
    clearance: Output<f64>,
    asked: Rc<Asked>,
}

impl EgoSetup {
    /// The middle and the radius in metres of a disc around the car where it starts.
    pub fn disc(&self) -> (Vector2<f64>, f64) {
        (self.car.start().position, 0.5 * (self.car.vehicle.length + self.car.vehicle.width))
    }
}

/// The placed car: its outputs.
#[derive(Debug, Clone)]
pub struct Car {
    vehicle: Vehicle,
    shown: Shown,
}

/// The car in motion.
pub(crate) struct Ego {
    car: AutonomousVehicle,
    shown: Shown,
    pub dynamics: Box<dyn Dynamics>,
    pub control: Control,
    /// Metres along its way.
    at: f64,
    /// How its acceleration ahead changed over the last tick, in m/s³.
    pub(super) jerk: f64,
    /// For how many seconds it has been standing.
    pub(super) standing: f64,
}

impl AutonomousVehicle {
    /// A car that stands at `start`, which is where its middle is, and is to go straight on.
    pub fn at(start: Pose) -> Self {
        let ahead = Path::straight(start.position, start.position + start.forward());
        Self { endless: true, ..Self::along(ahead) }
    }

    /// A car that stands at the beginning of a path, which is the way that it is to go.
    pub fn along(way: Path) -> Self {
        Self { vehicle: Vehicle::BMW_320I, way, endless: false, start: 0.0, speed: 0.0 }
    }

    /// How many metres along its way its middle is at first.
    pub fn starting(mut self, at: f64) -> Self {
        self.start = at;
        self
    }

    /// The speed in m/s at which it starts, and which its driver is told to keep.
    pub fn speed(mut self, speed: f64) -> Self {
        self.speed = speed;
        self
    }

    /// What it is made of, instead of a [`Vehicle::BMW_320I`].
    pub fn vehicle(mut self, vehicle: Vehicle) -> Self {
        self.vehicle = vehicle;
        self
    }

    fn start(&self) -> Pose {
        self.way.at(self.start)
    }
}

impl Place for AutonomousVehicle {
    type Handle = Car;

    fn place(self, scenario: &mut Scenario) -> Car {
        let (speed, most) = (self.speed, self.vehicle.max_speed);
        let asked = Rc::new(Asked::new(scenario.wiring.clone()));
        let mut draft = scenario.object("car");
        if let Some(flaw) = self.vehicle.flaw() {
            draft.flaw(flaw.into());
        }
        if let Some(piece) = self.way.wrong_piece() {
            draft.flaw(ObjectFlaw::Piece { line: "way", piece });
        }
        let length = self.way.length();
        if !(0.0..=length).contains(&self.start) {
            draft.flaw(ObjectFlaw::Start { line: "way", start: self.start, length });
        }
        if !(0.0..=most).contains(&speed) {
            draft.flaw(ObjectFlaw::Speed { speed, most });
        }
        let shown = Shown {
            position: draft.output("position"),
            x: draft.signal("x"),
            y: draft.signal("y"),
            heading: draft.signal("heading"),
            speed: draft.signal("speed"),
            acceleration: draft.signal("acceleration"),
            throttle: draft.signal("throttle"),
            steering: draft.signal("steering"),
            travelled: draft.signal("travelled"),
            clearance: draft.signal("clearance"),
            asked,
        };
        let vehicle = self.vehicle;
        scenario.cars.push(EgoSetup { car: self, shown: shown.clone() });
        Car { vehicle, shown }
    }
}

impl Car {
    /// Where its middle is.
    pub fn position(&self) -> Stream<Vector2<f64>> {
        self.shown.position.stream()
    }

    /// Where it points, in radians in (-π, π], counter-clockwise from x.
    pub fn heading(&self) -> Stream<f64> {
        self.shown.heading.stream()
    }

    /// Its speed in m/s.
    pub fn speed(&self) -> Stream<f64> {
        self.shown.speed.stream()
    }

    /// Its acceleration ahead in m/s², over the last tick.
    pub fn acceleration(&self) -> Stream<f64> {
        self.shown.acceleration.stream()
    }

    /// The length of the way it has come, in metres.
    pub fn travelled(&self) -> Stream<f64> {
        self.shown.travelled.stream()
    }

    /// Metres of free space to the nearest other body that does not stand on the [`Roadside`](crate::Roadside). Once it touches one: minus the braking distance that
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

    /// Its acceleration to the left in m/s².
    pub fn lateral_acceleration(&self) -> Stream<f64> {
        self.asked(Quantity::LateralAcceleration)
    }

    /// How fast it turns to the left, in rad/s.
    pub fn yaw_rate(&self) -> Stream<f64> {
        self.asked(Quantity::YawRate)
    }

    /// How its acceleration ahead changes, in m/s³.
    pub fn jerk(&self) -> Stream<f64> {
        self.asked(Quantity::Jerk)
    }

    /// The greatest slip ratio of its wheels, either way: 0 where all roll, 1 where one is locked or spins on the spot.
    pub fn wheel_slip(&self) -> Stream<f64> {
        self.asked(Quantity::WheelSlip)
    }

    /// The greatest slip angle of its wheels, to either side, in radians.
    pub fn slip_angle(&self) -> Stream<f64> {
        self.asked(Quantity::SlipAngle)
    }

    /// How many of its wheels touch the road.
    pub fn wheels_on_road(&self) -> Stream<f64> {
        self.asked(Quantity::WheelsOnRoad)
    }

    /// Seconds until it meets another body if both keep their velocities, the least over all of them; infinite if none.
    pub fn time_to_collision(&self) -> Stream<f64> {
        self.asked(Quantity::TimeToCollision)
    }

    /// Seconds that it takes at its speed to where the nearest body straight ahead is now; infinite without any.
    pub fn headway(&self) -> Stream<f64> {
        self.asked(Quantity::Headway)
    }

    /// Metres of its lane that are left beside it, on the side where fewer are; negative where it is over the edge.
    pub fn lane_margin(&self) -> Stream<f64> {
        self.asked(Quantity::LaneMargin)
    }

    /// Seconds until another that has the right of way comes to a place of an intersection where the car is: infinite
    /// while the car is in nobody's way.
    pub fn right_of_way(&self) -> Stream<f64> {
        self.asked(Quantity::RightOfWay)
    }

    /// How far it is to the left of the way that it is to go, in metres.
    pub fn way_offset(&self) -> Stream<f64> {
        self.asked(Quantity::WayOffset)
    }

    /// For how many seconds it has been standing: 0 while it moves.
    pub fn standing_time(&self) -> Stream<f64> {
        self.asked(Quantity::StandingTime)
    }

    /// Metres to the end of the way that it is to go; infinite where it is just to go straight on.
    pub fn remaining(&self) -> Stream<f64> {
        self.asked(Quantity::Remaining)
    }

    fn asked(&self, quantity: Quantity) -> Stream<f64> {
        self.shown.asked.stream(quantity)
    }
}

impl Ego {
    /// The car as a model moves it.
    pub fn new(setup: &EgoSetup, model: VehicleModel) -> Self {
        let EgoSetup { car, shown } = setup.clone();
        let dynamics = model.build(&car.vehicle, car.start(), car.speed);
        Self { at: car.start, car, shown, dynamics, control: Control::default(), jerk: 0.0, standing: 0.0 }
    }

    /// What its driver has to know beforehand.
    pub fn briefing(&self) -> Briefing {
        Briefing { cruise_speed: self.car.speed, vehicle: self.car.vehicle }
    }

    /// Its body where it is.
    pub fn body(&self) -> BodyState {
        let Vehicle { length, width, height, .. } = self.car.vehicle;
        let body = Body::block(Class::Car, length, width, height);
        BodyState { velocity: self.velocity(), ..BodyState::at_rest(body, self.pose()) }
    }

    pub fn pose(&self) -> Pose {
        self.dynamics.state().pose()
    }

    /// Its velocity over the ground in m/s.
    pub fn velocity(&self) -> Vector2<f64> {
        self.pose().turn_to_plane(self.dynamics.state().velocity)
    }

    /// What is left of the way that it is to go; none where it is just to go straight on.
    pub fn plan(&self) -> Option<Path> {
        (!self.car.endless).then(|| self.car.way.piece(self.at, self.car.way.length()))
    }

    /// How far it is to the left of its way, in metres.
    pub fn way_offset(&self) -> f64 {
        self.car.way.at(self.at).to_local(self.pose().position).y
    }

    /// Metres to the end of its way; infinite where it is just to go straight on.
    pub fn remaining(&self) -> f64 {
        if self.car.endless { f64::INFINITY } else { self.car.way.length() - self.at }
    }

    /// The lanes that it is on, with how many metres along each: those of its way, from its rear to its front, or where its
    /// way knows none the nearest that leads where it points.
    pub fn lanes<'n>(&self, network: &'n RoadNetwork) -> impl Iterator<Item = (LaneId, f64)> + use<'n> {
        let half = 0.5 * self.car.vehicle.length;
        let known = self.car.way.lanes(self.at - half, self.at + half);
        let pose = self.pose();
        let nearest = if known.len() == 0 { network.project_along(&pose) } else { None };
        let lanes = known.chain(nearest.map(|seen| seen.lane));
        lanes.map(move |lane| (lane, network.project_onto(lane, pose.position).s))
    }

    /// Where it is as seen from where it began.
    pub fn odometry(&self) -> Pose {
        self.car.start().relative(&self.pose())
    }

    /// Its way as it sees it.
    pub fn way(&self) -> Way {
        let (pose, here) = (self.pose(), self.car.way.at(self.at));
        let ahead = std::array::from_fn(|i| {
            let s = self.at + Way::SPACING * (i + 1) as f64;
            Ahead { position: pose.to_local(self.car.way.at(s).position), curvature: self.car.way.curvature(s) }
        });
        let offset = here.to_local(pose.position).y;
        Way { offset, heading: wrapped(pose.heading - here.heading), ahead }
    }

    /// Shows its outputs; `clearance` as [`Car::clearance`] says, and the car as the first of the bodies.
    pub fn show(&self, clearance: f64, bodies: &[BodyState], network: &RoadNetwork, outputs: &mut Outputs<'_>) {
        let state = self.dynamics.state();
        outputs.set(&self.shown.position, state.position);
        outputs.set(&self.shown.x, state.position.x);
        outputs.set(&self.shown.y, state.position.y);
        outputs.set(&self.shown.heading, wrapped(state.heading));
        outputs.set(&self.shown.speed, state.speed());
        outputs.set(&self.shown.acceleration, state.acceleration.x);
        outputs.set(&self.shown.throttle, self.control.throttle);
        outputs.set(&self.shown.steering, self.control.steering);
        outputs.set(&self.shown.travelled, state.travelled);
        outputs.set(&self.shown.clearance, clearance);
        self.shown.asked.show(self, bodies, network, outputs);
    }

    /// Moves on by a tick over ground of this friction.
    pub fn step(&mut self, friction: f64, dt: f64) -> Result<(), Upset> {
        let Control { throttle, steering } = self.control;
        for (what, value) in [("throttle", throttle), ("steering", steering)] {
            if !(-1.0..=1.0).contains(&value) {
                return Err(Upset::Control { what, value });
            }
        }
        let before = self.dynamics.state().acceleration.x;
        self.dynamics.step(Pedals { throttle, steering }, friction, dt);
        let state = self.dynamics.state();
        if !state.is_finite() {
            return Err(Upset::Car(Box::new(*state)));
        }
        self.jerk = (state.acceleration.x - before) / dt;
        self.standing = if state.speed() < STANDING { self.standing + dt } else { 0.0 };
        self.at = self.car.way.nearest(state.position, self.at);
        Ok(())
    }
}
