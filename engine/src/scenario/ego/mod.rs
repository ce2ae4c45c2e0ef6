//! The ego vehicle, with its place and its outputs in a program, and with its motion in a run.

mod lead;
mod quantity;
mod right_of_way;

use super::{Place, Scenario};
use crate::flaw::ObjectFlaw;
use crate::line::Line;
use crate::object::{Body, BodyState, Class, Output, Outputs};
use crate::observation::{Ahead, Briefing, Control, Navigation, Way};
use crate::road::{LaneId, Path, RoadNetwork};
use crate::signal::{Quantity, ROAD_USERS};
use crate::stream::{Source, Stream};
use crate::upset::Upset;
use crate::vehicle::{Dynamics, Pedals, Vehicle, VehicleSetup};
use lead::Led;
pub use lead::{Lead, LedMotion};
use nalgebra::Vector2;
use paracosm_road::Pose;
use paracosm_road::wrapped;
use quantity::Asked;
use std::rc::Rc;
use std::sync::Arc;

/// The speed in m/s below which the car counts as standing.
const STANDING: f64 = 0.1;

/// The car that the system under test drives, not placed yet. The default is a [`Vehicle::BMW_320I`].
#[derive(Debug, Clone)]
pub struct AutonomousVehicle {
    vehicle: Vehicle,
    way: Path,
    /// True if the car is to go straight on, without an end.
    endless: bool,
    start: f64,
    speed: f64,
    lead: Option<Lead>,
}

/// The data of the placed car that a run needs.
#[derive(Debug, Clone)]
pub(crate) struct EgoSetup {
    car: AutonomousVehicle,
    shown: Shown,
}

/// The outputs of the car.
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
    /// Measures a quantity in the run, and returns its name and the place of its values.
    pub fn record(&self, quantity: Quantity) -> (String, Source) {
        (quantity.name().to_owned(), self.shown.asked.output(quantity).source())
    }

    /// Returns the middle and the radius in metres of a disc around the car at its start.
    pub fn disc(&self) -> (Vector2<f64>, f64) {
        (self.car.start().position, 0.5 * (self.car.vehicle.length + self.car.vehicle.width))
    }
}

/// The placed ego vehicle, whose outputs a program can read.
#[derive(Debug, Clone)]
pub struct Car {
    vehicle: Vehicle,
    shown: Shown,
}

/// The ego vehicle in a run, which moves from tick to tick.
pub(crate) struct Ego {
    car: AutonomousVehicle,
    shown: Shown,
    setup: VehicleSetup,
    dynamics: Box<dyn Dynamics>,
    /// The lead of the scenario, and the motion that it gives the car; `None` if the driver has the car.
    led: Option<(Lead, Led)>,
    /// The distance in metres over which the scenario led the car before the driver got it.
    led_metres: f64,
    pub control: Control,
    /// The car's position along its way, in metres.
    at: f64,
    /// The change of the car's forward acceleration over the last tick, in m/s³.
    pub(super) jerk: f64,
    /// The seconds for which the car has been standing.
    pub(super) standing: f64,
}

impl AutonomousVehicle {
    /// Makes a car that starts with its middle at `start` and is to go straight on.
    pub fn at(start: Pose) -> Self {
        let ahead = Path::straight(start.position, start.position + start.forward());
        Self { endless: true, ..Self::along(ahead) }
    }

    /// Makes a car at the beginning of a path, which is the way that the car is to go.
    pub fn along(way: Path) -> Self {
        Self { vehicle: Vehicle::BMW_320I, way, endless: false, start: 0.0, speed: 0.0, lead: None }
    }

    /// Sets the place at which the car's middle starts, in metres along the car's way.
    pub fn starting(mut self, at: f64) -> Self {
        self.start = at;
        self
    }

    /// Sets the speed in m/s at which the car starts and that its driver is to keep. The speed is a number, for example
    /// [`Param::value`](crate::Param::value): the driver changes the speed later. A [`Mover`](crate::Mover) has no driver, so its speed is a
    /// stream.
    pub fn speed(mut self, speed: f64) -> Self {
        self.speed = speed;
        self
    }

