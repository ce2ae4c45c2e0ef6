//! The cut-out of UN Regulation No. 157: the leader changes to the next lane and reveals somebody who stands in the way.
//!
//! The ranges of the speed, the gap and the lateral speed are those of the public variations of the regulation's scenarios
//! (OSC-ALKS-scenarios, 4.5_1). These files fix `headway` at 2 s. The leader keeps the same speed, at a time headway ahead
//! of the ego vehicle, and changes lanes when it is `gap` metres before the obstacle. In the files, `lateral_speed` is the
//! greatest speed of a sinusoidal lane change. Here the leader keeps this speed, so it changes lanes in 2/π of the time. A
//! test is invalid if the leader would move to the side faster than it drives.

use crate::surroundings::{later_weather, roadside};
use crate::{LANE, checked_lateral, kind, middles};
use paracosm_engine::object::Body;
use paracosm_engine::{AutonomousVehicle, Fixture, Monitor, Mover, Program, RoadSegment, Scenario, Stream};

pub(crate) const PROGRAM: Program =
    Program::new("cut-out", "the leader changes lanes and reveals who stands in the way (UN R157)", cut_out);

/// The time in seconds in which the slowest ego vehicle, with 5 km/h, comes to the farthest obstacle.
const DURATION: f64 = 90.0;

fn cut_out(s: &mut Scenario) {
    let speed = s.interval("ego_speed", 5.0..=60.0).unit("km/h").default(50.0);
    let headway = s.interval("headway", 0.8..=3.0).unit("s").default(2.0);
    let gap = s.interval("gap", 10.0..=100.0).unit("m").default(30.0);
    let lateral = s.interval("lateral_speed", 0.5..=3.0).unit("m/s").default(2.0);
    let side = s.nominal_choice("side", ["left", "right"], "left").incidental();
    let obstacle = ["car", "van", "truck", "bus", "motorcycle", "pedestrian"];
    let obstacle = s.nominal_choice("obstacle", obstacle, "car").incidental();
    let friction = s.nominal("friction", 0.2..=0.8, 0.8);
    let weather = later_weather(s);

    s.place(weather.friction(friction));
    let road = s.place(RoadSegment::new(800.0).lanes(6).lane_width(LANE));
    let v = speed.value() / 3.6;
    checked_lateral(s, lateral.value(), v);
    let car = s.place(AutonomousVehicle::along(road.path(2)).starting(10.0).speed(v));
    let lead = 10.0 + middles(v * headway.value());
    let (name, body) = match obstacle.value() {
        "pedestrian" => ("pedestrian", Body::adult()),
        "car" => ("parked-car", Body::car()),
        vehicle => (vehicle, Body::of(kind(vehicle))),
    };
    // The leader drives for 3 s before it changes lanes.
    let front = lead + 3.0 * v + Body::car().outline.half_extent().x;
    let stands = front + gap.value() + body.outline.half_extent().x;
    let aside = ((Stream::time() - 3.0).max(0.0) * lateral.value()).min(LANE);
    let aside = if side.value() == "left" { aside } else { -aside };
    s.place(Mover::car(road.path(2)).named("leader").starting(lead).speed(v).offset(aside));
    s.place(Fixture::new(name, body, road.on_lane(2, stands)));
    roadside(s);

    s.duration(DURATION);
    s.premise(&car.time_to_collision().below(5.0));
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::lane_keeping(&car));
}
