use super::*;
use crate::driver::find;
use crate::kinematic::{BrakingModel, CutIn, CutOut, DT, LeaderBrakes, Situation, Unbraked};
use crate::object::{Class, Outline};
use crate::observation::{Briefing, Observation, Other};
use crate::vehicle::Vehicle;
use nalgebra::Vector2;
use paracosm_road::Pose;
use proptest::prelude::*;

mod cc;

/// A car in the lane of the ego vehicle.
const AHEAD: Situation = Situation {
    speed: 20.0,
    acceleration: 0.0,
    gap: 50.0,
    other_speed: 10.0,
    other_acceleration: 0.0,
    lateral: 0.0,
    approach: 0.0,
    width: 1.8,
    other_width: 1.8,
    lengths: 9.0,
};

fn cut_ins() -> impl Strategy<Value = CutIn> {
    let valid = |(a, b, c, d)| CutIn::from_unit([a, b, c, d]);
    let unit = || 0.0..=1.0;
    (unit(), unit(), unit(), unit()).prop_filter_map("the other would drive backwards", valid)
}

fn encounters() -> impl Strategy<Value = Encounter> {
    let cut_out = (5.0..20.0, 0.5..3.0, 0.0..100.0, 0.5..3.0).prop_map(|(speed, headway, distance, lateral_speed)| {
        CutOut { speed, gap: headway * speed, distance, lateral_speed }.encounter()
    });
    let leader = (5.0..20.0, 0.2..3.0, 1.0..10.0).prop_map(|(speed, headway, deceleration)| {
        LeaderBrakes { speed, gap: headway * speed, deceleration }.encounter()
    });
    prop_oneof![3 => cut_ins().prop_map(|cut_in| cut_in.encounter()), 1 => cut_out, 1 => leader]
}

/// Brakes as hard as it happens to like, anew at every step.
#[derive(Debug, Clone)]
struct Whimsical(u64);

