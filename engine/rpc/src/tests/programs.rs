//! Small worlds to drive in: somebody to brake for, somebody to follow, a turn to take.

use paracosm_engine::object::Body;
use paracosm_engine::road::{Composite, TIntersection};
use paracosm_engine::{AutonomousVehicle, Monitor, Mover, Pedestrian, Program, RoadSegment, Scenario, Side};

/// A pedestrian crosses the road when the car is near.
pub static CROSSING: Program = Program::new("crossing", "a pedestrian crosses the road", crossing);
/// The car follows a leader.
pub static BEHIND: Program = Program::new("behind", "the car follows another one", behind);
/// The car turns right at a T-intersection.
pub static TURNING: Program = Program::new("turning", "the car turns right", turning);

fn crossing(s: &mut Scenario) {
    let distance = s.interval("distance", 5.0..=60.0).unit("m").default(30.0);
    let road = s.place(RoadSegment::new(200.0));
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(15.0));
    let walker = s.place(Pedestrian::at(road.on_sidewalk(Side::Left, 100.0)));
    let near = car.gap_along(&road.crossing(100.0)).below(distance);
    walker.walk(road.on_sidewalk(Side::Right, 100.0), 1.4).skip_until(&near).take_until(&walker.arrived());
    s.duration(10.0);
    s.monitor(Monitor::no_collision(&car));
}

fn behind(s: &mut Scenario) {
    let leader_speed = s.interval("leader_speed", 0.0..=20.0).unit("m/s").default(12.0);
    let road = s.place(RoadSegment::new(1000.0));
    let car = s.place(AutonomousVehicle::along(road.path(1)).starting(10.0).speed(15.0));
    s.place(Mover::new("leader", Body::car(), road.path(1)).starting(39.0).speed(leader_speed));
    s.duration(15.0);
    s.monitor(Monitor::no_collision(&car));
}

fn turning(s: &mut Scenario) {
    let speed = s.interval("speed", 3.0..=12.0).unit("m/s").default(8.0);
    let road = |length: f64, name: &str| RoadSegment::new(length).named(name);
    let network = Composite::from(TIntersection::new().named("tee"))
        .connect("tee.three", road(60.0, "before"), "two")
        .connect("tee.two", road(120.0, "after"), "one")
        .connect("tee.one", road(25.0, "end"), "one")
        .build()
        .unwrap();
    let lanes =
        [network.lane_of("before", 1), network.lane_between("tee", "three", "two", 1), network.lane_of("after", 1)];
    let way = network.path(&lanes.map(Result::unwrap));
    s.place(network);
    let car = s.place(AutonomousVehicle::along(way).starting(5.0).speed(speed.value()));
    s.duration(15.0);
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::on_its_way(&car, 2.0));
}
