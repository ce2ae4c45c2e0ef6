//! The loop of the paper's Figure 10b: four straight roads joined by T-intersections, at each of which the ego vehicle
//! turns right.
//!
//! At an intersection the car could also go straight on, into a road that ends. A car that misses the turn leaves its
//! route, and a car that leaves the road runs into the houses around it. The run takes 200 s, which is about twenty
//! turns.

use crate::surroundings::{roadside, weather};
use paracosm_engine::road::{Composite, Path, RoadNetwork, RoadSegment, TIntersection};
use paracosm_engine::{AutonomousVehicle, Fixture, Monitor, Pose, Program, Scenario, Side};
use std::sync::{Arc, LazyLock};

pub(crate) const PROGRAM: Program =
    Program::new("t-loop", "a loop of T-intersections, turning right at each of them", t_loop);

/// The length of a side between two intersections, in metres.
const SIDE: f64 = 60.0;
/// The most laps that the ego vehicle can drive in 200 s.
const LAPS: usize = 10;

static LOOP: LazyLock<Arc<RoadNetwork>> = LazyLock::new(|| {
    let side = |i: usize| RoadSegment::new(SIDE).named(format!("side {i}"));
    let tee = |i: usize| TIntersection::new().named(format!("tee {i}"));
    let mut all = Composite::from(tee(1));
    for i in 1..=4 {
        all = all.connect(&format!("tee {i}.one"), RoadSegment::new(25.0).named(format!("end {i}")), "one");
        all = all.connect(&format!("tee {i}.two"), side(i), "one");
        let end = format!("side {i}.two");
        all = if i < 4 { all.connect(&end, tee(i + 1), "three") } else { all.close(&end, "tee 1.three") };
    }
    all.build().expect("the loop closes")
});

/// Returns the route of the ego vehicle, which repeatedly goes along the sides and through the right turns.
fn way() -> Path {
    let lane = |i: usize| {
        let turn = LOOP.lane_between(&format!("tee {}", i % 4 + 1), "three", "two", 1);
        [LOOP.lane_of(&format!("side {i}"), 1), turn].map(|lane| lane.expect("the loop has it"))
    };
    LOOP.path(&(0..LAPS).flat_map(|_| (1..=4).flat_map(lane)).collect::<Vec<_>>())
}

fn t_loop(s: &mut Scenario) {
    let speed = s.interval("speed", 3.0..=12.0).unit("m/s").default(8.0);
    let friction = s.interval("friction", 0.2..=0.8).default(0.8);
    let weather = weather(s);

    let streets = s.place(LOOP.clone());
    s.place(weather.friction(friction));
    for i in 1..=4 {
        for at in [12.0, 30.0, 48.0] {
            let kerb = streets.on_sidewalk(&format!("side {i}"), Side::Left, at);
            let position = kerb.position - kerb.forward() * 8.0;
            s.place(Fixture::house(Pose { position, ..kerb }));
        }
    }
    let car = s.place(AutonomousVehicle::along(way()).starting(5.0).speed(speed.value()));
    roadside(s);

    s.duration(200.0);
    s.monitor(Monitor::no_collision(&car));
    s.monitor(Monitor::on_its_way(&car, 2.0));
    s.monitor(Monitor::activity(&car, 10.0));
}
