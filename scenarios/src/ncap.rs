//! Tests of Euro NCAP's AEB protocols of 2023: crossing pedestrians (CPNA, CPFA, CPNCO) and cars ahead (CCR).
//!
//! The speeds, overlaps, gaps and decelerations are those of the public files of the protocols (OSC-NCAP-scenarios). The impact at 50 % of the
//! width for CPNA comes from the protocol of 2026.
//!
//! A pedestrian starts so that a car that does not brake hits the pedestrian with a given part of its front. `impact`
//! is the place of the pedestrian's middle at that moment as a share of the car's width, counted from the side that the
//! pedestrian comes from. The pedestrian stands beside the lane, gathers speed evenly over the first metre or so, and
//! walks on across. The run begins 6 s before the impact.

use crate::middles;
use crate::surroundings::{later_weather, roadside};
use paracosm_engine::object::{Body, VehicleKind};
use paracosm_engine::road::Path;
use paracosm_engine::vehicle::Vehicle;
use paracosm_engine::{
    AutonomousVehicle, Car, Fixture, Monitor, Mover, Param, Pose, Program, Road, RoadSegment, Scenario, Stream,
};

pub(crate) const CPNA: Program =
    Program::new("ncap-cpna", "an adult walks from the near side (Euro NCAP CPNA-25 to CPNA-75)", cpna);
pub(crate) const CPFA: Program = Program::new("ncap-cpfa", "an adult runs from the far side (Euro NCAP CPFA-50)", cpfa);
pub(crate) const CPNCO: Program =
    Program::new("ncap-cpnco", "a child runs from behind parked cars at the near side (Euro NCAP CPNCO-50)", cpnco);
pub(crate) const CCR: Program = Program::new(
    "ncap-ccr",
    "the ego vehicle comes upon a car that stands or drives slowly (Euro NCAP CCRs and CCRm)",
    ccr,
);
pub(crate) const CCRB: Program =
    Program::new("ncap-ccrb", "the ego vehicle follows a car that brakes (Euro NCAP CCRb)", ccrb);

/// The time from the beginning to the impact, in seconds.
const TIME: f64 = 6.0;
/// The speed in m/s of a target that drives (CCRm).
const SLOW: f64 = 20.0 / 3.6;
/// The speed in m/s to which a target brakes (CCRb).
const CRAWL: f64 = 2.0 / 3.6;
/// The time at which a target begins to brake (CCRb), in seconds.
const BRAKING: f64 = 3.0;
/// The least speed of the ego vehicle in km/h with a target that drives.
const SLOWEST_TO_MOVING: f64 = 30.0;
/// The place where the ego vehicle starts, in metres along the road.
const START: f64 = 10.0;

/// A pedestrian who crosses the road in front of the ego vehicle.
struct Crossing {
    body: Body,
    name: &'static str,
    /// The side of the road from which the pedestrian comes, -1 for the right and 1 for the left.
    side: f64,
    /// The starting distance of the pedestrian from the middle of the lane, and the distance over which the pedestrian
    /// accelerates, in metres.
    from: f64,
    run_up: f64,
    /// The walking speed of the pedestrian in m/s.
    speed: f64,
    /// The place of the impact on the car's front, as a share of the car's width.
    impact: f64,
}

impl Crossing {
    /// Returns the path of the pedestrian across the road. `lane` is the pose on the lane where the path crosses it.
    fn path(&self, lane: Pose) -> Path {
        let start = lane.position + lane.left() * (self.side * self.from);
        Path::straight(start, start - lane.left() * (self.side * 2.0 * self.from))
    }

    /// Returns the pedestrian's speed in m/s over time. The pedestrian starts late enough to reach the place of the
    /// impact after [`TIME`].
    fn speed(&self, time: &Stream<f64>) -> Stream<f64> {
        let width = Vehicle::BMW_320I.width;
        let way = self.from - 0.5 * width + self.impact * width;
        let gathering = 2.0 * self.run_up / self.speed;
        let begin = TIME - gathering - (way - self.run_up) / self.speed;
        ((time - begin) * (self.speed / gathering)).max(0.0).min(self.speed)
    }
}

/// Builds a straight road with the ego vehicle, which reaches the pedestrian after 6 s at constant speed.
fn approach(s: &mut Scenario, crossing: &Crossing, speed: &Param<f64>) -> (Road, Car) {
    let friction = s.nominal("friction", 0.2..=0.8, 0.8);
    let weather = later_weather(s);
    s.tick(0.002);
    let v = speed.value() / 3.6;
    s.place(weather.friction(friction));
    let road = s.place(RoadSegment::new(250.0));
    let car = s.place(AutonomousVehicle::along(road.path(1)).starting(START).speed(v));
    let radius = crossing.body.outline.half_extent().x;
    let lane = road.on_lane(1, START + v * TIME + 0.5 * Vehicle::BMW_320I.length + radius);
    let walker = Mover::new(crossing.name, crossing.body, crossing.path(lane)).speed(crossing.speed(&Stream::time()));
    s.place(walker);
    s.duration(TIME + 3.0);
    s.premise(&car.time_to_collision().below(4.0));
    s.monitor(Monitor::no_collision(&car));
    (road, car)
}

