//! The reference drivers drive a whole simulated car, and are told the truth.

use nalgebra::Vector2;
use paracosm_engine::driver::{Driver, find};
use paracosm_engine::vehicle::Model;
use paracosm_engine::{
    AutonomousVehicle, Briefing, Control, Observation, Outcome, Pedestrian, Program, RoadSegment, Scenario, Side,
    Stream, never, simulate,
};
use paracosm_oracles::Verdict;

const NAMES: [&str; 5] = ["cc", "rss", "fsm", "reg157", "ideal"];

/// Somebody steps onto the road 80 m ahead of a car that comes at 12 m/s, in time to be hit by it.
fn crossing(s: &mut Scenario) {
    let pace = s.interval("pace", 0.0..=2.0);
    let road = s.place(RoadSegment::new(300.0));
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(12.0));
    let walker = s.place(Pedestrian::at(road.on_sidewalk(Side::Right, 90.0)));
    let pace: Stream<f64> = pace.into();
    walker.walk(road.on_sidewalk(Side::Left, 90.0), pace);
    s.duration(20.0);
    s.require("no-collision", never(car.collides()));
}

const PROGRAM: Program = Program { name: "crossing", about: "somebody crosses", build: crossing };

fn outcome(driver: &mut dyn Driver, pace: f64) -> Outcome {
    let mut test = PROGRAM.declare().unwrap().nominal();
    test.set("pace", pace);
    simulate(&PROGRAM, &test, Model::SingleTrack, driver)
}

fn driven_by(name: &str, pace: f64) -> Outcome {
    outcome(find(name).unwrap().build(&[]).unwrap().as_mut(), pace)
}

/// Speeds of the car in m/s, tick by tick.
fn speeds(outcome: &Outcome) -> Vec<f64> {
    outcome.trace.as_ref().unwrap().signal("car.speed").unwrap().collect()
}

#[test]
fn every_reference_driver_spares_somebody_who_crosses_slowly_and_would_be_hit() {
    // 2.75 m from the middle of the lane.
    let pace = 0.4;
    assert_eq!(driven_by("cruise", pace).verdict, Verdict::Fail);
    for name in NAMES {
        let outcome = driven_by(name, pace);
        assert_eq!(outcome.verdict, Verdict::Pass, "{name}");
        assert!(speeds(&outcome).into_iter().any(|speed| speed < 11.0), "{name} did not brake");
    }
}

#[test]
fn no_reference_driver_brakes_for_somebody_who_stands_beside_the_road() {
    let undisturbed = speeds(&driven_by("cruise", 0.0));
    for name in NAMES {
        assert_eq!(speeds(&driven_by(name, 0.0)), undisturbed, "{name}");
    }
}

/// Notes what it sees.
#[derive(Default)]
struct Witness {
    seen: Vec<Observation>,
}

impl Driver for Witness {
    fn period(&self) -> f64 {
        0.1
    }

    fn reset(&mut self, _: &Briefing) {}

    fn step(&mut self, observation: &Observation) -> Control {
        self.seen.push(observation.clone());
        Control::default()
    }
}

#[test]
fn the_velocity_that_a_driver_is_told_is_over_the_ground_and_the_heading_points_along_it() {
    let mut witness = Witness::default();
    outcome(&mut witness, 1.5);
    // 9 m across the road take 6 s.
    for pair in witness.seen[1..50].windows(2) {
        let (now, next) = (&pair[0].others[0], &pair[1].others[0]);
        let relative = (next.position - now.position) / 0.1;
        let over_ground = relative + Vector2::new(12.0, 0.0);
        assert!((now.velocity - over_ground).norm() < 1e-6, "{} {over_ground}", now.velocity);
        let (sin, cos) = libm::sincos(now.heading);
        assert!((now.velocity - 1.5 * Vector2::new(cos, sin)).norm() < 1e-6, "{}", now.heading);
        assert_eq!(now.half_extent(), Vector2::repeat(0.25));
    }
}
