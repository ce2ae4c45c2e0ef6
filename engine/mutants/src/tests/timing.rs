//! Defects of time, and what decorators leave alone.

use super::*;
use crate::ALL;

#[test]
fn only_a_late_reaction_changes_the_latency_and_nothing_changes_the_period() {
    for kind in ALL {
        for &size in kind.sizes {
            let driver = defect(kind.name, size).in_driver(Box::new(Probe::default()));
            let later = if kind.name == "late-reaction" { size } else { 0.0 };
            assert_eq!(driver.latency(), 0.25 + later, "{} {size}", kind.name);
            assert_eq!(driver.period(), PERIOD);
            assert!(!driver.takes_over());
        }
    }
}

/// The steps of the answers that are in effect at each step.
fn steps(kind: &str, size: f64, world: &[Observation]) -> Vec<usize> {
    let wanted: Vec<f64> = (1..=world.len()).map(|step| 0.01 * step as f64).collect();
    let done = done(defect(kind, size), world, &throttles(&wanted));
    done.iter().map(|control| (100.0 * control.throttle).round() as usize).collect()
}

#[test]
fn a_busy_driver_answers_later_if_it_has_more_bodies_near_it() {
    let near = |count: usize| -> Vec<Other> {
        (0..count).map(|id| body(id, Class::Car, (20.0 + id as f64, 0.0), (0.0, 0.0))).collect()
    };
    // The car rolls before its first answer.
    assert_eq!(steps("busy", 0.1, &same(5, &near(2))), [0, 0, 1, 2, 3]);
    assert_eq!(steps("busy", 0.1, &same(5, &near(0))), [1, 2, 3, 4, 5]);
    assert_eq!(steps("busy", 0.1, &same(3, &[body(0, Class::Car, (101.0, 0.0), (0.0, 0.0))])), [1, 2, 3]);
    // With fewer bodies it catches up; with more bodies no answer comes twice.
    let mut world = same(8, &near(2));
    (4..6).for_each(|step| world[step].others.clear());
    assert_eq!(steps("busy", 0.1, &world), [0, 0, 1, 2, 5, 6, 6, 6]);
}

#[test]
fn an_output_freezes_at_the_end_of_every_four_seconds() {
    let found = steps("frozen-output", 0.2, &same(50, &[]));
    let expected: Vec<usize> = (1..=50).map(|step| if (39..=40).contains(&step) { 38 } else { step }).collect();
    assert_eq!(found, expected);
}

#[test]
fn about_as_many_answers_are_lost_as_the_size_says() {
    let found = steps("lost-answers", 40.0, &same(90, &[]));
    let lost = found.iter().zip(1..).filter(|(found, step)| *found != step).count();
    assert!((20..52).contains(&lost), "{lost} of 90");
    assert!(found.is_sorted());
}
