//! The scenario `pedestrian-crossing` at 30 km/h, with what comes before and after cut off, since every image costs time: a
//! test begins a little before the first of the walkers sets out, and ends when the walker has crossed.
//!
//! At 30 km/h a car that does not brake hits those who walk at 1 m/s and set out 33 to 55 m ahead of it, so that there is
//! something to learn; and they are tall enough in a small image where it has to brake for them.

use paracosm::engine::{
    AutonomousVehicle, Environment, Pedestrian, Program, RoadSegment, Scenario, Side, eventually, never,
};

/// A pedestrian crosses the road in front of the car.
pub const PROGRAM: Program = Program::new("crossing", "a pedestrian crosses the road, and the test ends", build);

/// Where the walker crosses, and how far before it the car begins: metres.
const CROSSING: f64 = 100.0;
const AHEAD: f64 = 70.0;
/// The car's speed at first, in m/s.
const SPEED: f64 = 30.0 / 3.6;
/// A test lasts until a car that goes on is this many metres past, and as long as the walker takes for this many more; but not
/// longer than so many seconds.
const PAST: f64 = 13.0;
const CROSSED: f64 = 8.5;
const LONGEST: f64 = 25.0;
/// Who comes no nearer than this many metres has not met the walker at all.
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
