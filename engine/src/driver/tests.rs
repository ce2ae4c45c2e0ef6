use super::*;
use crate::object::{Class, Outline};
use crate::observation::Other;
use crate::vehicle::Vehicle;
use nalgebra::Vector2;
use paracosm_road::Pose;

const SPEED: f64 = 15.0;

/// Where a car is that has come this far straight on.
fn odometry(travelled: f64) -> Pose {
    Pose { position: Vector2::new(travelled, 0.0), heading: 0.0 }
}

/// Somebody at a place, of whom `aeb` is not told how they move.
fn person(x: f64, y: f64) -> Other {
    let velocity = Vector2::zeros();
    Other {
        id: 0,
        class: Class::Prop,
        position: Vector2::new(x, y),
        velocity,
        heading: 0.0,
        outline: Outline::Disc { radius: 0.25 },
    }
}

/// Drives at constant speed past whatever `others` shows at each time; the throttle at every question.
fn drive(changes: &[(&str, f64)], others: impl Fn(f64) -> Option<(f64, f64)>, seconds: f64) -> Vec<(f64, f64)> {
    let changes: Vec<_> = changes.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    let mut driver = find("aeb").unwrap().build(&changes).unwrap();
    driver.reset(&Briefing { cruise_speed: SPEED, vehicle: Vehicle::BMW_320I, navigation: None }).unwrap();
    let steps = (seconds / driver.period()).round() as usize;
    let at = |i: usize| i as f64 * 0.05;
    (0..steps)
        .map(|i| {
            let others = others(at(i)).map(|(x, y)| person(x, y));
            let others = others.into_iter().collect();
            let observation = Observation {
                time: at(i),
                speed: SPEED,
                travelled: SPEED * at(i),
                odometry: odometry(SPEED * at(i)),
                others,
                ..Observation::default()
            };
            (at(i), driver.step(&observation).unwrap().throttle)
        })
        .collect()
}

/// The first time at which it brakes.
fn brakes_at(throttles: &[(f64, f64)]) -> Option<f64> {
    throttles.iter().find(|(_, throttle)| *throttle < 0.0).map(|(time, _)| *time)
}

/// Somebody who stands on the road and comes nearer at the car's speed, seen without noise.
const EXACT: (&str, f64) = ("noise", 0.0);

#[test]
fn aeb_brakes_for_somebody_who_stands_in_its_way_at_the_time_to_collision_it_is_set_to() {
    let bumper = 0.5 * Vehicle::BMW_320I.length + 0.25;
    for ttc in [1.0, 2.0] {
        let throttles = drive(&[EXACT, ("ttc", ttc)], |time| Some((60.0 - SPEED * time, 0.0)), 4.0);
        let expected = (60.0 - bumper) / SPEED - ttc;
        let time = brakes_at(&throttles).unwrap();
        assert!((expected..expected + 0.051).contains(&time), "ttc {ttc}: {time}, expected {expected}");
    }
}

#[test]
fn aeb_does_not_brake_for_somebody_beside_the_road_or_behind_or_out_of_range() {
    assert_eq!(brakes_at(&drive(&[], |time| Some((60.0 - SPEED * time, 4.0)), 6.0)), None);
    assert_eq!(brakes_at(&drive(&[EXACT], |_| Some((-5.0, 0.0)), 6.0)), None);
    assert_eq!(brakes_at(&drive(&[EXACT, ("range", 5.0)], |_| Some((10.0, 0.0)), 6.0)), None);
    assert_eq!(brakes_at(&drive(&[EXACT, ("field_of_view", 10.0)], |_| Some((12.0, 2.0)), 6.0)), None);
}

#[test]
fn every_frame_is_late_by_the_latency_not_only_the_first() {
    // Somebody in sight all the time steps onto the road at 2 s.
    let appears = |time: f64| Some((70.0 - SPEED * time, if time < 2.0 { 8.0 } else { 0.0 }));
    let set = |latency| [EXACT, ("samples", 3.0), ("ttc", 5.0), ("latency", latency)];
    let time = |latency| brakes_at(&drive(&set(latency), appears, 4.0)).unwrap();
    let delay = time(0.6) - time(0.1);
    assert!((delay - 0.5).abs() < 1e-9, "{delay}");
}

#[test]
fn the_brake_builds_up_at_the_jerk_it_is_set_to() {
    let throttles = drive(&[EXACT, ("jerk", 10.0)], |time| Some((40.0 - SPEED * time, 0.0)), 2.6);
    let brake: Vec<f64> = throttles.iter().map(|(_, throttle)| -throttle * 11.5).filter(|a| *a > 0.0).collect();
    for (i, a) in brake.iter().take(10).enumerate() {
        assert!((a - 0.5 * (i + 1) as f64).abs() < 1e-9, "{brake:?}");
    }
}

