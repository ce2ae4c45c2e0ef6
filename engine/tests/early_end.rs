//! Runs that may end as soon as all that is asked of them is decided.

use paracosm_coverage::Value;
use paracosm_engine::driver::find;
use paracosm_engine::vehicle::Model;
use paracosm_engine::{
    AutonomousVehicle, Car, Metric, Outcome, Program, RoadSegment, Run, Scenario, Step, Test, eventually,
};
use paracosm_oracles::{Formula, Verdict};

/// A car alone, which is asked to come some way.
fn alone(s: &mut Scenario) {
    placed(s);
}

/// One whose premise comes about later than that.
fn late(s: &mut Scenario) {
    let far = placed(s).travelled().at_least(60.0);
    s.premise(&far);
}

fn placed(s: &mut Scenario) -> Car {
    let speed = s.interval("speed", 5.0..=20.0).unit("m/s");
    let road = s.place(RoadSegment::new(400.0));
    let car = s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(speed.value()));
    s.duration(10.0);
    s.require("progress", eventually(car.travelled().at_least(30.0))).unit("m").scale(10.0);
    car
}

fn run(build: fn(&mut Scenario), speed: f64, early: Option<&[&str]>) -> (Outcome, f64) {
    let program = Program { name: "alone", about: "a car alone", build };
    let declaration = program.declare().unwrap();
    let mut test = declaration.nominal();
    test.set("speed", Value::Number(speed));
    let mut driver = find("cruise").unwrap().build(&[]).unwrap();
    let mut run = Run::seated(&program, Test::from(&test), Model::SingleTrack, driver.as_mut()).unwrap();
    if let Some(formulas) = early {
        let formulas: Vec<Formula> = formulas.iter().map(|formula| formula.parse().unwrap()).collect();
        run.end_when_decided(&formulas);
    }
    loop {
        if let Step::Done(outcome) = run.advance() {
            return (*outcome, run.time());
        }
        run.answer(driver.as_mut(), &[]).unwrap();
    }
}

fn ended_early(outcome: &Outcome) -> Option<&Metric> {
    outcome.metrics.iter().find(|(name, _)| name == "ended_early").map(|(_, metric)| metric)
}

#[test]
fn a_run_ends_when_all_is_decided_with_the_verdict_of_the_whole_run() {
    for speed in [6.0, 12.0, 19.0] {
        let (whole, time) = run(alone, speed, None);
        assert!(time == 10.0 && ended_early(&whole).is_none());
        let (early, at) = run(alone, speed, Some(&[]));
        assert!((at - 30.0 / speed).abs() < 0.3, "{at} s at {speed} m/s");
        assert_eq!((early.verdict, ended_early(&early)), (Verdict::Pass, Some(&Metric::Flag(true))));
        assert_eq!(whole.verdict, early.verdict);
        // That of what was run, on the same side of 0.
        let worth = |outcome: &Outcome| outcome.robustness[0].1.unwrap();
        assert!((0.0..0.5).contains(&worth(&early)) && worth(&whole) > 20.0);
    }
}

#[test]
fn what_is_asked_beside_has_to_be_decided_as_well() {
    let (_, at) = run(alone, 10.0, Some(&["always[0,5] (car.speed > 1)"]));
    assert!((at - 5.0).abs() < 0.02, "{at} s");
    let (violated, at) = run(alone, 10.0, Some(&["always (car.travelled < 45)"]));
    assert!((at - 4.5).abs() < 0.1, "{at} s");
    assert_eq!(violated.verdict, Verdict::Pass, "its own requirements are what a run is judged by");
    for undecided in ["always (car.speed > 1)", "always[0,60] (car.speed > 1)", "always (no.such > 1)"] {
        assert_eq!(run(alone, 10.0, Some(&[undecided])).1, 10.0, "{undecided}");
    }
}

#[test]
fn a_run_whose_premise_may_still_come_about_goes_on() {
    let (whole, _) = run(late, 10.0, None);
    let (early, at) = run(late, 10.0, Some(&[]));
    assert!((at - 6.0).abs() < 0.1, "{at} s");
    assert_eq!((whole.verdict, early.verdict), (Verdict::Pass, Verdict::Pass));
    // Where it never does, it is as inconclusive as it was.
    let (slow, at) = run(late, 5.0, Some(&[]));
    assert_eq!((slow.verdict, at), (Verdict::Inconclusive, 10.0));
}
