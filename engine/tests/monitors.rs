//! Monitors: what each says of a drive that is known beforehand.

use paracosm_engine::road::{Path, RoadSegment, TIntersection};
use paracosm_engine::vehicle::VehicleModel;
use paracosm_engine::{
    AutonomousVehicle, Car, Control, Monitor, Mover, Outcome, Program, Run, Scenario, Setup, Step, driver, simulate,
};
use paracosm_oracles::Verdict;
use paracosm_space::Values;

/// Runs a program with throttle and steering over time.
fn drive(build: fn(&mut Scenario), control: impl Fn(f64) -> (f64, f64)) -> Outcome {
    let program = Program::new("monitors", "monitors", build);
    let setup = Setup { vehicle: VehicleModel::SingleTrack.into(), ..Setup::asking_every(0.01) };
    let mut run = Run::new(&program, &Values::default(), setup).unwrap_or_else(|error| panic!("{error}"));
    loop {
        let time = match run.advance() {
            Step::Need(observation) => observation.time,
            Step::Done(outcome) => return *outcome,
        };
        let (throttle, steering) = control(time);
        run.supply(Control { throttle, steering });
    }
}

fn coast(_: f64) -> (f64, f64) {
    (0.0, 0.0)
}

fn robustness(outcome: &Outcome, id: &str) -> f64 {
    outcome.robustness(id).unwrap_or_else(|| panic!("{id} is undecided or unknown: {outcome:?}"))
}

/// A car that begins at 10 m/s on a road of 300 m, for 5 s.
fn car(s: &mut Scenario) -> Car {
    let road = s.place(RoadSegment::new(300.0));
    s.duration(5.0);
    s.place(AutonomousVehicle::along(road.path(1)).starting(20.0).speed(10.0))
}

#[track_caller]
fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-6, "{found}, expected {expected}");
}

#[test]
fn progress_is_the_way_beyond_what_is_asked() {
    let outcome = drive(
        |s| {
            let car = car(s);
            s.monitor(Monitor::progress(&car, 40.0));
            s.monitor(Monitor::route_completion(&car, 250.0));
        },
        coast,
    );
    assert_near(robustness(&outcome, "progress"), 10.0);
    assert_near(robustness(&outcome, "route-completion"), 20.0);
}

#[test]
fn a_speed_limit_is_kept_by_what_is_left_to_it() {
    let outcome = drive(
        |s| {
            let car = car(s);
            s.monitor(Monitor::speed_limit(&car, 12.5));
        },
        coast,
    );
    assert_near(robustness(&outcome, "speed-limit"), 2.5);
}

#[test]
fn activity_is_violated_by_a_car_that_stands_too_long_and_not_by_one_that_goes_on() {
    fn build(s: &mut Scenario) {
        let car = car(s);
        s.monitor(Monitor::activity(&car, 2.0));
    }
    let stops = drive(build, |_| (-1.0, 0.0));
    assert_eq!(stops.verdict(), Verdict::Fail);
    let standing = 5.0 - 10.0 / (0.8 * 9.80665);
    assert!((robustness(&stops, "activity") - (2.0 - standing)).abs() < 0.05, "{:?}", stops.judgements);
    let goes_on = drive(build, |time| if time < 2.5 { (-1.0, 0.0) } else { (0.5, 0.0) });
    assert_eq!(goes_on.verdict(), Verdict::Pass, "{:?}", goes_on.judgements);
    assert!(robustness(&goes_on, "activity") > 0.0);
}

#[test]
fn clearance_headway_and_time_to_collision_are_those_to_the_car_ahead() {
    let outcome = drive(
        |s| {
            let car = car(s);
            let path = Path::straight([0.0, -1.75].into(), [300.0, -1.75].into());
            // From bumper to bumper 40 m, shrinking by 4 m/s.
            let ahead = Mover::car(path).starting(20.0 + 40.0 + 0.5 * (4.508 + 4.5)).speed(6.0);
            s.place(ahead);
            s.monitor(Monitor::clearance(&car, 15.0));
            s.monitor(Monitor::headway(&car, 1.0));
            s.monitor(Monitor::time_to_collision(&car, 3.0));
            s.monitor(Monitor::no_collision(&car));
        },
        coast,
    );
    assert_near(robustness(&outcome, "clearance"), 20.0 - 15.0);
    assert_near(robustness(&outcome, "no-collision"), 20.0);
    assert_near(robustness(&outcome, "headway"), 2.0 - 1.0);
    assert_near(robustness(&outcome, "time-to-collision"), 5.0 - 3.0);
}

