//! The road of the paper's section 4.2.1: six lanes with all kinds of traffic, and a crossing on which a white truck passes
//! from left to right while the car comes along the innermost lane.

use paracosm_engine::road::{CrossIntersection, Network, RoadSegment};
use paracosm_engine::traffic::TrafficCar;
use paracosm_engine::{AutonomousVehicle, Environment, EnvironmentCars, Monitor, Mover, Program, Scenario, Stream};
use std::sync::{Arc, LazyLock};

pub(crate) const PROGRAM: Program = Program {
    name: "highway-traffic",
    about: "six lanes of traffic, and a truck that crosses them",
    build: highway_traffic,
};

static ROADS: LazyLock<Arc<Network>> = LazyLock::new(|| {
    let arm = |name: &str, length: f64| RoadSegment::new(length).lanes(6).named(name);
    CrossIntersection::new()
        .lanes(6)
        .connect("one", arm("east", 150.0), "one")
        .connect("two", arm("south", 150.0), "one")
        .connect("three", arm("west", 250.0), "one")
        .connect("four", arm("north", 150.0), "one")
        .build()
        .expect("the arms meet the crossing")
});

fn highway_traffic(s: &mut Scenario) {
    let delay = s.interval("truck_delay", 0.0..=15.0).unit("s").default(8.0);
    let truck_speed = s.interval("truck_speed", 3.0..=15.0).unit("m/s").default(8.0);
    let speed = s.nominal("ego_speed", 8.0..=25.0, 14.0).unit("m/s");
    let seed = s.nominal_choice("traffic_seed", [1, 2, 3, 4], 1);
    let fog = s.nominal("fog", 0.0..=1.0, 0.0);
    let light = s.nominal("light", 0.0..=1.0, 1.0);

    let streets = s.place(ROADS.clone());
    s.place(Environment::new().light(light).fog(fog));
    let way = streets.way(("west", -1, 240.0), ("east", 1, 140.0));
    let car = s.place(AutonomousVehicle::along(way).speed(speed.value()));
    // From the left of the car, which drives east, to its right.
    let crossing = streets.way(("north", -1, 60.0), ("south", 1, 140.0));
    let start = Stream::time().at_least(delay);
    s.place(Mover::truck(crossing).speed(Stream::from(truck_speed).skip_until(&start)));
    let lanes = [-3, -2, 2, 3].into_iter().zip([40.0, 75.0, 110.0, 145.0]);
    let cars = ["west", "east"].into_iter().flat_map(|road| lanes.clone().map(move |(lane, at)| (road, lane, at)));
    let cars = cars.filter_map(|(road, lane, at)| streets.place_on(road, lane, at)).map(TrafficCar::at);
    s.place(EnvironmentCars::on(&streets, cars.collect()).seed(seed.value() as u64));

    s.duration(25.0);
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::progress(&car, 200.0));
}