impl BrakingModel for Whimsical {
    fn brake(&mut self, _: &Situation, _: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        let share = (self.0 >> 11) as f64 / (1_u64 << 53) as f64;
        if self.0 & 4 == 0 { 0.0 } else { share * 9.8 }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn ideal_avoids_whatever_any_other_driver_avoids(encounter in encounters(), seed in 1_u64..) {
        let ideal = Ideal::default().best(&encounter).1;
        for (name, outcome) in ALL {
            let ended = outcome(&encounter);
            prop_assert!(ideal.collision.is_none() || ended.collision.is_some(), "{name}: {ended:?}");
        }
        for ended in [encounter.run(&Unbraked), encounter.run(&Whimsical(seed))] {
            prop_assert!(ideal.collision.is_none() || ended.collision.is_some(), "{ended:?}");
        }
    }

    #[test]
    fn reg157_avoids_what_the_regulation_demands_and_nothing_that_takes_more(cut_in in cut_ins()) {
        let closing = cut_in.speed - cut_in.other_speed;
        // 0.3 m into the lane, from where the other's side was one lane's width away from that of the car.
        let intrusion = (3.5 - (1.75 - 0.3 + 0.5 * 1.61)) / cut_in.lateral_speed;
        let ttc = (cut_in.gap - closing * intrusion) / closing;
        // Whoever is passed before it is in the path needs no brakes.
        let meets = closing * (3.5 - 1.61) / cut_in.lateral_speed < cut_in.gap + 2.0 * 4.508;
        let collision = cut_in.encounter().run(&Reg157::default()).collision;
        let demanded = closing / 12.0 + 0.35;
        // A step until the intrusion is seen, half a step until the brakes act, and what a step does to the last metre.
        if ttc > demanded + 0.1 + 0.05 + 0.01 {
            prop_assert_eq!(collision, None);
        } else if ttc < demanded && meets {
            prop_assert!(collision.is_some());
        }
    }

    #[test]
    fn the_longitudinal_distance_of_rss_is_what_the_worst_case_uses_up(speed in 0.0..40.0, other_speed in 0.0..40.0) {
        let mut rss = Rss::default();
        rss.leader_deceleration = 8.0;
        let distance = rss.longitudinal_distance(speed, other_speed);
        let (mut v, mut f, mut gap, mut least) = (speed, other_speed, distance, distance);
        let dt = 0.0005;
        for i in 0..40_000 {
            let a = if f64::from(i) * dt < 0.75 { 3.0 } else { -6.0 };
            gap += (f - v) * dt;
            v = (v + a * dt).max(0.0);
            f = (f - 8.0 * dt).max(0.0);
            least = least.min(gap);
        }
        prop_assert!(least > -0.05, "{least} m");
        prop_assert!(distance == 0.0 || least < 0.05, "{least} m");
    }

    #[test]
    fn the_lateral_distance_of_rss_is_what_the_worst_case_uses_up(approach in 0.0..3.0, own in 0.0..1.0) {
        let mut rss = Rss::default();
        rss.own_lateral = own;
        let room = rss.lateral_distance(approach);
        let (mut u, mut v, mut left) = (0.0_f64, approach, room);
        let dt = 0.0005;
        for i in 0..20_000 {
            let (a, b) = if f64::from(i) * dt < 0.75 { (own, 1.0) } else { (-1.0, -1.0) };
            left -= (u + v) * dt;
            u = (u + a * dt).max(0.0);
            v = (v + b * dt).max(0.0);
        }
        prop_assert!((left - 0.3).abs() < 0.01, "{left} m");
    }
}

/// What a model asks for at each tenth of a second, if the car goes on with constant speed.
fn demands(mut model: impl BrakingModel, start: Situation, steps: usize) -> Vec<f64> {
    let at = |i: usize| {
        let time = i as f64 * DT;
        let lateral = (start.lateral - start.approach * time).max(0.0);
        let approach = if lateral > 0.0 { start.approach } else { 0.0 };
        Situation { gap: start.gap - start.closing() * time, lateral, approach, ..start }
    };
    (0..steps).map(|i| model.brake(&at(i), DT)).collect()
}

fn first(demands: &[f64], above: f64) -> Option<usize> {
    demands.iter().position(|demand| *demand > above)
}

#[test]
fn rss_brakes_after_its_response_time_when_neither_distance_is_safe() {
    let distance = Rss::default().longitudinal_distance(20.0, 10.0);
    // 15 + 0.84375 + 22.25²/12 - 100/12
    assert!((distance - 48.7651).abs() < 1e-3, "{distance}");
    let near = Situation { gap: distance + 0.5, ..AHEAD };
    let near_demands = demands(Rss::default(), near, 20);
    assert_eq!(first(&near_demands, 0.0), Some(9), "unsafe from the first tenth on");
    // 12.65 m/s³ make 7.5900 m/s² in 0.6 s, and 0.774 g are 7.5903.
    assert_eq!(first(&near_demands, 0.774 * 9.80665 - 1e-9), Some(15));
    let beside = Situation { lateral: 3.5, ..near };
    assert_eq!(first(&demands(Rss::default(), beside, 20), 0.0), None);
}

#[test]
fn the_fuzzy_measures_are_those_of_a_calculation_by_hand() {
    let fsm = Fsm::default();
    // safe 15 + 50 - 100/14 + 2, unsafe 15 + 400/12 - 100/14, of 50 m less 2 m
    let (safe, unsafe_) = (67.0 - 100.0 / 14.0, 15.0 + 400.0 / 12.0 - 100.0 / 14.0);
    assert!((fsm.proactive(50.0, 20.0, 10.0) - (safe - 48.0) / (safe - unsafe_)).abs() < 1e-12);
    // safe 7.5 + 100/8, unsafe 7.5 + 100/12
    assert!((fsm.critical(17.0, 20.0, 0.0, 10.0) - 0.72).abs() < 1e-12);
    // With -2 m/s² the speed is 18.5 m/s after 0.75 s.
    let (meanwhile, rest) = (9.25 * 0.75, 8.5 * 8.5);
    let (safe, unsafe_) = (meanwhile + rest / 8.0, meanwhile + rest / 12.0);
    assert!((fsm.critical(15.0, 20.0, -2.0, 10.0) - (safe - 15.0) / (safe - unsafe_)).abs() < 1e-12);
    // With -4 m/s² 1 m/s of difference is gone before 0.75 s, after 1/8 m.
    assert_eq!(fsm.critical(0.13, 11.0, -9.0, 10.0), 0.0);
    assert_eq!(fsm.critical(0.12, 11.0, -9.0, 10.0), 1.0);
    assert_eq!(fsm.critical(0.0, 10.0, 0.0, 11.0), 0.0);
}

#[test]
fn fsm_brakes_comfortably_while_only_the_proactive_measure_is_alarmed() {
    let far = Situation { gap: 60.0, ..AHEAD };
    let demands = demands(Fsm::default(), far, 55);
    let begins = first(&demands, 0.0).unwrap();
    assert!((8..12).contains(&begins), "{begins}");
    // At 20 m the critical one is at 0, at 15.83 m at 1.
    let at = |gap: f64| demands[60 - gap as usize];
    assert!(at(21.0) <= 4.0 && at(18.0) > 4.0 && at(18.0) < 6.0 && at(14.0) == 6.0, "{demands:?}");
}

#[test]
fn fsm_does_not_look_at_a_car_that_it_will_have_passed_before_it_comes_over() {
    let slow = Situation { gap: 1.0, lateral: 3.5, approach: 0.5, ..AHEAD };
    // 1.7 m at 0.5 m/s take 3.4 s; 10 m at 10 m/s take 1 s.
    assert_eq!(first(&demands(Fsm::default(), slow, 12), 0.0), None);
    let quick = Situation { gap: 20.0, approach: 1.5, ..slow };
    assert!(first(&demands(Fsm::default(), quick, 12), 0.0).is_some());
}

#[test]
fn ideal_brakes_no_harder_than_it_must_and_not_at_all_where_it_gets_through() {
    let encounter = LeaderBrakes { speed: 0.0, gap: 100.0, deceleration: 0.0 }.encounter();
    let strength = |speed| Ideal::default().best(&Encounter { speed, ..encounter.clone() }).0.deceleration / 9.80665;
    // v²/(2 b) <= 100 m
    assert_eq!([20.0, 25.0, 35.0, 44.0].map(strength), [0.25, 0.5, 0.75, 1.0]);
    let passes = CutIn { speed: 15.0, other_speed: 5.0, gap: 1.0, lateral_speed: 0.5 }.encounter();
    let (profile, ended) = Ideal::default().best(&passes);
    assert_eq!((profile, ended.collision), (Profile::NONE, None));
}

#[test]
fn ideal_slips_through_with_less_room_than_it_wants_where_braking_would_not_help() {
    // It has passed after 1.1 s, 0.02 s before the other is in its path; braking with 1 g it would not be behind by
    // then.
    let narrow = Situation { gap: 2.0, lateral: 3.5, approach: 1.7 / 1.12, ..AHEAD };
    assert_eq!(Ideal::default().brake(&narrow, DT), 0.0);
    let hopeless = Situation { approach: 1.7 / 1.0, ..narrow };
    assert!(Ideal::default().brake(&hopeless, DT) > 0.0);
}

#[test]
fn ideal_passes_one_and_stops_for_the_next() {
    let passes = CutIn { speed: 15.0, other_speed: 3.0, gap: 1.0, lateral_speed: 1.8 };
    let mut encounter = Encounter { duration: 5.0, ..passes.encounter() };
    encounter.others.extend(LeaderBrakes { speed: 0.0, gap: 36.0, deceleration: 0.0 }.encounter().others);
    // The one that comes over is in the path after 1.05 s and passed after 0.83 s; to stop within 36 m takes half of
    // the brakes from 0.87 s on, or all of them from 1.63 s on. After 5 s, the one behind would be there.
    let (profile, ended) = Ideal::default().best(&encounter);
    assert_eq!(ended.collision, None);
    assert_eq!((profile.onset, profile.deceleration), (0.5, 0.5 * 9.80665));
}

/// Where a car is that has come this far straight on.
fn odometry(travelled: f64) -> Pose {
    Pose { position: Vector2::new(travelled, 0.0), heading: 0.0 }
}

/// A car of 4 m x 2 m.
fn car(x: f64, y: f64, velocity: Vector2<f64>) -> Other {
    Other {
        id: 0,
        class: Class::Prop,
        position: Vector2::new(x, y),
        velocity,
        heading: 0.0,
        outline: Outline::Rectangle { length: 4.0, width: 2.0 },
    }
}

const NAMES: [&str; 5] = ["cc", "rss", "fsm", "reg157", "ideal"];

/// Whether the driver brakes for this body at any time, while the car drives past it at a constant 15 m/s.
fn brakes(driver: &str, mut other: Other) -> bool {
    let mut driver = find(driver).unwrap().build(&[]).unwrap();
    driver.reset(&Briefing { cruise_speed: 15.0, vehicle: Vehicle::BMW_320I, navigation: None }).unwrap();
    let mut braked = false;
    for i in 0..100 {
        let time = f64::from(i) * DT;
        let observation = Observation {
            time,
            speed: 15.0,
            travelled: 15.0 * time,
            odometry: odometry(15.0 * time),
            others: vec![other],
            ..Observation::default()
        };
        braked |= driver.step(&observation).unwrap().throttle < 0.0;
        other.position += (other.velocity - Vector2::new(15.0, 0.0)) * DT;
    }
    braked
}

#[test]
fn every_reference_driver_brakes_for_a_standing_car_and_for_one_that_comes_over_but_not_for_one_beside_or_behind() {
    for name in NAMES {
        assert!(brakes(name, car(80.0, 0.0, Vector2::zeros())), "{name}");
        assert!(brakes(name, car(50.0, -3.5, Vector2::new(5.0, 1.0))), "{name}");
        assert!(!brakes(name, car(80.0, 3.5, Vector2::zeros())), "{name}");
        assert!(!brakes(name, car(-20.0, 0.0, Vector2::new(14.0, 0.0))), "{name}");
        assert!(!brakes(name, car(40.0, 0.0, Vector2::new(25.0, 0.0))), "{name}");
    }
}

#[test]
fn a_car_that_stands_across_the_road_counts_with_its_length() {
    for name in NAMES {
        let along = car(80.0, 2.7, Vector2::zeros());
        let across = Other { heading: std::f64::consts::FRAC_PI_2, ..along };
        // Half of 1.61 m and half of 4 m reach further than 2.7 m; half of 2 m do not.
        assert_eq!((brakes(name, along), brakes(name, across)), (false, true), "{name}");
    }
}

/// Whether the driver ever brakes at 15 m/s while a car that stands 58 m ahead comes nearer, and perhaps another drives
/// away at 20 m/s between the two.
fn brakes_behind(driver: &str, leader: bool) -> bool {
    let mut driver = find(driver).unwrap().build(&[]).unwrap();
    driver.reset(&Briefing { cruise_speed: 15.0, vehicle: Vehicle::BMW_320I, navigation: None }).unwrap();
    (0..22).map(|i| f64::from(i) * DT).any(|time| {
        let standing = Other { class: Class::Car, ..car(58.0 - 15.0 * time, 0.0, Vector2::zeros()) };
        let leader =
            leader.then(|| Other { id: 1, class: Class::Car, ..car(9.0 + 5.0 * time, 0.0, Vector2::new(20.0, 0.0)) });
        let others = std::iter::once(standing).chain(leader).collect();
        let travelled = 15.0 * time;
        let odometry = odometry(travelled);
        let observation = Observation { time, speed: 15.0, travelled, odometry, others, ..Observation::default() };
        driver.step(&observation).unwrap().throttle < 0.0
    })
}

#[test]
fn no_reference_driver_brakes_for_what_a_car_ahead_hides() {
    for name in NAMES {
        assert!(!brakes_behind(name, true), "{name}");
        assert!(brakes_behind(name, false), "{name}");
    }
}

#[test]
fn a_reference_driver_that_was_reset_does_the_same_again() {
    for name in NAMES {
        let mut driver = find(name).unwrap().build(&[]).unwrap();
        let mut runs = (0..2).map(|_| {
            driver.reset(&Briefing { cruise_speed: 15.0, vehicle: Vehicle::BMW_320I, navigation: None }).unwrap();
            (0..60)
                .map(|i| {
                    let time = f64::from(i) * DT;
                    let others = vec![car(70.0 - 15.0 * time, 0.0, Vector2::zeros())];
                    driver
                        .step(&Observation {
                            time,
                            speed: 15.0,
                            travelled: 15.0 * time,
                            odometry: odometry(15.0 * time),
                            others,
                            ..Observation::default()
                        })
                        .unwrap()
                        .throttle
                })
                .collect::<Vec<_>>()
        });
        assert_eq!(runs.next(), runs.next(), "{name}");
    }
}

#[test]
fn the_drivers_of_the_kinematic_world_are_those_of_the_list() {
    assert_eq!(ALL.map(|(name, _)| name), NAMES);
    for name in NAMES {
        let driver = find(name).unwrap().build(&[]).unwrap();
        assert_eq!(driver.period(), DT, "{name}");
    }
}