#[test]
fn lane_keeping_is_what_is_left_of_the_lane_beside_the_car() {
    fn build(s: &mut Scenario) {
        let car = car(s);
        s.monitor(Monitor::lane_keeping(&car));
        s.monitor(Monitor::on_its_way(&car, 0.5));
    }
    let straight = drive(build, coast);
    assert_near(robustness(&straight, "lane-keeping"), 0.5 * (3.5 - 1.61));
    assert_near(robustness(&straight, "on-its-way"), 0.5);
    let swerves = drive(build, |time| (0.0, if time < 1.0 { -0.05 } else { 0.0 }));
    assert_eq!(swerves.verdict(), Verdict::Fail);
    assert!(robustness(&swerves, "lane-keeping") < 0.0 && robustness(&swerves, "on-its-way") < 0.0);
}

#[test]
fn jerk_is_how_fast_the_brakes_are_put_on() {
    let outcome = drive(
        |s| {
            let car = car(s);
            s.monitor(Monitor::jerk(&car, 40.0));
        },
        |time| (-(0.2 * time).min(0.4), 0.0),
    );
    // 0.2 a second of 11.5 m/s² is 2.3 m/s³, until the brakes of the car that has stopped let go.
    let found = robustness(&outcome, "jerk");
    assert!(found < 40.0 - 2.3 + 0.1, "{found}");
}

/// A T at which the car turns left from the stem, while another comes along the bar, `away` metres from the T.
fn tee(s: &mut Scenario, away: f64) {
    let arm = |name: &str| RoadSegment::new(100.0).named(name);
    let network = TIntersection::new().connect("one", arm("east"), "one").connect("two", arm("south"), "one");
    let streets = s.place(network.connect("three", arm("west"), "one"));
    let car = s.place(AutonomousVehicle::along(streets.way(("south", -1, 40.0), ("west", 1, 60.0))).speed(5.0));
    let way = streets.way(("west", -1, away), ("east", 1, 90.0));
    s.place(Mover::car(way).speed(10.0));
    s.duration(12.0);
    s.monitor(Monitor::right_of_way(&car, 1.0));
}

#[test]
fn the_right_of_way_is_taken_from_who_comes_soon_and_not_from_who_is_gone() {
    let run = |build: fn(&mut Scenario)| {
        let program = Program::new("tee", "a T", build);
        let mut driver = driver::find("cruise").unwrap().build(&[]).unwrap();
        simulate(&program, &Values::default(), VehicleModel::SingleTrack, driver.as_mut())
    };
    let soon = run(|s| tee(s, 85.0));
    assert_eq!(soon.verdict(), Verdict::Fail, "{:?} {:?}", soon.judgements, soon.ending.message());
    let gone = run(|s| tee(s, 20.0));
    assert_eq!(gone.verdict(), Verdict::Pass, "{:?} {:?}", gone.judgements, gone.ending.message());
}

#[test]
fn a_car_that_has_just_begun_to_stand_is_not_inactive() {
    let outcome = drive(
        |s| {
            let road = s.place(RoadSegment::new(300.0));
            s.duration(5.0);
            let car = s.place(AutonomousVehicle::along(road.path(1)).starting(20.0));
            s.monitor(Monitor::activity(&car, 2.0));
        },
        |time| (if time < 1.0 { 0.0 } else { 0.5 }, 0.0),
    );
    assert_eq!(outcome.verdict(), Verdict::Pass, "{:?}", outcome.judgements);
    assert!((robustness(&outcome, "activity") - 1.0).abs() < 0.1);
}

#[test]
fn a_car_that_is_just_to_go_straight_on_completes_no_route() {
    let outcome = drive(
        |s| {
            let road = s.place(RoadSegment::new(300.0));
            s.duration(1.0);
            let car = s.place(AutonomousVehicle::at(road.on_lane(1, 20.0)).speed(10.0));
            s.monitor(Monitor::route_completion(&car, 5.0));
        },
        coast,
    );
    assert_eq!(outcome.verdict(), Verdict::Fail);
}

#[test]
fn a_run_that_a_contact_ends_before_anything_is_decided_is_inconclusive() {
    let outcome = drive(
        |s| {
            let car = car(s);
            let path = Path::straight([0.0, -1.75].into(), [300.0, -1.75].into());
            s.place(Mover::car(path).starting(40.0));
            s.monitor(Monitor::progress(&car, 100.0));
        },
        coast,
    );
    assert_eq!((outcome.verdict(), outcome.judgements[0].robustness), (Verdict::Inconclusive, None));
}
