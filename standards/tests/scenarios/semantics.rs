//! What single actions and conditions do, in small scenarios of our own.

use super::bad::changed_in;
use super::worlds::{at, driven_by, file, led};
use paracosm_oracles::Trace;
use paracosm_standards::openscenario::Xosc;
use std::f64::consts::FRAC_PI_2;

fn trace(name: &str) -> Trace {
    let program = Xosc::read(&file(name)).unwrap_or_else(|error| panic!("{error}")).program();
    let outcome = led(&program).unwrap();
    outcome.trace.unwrap_or_else(|| panic!("{:?}", outcome.ending))
}

/// Returns the seconds at which a signal first has a value.
fn first(trace: &Trace, signal: &str, value: f64) -> Option<f64> {
    let tick = trace.signal(signal).unwrap().position(|now| now == value)?;
    Some(tick as f64 * trace.dt())
}

fn near(trace: &Trace, seconds: f64, expected: &[(&str, f64, f64)]) {
    for (signal, value, tolerance) in expected {
        let found = at(trace, signal, seconds);
        assert!((found - value).abs() <= *tolerance, "{signal} is {found} at {seconds} s, not {value}");
    }
}

#[test]
fn a_speed_profile_goes_through_its_targets() {
    let trace = trace("actions.xosc");
    for (seconds, speed) in [(2.0, 4.0), (4.0, 8.0), (5.0, 5.0), (6.0, 2.0), (9.0, 2.0)] {
        near(&trace, seconds, &[("Even.speed", speed, 1e-6)]);
    }
    // The speed of the ego vehicle minus 2 m/s, with the jerk and the acceleration of the limits.
    for (seconds, speed) in [(0.5, 0.25), (1.0, 1.0), (3.0, 5.0), (6.0, 8.0)] {
        near(&trace, seconds, &[("Smooth.speed", speed, 1e-6)]);
    }
}

#[test]
fn an_entity_keeps_its_distance_to_the_side() {
    let trace = trace("actions.xosc");
    near(&trace, 0.0, &[("Beside.y", -5.25, 1e-9)]);
    near(&trace, 19.0, &[("Beside.y", -4.75, 0.01), ("Beside.heading", 0.0, 0.01)]);
}

#[test]
fn a_person_walks_along_a_quarter_of_a_circle() {
    let trace = trace("actions.xosc");
    for seconds in [1.0, 5.0, 9.0, 14.0] {
        let (x, y) = (at(&trace, "Person.x", seconds), at(&trace, "Person.y", seconds));
        assert!((libm::hypot(x - 200.0, y + 10.0) - 10.0).abs() < 0.02, "({x}, {y}) at {seconds} s");
        near(&trace, seconds, &[("Person.heading", seconds / 10.0, 0.01)]);
    }
}

#[test]
fn each_condition_comes_at_its_time() {
    let trace = trace("actions.xosc");
    // The front of the ego vehicle is 3.9 m before its reference point, and the box begins 0.25 m before its own.
    for (shown, seconds, tolerance) in [
        (7.0, 0.01, 0.02),
        (1.0, 2.0, 0.03),
        (4.0, 3.0, 0.03),
        (8.0, 4.0, 0.03),
        (9.0, 6.0, 0.03),
        (2.0, 7.654, 0.05),
        (6.0, 9.6, 0.15),
        (3.0, 15.5, 0.05),
        (5.0, 18.0, 0.03),
    ] {
        let found = first(&trace, "Shown.speed", shown).unwrap_or_else(|| panic!("{shown} is not shown"));
        assert!((found - seconds).abs() <= tolerance, "{shown} is shown at {found} s, not at {seconds} s");
    }
    assert_eq!(first(&trace, "Shown.speed", 99.0), None, "the ego vehicle met an entity that is not in the world");
}

#[test]
fn a_condition_sees_a_transition_at_its_tick() {
    // The profile begins when its act starts: a tick later, the speed would be 0.02 m/s less.
    near(&trace("actions.xosc"), 2.0, &[("Even.speed", 4.0, 1e-6)]);
}

