//! How the driver `lane-camera` goes round bends.

use super::can_draw;
use crate::{Study, Worker};
use paracosm_engine::road::{Composite, RoadSegment};
use paracosm_engine::{AutonomousVehicle, Monitor, Program, Scenario};
use paracosm_space::Values;

const BEND: Program = Program::new("bend", "a straight way into a bend", bend);

/// 30 m straight on, and then 90 degrees to the left or to the right.
fn bend(s: &mut Scenario) {
    let radius = s.interval("radius", 10.0..=300.0).unit("m");
    let speed = s.interval("speed", 2.0..=30.0).unit("m/s");
    let side = s.choice("side", ["left", "right"]);
    let angle = std::f64::consts::FRAC_PI_2 * if side.value() == "left" { 1.0 } else { -1.0 };
    let straight = Composite::from(RoadSegment::new(30.0).named("straight"));
    let curved = RoadSegment::arc(radius.value(), angle).named("curved");
    let after = RoadSegment::new(60.0).named("after");
    let streets = s.place(straight.connect("straight.two", curved, "one").connect("curved.two", after, "one"));
    let way = streets.way(("straight", 1, 5.0), ("after", 1, 30.0));
    s.duration(way.length() / speed.value());
    let car = s.place(AutonomousVehicle::along(way).speed(speed.value()));
    s.monitor(Monitor::lane_keeping(&car));
}

/// How much room is left beside the car in its lane, in metres, at its worst.
fn margin(worker: &mut Worker<'_>, side: &str, radius: f64, speed: f64) -> f64 {
    let mut test = Values::default();
    test.set("radius", radius);
    test.set("speed", speed);
    test.set("side", side);
    let trial = worker.run(0, &test).0;
    trial.robustness("lane-keeping").unwrap_or_else(|| panic!("{:?}", trial.error()))
}

#[test]
fn it_keeps_its_lane_in_bends_that_ask_for_little_and_leaves_it_where_tyres_cannot_hold() {
    if !can_draw() {
        return;
    }
    let study = Study::of(BEND).driver("lane-camera").build().unwrap();
    let mut worker = Worker::new(&study).unwrap();
    for side in ["left", "right"] {
        for (radius, speed) in [(15.0, 5.0), (20.0, 8.0), (30.0, 10.0), (70.0, 14.0), (150.0, 22.0)] {
            let left = margin(&mut worker, side, radius, speed);
            assert!(left > 0.3, "{side}, {radius} m at {speed} m/s: {left} m");
        }
        // It does not slow down for them.
        for (radius, speed) in [(20.0, 14.0), (45.0, 22.0)] {
            let left = margin(&mut worker, side, radius, speed);
            assert!(left < 0.0, "{side}, {radius} m at {speed} m/s: {left} m");
        }
    }
}
