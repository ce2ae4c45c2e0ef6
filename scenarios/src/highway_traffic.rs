//! The road of the paper's section 4.2.1: six lanes with all kinds of traffic. At a crossing a white truck passes from
//! left to right while the ego vehicle approaches on the innermost lane.
//!
//! Cars, vans and trucks of different sizes and temperaments drive in both directions beside the ego vehicle. Cars and
//! vans change lanes where they can, also into the lane of the ego vehicle. Trucks keep to the middle lanes, which
//! lead straight on.

use crate::surroundings::{roadside, weather};
use paracosm_engine::object::{Body, Colour};
use paracosm_engine::road::{CrossIntersection, RoadNetwork, RoadSegment};
use paracosm_engine::traffic::TrafficCar;
use paracosm_engine::{AutonomousVehicle, EnvironmentCars, Monitor, Program, Scenario, Stream};
use std::sync::{Arc, LazyLock};

pub(crate) const PROGRAM: Program =
    Program::new("highway-traffic", "six lanes of traffic, and a truck that crosses them", highway_traffic);

const WHITE: Colour = [245, 245, 245];
/// The roads with traffic, and the number of cars on each of their lanes, 40 m apart.
const TRAFFIC: [(&str, i32); 2] = [("west", 6), ("east", 3)];

static ROADS: LazyLock<Arc<RoadNetwork>> = LazyLock::new(|| {
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
    let weather = weather(s);

    let streets = s.place(ROADS.clone());
    s.place(weather);
    let way = streets.way(("west", -1, 240.0), ("east", 1, 140.0));
    let car = s.place(AutonomousVehicle::along(way).speed(speed.value()));
    // The truck drives from the left of the ego vehicle, which drives east, to its right. The truck reacts to the
    // traffic, but not to the ego vehicle.
    let [from, to] =
        [("north", -1, 25.0), ("south", 1, 140.0)].map(|(road, lane, at)| streets.place_on(road, lane, at));
    let crossing = from.zip(to).and_then(|(from, to)| ROADS.route(from, to, 0.0)).expect("the roads are longer");
    let truck = TrafficCar::following(&crossing).body(Body::truck()).heedless().coloured(WHITE);
    let seed = seed.value() as u64;
    let places = TRAFFIC.into_iter().flat_map(|(road, count)| {
        [-3, -2, 2, 3].into_iter().flat_map(move |lane| (0..count).map(move |i| (road, lane, i)))
    });
    let cars = places.enumerate().filter_map(|(index, (road, lane, i))| {
        let at = 30.0 + 40.0 * f64::from(i) + if lane % 2 == 0 { 0.0 } else { 15.0 };
        let start = streets.place_on(road, lane, at)?;
        let car = match (index as u64 + seed) % 3 {
            0 if lane % 2 == 0 => TrafficCar::truck(start),
            0 => TrafficCar::van(start).changing_lanes(),
            _ => TrafficCar::at(start).changing_lanes(),
        };
        Some(car.varied(100 * seed + index as u64).moving())
    });
    let all = [truck].into_iter().chain(cars).collect();
    let fleet = s.place(EnvironmentCars::on(&streets, all).seed(seed));
    let start = Stream::time().at_least(delay);
    fleet.drive(0, Stream::from(truck_speed).skip_until(&start).hold(0.0));
    roadside(s);

    s.duration(25.0);
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::progress(&car, 200.0));
}
