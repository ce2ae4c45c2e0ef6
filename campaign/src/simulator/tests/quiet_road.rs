//! A car alone on a road, for tests of drivers that see.

use paracosm_engine::{AutonomousVehicle, Environment, Monitor, Program, RoadSegment, Scenario};

pub const QUIET: Program = Program::new("quiet-road", "a car alone on a road", quiet_road);

fn quiet_road(s: &mut Scenario) {
    let speed = s.interval("speed", 5.0..=15.0).unit("m/s");
    let turned = s.interval("turned", -0.1..=0.1).unit("rad");
    let fog = s.nominal("fog", 0.0..=1.0, 0.0);
    let light = s.nominal("light", 0.0..=1.0, 1.0);
    let rain = s.nominal("rain", 0.0..=1.0, 0.0);
    let road = s.place(RoadSegment::new(200.0));
    s.place(Environment::new().light(light).fog(fog).rain(rain));
    let start = road.on_lane(1, 10.0);
    let start = paracosm_engine::Pose { heading: start.heading + turned.value(), ..start };
    let car = s.place(AutonomousVehicle::at(start).speed(speed.value()));
    s.duration(3.0);
    s.monitor(Monitor::lane_keeping(&car));
    s.monitor(Monitor::progress(&car, 12.0));
}
