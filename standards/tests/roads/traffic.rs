//! The scenario `map-traffic`: it runs on our own town and on published maps.

use crate::others::{files_of_others, with_ending};
use paracosm_engine::driver::find;
use paracosm_engine::vehicle::VehicleModel;
use paracosm_engine::{Outcome, Program, ProgramError, WorldFlaw, simulate};
use paracosm_oracles::Verdict;
use paracosm_space::{Value, Values};
use paracosm_standards::map_traffic;

/// Returns the nominal test with other values.
fn test(program: &Program, changes: &[(&str, Value)]) -> Values {
    let mut test = program.declare().unwrap().nominal();
    for (name, value) in changes {
        test.set(*name, value.clone());
    }
    test
}

fn drive(program: &Program, test: &Values, driver: &str) -> Outcome {
    let mut driver = find(driver).unwrap().build(&[]).unwrap();
    simulate(program, test, VehicleModel::SingleTrack, driver.as_mut())
}

fn travelled(outcome: &Outcome) -> f64 {
    outcome.measured.as_ref().expect("a run").travelled
}

#[test]
fn the_planner_drives_every_way_over_the_town() {
    let program = map_traffic();
    for route in 1..=8 {
        let outcome = drive(&program, &test(&program, &[("route", route.into())]), "planner");
        assert_eq!(outcome.verdict(), Verdict::Pass, "way {route}: {:?}", outcome.ending.message());
        assert!(travelled(&outcome) > 100.0, "way {route}: {} m", travelled(&outcome));
    }
}

#[test]
fn other_values_of_route_and_traffic_seed_give_other_worlds() {
    let program = map_traffic();
    let hash = |changes: &[(&str, Value)]| drive(&program, &test(&program, changes), "cruise").trace.unwrap().hash();
    let nominal = hash(&[]);
    assert_eq!(hash(&[]), nominal);
    for name in ["route", "traffic_seed"] {
        assert_ne!(hash(&[(name, 2.into())]), nominal, "{name}");
    }
}

#[test]
fn a_map_without_room_for_the_cars_says_how_many_have_room() {
    let program = map_traffic();
    let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/roads/files/geometries.xodr");
    let crowded = test(&program, &[("roads", file.to_str().unwrap().into()), ("cars", 40.0.into())]);
    let error = program.check(&crowded).expect_err("the road is short");
    let ProgramError::World { flaws, .. } = &error else { panic!("{error}") };
    assert!(matches!(flaws.as_slice(), [WorldFlaw::Refused { why }] if why.contains("of 40 cars")), "{error}");
}

#[test]
fn tests_on_published_maps_have_a_verdict() {
    let Some(folder) = files_of_others() else { return };
    let program = map_traffic();
    for file in with_ending(&folder, "xodr") {
        let roads = Value::from(file.to_str().expect("a path"));
        for (driver, route) in [("planner", 1), ("aeb", 5), ("default", 8)] {
            let test = test(&program, &[("roads", roads.clone()), ("cars", 8.0.into()), ("route", route.into())]);
            let outcome = drive(&program, &test, driver);
            let verdict = outcome.verdict();
            assert!(matches!(verdict, Verdict::Pass | Verdict::Fail), "{}: {:?}", file.display(), outcome.ending);
            assert!(travelled(&outcome) > 10.0, "{}", file.display());
        }
    }
}
