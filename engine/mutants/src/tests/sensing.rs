//! Each kind of defect of the senses changes what it says, and nothing else.

use super::*;
use crate::ALL;
use paracosm_engine::Ahead;
use paracosm_engine::Pose;

fn at(x: f64, y: f64) -> Other {
    body(0, Class::Car, (x, y), (0.0, 0.0))
}

fn moves(vx: f64, vy: f64) -> Other {
    body(0, Class::Car, (30.0, 0.0), (vx, vy))
}

fn of(class: Class, x: f64) -> Other {
    body(0, class, (x, 0.0), (0.0, 0.0))
}

#[test]
fn a_driver_does_not_see_the_bodies_that_its_defect_hides_and_sees_all_others_as_they_are() {
    let small = Other { outline: Outline::Disc { radius: 0.25 }, ..at(30.0, 0.0) };
    for (kind, size, unseen, seen_still) in [
        ("short-range", 30.0, vec![at(30.1, 0.0), at(25.0, 20.0), at(-31.0, 0.0)], vec![at(29.9, 0.0)]),
        ("narrow-view", 90.0, vec![at(10.0, 10.1), at(10.0, -10.1), at(-5.0, 0.0)], vec![at(10.0, 9.9), at(5.0, 0.0)]),
        ("blind-left", 43.0, vec![at(10.0, 9.9), at(10.0, 0.4)], vec![at(10.0, 0.3), at(10.0, 10.1), at(10.0, -5.0)]),
        ("blind-right", 43.0, vec![at(10.0, -9.9), at(10.0, -0.4)], vec![at(10.0, -0.3), at(10.0, 5.0)]),
        ("blind-near", 10.0, vec![at(9.9, 0.0), at(-3.0, 0.0)], vec![at(10.1, 0.0)]),
        ("blind-speeds", 6.0, vec![at(9.9, 0.0)], vec![]),
        ("blind-speeds", 5.9, vec![], vec![at(9.9, 0.0)]),
        ("narrow-corridor", 2.0, vec![at(9.0, 2.1), at(9.0, -2.1)], vec![at(9.0, 1.9), at(90.0, -1.9)]),
        ("unseen-standing", 1.0, vec![moves(0.0, 0.0), moves(0.6, -0.7)], vec![moves(0.8, 0.7), moves(-1.0, 0.0)]),
        ("unseen-crossing", 1.0, vec![moves(0.0, 1.1), moves(9.0, -1.1)], vec![moves(9.0, 0.9)]),
        ("unseen-oncoming", 1.0, vec![moves(-1.1, 0.0)], vec![moves(-0.9, 0.0), moves(5.0, 9.0)]),
        ("unseen-small", 0.6, vec![small], vec![at(30.0, 0.0)]),
        ("unseen-pedestrians", 10.0, vec![of(Class::Pedestrian, 10.1)], vec![of(Class::Pedestrian, 9.9)]),
        ("unseen-pedestrians", 0.0, vec![of(Class::Pedestrian, 0.0)], vec![of(Class::Car, 50.0)]),
        (
            "unseen-two-wheelers",
            0.0,
            vec![of(Class::Bicycle, 1.0), of(Class::Motorcycle, 1.0)],
            vec![of(Class::Car, 9.0), of(Class::Pedestrian, 9.0)],
        ),
        ("unseen-cars", 0.0, vec![of(Class::Car, 1.0), of(Class::Van, 1.0)], vec![of(Class::Truck, 9.0)]),
        ("unseen-lorries", 0.0, vec![of(Class::Truck, 1.0), of(Class::Bus, 1.0)], vec![of(Class::Car, 9.0)]),
        (
            "unseen-things",
            0.0,
            vec![of(Class::Prop, 1.0), of(Class::Tree, 1.0), of(Class::Sign, 1.0), of(Class::Building, 1.0)],
            vec![of(Class::Pedestrian, 9.0)],
        ),
    ] {
        let all = [unseen.clone(), seen_still.clone()].concat();
        let world = [moment(0.3, all)];
        let expected = moment(0.3, seen_still);
        assert_eq!(seen(defect(kind, size), &world), [expected], "{kind} {size}");
    }
}

