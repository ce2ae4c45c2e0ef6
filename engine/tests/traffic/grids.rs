//! Whole networks full of cars: nobody touches anybody, and nobody stands for ever.

use super::*;

#[test]
fn a_hundred_cars_drive_ten_minutes_through_a_grid() {
    let net = grid_city(5, 5, 80.0, 2).build().unwrap();
    for seed in [1, 2] {
        let way = drive_on(&mut scattered(&net, 100, seed, |_, car| car), 600.0, 60.0);
        assert!(way > 3000.0, "{way} m a car in 10 minutes");
    }
}

#[test]
fn they_do_with_four_lanes_and_lane_changes() {
    let net = grid_city(5, 5, 80.0, 4).build().unwrap();
    let way = drive_on(&mut scattered(&net, 100, 3, |_, car| car), 600.0, 60.0);
    assert!(way > 4000.0, "{way} m a car in 10 minutes");
    let way = drive_on(&mut scattered(&net, 100, 4, |_, car| car.changing_lanes()), 600.0, 60.0);
    assert!(way > 4000.0, "{way} m a car in 10 minutes");
}

#[test]
fn they_do_where_the_streets_are_half_full() {
    let net = grid_city(4, 4, 60.0, 2).build().unwrap();
    let way = drive_on(&mut scattered(&net, 100, 5, |_, car| car), 600.0, 60.0);
    assert!(way > 1500.0, "{way} m a car in 10 minutes");
}

#[test]
fn they_do_with_bicycles_and_vans_among_them() {
    let net = grid_city(4, 4, 80.0, 2).build().unwrap();
    let mixed = |index: usize, car: TrafficCar| match index % 4 {
        0 => car.body(Body::bicycle()).desired_speed(5.0).keeping_right(1.0),
        1 => car.body(Body::van()).size(7.0, 2.3).desired_speed(11.0),
        _ => car,
    };
    let way = drive_on(&mut scattered(&net, 60, 6, mixed), 600.0, 60.0);
    assert!(way > 2000.0, "{way} m a car in 10 minutes");
}

#[test]
fn they_do_on_slippery_roads() {
    let net = grid_city(5, 5, 80.0, 4).build().unwrap();
    for friction in [0.2, 0.4] {
        let mut traffic = scattered(&net, 100, 10, |_, car| car.changing_lanes());
        traffic.set_friction(friction);
        let way = drive_on(&mut traffic, 300.0, 60.0);
        assert!(way > 1500.0, "{way} m a car in 5 minutes with a friction of {friction}");
    }
}

#[test]
fn who_begins_fast_on_a_slippery_road_claims_the_intersection_that_it_cannot_stop_before() {
    let net = tee();
    // With 14 m/s and 2 m/s² one stops in 50 m: the car on the side road does, the one on the main road need not.
    let across = route(&net, place(&net, "west", -1, 60.0), place(&net, "east", 1, 95.0));
    let from_side = route(&net, place(&net, "south", -1, 20.0), place(&net, "west", 1, 95.0));
    let start = |route| TrafficCar::following(route).desired_speed(14.0).moving();
    let mut traffic = Traffic::new(net.clone(), vec![start(&across), start(&from_side)], 0).unwrap();
    traffic.set_friction(0.2);
    for _ in 0..ticks(60.0) {
        traffic.step(DT, &[]);
        assert_eq!(collision(&traffic), None);
        assert!(traffic.cars().all(|car| car.acceleration > -0.2 * 9.80665 - 1e-6));
    }
    assert!(traffic.cars().all(|car| car.travelled > 100.0));
}

#[test]
fn the_rest_of_a_way_ends_where_it_does_and_is_shorter_by_what_was_left_out() {
    let net = grid_city(3, 3, 80.0, 4).build().unwrap();
    let way = route(&net, place(&net, "street 1,0 east", 1, 10.0), place(&net, "street 0,1 south", 2, 50.0));
    assert!(way.lanes.len() > 2);
    let length = |way: &Route| {
        let beside = |pair: &[_]| net.lane(pair[0]).beside().any(|lane| lane == pair[1]);
        let left: f64 = way.lanes.windows(2).filter(|pair| !beside(pair)).map(|pair| net.lane(pair[0]).length()).sum();
        left + way.end - way.start
    };
    for metres in [0.0, 1.0, 30.0, 75.0, 90.0, 100.0, way.length - 0.5] {
        let rest = net.rest_of(&way, metres);
        assert!(
            (rest.length - (way.length - metres)).abs() < 1e-9 && (length(&rest) - rest.length).abs() < 0.5,
            "{rest:?}"
        );
        assert!(way.lanes.ends_with(&rest.lanes) && rest.end == way.end);
        assert!((0.0..=net.lane(rest.lanes[0]).length()).contains(&rest.start));
    }
    let end = net.rest_of(&way, 1e9);
    assert_eq!((end.lanes.len(), end.start, end.length), (1, way.end, 0.0));
}

