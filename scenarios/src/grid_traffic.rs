//! A city of 6 by 6 junctions full of cars that follow each other, yield at crossings and turn at random. The ego
//! vehicle drives a long route through the city, and has to cope with junctions at which other cars may have the right
//! of way.

use crate::surroundings::{later_weather, roadside};
use paracosm_engine::road::{RoadNetwork, grid_city};
use paracosm_engine::{AutonomousVehicle, EnvironmentCars, Monitor, Program, Scenario};
use std::sync::{Arc, LazyLock};

pub(crate) const PROGRAM: Program =
    Program::new("grid-traffic", "a route through a city with a hundred cars", grid_traffic);

static CITY: LazyLock<Arc<RoadNetwork>> =
    LazyLock::new(|| grid_city(6, 6, 80.0, 2).build().expect("the streets meet at the junctions"));

fn grid_traffic(s: &mut Scenario) {
    let seed = s.choice("traffic_seed", [1, 2, 3, 4, 5, 6, 7, 8]).default(1);
    let speed = s.interval("speed", 5.0..=14.0).unit("m/s").default(9.0);
    let cars = s.nominal_choice("cars", [10, 30, 100], 100);
    let friction = s.nominal("friction", 0.2..=0.8, 0.8);
    let weather = later_weather(s);

    s.tick(0.02);
    let streets = s.place(CITY.clone());
    s.place(weather.friction(friction));
    let way = streets.way(("street 2,0 east", 1, 10.0), ("street 4,5 south", 1, 40.0));
    let car = s.place(AutonomousVehicle::along(way).speed(speed.value()));
    let start = streets.on_lane("street 2,0 east", 1, 10.0).position;
    let others = EnvironmentCars::scattered(&streets, cars.value() as usize, seed.value() as u64);
    s.place(others.away_from(start, 15.0));
    roadside(s);

    s.duration(60.0);
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::right_of_way(&car, 1.0));
    s.monitor(Monitor::activity(&car, 30.0));
}
