//! The cut-in of UN Regulation No. 157: a slower car changes into the lane of the ego vehicle, directly in front of it.
//!
//! The ranges are those of the public variations of the regulation's scenarios. The lane change begins at once; `gap`
//! is the distance from bumper to bumper at that moment. A test in which the other car would drive backwards is
//! invalid.

use crate::LANE;
use crate::surroundings::{later_weather, roadside};
use paracosm_engine::{AutonomousVehicle, Monitor, Mover, Program, RoadSegment, Scenario, Stream};

pub(crate) const PROGRAM: Program =
    Program::new("cut-in", "a slower car changes into the ego vehicle's lane, right in front of it (UN R157)", cut_in);

fn cut_in(s: &mut Scenario) {
    let speed = s.interval("ego_speed", 20.0..=60.0).unit("km/h").default(50.0);
    let relative = s.interval("relative_speed", -50.0..=-10.0).unit("km/h").default(-20.0);
    let gap = s.interval("gap", 0.0..=60.0).unit("m").default(20.0);
    let lateral = s.interval("lateral_speed", 0.5..=3.0).unit("m/s").default(1.0);
    let friction = s.nominal("friction", 0.2..=0.8, 0.8);
    let weather = later_weather(s);

    s.place(weather.friction(friction));
    let road = s.place(RoadSegment::new(800.0).lanes(4).lane_width(LANE));
    let car = s.place(AutonomousVehicle::along(road.path(2)).starting(10.0).speed(speed.value() / 3.6));
    let other_speed = (speed.value() + relative.value()) / 3.6;
    if other_speed < 0.0 {
        s.refuse("the other car would drive backwards");
    }
    let aside = (Stream::time() * lateral.value()).min(LANE);
    let start = 10.0 + crate::middles(gap.value());
    let other = Mover::car(road.path(1)).starting(start).speed(other_speed.max(0.0)).offset(-aside);
    let other = s.place(other);
    roadside(s);

    s.duration(20.0);
    s.premise(&other.position().y().at_most(-LANE));
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::lane_keeping(&car));
}