#[test]
fn t_intersections_alone_come_to_no_standstill() {
    // Two rows: corners and T-intersections only.
    let net = grid_city(2, 8, 60.0, 2).build().unwrap();
    let way = drive_on(&mut scattered(&net, 60, 7, |_, car| car), 600.0, 60.0);
    assert!(way > 2000.0, "{way} m a car in 10 minutes");
}

#[test]
fn a_roundabout_takes_heavy_traffic() {
    let way = drive_on(&mut scattered(&cloverleaf(2), 70, 8, |_, car| car), 600.0, 60.0);
    assert!(way > 1200.0, "{way} m a car in 10 minutes");
    let way = drive_on(&mut scattered(&cloverleaf(4), 30, 9, |_, car| car.changing_lanes()), 600.0, 60.0);
    assert!(way > 1200.0, "{way} m a car in 10 minutes");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_two_cars_ever_touch(
        rows in 2..5_usize, columns in 2..5_usize, block in 30.0..120.0, both_ways in 1..4, share in 0.05..0.4,
        friction in 0.2..0.8, seed in 0..1000_u64, changing: bool,
    ) {
        let net = grid_city(rows, columns, block, 2 * both_ways).build().unwrap();
        let most = TrafficCar::scattered(&net, usize::MAX, seed).len();
        let count = (share * most as f64) as usize;
        let mut traffic = scattered(&net, count, seed, |_, car| if changing { car.changing_lanes() } else { car });
        traffic.set_friction(friction);
        for tick in 0..ticks(60.0) {
            traffic.step(DT, &[]);
            if tick % 5 == 0 {
                prop_assert_eq!(collision(&traffic), None, "after {} s", tick as f64 * DT);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_choice_of_parameters_makes_a_car_run_into_the_one_ahead(
        drivers in prop::collection::vec(
            (0.3..4.0, 0.5..5.0, 0.1..3.0, 0.6..5.0, 1.0..8.0, 2.0..12.0, 5.0..40.0), 6,
        ),
        leader in prop::collection::vec(0.0..35.0_f64, 6),
        friction in 0.05..1.0_f64, dt in 0.01..0.1_f64,
    ) {
        let net = RoadSegment::new(20_000.0).named("road").build().unwrap();
        let cars = drivers.iter().enumerate().map(|(i, &(acceleration, deceleration, headway, gap, exponent, length, desired))| {
            let idm = Idm { acceleration, deceleration, headway, gap, exponent };
            TrafficCar::at(place(&net, "road", 1, 500.0 - 15.0 * i as f64)).idm(idm).size(length, 1.8).desired_speed(desired)
        });
        let mut traffic = Traffic::new(net.clone(), cars.collect(), 0).unwrap();
        traffic.set_friction(friction);
        let braking = (9.80665 * friction).min(8.0);
        for wanted in leader {
            for _ in 0..(10.0 / dt) as usize {
                // The leader does what a car can: 3 m/s² up, 8 m/s² down, or what the road gives.
                let now = traffic.car(0).speed;
                traffic.set_speed(0, Some(wanted.clamp((now - braking * dt).max(0.0), now + 3.0 * dt)));
                traffic.step(dt, &[]);
                let cars: Vec<CarState> = traffic.cars().collect();
                for pair in cars.windows(2) {
                    let gap = pair[0].s - pair[1].s - 0.5 * (pair[0].length + pair[1].length);
                    prop_assert!(gap > 0.0, "{} m", gap);
                    let least = pair[1].acceleration;
                    prop_assert!(least > -braking - 1e-6, "{} m/s² with a friction of {}", least, friction);
                }
            }
        }
    }
}
