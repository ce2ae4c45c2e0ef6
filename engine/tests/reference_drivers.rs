//! The reference drivers drive a whole simulated car, and are told the truth.

use nalgebra::Vector2;
use paracosm_engine::driver::{Driver, Fault, find};
use paracosm_engine::vehicle::VehicleModel;
use paracosm_engine::{
    AutonomousVehicle, Briefing, Control, Mover, Observation, Outcome, Pedestrian, Program, RoadSegment, Scenario,
    Side, Stream, never, simulate,
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

const PROGRAM: Program = Program::new("crossing", "somebody crosses", crossing);

fn outcome(driver: &mut dyn Driver, pace: f64) -> Outcome {
    let mut test = PROGRAM.declare().unwrap().nominal();
    test.set("pace", pace);
    simulate(&PROGRAM, &test, VehicleModel::SingleTrack, driver)
}

/// A car stands 60 m ahead of one that comes at 12 m/s, and drives on with 5 m/s when it has stood long enough.
fn standing(s: &mut Scenario) {
    let leaves = s.interval("leaves", 0.0..=100.0).unit("s");
    let road = s.place(RoadSegment::new(600.0));
    let car = s.place(AutonomousVehicle::along(road.path(1)).starting(10.0).speed(12.0));
    let speed = (Stream::time() - leaves.value()).max(0.0).min(5.0);
    s.place(Mover::car(road.path(1)).starting(75.0).speed(speed));
    s.duration(60.0);
    s.require("no-collision", never(car.collides()));
}

const STANDING: Program = Program::new("standing", "a car stands in the way", standing);

fn behind_a_standing_car(name: &str, leaves: f64) -> Outcome {
    let mut test = STANDING.declare().unwrap().nominal();
    test.set("leaves", leaves);
    simulate(&STANDING, &test, VehicleModel::SingleTrack, find(name).unwrap().build(&[]).unwrap().as_mut())
}

/// Seconds from one sample to the next.
const TICK: f64 = paracosm_engine::DEFAULT_DT;

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
    assert_eq!(driven_by("cruise", pace).verdict(), Verdict::Fail);
    for name in NAMES {
        let outcome = driven_by(name, pace);
        assert_eq!(outcome.verdict(), Verdict::Pass, "{name}");
        assert!(speeds(&outcome).into_iter().any(|speed| speed < 11.0), "{name} did not brake");
    }
}

#[test]
fn every_reference_driver_waits_behind_a_standing_car_for_as_long_as_it_stands() {
    for name in NAMES {
        let outcome = behind_a_standing_car(name, 100.0);
        assert_eq!(outcome.verdict(), Verdict::Pass, "{name}");
        let speeds = speeds(&outcome);
        let stops = speeds.iter().position(|speed| *speed < 1e-3).unwrap_or_else(|| panic!("{name} does not stop"));
        let waits = &speeds[stops..];
        assert!(waits.len() as f64 * TICK > 30.0, "{name} stops too late");
        assert!(waits.iter().all(|speed| *speed < 1e-3), "{name} takes up speed again");
    }
}

#[test]
fn every_reference_driver_follows_a_car_that_drives_on_and_does_not_run_into_it() {
    for name in NAMES {
        let outcome = behind_a_standing_car(name, 40.0);
        assert_eq!(outcome.verdict(), Verdict::Pass, "{name}");
        let speeds = speeds(&outcome);
        let waits = (30.0 / TICK) as usize..(40.0 / TICK) as usize;
        assert!(speeds[waits].iter().all(|speed| *speed < 1e-3), "{name} does not wait");
        assert!(*speeds.last().unwrap() > 4.5, "{name} does not drive on");
    }
}

#[test]
fn every_reference_driver_waits_for_somebody_who_crosses_and_goes_on_when_the_way_is_free() {
    let pace = 0.4;
    // From 2.75 m to the right to 0.805 m and 0.25 m to the left of the middle of the lane.
    let free = (2.75 + 0.805 + 0.25) / pace;
    for name in NAMES {
        let speeds = speeds(&driven_by(name, pace));
        let brakes = speeds.iter().position(|speed| *speed < 11.9).unwrap();
        let before = &speeds[brakes..((free - 0.1) / TICK) as usize];
        assert!(before.windows(2).all(|pair| pair[1] < pair[0] + 1e-6), "{name} takes up speed in front of somebody");
        assert!(*speeds.last().unwrap() > 11.0, "{name} does not go on: {:?}", speeds.last());
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

    fn reset(&mut self, _: &Briefing) -> Result<(), Fault> {
        Ok(())
    }

    fn step(&mut self, observation: &Observation) -> Result<Control, Fault> {
        self.seen.push(observation.clone());
        Ok(Control::default())
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
