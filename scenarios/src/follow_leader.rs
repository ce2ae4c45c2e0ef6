//! The paper's second study (section 4.2.2, Figure 10): the ego vehicle follows a leader whose speed is a signal over
//! the run.
//!
//! The leader starts `gap` metres ahead, from bumper to bumper, and drives at the speed of the signal, which may make
//! it brake. Fog and light matter to drivers that use cameras.

use crate::oncoming_distractor::RED;
use crate::surroundings::{roadside, weather};
use paracosm_engine::object::Body;
use paracosm_engine::{AutonomousVehicle, Monitor, Mover, Program, RoadSegment, Scenario, Shape};

pub(crate) const PROGRAM: Program =
    Program::new("follow-leader", "the ego vehicle follows a leader whose speed varies over the run", follow_leader);

fn follow_leader(s: &mut Scenario) {
    let leader_speed =
        s.interval("leader_speed", 0.0..=20.0).unit("m/s").signal(Shape::PiecewiseLinear { pieces: 3 }).default(12.0);
    let gap = s.nominal("gap", 10.0..=60.0, 25.0).unit("m");
    let speed = s.nominal("approach_speed", 5.0..=30.0, 15.0).unit("m/s");
    let friction = s.nominal("friction", 0.2..=0.8, 0.8);
    let weather = weather(s);

    let road = s.place(RoadSegment::new(1000.0));
    s.place(weather.friction(friction));
    let car = s.place(AutonomousVehicle::along(road.path(1)).starting(10.0).speed(speed.value()));
    let leader = 10.0 + crate::middles(gap.value());
    let red = Body::car().coloured(RED);
    s.place(Mover::new("leader", red, road.path(1)).starting(leader).speed(leader_speed));
    roadside(s);

    s.duration(15.0);
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::lane_keeping(&car));
    s.monitor(Monitor::progress(&car, 10.0));
}