#[test]
fn a_gap_is_made_up_without_overshooting_until_a_speed_ends_it() {
    let trace = trace("actions.xosc");
    let gap = |seconds: f64| at(&trace, "Ego.x", seconds) - at(&trace, "Follows.x", seconds);
    let gaps: Vec<f64> = (0..30).map(|step| gap(f64::from(step) * 0.5)).collect();
    assert!(gaps[0] == 22.0 && gaps.windows(2).all(|pair| pair[1] < pair[0] && pair[1] > 20.0 - 1e-6), "{gaps:?}");
    assert!((gap(14.9) - 20.0).abs() < 0.1, "{}", gap(14.9));
    // The spring of 0.4 * 3 /s² pulls with 2.4 m/s² over the first tick.
    near(&trace, 0.01, &[("Follows.speed", 10.024, 1e-6)]);
    near(&trace, 15.5, &[("Follows.speed", 4.0, 0.0)]);
    near(&trace, 19.0, &[("Follows.speed", 4.0, 0.0)]);
}

#[test]
fn a_selection_stands_for_its_members() {
    let trace = trace("actions.xosc");
    near(&trace, 1.5, &[("First.speed", 3.0, 0.0), ("Second.speed", 3.0, 0.0)]);
}

#[test]
fn a_synchronized_entity_arrives_with_a_speed_relative_to_its_master() {
    let trace = trace("actions.xosc");
    near(&trace, 10.0, &[("Absolute.x", 100.0, 0.05), ("Absolute.speed", 12.0, 1e-9)]);
    near(&trace, 10.0, &[("Half.x", 460.0, 0.05), ("Half.speed", 5.0, 1e-9)]);
    near(&trace, 9.5, &[("Absolute.speed", 12.0, 1e-9), ("Half.speed", 5.0, 1e-9)]);
}

#[test]
fn a_route_leads_through_a_junction() {
    let trace = trace("routes.xosc");
    near(&trace, 12.0, &[("Ego.x", 130.0, 0.01), ("Ego.y", -1.75, 1e-6)]);
    near(&trace, 12.0, &[("Left.x", 111.75, 1e-6), ("Left.heading", FRAC_PI_2, 1e-6)]);
    near(&trace, 12.0, &[("Acquires.x", 111.75, 1e-6), ("Acquires.heading", FRAC_PI_2, 1e-6)]);
    // On the outer lane of the bend, the way is longer by 1.75 m times the angle.
    let bend = (10.0 + 1.75) * FRAC_PI_2;
    near(&trace, 12.0, &[("Left.y", 10.0 + 120.0 - 80.0 - bend, 0.01)]);
}

#[test]
fn a_position_on_a_route_counts_from_its_beginning() {
    let trace = trace("routes.xosc");
    let beyond = 130.0 - 100.0 - 10.0 * FRAC_PI_2;
    near(&trace, 0.0, &[("OnLane.x", 111.5, 1e-6), ("OnLane.y", 30.0 + beyond, 1e-6)]);
    near(&trace, 0.0, &[("OnRoad.x", 60.0, 1e-6), ("OnRoad.y", -3.0, 1e-6), ("OnRoad.heading", 0.5, 1e-9)]);
    // It was where the other car was at that moment.
    near(&trace, 0.0, &[("Same.x", 111.5, 1e-6), ("Same.y", 10.0 + beyond, 1e-6)]);
    // The master has 110 m along its route to go, and 2.75 m more on the outer lane of the bend.
    let place = 10.0 + 125.0 - 100.0 - 10.0 * FRAC_PI_2;
    near(&trace, 11.27, &[("Late.x", 111.75, 1e-6), ("Late.y", place, 0.1)]);
}

#[test]
fn an_action_that_assigns_a_controller_may_activate_it() {
    let (_folder, path) = changed_in(
        "slow-leader.xosc",
        "<ActivateControllerAction lateral=\"true\" longitudinal=\"true\"/>",
        "<AssignControllerAction activateLateral=\"true\" activateLongitudinal=\"true\"><Controller name=\"a\"/></AssignControllerAction>",
    );
    let program = Xosc::read(&path).unwrap_or_else(|error| panic!("{error}")).program();
    let trace = driven_by("aeb", &program).trace.unwrap();
    assert_eq!(at(&trace, "Ego.speed", 0.99), 30.0);
    let last = trace.signal("Ego.speed").unwrap().next_back().unwrap();
    assert!(last < 15.0, "the driver did not brake: {last} m/s");
}
