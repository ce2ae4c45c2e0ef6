//! Small scenarios of our own: how entities move, who drives the ego vehicle, and which tests a distribution makes.

use super::bad::changed_in;
use paracosm_engine::driver::find;
use paracosm_engine::vehicle::VehicleModel;
use paracosm_engine::{Control, Declared, Ending, Outcome, Program, ProgramError, Run, Setup, Step, simulate};
use paracosm_oracles::Trace;
use paracosm_space::{Domain, Value, Values};
use paracosm_standards::openscenario::Xosc;
use std::path::{Path, PathBuf};

/// Returns a file of our own.
pub fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/scenarios/files").join(name)
}

pub fn program(name: &str) -> Program {
    Xosc::read(&file(name)).unwrap_or_else(|error| panic!("{error}")).program()
}

/// Runs a scenario with nominal values, in which the scenario leads the ego vehicle throughout.
pub fn led(program: &Program) -> Result<Outcome, ProgramError> {
    led_with(program, &program.declare()?.nominal())
}

/// Runs a scenario with the values of a test, in which the scenario leads the ego vehicle throughout.
pub fn led_with(program: &Program, test: &Values) -> Result<Outcome, ProgramError> {
    let setup = Setup { takes_over: false, ..Setup::asking_every(0.1) };
    let mut run = Run::new(program, test, setup)?;
    loop {
        match run.advance() {
            Step::Need(_) => run.supply(Control::default()),
            Step::Done(outcome) => return Ok(*outcome),
        }
    }
}

pub fn driven_by(driver: &str, program: &Program) -> Outcome {
    driven_with(driver, program, &program.declare().unwrap().nominal())
}

pub fn driven_with(driver: &str, program: &Program, test: &Values) -> Outcome {
    let descriptor = find(driver).unwrap();
    let mut driver = (descriptor.make)(&descriptor.settings(&[]).unwrap());
    simulate(program, test, VehicleModel::SingleTrack, driver.as_mut())
}

/// Returns the value of a signal at a time in seconds.
pub fn at(trace: &Trace, signal: &str, seconds: f64) -> f64 {
    let mut values = trace.signal(signal).unwrap_or_else(|| panic!("no signal {signal}"));
    values.nth((seconds / trace.dt()).round() as usize).unwrap()
}

#[test]
fn a_leader_slows_down_at_the_rate_of_its_maneuver() {
    let trace = led(&program("slow-leader.xosc")).unwrap().trace.unwrap();
    for (seconds, speed) in [(0.0, 30.0), (5.0, 30.0), (6.0, 28.0), (14.0, 12.0), (15.0, 10.0), (19.0, 10.0)] {
        assert!((at(&trace, "Leader.speed", seconds) - speed).abs() < 1e-9, "at {seconds} s");
    }
    // 150 m at 30 m/s, then 1000 ticks of which each is 0.02 m/s slower than the one before.
    assert!((at(&trace, "Leader.x", 15.0) - (60.0 + 150.0 + 300.0 - 100.1)).abs() < 1e-6);
    assert_eq!(at(&trace, "Leader.y", 15.0), -1.75);
}

#[test]
fn a_scenario_ends_with_its_stop_trigger() {
    let trace = led(&program("slow-leader.xosc")).unwrap().trace.unwrap();
    let end = (trace.len() - 1) as f64 * trace.dt();
    assert!((end - 20.0).abs() < 0.03, "it ended at {end} s");
}

#[test]
fn no_contact_ends_the_run_of_the_default_driver() {
    let outcome = driven_by("default", &program("slow-leader.xosc"));
    assert_eq!(outcome.ending, Ending::Fail);
    let trace = outcome.trace.unwrap();
    assert_eq!(at(&trace, "Ego.speed", 19.0), 30.0);
    assert!((trace.len() as f64 * trace.dt()) > 19.9);
}

#[test]
fn a_driver_gets_the_car_when_the_scenario_activates_its_controller() {
    let program = program("slow-leader.xosc");
    let trace = driven_by("aeb", &program).trace.unwrap();
    let led = led(&program).unwrap().trace.unwrap();
    for seconds in [0.0, 0.5, 0.99] {
        assert_eq!(at(&trace, "Ego.x", seconds), at(&led, "Ego.x", seconds));
    }
    // The car goes on from its place at the handing over.
    assert!((at(&trace, "Ego.x", 1.02) - at(&led, "Ego.x", 1.02)).abs() < 0.01);
    assert!((at(&trace, "car.travelled", 1.02) - 30.6).abs() < 0.01);
    let last = trace.signal("Ego.speed").unwrap().next_back().unwrap();
    assert!(last < 15.0, "the driver did not brake: {last} m/s");
    // The reference point is the middle of the rear axle, 1.4 m behind the middle of the car.
    assert!((at(&trace, "car.x", 10.0) - at(&trace, "Ego.x", 10.0) - 1.4).abs() < 1e-6);
}