#[test]
fn a_driver_sees_bodies_changed_as_its_defect_says() {
    let b = body(3, Class::Car, (40.0, -3.0), (10.0, -2.0));
    let turned = |angle: f64, v: Vector2<f64>| {
        let (sin, cos) = libm::sincos(angle);
        Vector2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
    };
    let angle = 2.0_f64.to_radians();
    let position = |x, y| Other { position: Vector2::new(x, y), ..b };
    let velocity = |x, y| Other { velocity: Vector2::new(x, y), ..b };
    for (kind, size, expected) in [
        ("far-distances", 10.0, position(44.0, -3.3)),
        ("slow-others", 50.0, velocity(5.0, -1.0)),
        ("slow-others", 100.0, velocity(0.0, 0.0)),
        ("fast-others", 50.0, velocity(15.0, -3.0)),
        ("no-sideways", 50.0, velocity(10.0, -1.0)),
        ("thin-bodies", 50.0, Other { outline: Outline::Rectangle { length: 2.0, width: 0.9 }, ..b }),
        ("mixed-units", 35.0, velocity(10.0 / 3.6, -2.0 / 3.6)),
        ("mixed-units", 50.0, b),
        ("flipped-side", 2.5, position(40.0, 3.0)),
        ("flipped-side", 3.5, b),
        ("off-by-one-lane", 35.0, position(40.0, 0.5)),
        ("off-by-one-lane", 50.0, b),
        (
            "misaligned",
            2.0,
            Other { position: turned(angle, b.position), velocity: turned(angle, b.velocity), heading: angle, ..b },
        ),
    ] {
        let found = &seen(defect(kind, size), &[moment(0.3, vec![b])])[0];
        let (other, close) = (found.others[0], |a: Vector2<f64>, b: Vector2<f64>| (a - b).norm() < 1e-12);
        assert!(close(other.position, expected.position), "{kind} {size}: {other:?}");
        assert!(close(other.velocity, expected.velocity), "{kind} {size}: {other:?}");
        let rest = |body: Other| (body.id, body.class, body.heading, body.outline);
        assert_eq!(rest(other), rest(expected), "{kind} {size}");
        assert_eq!(moment(0.3, vec![b]), Observation { others: vec![b], ..found.clone() }, "{kind} {size}");
    }
}

#[test]
fn only_bodies_on_the_right_are_seen_on_the_other_side() {
    let left = moment(0.0, vec![at(20.0, 5.0)]);
    assert_eq!(seen(defect("flipped-side", 0.0), std::slice::from_ref(&left)), [left]);
}

#[test]
fn a_driver_misjudges_its_own_speed_or_its_own_place_and_sees_all_bodies_as_they_are() {
    let truth = moment(0.0, vec![at(20.0, 5.0)]);
    let slow = &seen(defect("slow-self", 10.0), std::slice::from_ref(&truth))[0];
    assert_eq!(*slow, Observation { speed: 13.5, ..truth.clone() });

    let lost = &seen(defect("mislocated", 1.0), std::slice::from_ref(&truth))[0];
    let mut expected = truth;
    expected.way.offset = 1.0;
    expected.way.ahead = expected.way.ahead.map(|point| Ahead { position: Vector2::new(0.0, -1.0), ..point });
    assert_eq!(*lost, expected);
}

#[test]
fn only_the_nearest_bodies_are_seen_in_the_order_of_their_numbers() {
    let others = [(30.0, 0.0), (10.0, 0.0), (0.0, -20.0), (-10.0, 0.0)];
    let others: Vec<_> =
        others.into_iter().enumerate().map(|(id, place)| Other { id, ..at(place.0, place.1) }).collect();
    let ids = |count| -> Vec<usize> {
        seen(defect("nearest-only", count), &[moment(0.0, others.clone())])[0]
            .others
            .iter()
            .map(|body| body.id)
            .collect()
    };
    assert_eq!(ids(3.0), [1, 2, 3]);
    // Of two bodies at the same distance, the lower number counts.
    assert_eq!(ids(1.0), [1]);
    assert_eq!(ids(4.0), [0, 1, 2, 3]);
}

fn times_with_bodies(observations: &[Observation]) -> Vec<usize> {
    let with = observations.iter().enumerate().filter(|(_, moment)| !moment.others.is_empty());
    with.map(|(step, _)| step).collect()
}

#[test]
fn a_body_is_seen_after_it_has_been_in_sight_for_a_while_and_anew_after_it_was_hidden() {
    let person = body(0, Class::Pedestrian, (40.0, 0.0), (0.0, 1.0));
    let wall = body(1, Class::Building, (20.0, 0.0), (0.0, 0.0));
    let mut world = same(14, &[person]);
    // The wall hides the person at the sixth moment, and is a new body itself.
    world[5].others.push(wall);
    assert_eq!(times_with_bodies(&seen(defect("late-detection", 0.4), &world)), [4, 10, 11, 12, 13]);
    let behind = same(10, &[at(-10.0, 0.0)]);
    assert_eq!(times_with_bodies(&seen(defect("late-detection", 0.4), &behind)), [0; 0]);
}

#[test]
fn bodies_are_lost_while_the_car_turns_and_for_a_while_after() {
    let mut world = same(10, &[at(20.0, 0.0)]);
    for (step, moment) in world.iter_mut().enumerate() {
        // It turns by 0.01 rad from the third moment to the fourth, and by a full turn that means nothing.
        let full = if step >= 5 { std::f64::consts::TAU } else { 0.0 };
        moment.odometry = Pose { heading: if step >= 3 { 0.01 + full } else { 0.0 }, ..Pose::default() };
    }
    assert_eq!(times_with_bodies(&seen(defect("lost-in-turns", 0.3), &world)), [0, 1, 2, 7, 8, 9]);
}