fn cpna(s: &mut Scenario) {
    let speed = s.interval("ego_speed", 10.0..=60.0).unit("km/h").default(40.0);
    let impact = s.choice("impact", [25, 50, 75]).unit("%").default(25);
    let impact = f64::from(impact.value()) / 100.0;
    let body = Body::adult();
    let crossing = Crossing { body, name: "adult", side: -1.0, from: 4.0, run_up: 1.0, speed: 5.0 / 3.6, impact };
    approach(s, &crossing, &speed);
    roadside(s);
}

fn cpfa(s: &mut Scenario) {
    let speed = s.interval("ego_speed", 10.0..=60.0).unit("km/h").default(40.0);
    let body = Body::adult();
    let crossing = Crossing { body, name: "adult", side: 1.0, from: 6.0, run_up: 1.5, speed: 8.0 / 3.6, impact: 0.5 };
    approach(s, &crossing, &speed);
    roadside(s);
}

fn cpnco(s: &mut Scenario) {
    let speed = s.interval("ego_speed", 10.0..=60.0).unit("km/h").default(40.0);
    let body = Body::child();
    let crossing = Crossing { body, name: "child", side: -1.0, from: 4.0, run_up: 1.0, speed: 5.0 / 3.6, impact: 0.5 };
    let (road, _) = approach(s, &crossing, &speed);
    // Two cars are parked one after the other, a metre beside the way of the ego vehicle. The child comes out a metre
    // beyond the second of them.
    let line = START + speed.value() / 3.6 * TIME + 0.5 * Vehicle::BMW_320I.length;
    let [length, width, _] = VehicleKind::CAR.size;
    for back in [1.0 + 0.5 * length, 1.0 + 1.5 * length + 1.0] {
        let lane = road.on_lane(1, line - back);
        let position = lane.position - lane.left() * (0.5 * Vehicle::BMW_320I.width + 1.0 + 0.5 * width);
        s.place(Fixture::parked_car(Pose { position, ..lane }));
    }
    roadside(s);
}

/// Returns the distance in metres from the middle line of the ego vehicle to that of the target, to the left. The
/// target covers the given share of the ego vehicle's width; with a negative share it is to the right. With all of the
/// width, both middle lines are the same.
fn aside(overlap: f64) -> f64 {
    let (own, target) = (Vehicle::BMW_320I.width, 2.0 * Body::car().outline.half_extent().y);
    if overlap.abs() < 1.0 { (0.5 * (own + target) - overlap.abs() * own).copysign(overlap) } else { 0.0 }
}

fn ccr(s: &mut Scenario) {
    let speed = s.interval("ego_speed", 10.0..=80.0).unit("km/h").default(50.0);
    // The share of the ego vehicle's width that the target covers; for a negative share the target is to the right.
    let overlap = s.choice("overlap", [-50, -75, 100, 75, 50]).unit("%").default(100);
    let target = s.choice("target", ["standing", "moving"]).default("standing");
    let friction = s.nominal("friction", 0.2..=0.8, 0.8);
    let weather = later_weather(s);

    let v = speed.value() / 3.6;
    let slow = if target.value() == "moving" { SLOW } else { 0.0 };
    if target.value() == "moving" && speed.value() < SLOWEST_TO_MOVING {
        s.refuse("with a target that drives, the protocol begins at 30 km/h");
    }
    s.place(weather.friction(friction));
    let road = s.place(RoadSegment::new(600.0));
    let shifted = road.path(1).shifted(aside(f64::from(overlap.value()) / 100.0));
    let target = Mover::car(shifted).speed(slow);
    behind(s, &road, v, target, ((v - slow) * TIME).max(0.0));
}

fn ccrb(s: &mut Scenario) {
    let gap = s.interval("gap", 12.0..=40.0).unit("m").default(40.0);
    let brake = s.interval("deceleration", 2.0..=6.0).unit("m/s²").default(6.0);
    // The protocol has 50 km/h only.
    let speed = s.nominal("ego_speed", 30.0..=80.0, 50.0).unit("km/h");
    let friction = s.nominal("friction", 0.2..=0.8, 0.8);
    let weather = later_weather(s);

    let v = speed.value() / 3.6;
    s.place(weather.friction(friction));
    let road = s.place(RoadSegment::new(600.0));
    let braking = (v - (Stream::time() - BRAKING).max(0.0) * brake.value()).max(CRAWL);
    behind(s, &road, v, Mover::car(road.path(1)).speed(braking), gap.value());
}

/// Places the ego vehicle with a speed in m/s on the first lane, the target `ahead` metres before it, and states the
/// requirements.
fn behind(s: &mut Scenario, road: &Road, speed: f64, target: Mover, ahead: f64) {
    let car = s.place(AutonomousVehicle::along(road.path(1)).starting(START).speed(speed));
    s.place(target.named("target").starting(START + middles(ahead)));
    roadside(s);

    s.duration(15.0);
    s.premise(&car.time_to_collision().below(TIME));
    s.monitor(Monitor::no_collision(&car));
}