    /// Sets the vehicle; the default is a [`Vehicle::BMW_320I`].
    pub fn vehicle(mut self, vehicle: Vehicle) -> Self {
        self.vehicle = vehicle;
        self
    }

    /// Lets the scenario lead the car until it hands the car over to the driver.
    pub fn led_by(mut self, lead: &Lead) -> Self {
        self.lead = Some(lead.clone());
        self
    }

    fn start(&self) -> Pose {
        let led = self.lead.as_ref().and_then(Lead::next);
        led.map_or_else(|| self.way.at(self.start), |motion| motion.pose)
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
    /// Returns the position of the car's middle.
    pub fn position(&self) -> Stream<Vector2<f64>> {
        self.shown.position.stream()
    }

    /// Returns the car's heading, in radians in (-π, π], counter-clockwise from x.
    pub fn heading(&self) -> Stream<f64> {
        self.shown.heading.stream()
    }

    /// Returns the car's speed in m/s.
    pub fn speed(&self) -> Stream<f64> {
        self.shown.speed.stream()
    }

    /// Returns the car's forward acceleration over the last tick, in m/s².
    pub fn acceleration(&self) -> Stream<f64> {
        self.shown.acceleration.stream()
    }

    /// Returns the distance that the car has covered, in metres.
    pub fn travelled(&self) -> Stream<f64> {
        self.shown.travelled.stream()
    }

    /// Returns the distance to the nearest other body in metres; bodies on the [`Roadside`](crate::Roadside) do not
    /// count. At a contact: minus the missing braking distance, max(v²/(2 μ g), 0.001), with v the speed at which the
    /// car and the body close along the heading of the car, or 0 if they do not close.
    pub fn clearance(&self) -> Stream<f64> {
        self.shown.clearance.stream()
    }

    /// Returns the distance to the nearest road user of a class in metres; infinite without one. At a contact with such a road user it is
    /// the same number as [`clearance`](Self::clearance). Bodies that are no road users, such as buildings, have no clearance of their own:
    /// the stream is that of all bodies then.
    pub fn clearance_to(&self, class: Class) -> Stream<f64> {
        match ROAD_USERS.iter().position(|(known, ..)| *known == class) {
            Some(index) => self.asked(Quantity::Clearance(index)),
            None => self.clearance(),
        }
    }

    /// Returns a stream that is true while the car touches another body.
    pub fn collides(&self) -> Stream<bool> {
        self.clearance().at_most(0.0)
    }

    /// Returns the distance in metres from the car's front bumper to a line ahead; negative beyond the line.
    pub fn gap_along(&self, line: &Line) -> Stream<f64> {
        self.position().distance_to(line) - 0.5 * self.vehicle.length
    }

    /// Returns the car's acceleration to the left in m/s².
    pub fn lateral_acceleration(&self) -> Stream<f64> {
        self.asked(Quantity::LateralAcceleration)
    }

    /// Returns the car's yaw rate, to the left, in rad/s.
    pub fn yaw_rate(&self) -> Stream<f64> {
        self.asked(Quantity::YawRate)
    }

    /// Returns the rate at which the car's forward acceleration changes, in m/s³.
    pub fn jerk(&self) -> Stream<f64> {
        self.asked(Quantity::Jerk)
    }

    /// Returns the greatest absolute slip ratio of the car's wheels; 0 if all wheels roll, 1 if a wheel is locked or
    /// spins in place.
    pub fn wheel_slip(&self) -> Stream<f64> {
        self.asked(Quantity::WheelSlip)
    }

    /// Returns the greatest absolute slip angle of the car's wheels, in radians.
    pub fn slip_angle(&self) -> Stream<f64> {
        self.asked(Quantity::SlipAngle)
    }

    /// Returns the number of the car's wheels that touch the road.
    pub fn wheels_on_road(&self) -> Stream<f64> {
        self.asked(Quantity::WheelsOnRoad)
    }

    /// Returns the least time to collision with another body, in seconds; infinite without a collision course.
    pub fn time_to_collision(&self) -> Stream<f64> {
        self.asked(Quantity::TimeToCollision)
    }

    /// Returns the time headway in seconds, which is the time that the car takes to the present place of the nearest
    /// body straight ahead; infinite without such a body.
    pub fn headway(&self) -> Stream<f64> {
        self.asked(Quantity::Headway)
    }

    /// Returns the free width of the lane beside the car on the narrower side, in metres; negative beyond the edge.
    pub fn lane_margin(&self) -> Stream<f64> {
        self.asked(Quantity::LaneMargin)
    }

    /// Returns the seconds until a road user with the right of way comes to the car's place in an intersection;
    /// infinite if no road user comes.
    pub fn right_of_way(&self) -> Stream<f64> {
        self.asked(Quantity::RightOfWay)
    }

    /// Returns the distance of the car from the way that the car is to go, in metres, positive to the left of the way.
    pub fn way_offset(&self) -> Stream<f64> {
        self.asked(Quantity::WayOffset)
    }

    /// Returns the seconds for which the car has been standing; 0 while the car moves.
    pub fn standing_time(&self) -> Stream<f64> {
        self.asked(Quantity::StandingTime)
    }

    /// Returns the metres to the end of the way that the car is to go; infinite if the way has no end.
    pub fn remaining(&self) -> Stream<f64> {
        self.asked(Quantity::Remaining)
    }

    fn asked(&self, quantity: Quantity) -> Stream<f64> {
        self.shown.asked.stream(quantity)
    }
}

impl Ego {
    /// Makes the ego vehicle of a run with the given model of its motion.
    pub fn new(setup: &EgoSetup, vehicle: VehicleSetup) -> Self {
        let EgoSetup { car, shown } = setup.clone();
        let dynamics = vehicle.build(&car.vehicle, car.start(), car.speed);
        let led = car.lead.clone().map(|lead| (lead, Led::new(LedMotion { pose: car.start(), speed: car.speed })));
        let (at, control) = (car.start, Control::default());
        Self { at, car, shown, setup: vehicle, dynamics, led, led_metres: 0.0, control, jerk: 0.0, standing: 0.0 }
    }