#[test]
fn a_body_is_a_standing_thing_for_half_a_second_in_each_period() {
    let person = body(0, Class::Pedestrian, (40.0, 0.0), (0.0, 1.0));
    let found = seen(defect("reclassified", 2.0), &same(60, &[person]));
    let things = found.iter().filter(|moment| moment.others[0].class == Class::Prop);
    assert_eq!(things.clone().count(), 15);
    assert!(things.clone().all(|moment| moment.others[0].velocity == Vector2::zeros()));
    assert!(found.iter().filter(|moment| moment.others[0] == person).count() == 45);
    let always = seen(defect("reclassified", 0.5), &same(60, &[person]));
    assert!(always.iter().all(|moment| moment.others[0].class == Class::Prop));
}

#[test]
fn bodies_of_a_stale_world_are_those_of_an_earlier_moment() {
    let world = approach(12);
    let found = seen(defect("stale-world", 0.5), &world);
    for (step, moment) in found.iter().enumerate() {
        assert_eq!(moment.others, world[step.saturating_sub(5)].others, "step {step}");
        assert_eq!((moment.time, moment.speed), (world[step].time, world[step].speed));
    }
}

#[test]
fn some_frames_or_some_bodies_are_lost_about_as_often_as_the_size_says() {
    let world = same(2000, &[at(20.0, 0.0), Other { id: 1, ..at(30.0, 0.0) }]);
    let counts = |kind| -> Vec<usize> {
        let found = seen(defect(kind, 20.0), &world);
        (0..3).map(|count| found.iter().filter(|moment| moment.others.len() == count).count()).collect()
    };
    let frames = counts("lost-frames");
    assert!(frames[1] == 0 && (320..480).contains(&frames[0]), "{frames:?}");
    let bodies = counts("lost-bodies");
    assert!((40..120).contains(&bodies[0]) && (560..720).contains(&bodies[1]), "{bodies:?}");
}

#[test]
fn sensors_fail_freeze_or_see_phantoms_at_the_end_of_every_four_seconds() {
    let world = approach(80);
    let is_disturbed = |step: usize| step % 40 >= 33;
    let outages = seen(defect("outages", 0.7), &world);
    let frozen = seen(defect("frozen-sensor", 0.7), &world);
    let phantoms = seen(defect("phantom", 0.7), &world);
    for (step, truth) in world.iter().enumerate() {
        let last = if is_disturbed(step) { step - step % 40 + 32 } else { step };
        assert_eq!(outages[step].others.is_empty(), is_disturbed(step), "step {step}");
        assert_eq!(frozen[step].others, world[last].others, "step {step}");
        assert_eq!(phantoms[step].others.len(), 1 + usize::from(is_disturbed(step)), "step {step}");
        assert_eq!(phantoms[step].others[0], truth.others[0]);
    }
}

#[test]
fn noise_has_the_size_of_its_defect_and_no_bias() {
    let truth = body(0, Class::Car, (40.0, 0.0), (3.0, 0.0));
    let part = |kind: &str| -> Vec<Vector2<f64>> {
        let found = seen(defect(kind, 2.0), &same(4000, &[truth]));
        let errors = found.iter().map(|moment| {
            let (place, speed) =
                (moment.others[0].position - truth.position, moment.others[0].velocity - truth.velocity);
            if kind == "position-noise" {
                assert_eq!(speed, Vector2::zeros());
                place
            } else {
                assert_eq!(place, Vector2::zeros());
                speed
            }
        });
        errors.collect()
    };
    for kind in ["position-noise", "speed-noise"] {
        let errors = part(kind);
        let n = errors.len() as f64;
        let mean: Vector2<f64> = errors.iter().sum::<Vector2<f64>>() / n;
        let square: f64 = errors.iter().map(Vector2::norm_squared).sum::<f64>() / (2.0 * n);
        // Five standard deviations of a mean and of a variance of so many numbers.
        assert!(mean.amax() < 5.0 * 2.0 / n.sqrt(), "{kind}: {mean}");
        assert!((square - 4.0).abs() < 5.0 * 4.0 / n.sqrt(), "{kind}: {square}");
    }
}

#[test]
fn without_bodies_only_phantoms_and_errors_about_the_car_itself_change_anything() {
    let world = same(100, &[]);
    for kind in ALL {
        for &size in kind.sizes {
            let found = seen(defect(kind.name, size), &world);
            let matters = ["phantom", "slow-self", "mislocated"].contains(&kind.name);
            assert_eq!(found != world, matters, "{} {size}", kind.name);
        }
    }
}
