//! How long runs last, and when the driver has the ego vehicle.

use super::bad::changed_in;
use super::worlds::{at, driven_with, led_with};
use paracosm_engine::{Outcome, Program};
use paracosm_space::{Value, Values};
use paracosm_standards::openscenario::{DURATION, Xosc};

const LEADER: &str = "slow-leader.xosc";
const STATE: &str = "<StoryboardElementStateCondition storyboardElementType=\"event\" storyboardElementRef=\"slowing down\" \
                     state=\"completeState\"/>";
const ACTIVATION: &str = "<ActivateControllerAction lateral=\"true\" longitudinal=\"true\"/>";

fn program(path: &std::path::Path) -> Program {
    Xosc::read(path).unwrap_or_else(|error| panic!("{error}")).program()
}

fn nominal(program: &Program) -> Values {
    program.declare().unwrap().nominal()
}

/// Runs the scenario of the slow leader with another stop trigger, and returns the outcome and its duration in seconds.
fn with_stop(condition: &str, duration: Option<f64>) -> (Outcome, f64) {
    let (_folder, path) = changed_in(LEADER, STATE, condition);
    let program = program(&path);
    let mut test = nominal(&program);
    if let Some(seconds) = duration {
        test.set(DURATION, Value::from(seconds));
    }
    let outcome = led_with(&program, &test).unwrap();
    let trace = outcome.trace.as_ref().unwrap();
    let seconds = (trace.len() - 1) as f64 * trace.dt();
    (outcome, seconds)
}

#[test]
fn a_run_without_its_stop_trigger_lasts_40_s_and_its_delay_or_as_long_as_somebody_says() {
    let never = "<SimulationTimeCondition value=\"0\" rule=\"lessThan\"/>";
    let never_of_state = STATE.replace("completeState", "skipTransition");
    for (duration, expected) in [(None, 40.0), (Some(12.5), 12.5), (Some(90.0), 90.0)] {
        // The delay of the condition is 5 s. The moment of a trigger at a time is known, and has passed here.
        for (stop, delay) in [(never, 0.0), (never_of_state.as_str(), 5.0)] {
            let (_, seconds) = with_stop(stop, duration);
            assert!((seconds - expected - delay).abs() < 0.011, "{seconds} s for {duration:?}");
        }
    }
}

#[test]
fn a_stop_trigger_at_a_later_time_still_comes() {
    // The delay of the condition is 5 s.
    for time in [50.0, 3600.0] {
        let stop = format!("<SimulationTimeCondition value=\"{time}\" rule=\"greaterOrEqual\"/>");
        let (_, seconds) = with_stop(&stop, Some(10.0));
        assert!((time + 4.99..time + 5.03).contains(&seconds), "{seconds} s");
    }
}

#[test]
fn the_name_of_the_duration_is_taken() {
    let (_folder, path) = changed_in(LEADER, "name=\"start\"", "name=\"run_duration\"");
    let message = Xosc::read(&path).err().expect("it is refused").to_string();
    assert!(message.contains("another name, because this one gives the duration of a run"), "{message}");
}

/// Returns the notes on the ego vehicle and the speed at 12 s with a driver that brakes from 30 m/s behind the leader.
fn handed_over(activation: &str) -> (Vec<String>, f64) {
    let (_folder, path) = changed_in(LEADER, ACTIVATION, activation);
    let program = program(&path);
    let test = nominal(&program);
    let trace = driven_with("aeb", &program, &test).trace.unwrap();
    let start = format!("{}:", path.display());
    let notes = program.notes(&test);
    let notes = notes.iter().filter_map(|note| note.strip_prefix(&start)).filter(|note| note.contains("driver"));
    (notes.map(str::to_owned).collect(), at(&trace, "car.speed", 5.0))
}

#[test]
fn a_driver_has_the_car_once_both_of_its_controls_are_active() {
    let one = "<ControllerAction><ActivateControllerAction longitudinal=\"true\"/></ControllerAction>";
    let (notes, whole) = handed_over(ACTIVATION);
    assert!(notes.is_empty(), "{notes:?}");
    // One action after the other, in one event.
    let rest = "</PrivateAction></Action><Action name=\"lateral\"><PrivateAction><ControllerAction>\
                <ActivateControllerAction lateral=\"true\"/>";
    let (notes, parts) =
        handed_over(&format!("<ActivateControllerAction longitudinal=\"true\"/></ControllerAction>{rest}"));
    assert!(notes.is_empty(), "{notes:?}");
    assert_eq!(parts.to_bits(), whole.to_bits());
    let half = one.trim_start_matches("<ControllerAction>").trim_end_matches("</ControllerAction>");
    let (notes, led) = handed_over(half);
    let says = "a driver never drives `Ego`, because no action activates its lateral control; a driver needs both";
    assert!(notes[0].ends_with(says), "{notes:?}");
    assert_ne!(led.to_bits(), whole.to_bits());
}

#[test]
fn a_driver_drives_from_the_beginning_and_keeps_the_car_if_actions_only_deactivate_it() {
    let (notes, _) = handed_over("<ActivateControllerAction lateral=\"false\" longitudinal=\"false\"/>");
    assert!(notes[0].ends_with("a driver that has `Ego` keeps it, although the action deactivates it"), "{notes:?}");
}

#[test]
fn an_entity_that_gets_a_controller_is_the_usual_ego_vehicle() {
    let (_folder, path) = changed_in(LEADER, "<ScenarioObject name=\"Ego\">", "<ScenarioObject name=\"Own\">");
    let text = std::fs::read_to_string(&path).unwrap().replace("\"Ego\"", "\"Own\"");
    let without = {
        let begin = text.find("<ObjectController>");
        begin.map_or(text.clone(), |begin| {
            let end = text.find("</ObjectController>").unwrap() + "</ObjectController>".len();
            format!("{}{}", &text[..begin], &text[end..])
        })
    };
    let assign = "<PrivateAction><ControllerAction><AssignControllerAction activateLateral=\"false\" \
                  activateLongitudinal=\"false\"><Controller name=\"a\"><Properties/></Controller></AssignControllerAction>\
                  </ControllerAction></PrivateAction>";
    let private = "<Private entityRef=\"Leader\">";
    let assigned = without.replacen(private, &format!("{private}{assign}"), 1);
    std::fs::write(&path, assigned).unwrap();
    assert_eq!(nominal(&program(&path)).get("ego"), Some(&Value::from("Leader")));
}

#[test]
fn a_contact_that_does_not_end_the_run_is_in_the_measurements() {
    let (_folder, path) = changed_in(LEADER, ACTIVATION, ACTIVATION);
    let program = program(&path);
    let mut test = nominal(&program);
    test.set("speed", Value::from(45.0));
    test.set("gap", Value::from(20.0));
    let outcome = led_with(&program, &test).unwrap();
    let contact = outcome.measured.unwrap().contact.expect("the ego vehicle goes through the leader");
    assert_eq!(contact.with, "Leader");
    assert!((contact.speed - 45.0).abs() < 1e-9 && contact.other_speed < 45.0, "{contact:?}");
    let trace = outcome.trace.unwrap();
    assert!((trace.len() - 1) as f64 * trace.dt() > 15.0, "the contact ended the run");
}
