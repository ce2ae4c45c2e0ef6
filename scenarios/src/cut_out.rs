//! The cut-out of UN Regulation No. 157: the leader changes to the next lane and reveals a standing car.
//!
//! The leader keeps the same speed, at a time headway ahead of the ego vehicle, and changes lanes when it is `gap`
//! metres before the standing car.

use crate::surroundings::{later_weather, roadside};
use crate::{LANE, middles};
use paracosm_engine::object::Body;
use paracosm_engine::{AutonomousVehicle, Fixture, Monitor, Mover, Program, RoadSegment, Scenario, Stream};

pub(crate) const PROGRAM: Program =
    Program::new("cut-out", "the leader changes lanes and reveals a standing car (UN R157)", cut_out);

fn cut_out(s: &mut Scenario) {
    let speed = s.interval("ego_speed", 20.0..=60.0).unit("km/h").default(50.0);
    let headway = s.interval("headway", 0.8..=3.0).unit("s").default(2.0);
    let gap = s.interval("gap", 10.0..=60.0).unit("m").default(30.0);
    let lateral = s.interval("lateral_speed", 0.5..=3.0).unit("m/s").default(2.0);
    let friction = s.nominal("friction", 0.2..=0.8, 0.8);
    let weather = later_weather(s);

    s.place(weather.friction(friction));
    let road = s.place(RoadSegment::new(800.0).lanes(4).lane_width(LANE));
    let v = speed.value() / 3.6;
    let car = s.place(AutonomousVehicle::along(road.path(2)).starting(10.0).speed(v));
    let lead = 10.0 + middles(v * headway.value());
    // The leader drives for 3 s before it changes lanes.
    let stands = lead + 3.0 * v + gap.value() + 2.0 * Body::car().outline.half_extent().x;
    let aside = ((Stream::time() - 3.0).max(0.0) * lateral.value()).min(LANE);
    s.place(Mover::car(road.path(2)).named("leader").starting(lead).speed(v).offset(aside));
    s.place(Fixture::parked_car(road.on_lane(2, stands)));
    roadside(s);

    s.duration(20.0);
    s.premise(&car.time_to_collision().below(5.0));
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::lane_keeping(&car));
}
