//! The scenario `pedestrian-crossing` at 30 km/h in a short form, because every image costs time. A test begins a
//! little before the first walker sets out, and ends when the walker has crossed.
//!
//! At 30 km/h, a car that does not brake hits the walkers of 1 m/s that set out when the car is 33 to 55 m away, so
//! that there is something to learn. At the distance at which the car has to brake, a walker is tall enough to be seen
//! in a small image.

use paracosm::engine::{
    AutonomousVehicle, Environment, Pedestrian, Program, RoadSegment, Scenario, Side, eventually, never,
};

/// A pedestrian crosses the road in front of the car.
pub const PROGRAM: Program = Program::new("crossing", "a pedestrian crosses the road, and the test ends", build);

/// The place where the walker crosses, and how far before it the car begins, in metres.
const CROSSING: f64 = 100.0;
const AHEAD: f64 = 70.0;
/// The initial speed of the car, in m/s.
const SPEED: f64 = 30.0 / 3.6;
/// The duration of a test: until a car that does not brake is `PAST` metres beyond the crossing, plus the time in which
/// the walker walks `CROSSED` metres; at most `LONGEST` seconds.
const PAST: f64 = 13.0;
const CROSSED: f64 = 8.5;
const LONGEST: f64 = 25.0;
/// A car that does not come nearer than this to the crossing, in metres, has not met the walker: it fails `progress`.
const MET: f64 = 30.0;

fn build(s: &mut Scenario) {
    let speed = s.interval("speed", 0.5..=10.0).unit("m/s").default(1.0);
    let distance = s.interval("distance", 5.0..=60.0).unit("m").default(30.0);

    s.place(Environment::new());
    let road = s.place(RoadSegment::new(400.0));
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, CROSSING - AHEAD)).speed(SPEED));
    let walker = s.place(Pedestrian::at(road.on_sidewalk(Side::Left, CROSSING)));

    let near = car.gap_along(&road.crossing(CROSSING)).below(distance);
    let walk = walker.walk(road.on_sidewalk(Side::Right, CROSSING), &speed);
    walk.skip_until(&near).take_until(&walker.arrived());

    s.duration(((AHEAD + PAST) / SPEED + CROSSED / speed.value()).min(LONGEST));
    s.premise(&near);
    s.require("no-collision", never(car.collides())).unit("m").scale(5.0);
    s.require("progress", eventually(car.travelled().at_least(AHEAD - MET))).unit("m").scale(50.0);
}