    /// Returns the briefing of the car's driver, with the map of the given roads.
    pub fn briefing(&self, network: &Arc<RoadNetwork>) -> Briefing {
        let AutonomousVehicle { vehicle, speed, start, .. } = self.car;
        let navigation = Navigation { network: network.clone(), way: self.car.way.clone(), start };
        Briefing { cruise_speed: speed, vehicle, navigation: Some(navigation) }
    }

    /// Returns the state of the car's body.
    pub fn body(&self) -> BodyState {
        let Vehicle { length, width, height, .. } = self.car.vehicle;
        let body = Body::block(Class::Car, length, width, height);
        BodyState { velocity: self.velocity(), ..BodyState::at_rest(body, self.pose()) }
    }

    /// Returns the motion of the car.
    pub fn dynamics(&self) -> &dyn Dynamics {
        match &self.led {
            Some((_, led)) => led,
            None => &*self.dynamics,
        }
    }

    pub fn pose(&self) -> Pose {
        self.dynamics().state().pose()
    }

    /// Returns the car's velocity over the ground in m/s.
    pub fn velocity(&self) -> Vector2<f64> {
        let state = self.dynamics().state();
        state.pose().turn_to_plane(state.velocity)
    }

    /// Returns the rest of the way that the car is to go; `None` if the car is just to go straight on.
    pub fn plan(&self) -> Option<Path> {
        (!self.car.endless).then(|| self.car.way.piece(self.at, self.car.way.length()))
    }

    /// Returns the distance of the car from its way, in metres, positive to the left of the way.
    pub fn way_offset(&self) -> f64 {
        self.car.way.at(self.at).to_local(self.pose().position).y
    }

    /// Returns the metres to the end of the car's way; infinite if the car is just to go straight on.
    pub fn remaining(&self) -> f64 {
        if self.car.endless { f64::INFINITY } else { self.car.way.length() - self.at }
    }