#[test]
fn conditions_along_lanes_see_the_car_of_a_driver_where_it_is() {
    let trigger = "<StopTrigger><ConditionGroup><Condition name=\"near\" delay=\"0\" conditionEdge=\"none\"><ByEntityCondition>\
        <TriggeringEntities triggeringEntitiesRule=\"any\"><EntityRef entityRef=\"Ego\"/></TriggeringEntities><EntityCondition>\
        <RelativeDistanceCondition entityRef=\"Leader\" relativeDistanceType=\"longitudinal\" coordinateSystem=\"road\" \
        value=\"30\" freespace=\"false\" rule=\"lessThan\"/></EntityCondition></ByEntityCondition></Condition></ConditionGroup>";
    let (_folder, path) =
        changed_in("slow-leader.xosc", "<StopTrigger><ConditionGroup>", &format!("{trigger}<ConditionGroup>"));
    let program = Xosc::read(&path).unwrap().program();
    let trace = driven_by("cruise", &program).trace.unwrap();
    let last = |signal: &str| trace.signal(signal).unwrap().next_back().unwrap();
    let distance = last("Leader.x") - last("Ego.x");
    assert!((distance - 30.0).abs() < 0.5, "{distance} m");
}

#[test]
fn a_distribution_opens_its_parameters() {
    let declaration = program("slow-leader-variation.xosc").declare().unwrap();
    let parameter = |name: &str| declaration.parameters.iter().find(|one| one.parameter.name == name).unwrap();
    let numbers = |all: &[f64]| Domain::Choice(all.iter().map(|number| Value::Number(*number)).collect());
    // A range is an interval, of which the tests have the values of the steps.
    assert_eq!(parameter("speed").parameter.domain, Domain::Interval { lo: 20.0, hi: 60.0 });
    assert_eq!(parameter("speed").opened().domain, numbers(&[20.0, 30.0, 40.0, 50.0, 60.0]));
    assert_eq!(parameter("gap").parameter.domain, numbers(&[20.0, 50.0]));
    let open = |declared: &&Declared| declared.open;
    let open: Vec<_> = declaration.parameters.iter().filter(open).map(|declared| &declared.parameter.name).collect();
    assert_eq!(open, ["speed", "gap"]);
    let nominal = declaration.nominal();
    assert_eq!(nominal.get("speed"), Some(&Value::Number(30.0)));
    assert_eq!(nominal.get("gap"), Some(&Value::Number(50.0)));
    assert_eq!(nominal.get("start"), None, "it follows from the gap");
}

#[test]
fn constraints_name_the_parameters_on_which_they_depend() {
    let constraints = program("slow-leader-variation.xosc").declare().unwrap().constraints;
    assert_eq!(constraints.iter().map(|one| one.expression.names()).collect::<Vec<_>>(), [["speed"]]);
}

#[test]
fn another_entity_can_be_the_ego_vehicle() {
    let program = program("slow-leader.xosc");
    let mut test = program.declare().unwrap().nominal();
    assert_eq!(test.get("ego"), Some(&Value::from("Ego")));
    test.set("ego", Value::from("Leader"));
    let trace = driven_with("aeb", &program, &test).trace.unwrap();
    // The car begins where the leader begins: 1.4 m in front of its rear axle.
    assert!((at(&trace, "car.x", 0.0) - at(&trace, "Leader.x", 0.0) - 1.4).abs() < 1e-6);
}

#[test]
fn a_test_that_breaks_a_constraint_is_invalid() {
    let program = program("slow-leader-variation.xosc");
    let mut test = program.declare().unwrap().nominal();
    test.set("speed", Value::Number(50.0));
    program.check(&test).unwrap();
    test.set("speed", Value::Number(60.0));
    let error = program.check(&test).unwrap_err().to_string();
    assert!(
        error.contains("slow-leader.xosc:5: the constraint `speed > 0 and speed <= 50` does not hold for speed = 60"),
        "{error}"
    );
}

#[test]
fn tuples_of_values_are_one_choice() {
    let program = program("slow-leader-tuples.xosc");
    let declaration = program.declare().unwrap();
    let names: Vec<_> = declaration.parameters.iter().map(|declared| declared.parameter.name.as_str()).collect();
    assert_eq!(names, ["speed|gap", "ego", "run_duration"]);
    assert_eq!(declaration.nominal().get("speed|gap"), Some(&Value::from("30|50")));
    let mut test = declaration.nominal();
    test.set("speed|gap", Value::from("20|20"));
    program.check(&test).unwrap();
}

#[test]
fn a_scenario_with_every_element_is_played_to_its_end() {
    let trace = led(&program("everything.xosc")).unwrap().trace.unwrap();
    assert!((trace.len() as f64 * trace.dt() - 20.0).abs() < 0.05);
    // B changes to the lane of the ego vehicle and back.
    assert!((at(&trace, "B.y", 0.5) + 5.25).abs() < 1e-9);
    assert!((at(&trace, "B.y", 3.0) + 1.75).abs() < 0.05, "{}", at(&trace, "B.y", 3.0));
    assert!((at(&trace, "B.y", 8.0) + 5.25).abs() < 1e-6, "{}", at(&trace, "B.y", 8.0));
    // The ego vehicle moves aside, and then to the offset of B, which is on its way then.
    assert!(at(&trace, "Ego.y", 0.9) > -1.74);
    // The pedestrian walks 4 m, and then goes on along the lane at its speed.
    assert!((at(&trace, "Person.y", 0.1) - 8.25).abs() < 1e-9);
    assert!(at(&trace, "Person.y", 8.0) < 4.3);
    // C starts late enough to be at 229 m when the ego vehicle is at 199 m, which is after 9.95 s: 1 m before their targets they arrive.
    assert_eq!(at(&trace, "C.speed", 1.0), 0.0);
    assert!((at(&trace, "C.x", 9.95) - 229.0).abs() < 0.2, "{}", at(&trace, "C.x", 9.95));
    assert_eq!(at(&trace, "Box.x", 19.0), 170.0);
}
