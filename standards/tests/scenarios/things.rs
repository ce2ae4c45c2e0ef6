//! Objects and signals of maps in the worlds of scenarios.

use super::worlds::{at, driven_by, file, led};
use paracosm_engine::object::Class;
use paracosm_engine::{Ending, Program, Run, Setup};
use paracosm_standards::openscenario::Xosc;
use std::fs;
use tempfile::TempDir;

/// Things beside the road `straight.xodr`, in whose lane -1 the ego vehicle drives from x = 10 m on, and a light over this lane.
const BESIDE: &str = r#"
    <objects><object id="tree" type="tree" s="150" t="-12" radius="0.3" height="6" zOffset="0"/></objects>
    <signals>
        <signal id="limit" type="274" s="300" t="-10" zOffset="2" height="0.6"/>
        <signal id="light" type="1000001" s="200" t="-1.75" zOffset="5" height="0.9"/>
    </signals>"#;
/// A block in the lane of the ego vehicle, and a wall across the place at which the ego vehicle begins.
const IN_THE_WAY: &str = r#"<objects>
        <object id="block" type="obstacle" s="200" t="-1.75" length="2" width="2" height="1" zOffset="0"/>
        <object id="wall" type="barrier" s="11" t="-1.75" length="0.2" width="3" height="1" zOffset="0"/>
    </objects>"#;
const WALL: &str = r#"<object id="wall""#;

/// Returns `slow-leader.xosc` on a road with these things.
fn with(things: &str) -> (TempDir, Program) {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("catalogs")).unwrap();
    for name in ["slow-leader.xosc", "catalogs/entities.xosc"] {
        fs::copy(file(name), folder.path().join(name)).unwrap();
    }
    let road = fs::read_to_string(file("straight.xodr")).unwrap();
    fs::write(folder.path().join("straight.xodr"), road.replacen("</road>", &format!("{things}</road>"), 1)).unwrap();
    let program = Xosc::read(&folder.path().join("slow-leader.xosc")).unwrap_or_else(|error| panic!("{error}"));
    (folder, program.program())
}

/// Returns the things without the wall.
fn block_alone() -> String {
    let line = IN_THE_WAY.lines().find(|line| line.contains(WALL)).unwrap();
    IN_THE_WAY.replacen(line, "", 1)
}

#[test]
fn things_of_the_map_stand_in_the_world() {
    let (_folder, program) = with(&format!("{BESIDE}{}", block_alone()));
    let run = Run::new(&program, &program.declare().unwrap().nominal(), Setup::asking_every(0.1)).unwrap();
    let bodies = run.bodies().iter().enumerate().skip(2);
    let found: Vec<_> = bodies
        .map(|(index, state)| (run.name_of(index), state.body.class, state.pose.position.x, state.pose.position.y))
        .collect();
    // The block is in the way of everybody, and the other things are scenery. The light hangs over the lane.
    let expected =
        [("prop", Class::Prop, 200.0, -1.75), ("tree", Class::Tree, 150.0, -12.0), ("sign", Class::Sign, 300.0, -10.0)];
    assert_eq!(found, expected);
}

#[test]
fn a_car_runs_into_a_thing_on_its_lane_or_brakes_for_it() {
    let (_folder, program) = with(&format!("{BESIDE}{}", block_alone()));
    let blind = driven_by("cruise", &program);
    assert_eq!(blind.ending, Ending::Fail);
    let trace = blind.trace.unwrap();
    let last = trace.len() - 1;
    let x = trace.signal("car.x").unwrap().nth(last).unwrap();
    assert!((x + 2.5 - 199.0).abs() < 0.5, "the car ended at {x} m");
    let braking = driven_by("aeb", &program).trace.unwrap();
    let [x, speed] = ["car.x", "car.speed"].map(|name| braking.signal(name).unwrap().next_back().unwrap());
    assert!(x + 2.5 < 199.0 && speed < 0.1, "the car ended at {x} m with {speed} m/s");
}

#[test]
fn entities_go_through_things_where_the_scenario_leads_them() {
    let without = led(&with("").1).unwrap().trace.unwrap();
    let (_folder, program) = with(&format!("{BESIDE}{IN_THE_WAY}"));
    let trace = led(&program).unwrap().trace.unwrap();
    assert_eq!(trace.len(), without.len());
    for entity in ["Ego", "Leader"] {
        for signal in ["x", "y", "heading", "speed"].map(|part| format!("{entity}.{part}")) {
            assert!(trace.signal(&signal).unwrap().eq(without.signal(&signal).unwrap()), "{signal}");
        }
    }
    // The leader goes through the block where a driver has the ego vehicle, too.
    let driven = driven_by("aeb", &with(&block_alone()).1).trace.unwrap();
    assert!(at(&driven, "Leader.x", 5.0) > 205.0);
    // A driver cannot begin within a wall.
    let ending = driven_by("aeb", &program).ending;
    assert!(matches!(ending, Ending::Invalid(_)), "{ending:?}");
}
