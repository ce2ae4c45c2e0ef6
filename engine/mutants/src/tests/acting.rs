//! Each kind of defect of the hands and feet changes what it says, and nothing else.

use super::*;
use crate::{ALL, NO_BRAKES};

/// Returns the throttles of a driver with a defect that wants these throttles, one after the other.
fn throttled(kind: &str, size: f64, wanted: &[f64]) -> Vec<f64> {
    let done = done(defect(kind, size), &same(wanted.len(), &[]), &throttles(wanted));
    assert!(done.iter().all(|control| control.steering == 0.0), "{kind} {size}");
    done.iter().map(|control| (control.throttle * 1e9).round() * 1e-9).collect()
}

fn assert_close(found: &[f64], expected: &[f64], what: &str) {
    let close = found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6);
    assert!(close, "{what}: {found:?}, expected {expected:?}");
}

#[test]
fn brakes_do_what_their_defect_says() {
    let full = [-1.0; 6];
    let twice = [-1.0, -1.0, 0.5, -1.0, -0.05, -1.0];
    for (kind, size, wanted, expected) in [
        ("weak-brakes", 40.0, &[-1.0, -0.6, -0.3, 0.0, 1.0, -0.7], [-0.6, -0.6, -0.3, 0.0, 1.0, -0.6]),
        ("weak-brakes", 100.0, &twice, [0.0, 0.0, 0.5, 0.0, 0.0, 0.0]),
        ("slow-brakes", 0.4, &full, [0.0, -0.25, -0.5, -0.75, -1.0, -1.0]),
        ("slow-brakes", 0.4, &twice, [0.0, -0.25, 0.5, -0.25, -0.05, -0.3]),
        ("fading-brakes", 0.2, &full, [-1.0, -1.0, 0.0, 0.0, 0.0, 0.0]),
        ("fading-brakes", 0.2, &[-1.0, -1.0, -1.0, 0.0, -1.0, -1.0], [-1.0, -1.0, 0.0, 0.0, -1.0, -1.0]),
        ("few-brakings", 1.0, &twice, [-1.0, -1.0, 0.5, 0.0, -0.05, 0.0]),
        ("few-brakings", 2.0, &twice, [-1.0, -1.0, 0.5, -1.0, -0.05, 0.0]),
        ("suppressed-braking", 0.2, &full, [0.0, 0.0, -1.0, -1.0, -1.0, -1.0]),
        ("suppressed-braking", 0.2, &twice, [0.0, 0.0, 0.5, 0.0, -0.05, 0.0]),
        ("biased-throttle", 10.0, &[-1.0, -0.6, -0.3, 0.0, 1.0, -0.7], [-0.9, -0.5, -0.2, 0.1, 1.0, -0.6]),
        ("slow-cycle", 0.25, &[0.1, 0.2, 0.3, 0.4, 0.5, 0.6], [0.1, 0.1, 0.1, 0.4, 0.4, 0.4]),
    ] {
        assert_close(&throttled(kind, size, wanted), &expected, &format!("{kind} {size}"));
    }
}

#[test]
fn a_driver_without_brakes_keeps_its_power_and_its_steering() {
    let wanted: Vec<_> = [-1.0, -0.2, 0.0, 0.7].map(|throttle| Control { throttle, steering: -0.4 }).into();
    let done = done(NO_BRAKES, &same(4, &[]), &wanted);
    assert_eq!(done.iter().map(|control| control.throttle).collect::<Vec<_>>(), [0.0, 0.0, 0.0, 0.7]);
    assert!(done.iter().all(|control| control.steering == -0.4 && control.throttle.is_sign_positive()));
    assert_eq!(NO_BRAKES, defect("weak-brakes", 100.0));
}

#[test]
fn brakes_that_depend_on_the_state_of_the_car_fail_only_there() {
    let at = |speed: f64| Observation { speed, ..moment(0.0, vec![]) };
    let brake = |steering| Control { throttle: -1.0, steering };
    for (kind, size, speed, steering, brakes) in [
        ("no-brakes-above", 36.0, 10.1, 0.0, false),
        ("no-brakes-above", 36.0, 9.9, 0.0, true),
        ("no-brakes-below", 36.0, 9.9, 0.0, false),
        ("no-brakes-below", 36.0, 10.1, 0.0, true),
        ("no-brakes-in-bends", 10.0, 10.0, 0.11, false),
        ("no-brakes-in-bends", 10.0, 10.0, -0.11, false),
        ("no-brakes-in-bends", 10.0, 10.0, 0.09, true),
    ] {
        let done = done(defect(kind, size), &[at(speed)], &[brake(steering)]);
        let expected = Control { throttle: if brakes { -1.0 } else { 0.0 }, steering };
        assert_eq!(done, [expected], "{kind} at {speed}, {steering}");
    }
}

#[test]
fn steering_does_what_its_defect_says() {
    let wanted: Vec<_> = [-1.0, -0.5, 0.0, 0.5].map(|steering| Control { throttle: -0.3, steering }).into();
    for (kind, size, expected) in [
        ("weak-steering", 50.0, [-0.5, -0.25, 0.0, 0.25]),
        ("weak-steering", 100.0, [0.0; 4]),
        ("biased-steering", 10.0, [-1.0, -0.6, -0.1, 0.4]),
    ] {
        let done = done(defect(kind, size), &same(4, &[]), &wanted);
        let steering: Vec<_> = done.iter().map(|control| control.steering).collect();
        assert_close(&steering, &expected, kind);
        assert!(done.iter().all(|control| control.throttle == -0.3), "{kind}");
    }
}

#[test]
fn a_driver_that_only_drives_on_is_changed_by_no_defect_of_the_brakes() {
    let wanted = vec![Control { throttle: 0.4, steering: 0.2 }; 60];
    let matters = ["biased-throttle", "weak-steering", "biased-steering", "busy", "lost-answers"];
    for kind in ALL.iter().filter(|kind| !matters.contains(&kind.name)) {
        for &size in kind.sizes {
            assert_eq!(done(defect(kind.name, size), &same(60, &[]), &wanted), wanted, "{} {size}", kind.name);
        }
    }
}
