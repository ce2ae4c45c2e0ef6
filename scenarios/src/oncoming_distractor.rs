//! The ego vehicle follows a leader of constant speed while another car of the same colour comes the other way. A
//! driver that follows the car that it sees must not confuse the two (section 4.2.2 of the paper).

use crate::surroundings::{roadside, weather};
use paracosm_engine::object::{Body, Colour};
use paracosm_engine::{AutonomousVehicle, Monitor, Mover, Program, RoadSegment, Scenario};

pub(crate) const PROGRAM: Program = Program::new(
    "oncoming-distractor",
    "the ego vehicle follows a leader while another car comes the other way",
    oncoming_distractor,
);

/// The colour of leaders.
pub(crate) const RED: Colour = [190, 25, 30];

fn oncoming_distractor(s: &mut Scenario) {
    let distance = s.interval("distance", 40.0..=200.0).unit("m").default(120.0);
    let oncoming_speed = s.interval("oncoming_speed", 3.0..=20.0).unit("m/s").default(10.0);
    let leader_speed = s.nominal("leader_speed", 2.0..=15.0, 8.0).unit("m/s");
    let gap = s.nominal("gap", 10.0..=60.0, 25.0).unit("m");
    let weather = weather(s);

    let road = s.place(RoadSegment::new(500.0));
    s.place(weather);
    let car = s.place(AutonomousVehicle::along(road.path(1)).starting(10.0).speed(10.0));
    let leader = 10.0 + crate::middles(gap.value());
    let red = Body::car().coloured(RED);
    s.place(Mover::new("leader", red, road.path(1)).starting(leader).speed(leader_speed));
    let oncoming = Mover::new("oncoming", red, road.path(-1));
    s.place(oncoming.starting(500.0 - 10.0 - distance.value()).speed(oncoming_speed));
    roadside(s);

    s.duration(15.0);
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::lane_keeping(&car));
    s.monitor(Monitor::progress(&car, 60.0));
}