    /// Returns the lanes under the car, each with the car's position along the lane in metres. They are the lanes of
    /// its way between its rear and its front. If the way knows no lanes there, the result is the nearest lane in the
    /// car's direction.
    pub fn lanes<'n>(&self, network: &'n RoadNetwork) -> impl Iterator<Item = (LaneId, f64)> + use<'n> {
        let half = 0.5 * self.car.vehicle.length;
        let known = self.car.way.lanes(self.at - half, self.at + half);
        let pose = self.pose();
        let nearest = if !self.car.way.is_on_lanes() { network.project_along(&pose) } else { None };
        let lanes = known.chain(nearest.map(|seen| seen.lane));
        lanes.map(move |lane| (lane, network.project_onto(lane, pose.position).s))
    }

    /// Returns the distance that the car has travelled, in metres.
    pub fn travelled(&self) -> f64 {
        self.led_metres + self.dynamics().state().travelled
    }

    /// Returns the car's pose as seen from its start.
    pub fn odometry(&self) -> Pose {
        self.car.start().relative(&self.pose())
    }

    /// Returns the way of the car, as seen from the car.
    pub fn way(&self) -> Way {
        let (pose, here) = (self.pose(), self.car.way.at(self.at));
        let frame = pose.frame();
        let places = std::array::from_fn(|i| self.at + Way::SPACING * (i + 1) as f64);
        let points = self.car.way.points(places);
        let ahead = points.map(|(point, curvature)| Ahead { position: frame.to_local(point), curvature });
        let offset = here.to_local(pose.position).y;
        Way { offset, heading: wrapped(pose.heading - here.heading), ahead }
    }

    /// Sets the car's outputs. `clearance` is the value of [`Car::clearance`], and the car is the first of the bodies.
    pub fn show(&self, clearance: f64, bodies: &[BodyState], network: &RoadNetwork, outputs: &mut Outputs<'_>) {
        let state = self.dynamics().state();
        outputs.set(&self.shown.position, state.position);
        outputs.set(&self.shown.x, state.position.x);
        outputs.set(&self.shown.y, state.position.y);
        outputs.set(&self.shown.heading, wrapped(state.heading));
        outputs.set(&self.shown.speed, state.speed());
        outputs.set(&self.shown.acceleration, state.acceleration.x);
        outputs.set(&self.shown.throttle, self.control.throttle);
        outputs.set(&self.shown.steering, self.control.steering);
        outputs.set(&self.shown.travelled, self.led_metres + state.travelled);
        outputs.set(&self.shown.clearance, clearance);
        self.shown.asked.show(self, clearance, bodies, network, outputs);
    }

    /// Moves the car on by a tick on ground with the given friction. If the scenario leads the car, `takes_over` tells whether
    /// the driver gets the car when the scenario hands it over.
    pub fn step(&mut self, friction: f64, dt: f64, takes_over: bool) -> Result<(), Upset> {
        let before = self.dynamics().state().acceleration.x;
        if takes_over {
            self.take_over();
        }
        match &mut self.led {
            Some((lead, led)) => {
                if let Some(motion) = lead.next() {
                    led.follow(motion, dt);
                }
            }
            None => self.drive(friction, dt)?,
        }
        let state = self.dynamics().state();
        let (position, acceleration, speed) = (state.position, state.acceleration.x, state.speed());
        if !state.is_finite() {
            return Err(Upset::Car(Box::new(*state)));
        }
        if let (None, Some(lead)) = (&self.led, &self.car.lead) {
            lead.show(LedMotion { pose: state.pose(), speed: state.velocity.x });
        }
        self.jerk = (acceleration - before) / dt;
        self.standing = if speed < STANDING { self.standing + dt } else { 0.0 };
        self.at = self.car.way.nearest(position, self.at);
        Ok(())
    }

    /// Gives the car to the driver if the scenario has handed it over.
    fn take_over(&mut self) {
        if let Some((_, led)) = self.led.take_if(|(lead, _)| lead.is_handed_over()) {
            let state = led.state();
            let (pose, speed) = (state.pose(), state.velocity.x.max(0.0));
            self.led_metres = state.travelled;
            self.dynamics = self.setup.build(&self.car.vehicle, pose, speed);
        }
    }

    fn drive(&mut self, friction: f64, dt: f64) -> Result<(), Upset> {
        let Control { throttle, steering } = self.control;
        for (what, value) in [("throttle", throttle), ("steering", steering)] {
            if !(-1.0..=1.0).contains(&value) {
                return Err(Upset::Control { what, value });
            }
        }
        self.dynamics.step(Pedals { throttle, steering }, friction, dt);
        Ok(())
    }
}