#[test]
fn aeb_goes_on_when_the_way_is_clear_and_not_before() {
    // Somebody stands in the way until 3 s and is out of it from then on.
    let steps_aside = |time: f64| Some((75.0 - SPEED * time, if time < 3.0 { 0.0 } else { 9.0 }));
    let throttles = drive(&[EXACT, ("latency", 0.0), ("ttc", 3.0)], steps_aside, 4.8);
    let last = throttles.iter().rev().find(|(_, throttle)| *throttle < 0.0).unwrap().0;
    assert!((3.5..4.5).contains(&last), "{last}");
}

#[test]
fn a_driver_that_was_reset_does_the_same_again() {
    let mut driver = find("aeb").unwrap().build(&[]).unwrap();
    let mut runs = (0..2).map(|_| {
        driver.reset(&Briefing { cruise_speed: SPEED, vehicle: Vehicle::BMW_320I, navigation: None }).unwrap();
        (0..80)
            .map(|i| {
                let time = f64::from(i) * 0.05;
                let others = vec![person(50.0 - SPEED * time, 1.2)];
                driver
                    .step(&Observation {
                        time,
                        speed: SPEED,
                        travelled: SPEED * time,
                        odometry: odometry(SPEED * time),
                        others,
                        ..Observation::default()
                    })
                    .unwrap()
                    .throttle
            })
            .collect::<Vec<_>>()
    });
    assert_eq!(runs.next(), runs.next());
}

#[test]
fn unknown_drivers_and_settings_are_named_with_the_nearest() {
    let message = |error: DriverError| error.to_string();
    assert_eq!(
        find("aebs").map(|kind| kind.name).map_err(message).unwrap_err(),
        "no driver is called `aebs` (did you mean `aeb`?)"
    );
    let aeb = find("aeb").unwrap();
    let set = |name: &str, value| message(aeb.settings(&[(name.to_owned(), value)]).unwrap_err());
    assert_eq!(set("tcc", 1.0), "driver `aeb` has no setting `tcc` (did you mean `ttc`?)");
    assert_eq!(set("ttc", -1.0), "the setting `ttc` of driver `aeb` is -1, expected a number from 0 to 10");
    assert!(set("ttc", f64::NAN).contains("NaN"));
}

/// What `expert` gives at its cruise speed when one body is there.
fn expert_with(body: Other) -> f64 {
    let mut driver = find("expert").unwrap().build(&[]).unwrap();
    driver.reset(&Briefing { cruise_speed: SPEED, vehicle: Vehicle::BMW_320I, navigation: None }).unwrap();
    let observation = Observation { speed: SPEED, others: vec![body], ..Observation::default() };
    driver.step(&observation).unwrap().throttle
}

#[test]
fn the_expert_keeps_a_distance_in_proportion_to_its_speed() {
    let car = |gap: f64| Other {
        class: Class::Car,
        outline: Outline::Rectangle { length: 4.5, width: 1.8 },
        ..person(gap + 0.5 * (4.5 + Vehicle::BMW_320I.length), 0.0)
    };
    // 5 m and 1.5 s.
    let kept = 5.0 + 1.5 * SPEED;
    assert!(expert_with(car(kept + 0.1)).abs() < 1e-9);
    let throttles = [0.0, 2.0, 5.0, 10.0].map(|nearer| expert_with(car(kept - nearer)));
    assert!(throttles.windows(2).all(|pair| pair[0] > pair[1]), "{throttles:?}");
    let beside = Other { position: Vector2::new(15.0, 3.5), ..car(10.0) };
    assert!(expert_with(beside).abs() < 1e-9, "who drives in the next lane is not in the way");
}

#[test]
fn the_expert_stops_for_people_who_walk_on_the_road_if_it_can() {
    let walker = |x: f64, y: f64, speed: f64| Other {
        class: Class::Pedestrian,
        velocity: Vector2::new(0.0, -speed),
        ..person(x, y)
    };
    assert!(expert_with(walker(25.0, 3.5, 1.0)) < -0.2, "on the other lane");
    assert!(expert_with(walker(25.0, 0.0, 0.0)) < -0.2, "standing in the way");
    assert!(expert_with(walker(25.0, 6.0, 1.0)) < -0.2, "on the road in a second");
    assert!(expert_with(walker(25.0, 6.5, 0.0)).abs() < 1e-9, "on the sidewalk");
    assert!(expert_with(walker(12.0, 4.5, 1.0)).abs() < 1e-9, "too near to stop, and not yet in the way");
    assert!(expert_with(walker(-8.0, 0.0, 1.0)).abs() < 1e-9, "behind");
}
