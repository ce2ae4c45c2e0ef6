//! A strategy, a driver, a scenario, a measure, a sensor and a camera setting that only this module knows are shown
//! like all others.

use super::*;
use crate::coverage::Measure;
use crate::coverage::measure::{self, Compare, Computation};
use crate::engine::driver::{self, Driver, Fault};
use crate::engine::{AutonomousVehicle, Briefing, Control, Observation, RoadSegment, Scenario, sensor};
use crate::generators::{self, Look, MarkShape, Strategy};

static STRATEGY: generators::Descriptor = generators::Descriptor {
    name: "scratch-strategy",
    about: "a strategy of this test",
    dims: 1..=2,
    look: Look::filled(0x12_3456, MarkShape::Circle),
    method: generators::Method::own(|request| Strategy::HALTON.build(request)),
};

static MEASURE: measure::Descriptor = measure::Descriptor {
    name: "scratch-measure",
    key: "scratch_measure",
    label: "scratch",
    title: "scratch measure",
    about: "a measure of this test",
    pace: 0,
    compare: Compare::Always,
    method: Computation::Number(|points, _| Some(points.len() as f64)),
};

struct Idle;

impl Driver for Idle {
    fn period(&self) -> f64 {
        0.1
    }

    fn reset(&mut self, _: &Briefing) -> Result<(), Fault> {
        Ok(())
    }

    fn step(&mut self, _: &Observation) -> Result<Control, Fault> {
        Ok(Control { throttle: 0.0, steering: 0.0 })
    }
}

static DRIVER: driver::Descriptor = driver::Descriptor {
    name: "scratch-driver",
    about: "a driver of this test",
    settings: &[Setting {
        name: "patience",
        default: 1.5,
        unit: "s",
        range: (0.0, 9.0),
        whole: false,
        about: "a setting of this test",
    }],
    make: |_| Box::new(Idle),
};

const SENSOR: sensor::Descriptor = sensor::Descriptor { name: "scratch-sensor", about: "a sensor of this test" };

const CAMERA: CameraSetting =
    CameraSetting::of_lens("scratch-setting", "px", (0.0, 8.0), "a camera setting of this test");

const SCENARIO: Program = Program::new("scratch-scenario", "a scenario of this test", |s: &mut Scenario| {
    let speed = s.interval("scratch_speed", 1.0..=6.0).unit("m/s");
    let road = s.place(RoadSegment::new(100.0));
    s.place(AutonomousVehicle::at(road.on_lane(1, 10.0)).speed(speed.value()));
});

fn with_scratch() -> Lists {
    let mut lists = Lists::of(&crate::catalogue());
    lists.scenarios.push(SCENARIO);
    lists.strategies.push(Strategy::of(&STRATEGY));
    lists.drivers.push(ListedDriver::of(&DRIVER));
    lists.measures.push(Measure::of(&MEASURE));
    lists.sensors.push(SENSOR);
    lists.cameras.push(CAMERA);
    lists
}

const NAMES: [&str; 6] =
    ["scratch-scenario", "scratch-strategy", "scratch-driver", "scratch-measure", "scratch-sensor", "scratch-setting"];

#[test]
fn whatever_has_a_descriptor_is_in_the_table_with_its_settings() {
    let Ok(text) = table(&with_scratch(), ListKind::value_variants()) else { panic!("every scenario can be declared") };
    for name in NAMES {
        assert!(text.lines().any(|line| line.starts_with(&format!("  {name}"))), "{name} is missing in {text}");
    }
    assert!(text.contains("    patience             1.5 s         a setting of this test"), "{text}");
    assert!(text.contains("scratch_speed"), "{text}");
}

#[test]
fn whatever_has_a_descriptor_is_in_the_json_of_its_kind() {
    let lists = with_scratch();
    for (kind, name) in ListKind::value_variants().iter().zip(NAMES) {
        let Ok(all) = as_json(&lists, &[*kind]) else { panic!("every scenario can be declared") };
        let list = all[key(*kind)].as_array().expect("a list");
        assert!(list.iter().any(|entry| entry["name"] == name), "{name} is missing in {all}");
        assert_eq!(all.as_object().expect("an object").len(), 1);
    }
}

#[test]
fn whatever_has_a_descriptor_is_in_the_tables_of_the_documents() {
    let Ok(text) = markdown(&with_scratch(), ListKind::value_variants()) else {
        panic!("every scenario can be declared")
    };
    for name in NAMES {
        assert!(text.contains(&format!("\n| `{name}` | a ")), "{name} is missing in {text}");
    }
    assert!(text.contains("| `scratch-driver` | `patience` | 1.5 s | 0 to 9 | a setting of this test |"), "{text}");
}

const WITHOUT_A_CAR: Program =
    Program::new("scratch-empty", "a road without a car", |s: &mut Scenario| drop(s.place(RoadSegment::new(100.0))));

const PANICKING: Program = Program::new("scratch-panic", "a scenario that panics", |_: &mut Scenario| {
    panic!("a table of a test has no row 7");
});

#[test]
fn a_wrong_scenario_shows_its_error_and_hides_no_other() {
    let mut lists = with_scratch();
    lists.scenarios.insert(0, WITHOUT_A_CAR);
    lists.scenarios.insert(0, PANICKING);
    let panicked = "scenario `scratch-panic` panicked with nominal values: a table of a test has no row 7";
    let Ok(text) = table(&lists, &[ListKind::Scenarios]) else { panic!("the list is printed") };
    assert!(text.contains(&format!("a scenario that panics\n    error: {panicked}\n  scratch-empty")), "{text}");
    assert!(text.contains("a road without a car\n    error: scenario `scratch-empty`: "), "{text}");
    assert!(text.contains("scratch_speed"), "{text}");
    let Ok(page) = markdown(&lists, &[ListKind::Scenarios]) else { panic!("the list is printed") };
    assert!(
        page.contains(&format!("| `scratch-panic` | error: {panicked} |")) && page.contains("scratch_speed"),
        "{page}"
    );
    let Ok(all) = as_json(&lists, &[ListKind::Scenarios]) else { panic!("the list is printed") };
    assert_eq!(all["scenarios"][0]["error"], panicked);
    assert!(all["scenarios"][2]["error"].is_null() && all["scenarios"][2]["parameters"].is_array(), "{all}");
}

#[test]
fn the_page_of_names_is_what_the_command_prints() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/reference.md");
    let lists = Lists::of(&crate::catalogue());
    let Ok(text) = markdown(&lists, ListKind::value_variants()) else { panic!("every scenario can be declared") };
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(page, &text).unwrap();
    }
    assert!(std::fs::read_to_string(page).unwrap_or_default() == text, "UPDATE_GOLDEN=1 writes docs/reference.md anew");
}

#[test]
fn no_two_of_a_kind_have_the_same_name() {
    let lists = Lists::of(&crate::catalogue());
    let names: [Vec<&str>; 6] = [
        lists.scenarios.iter().map(Program::name).collect(),
        lists.strategies.iter().map(|it| it.name()).collect(),
        lists.drivers.iter().map(|it| it.name).collect(),
        lists.measures.iter().map(|it| it.name()).collect(),
        lists.sensors.iter().map(|it| it.name).collect(),
        lists.cameras.iter().map(|it| it.name).collect(),
    ];
    for mut names in names {
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count, "{names:?}");
    }
}
