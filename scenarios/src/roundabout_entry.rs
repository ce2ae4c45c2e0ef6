//! The ego vehicle comes to a roundabout with another car in it. It has to let that car pass, or enter well before it.
//!
//! The other car drives round from the arm at the left to the arm opposite, past the entry of the ego vehicle. `lead`
//! is the number of seconds by which the other car would reach the entry before the ego vehicle if neither changed its
//! speed. The other car slows down only for road users that are in its way.

use crate::surroundings::{later_weather, roadside};
use paracosm_engine::road::{RoadNetwork, RoadSegment, Roundabout};
use paracosm_engine::traffic::TrafficCar;
use paracosm_engine::{AutonomousVehicle, EnvironmentCars, Monitor, Program, Scenario};
use std::sync::{Arc, LazyLock};

pub(crate) const PROGRAM: Program =
    Program::new("roundabout-entry", "the ego vehicle enters a roundabout with another car in it", roundabout_entry);

static ROUNDABOUT: LazyLock<Arc<RoadNetwork>> = LazyLock::new(|| {
    let arm = |name: &str| RoadSegment::new(120.0).named(name);
    Roundabout::new()
        .named("circus")
        .connect("one", arm("east"), "one")
        .connect("two", arm("south"), "one")
        .connect("three", arm("west"), "one")
        .connect("four", arm("north"), "one")
        .build()
        .expect("the arms meet the roundabout")
});

fn roundabout_entry(s: &mut Scenario) {
    let speed = s.interval("approach_speed", 4.0..=14.0).unit("m/s").default(8.0);
    let other_speed = s.interval("other_speed", 3.0..=9.0).unit("m/s").default(6.0);
    let lead = s.interval("lead", -4.0..=4.0).unit("s").default(0.5);
    let friction = s.nominal("friction", 0.2..=0.8, 0.8);
    let weather = later_weather(s);

    let streets = s.place(ROUNDABOUT.clone());
    s.place(weather.friction(friction));
    // Roads lead away from the roundabout, so that lane -1 leads to it. Both cars reach the ring after 60 m.
    let way = streets.way(("south", -1, 60.0), ("north", 1, 100.0));
    let car = s.place(AutonomousVehicle::along(way).speed(speed.value()));
    let from = streets.place_on("west", -1, 110.0).expect("the road is longer");
    let to = streets.place_on("north", 1, 100.0).expect("the road is longer");
    let other = ROUNDABOUT.route(from, to, 0.0).expect("the ring leads there");
    // From the entry of the other car to that of the ego vehicle it is a quarter of the ring.
    let meeting = 110.0 + 20.0;
    let time = 60.0 / speed.value();
    let start = meeting - other_speed.value() * (time - lead.value());
    if start < 0.0 {
        s.refuse("the other car would have to start before the beginning of its road");
    }
    let other = TrafficCar::following(&ROUNDABOUT.rest_of(&other, start));
    s.place(EnvironmentCars::on(&streets, vec![other])).drive(0, other_speed);
    roadside(s);

    s.duration(45.0);
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::right_of_way(&car, 0.5));
    s.monitor(Monitor::route_completion(&car, 60.0));
}
