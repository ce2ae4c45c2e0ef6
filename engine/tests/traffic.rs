//! Traffic as scenarios use it: how cars follow, give way, change lanes and stop, and that they never touch nor get stuck.

use nalgebra::Vector2;
use paracosm_engine::road::{
    Composite, CrossIntersection, LaneKind, Network, Place, RoadSegment, Roundabout, Route, TIntersection, grid_city,
};
use paracosm_engine::traffic::{CarState, Idm, Obstacle, Traffic, TrafficCar, TrafficError};
use paracosm_engine::{Pose, Side};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

const DT: f64 = 0.02;

fn ticks(seconds: f64) -> usize {
    (seconds / DT).round() as usize
}

fn run(traffic: &mut Traffic, seconds: f64, obstacles: &[Obstacle]) {
    for _ in 0..ticks(seconds) {
        traffic.step(DT, obstacles);
    }
}

/// A straight road with two lanes for each direction.
fn road(length: f64) -> Arc<Network> {
    RoadSegment::new(length).lanes(4).named("road").build().unwrap()
}

fn place(net: &Network, element: &str, lane: i32, s: f64) -> Place {
    Place { lane: net.lane_of(element, lane).unwrap(), s }
}

fn corners(pose: &Pose, length: f64, width: f64) -> [Vector2<f64>; 4] {
    let forward = pose.forward();
    let left = Vector2::new(-forward.y, forward.x);
    [(1.0, 1.0), (1.0, -1.0), (-1.0, -1.0), (-1.0, 1.0)]
        .map(|(x, y)| pose.position + forward * (0.5 * x * length) + left * (0.5 * y * width))
}

/// Whether two rectangles meet: no side of either parts them.
fn touch(one: &CarState, other: &CarState) -> bool {
    let corners = [one, other].map(|car| corners(&car.pose, car.length, car.width));
    corners.iter().flat_map(|quad| [quad[1] - quad[0], quad[2] - quad[1]]).all(|axis| {
        let [(a, b), (c, d)] = corners.map(|quad| {
            let along = quad.map(|corner| corner.dot(&axis));
            (along.into_iter().fold(f64::INFINITY, f64::min), along.into_iter().fold(f64::NEG_INFINITY, f64::max))
        });
        a <= d && c <= b
    })
}

/// Every pair of cars that meets, by trying all.
fn collision(traffic: &Traffic) -> Option<(usize, usize)> {
    let cars: Vec<CarState> = traffic.cars().collect();
    let near = |i: usize, j: usize| {
        let reach = 0.5 * (cars[i].length + cars[i].width + cars[j].length + cars[j].width);
        (cars[i].pose.position - cars[j].pose.position).norm_squared() < reach * reach
    };
    let mut pairs = (0..cars.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    pairs.find(|&(i, j)| !cars[i].gone && !cars[j].gone && near(i, j) && touch(&cars[i], &cars[j]))
}

/// Drives on and on, and looks at all pairs of cars every tenth of a second. No car may stand longer than `patience`
/// seconds. How many metres a car has come on average.
fn drive_on(traffic: &mut Traffic, seconds: f64, patience: f64) -> f64 {
    let mut moved: Vec<(f64, usize)> = traffic.cars().map(|_| (0.0, 0)).collect();
    for tick in 0..ticks(seconds) {
        traffic.step(DT, &[]);
        if tick % 5 != 0 {
            continue;
        }
        let now = tick as f64 * DT;
        assert_eq!(collision(traffic), None, "two cars touch after {now} s");
        for (index, (car, (way, since))) in traffic.cars().zip(&mut moved).enumerate() {
            if car.travelled > *way + 1.0 {
                (*way, *since) = (car.travelled, tick);
            }
            let stood = (tick - *since) as f64 * DT;
            assert!(stood < patience, "car {index} has stood for {stood} s after {now} s: {car:?}");
        }
    }
    traffic.cars().map(|car| car.travelled).sum::<f64>() / traffic.cars().len() as f64
}

fn scattered(net: &Arc<Network>, count: usize, seed: u64, with: impl Fn(usize, TrafficCar) -> TrafficCar) -> Traffic {
    let cars: Vec<_> =
        TrafficCar::scattered(net, count, seed).into_iter().enumerate().map(|(i, c)| with(i, c)).collect();
    assert_eq!(cars.len(), count);
    Traffic::new(net.clone(), cars, seed).unwrap()
}

/// A roundabout whose arms are connected in pairs by roads around three bends.
fn cloverleaf(lanes: i32) -> Arc<Network> {
    const BEND: f64 = 30.0;
    const ARM: f64 = 60.0;
    let circus = Roundabout::new().lanes(lanes).named("circus");
    let side = ARM + circus.reach() - BEND;
    let mut net = Composite::from(circus);
    for (from, to) in [("one", "two"), ("three", "four")] {
        let straight = |name: &str, length| RoadSegment::new(length).lanes(lanes).named(format!("{name} {from}"));
        let bend = |name: &str| RoadSegment::arc(BEND, -FRAC_PI_2).lanes(lanes).named(format!("{name} {from}"));
        let end = |name: &str| format!("{name} {from}.two");
        net = net
            .connect(&format!("circus.{from}"), straight("out", ARM), "one")
            .connect(&end("out"), bend("first"), "one")
            .connect(&end("first"), straight("along", side), "one")
            .connect(&end("along"), bend("second"), "one")
            .connect(&end("second"), straight("back", side), "one")
            .connect(&end("back"), bend("third"), "one")
            .connect(&end("third"), straight("in", ARM), "one")
            .close(&end("in"), &format!("circus.{to}"));
    }
    net.build().unwrap()
}

#[test]
fn the_check_of_rectangles_sees_what_touches() {
    let net = road(100.0);
    let cars = [10.0, 14.49].map(|s| TrafficCar::at(place(&net, "road", 1, s)));
    let overlap = Traffic::new(net.clone(), cars.to_vec(), 0).unwrap_err();
    assert_eq!(overlap, TrafficError::Overlap { first: 0, second: 1 });
    // Side by side on lanes of 3.5 m, 1.7 m apart; half way over to the other lane, they touch.
    let cars = [1, 2].map(|lane| TrafficCar::at(place(&net, "road", lane, 30.0)).speed(10.0).desired_speed(10.0));
    let mut traffic = Traffic::new(net, cars.to_vec(), 0).unwrap();
    assert_eq!(collision(&traffic), None);
    assert!(traffic.change_lane(0, Side::Right, 2.0));
    assert!((0..150).any(|_| {
        traffic.step(DT, &[]);
        collision(&traffic) == Some((1, 0))
    }));
}

#[test]
fn a_car_settles_at_the_gap_of_the_formula() {
    let net = RoadSegment::new(20_000.0).named("road").build().unwrap();
    for (speed, headway, exponent) in [(5.0, 1.5, 4.0), (10.0, 1.0, 4.0), (12.0, 1.6, 2.0), (0.0, 1.5, 4.0)] {
        let idm = Idm { headway, exponent, ..Idm::default() };
        let leader = TrafficCar::at(place(&net, "road", 1, 100.0)).speed(speed);
        let car = TrafficCar::at(place(&net, "road", 1, 20.0)).speed(speed).idm(idm).desired_speed(15.0);
        let mut traffic = Traffic::new(net.clone(), vec![leader, car], 0).unwrap();
        traffic.set_speed(0, Some(speed));
        run(&mut traffic, 300.0, &[]);
        let gap = traffic.car(0).s - traffic.car(1).s - 4.5;
        let expected = (idm.gap + speed * headway) / (1.0 - libm::pow(speed / 15.0, exponent)).sqrt();
        assert!((gap / expected - 1.0).abs() < 0.01, "{gap} m at {speed} m/s, expected {expected}");
        assert!((traffic.car(1).speed - speed).abs() < 0.01);
    }
}

/// The equations of the paper for cars in a row behind a leader with the speed `leader(t)`, in steps of a millisecond.
fn platoon(
    mut cars: Vec<(f64, f64)>,
    idm: &Idm,
    desired: f64,
    seconds: f64,
    leader: impl Fn(f64) -> f64,
) -> Vec<(f64, f64)> {
    let step = 0.001;
    for tick in 0..(seconds / step) as usize {
        let now = cars.clone();
        for i in 1..cars.len() {
            let ((x_ahead, v_ahead), (x, v)) = (now[i - 1], now[i]);
            let gap = x_ahead - x - 4.5;
            let wanted = idm.gap
                + (idm.headway * v + v * (v - v_ahead) / (2.0 * (idm.acceleration * idm.deceleration).sqrt())).max(0.0);
            let a = idm.acceleration * (1.0 - libm::pow(v / desired, idm.exponent) - libm::pow(wanted / gap, 2.0));
            let next = (v + a * step).max(0.0);
            cars[i] = (x + 0.5 * (v + next) * step, next);
        }
        let next = leader(tick as f64 * step);
        cars[0] = (cars[0].0 + 0.5 * (cars[0].1 + next) * step, next);
    }
    cars
}

#[test]
fn a_platoon_drives_as_the_equations_integrate() {
    let net = RoadSegment::new(5000.0).named("road").build().unwrap();
    // 10 m/s for 20 s, then down to 2 m/s in 10 s, and up to 12 m/s.
    let leader = |t: f64| {
        let braking = 10.0 - 0.8 * (t - 20.0).max(0.0);
        if t < 30.0 { braking } else { (2.0 + 0.5 * (t - 30.0)).min(12.0) }
    };
    let start: Vec<(f64, f64)> = (0..12).map(|i| (500.0 - 25.0 * f64::from(i), 10.0)).collect();
    let cars = start.iter().map(|(x, v)| TrafficCar::at(place(&net, "road", 1, *x)).speed(*v).desired_speed(14.0));
    let mut traffic = Traffic::new(net.clone(), cars.collect(), 0).unwrap();
    let mut tick = 0;
    for seconds in [15.0, 30.0, 45.0, 80.0] {
        while tick < ticks(seconds) {
            traffic.set_speed(0, Some(leader(tick as f64 * DT)));
            traffic.step(DT, &[]);
            tick += 1;
        }
        let expected = platoon(start.clone(), &Idm::default(), 14.0, seconds, leader);
        for (index, ((x, v), car)) in expected.iter().zip(traffic.cars()).enumerate() {
            let near = (x - car.s).abs() < 0.5 && (v - car.speed).abs() < 0.1;
            assert!(near, "car {index} after {seconds} s: {car:?}, expected {x} m, {v} m/s");
        }
    }
}

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
        0 => car.size(1.8, 0.6).desired_speed(5.0).keeping_right(1.0),
        1 => car.size(7.0, 2.3).desired_speed(11.0),
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

/// Something that stands across lane 1 of the road.
fn standing(x: f64, y: f64) -> Obstacle {
    let pose = Pose { position: Vector2::new(x, y), heading: FRAC_PI_2 };
    Obstacle { pose, length: 0.6, width: 0.5, velocity: Vector2::zeros() }
}

#[test]
fn a_car_stops_for_what_stands_before_it_and_goes_on_when_that_is_gone() {
    let net = road(300.0);
    let car = TrafficCar::at(place(&net, "road", 1, 20.0)).speed(13.0);
    let mut traffic = Traffic::new(net, vec![car], 0).unwrap();
    // The middle of lane 1 is 1.75 m to the right of the road's.
    let person = standing(120.0, -1.75);
    run(&mut traffic, 30.0, &[person]);
    let gap = 120.0 - 0.25 - traffic.car(0).s - 2.25;
    assert!(traffic.car(0).speed < 0.01 && (1.5..3.0).contains(&gap), "{gap} m, {:?}", traffic.car(0));
    run(&mut traffic, 10.0, &[]);
    assert!(traffic.car(0).s > 150.0 && traffic.car(0).speed > 8.0);
}

#[test]
fn it_does_not_stop_for_who_stands_on_the_sidewalk_or_on_another_lane() {
    let net = road(300.0);
    for (y, stops) in [(-8.0, false), (-5.25, false), (-3.2, true), (1.75, false)] {
        let car = TrafficCar::at(place(&net, "road", 1, 20.0)).speed(13.0);
        let mut traffic = Traffic::new(net.clone(), vec![car], 0).unwrap();
        run(&mut traffic, 18.0, &[standing(120.0, y)]);
        assert_eq!(traffic.car(0).s < 120.0, stops, "with somebody at {y} m: {:?}", traffic.car(0));
    }
}

#[test]
fn it_brakes_for_who_walks_into_its_way_but_not_for_who_walks_along() {
    let net = road(300.0);
    for (velocity, stops) in [(Vector2::new(0.0, 1.4), true), (Vector2::new(1.4, 0.0), false)] {
        let car = TrafficCar::at(place(&net, "road", 2, 20.0)).speed(8.0).desired_speed(8.0);
        let mut traffic = Traffic::new(net.clone(), vec![car], 0).unwrap();
        let mut least = f64::INFINITY;
        for tick in 0..ticks(12.0) {
            // 1 m beside the car's way where it arrives after some 6 s, then on.
            let shift = velocity * (tick as f64 * DT - 5.0).max(0.0);
            let mut person = standing(70.0, -8.2);
            person.pose.position += shift;
            person.velocity = if tick as f64 * DT > 5.0 { velocity } else { Vector2::zeros() };
            traffic.step(DT, &[person]);
            least = least.min(traffic.car(0).speed);
        }
        assert_eq!(least < 3.0, stops, "{least} m/s at least, walking at {velocity:?}");
    }
}

#[test]
fn it_follows_a_foreign_car_as_one_of_its_own() {
    let net = road(2000.0);
    let car = TrafficCar::at(place(&net, "road", 1, 20.0)).speed(8.0);
    let mut traffic = Traffic::new(net, vec![car], 0).unwrap();
    let idm = Idm::default();
    let mut gap = 0.0;
    for tick in 0..ticks(120.0) {
        let x = 60.0 + 8.0 * DT * tick as f64;
        let pose = Pose { position: Vector2::new(x, -1.75), heading: 0.0 };
        traffic.step(DT, &[Obstacle { pose, length: 4.5, width: 1.6, velocity: Vector2::new(8.0, 0.0) }]);
        gap = x + 8.0 * DT - traffic.car(0).s - 4.5;
    }
    let expected = (idm.gap + 8.0 * idm.headway) / (1.0 - libm::pow(8.0 / (50.0 / 3.6), 4.0)).sqrt();
    assert!((gap / expected - 1.0).abs() < 0.02, "{gap} m, expected {expected}");
}

#[test]
fn a_heedless_car_drives_on() {
    let net = road(300.0);
    let car = TrafficCar::at(place(&net, "road", 1, 20.0)).speed(13.0).heedless();
    let mut traffic = Traffic::new(net, vec![car], 0).unwrap();
    run(&mut traffic, 10.0, &[standing(100.0, -1.75)]);
    assert!(traffic.car(0).s > 120.0);
}

#[test]
fn cars_of_both_directions_let_somebody_cross_on_the_zebra_crossing() {
    let net = RoadSegment::new(200.0).zebra(100.0).named("road").build().unwrap();
    let start = |lane| TrafficCar::at(place(&net, "road", lane, 30.0)).speed(8.0).desired_speed(8.0);
    let alone = |obstacle: fn(f64) -> Option<Obstacle>| {
        let mut traffic = Traffic::new(net.clone(), vec![start(1), start(-1)], 0).unwrap();
        let mut least = [f64::INFINITY; 2];
        for tick in 0..ticks(25.0) {
            let person = obstacle(tick as f64 * DT);
            traffic.step(DT, person.as_slice());
            for ((least, car), lane) in least.iter_mut().zip(traffic.cars()).zip([0.0, 3.5]) {
                if let Some(person) = person.filter(|_| (car.pose.position.x - 100.0).abs() < 4.0) {
                    // Nobody is on the crossing while somebody walks over it and has not passed its lane.
                    let y = person.pose.position.y;
                    assert!(
                        y < -3.5 || y > lane || person.velocity.y == 0.0,
                        "{car:?} is on the crossing with somebody at {y} m"
                    );
                }
                *least = least.min(car.speed);
            }
        }
        assert!(traffic.cars().all(|car| car.travelled > 60.0), "nobody has to wait for ever");
        least
    };
    // Steps onto the road after 6 s and walks over its 7 m.
    let walker = |t: f64| {
        let y = -6.3 + 1.4 * (t - 4.0).max(0.0);
        let velocity = Vector2::new(0.0, if t > 4.0 && y < 6.0 { 1.4 } else { 0.0 });
        Some(Obstacle { velocity, ..standing(100.0, y.min(6.0)) })
    };
    assert!(alone(walker).iter().all(|least| *least < 4.0), "both brake: {:?}", alone(walker));
    // Who stands on the sidewalk does not want to cross.
    assert!(alone(|_| Some(standing(100.0, -5.5))).iter().all(|least| *least > 7.0));
    // A car is no pedestrian: the other direction does not mind it.
    let crossed = alone(|t| {
        let pose = Pose { position: Vector2::new(200.0 - 8.0 * t, 10.0), heading: PI };
        Some(Obstacle { pose, length: 4.5, width: 1.6, velocity: Vector2::new(-8.0, 0.0) })
    });
    assert!(crossed.iter().all(|least| *least > 7.0), "{crossed:?}");
}

/// Three arms of 100 m: `east` and `west` of the main road, `south`, which ends at it.
fn tee() -> Arc<Network> {
    let arm = |name: &str| RoadSegment::new(100.0).named(name);
    let net = TIntersection::new().named("tee").connect("one", arm("east"), "one").connect("two", arm("south"), "one");
    net.connect("three", arm("west"), "one").build().unwrap()
}

fn route(net: &Network, from: Place, to: Place) -> Route {
    net.route(from, to, 20.0).expect("there is a way")
}

#[test]
fn who_comes_from_the_side_lets_the_main_road_go_first() {
    let net = tee();
    let across = route(&net, place(&net, "west", -1, 40.0), place(&net, "east", 1, 95.0));
    let from_side = route(&net, place(&net, "south", -1, 50.0), place(&net, "west", 1, 95.0));
    let cars = vec![
        TrafficCar::following(&from_side).speed(8.0).desired_speed(8.0),
        TrafficCar::following(&across).speed(8.0).desired_speed(8.0),
    ];
    let mut traffic = Traffic::new(net.clone(), cars, 0).unwrap();
    let in_tee = |car: &CarState| net.lane(car.lane).kind != LaneKind::Road;
    let mut order = Vec::new();
    let mut least = [f64::INFINITY; 2];
    for _ in 0..ticks(40.0) {
        traffic.step(DT, &[]);
        for (index, car) in traffic.cars().enumerate() {
            if in_tee(&car) && !order.contains(&index) {
                order.push(index);
            }
            if car.travelled < 55.0 {
                least[index] = least[index].min(car.speed);
            }
        }
        assert_eq!(collision(&traffic), None);
    }
    assert_eq!(order, [1, 0], "the side road is 10 m nearer, and waits");
    assert!(least[1] > 7.5 && least[0] < 4.0, "{least:?}");
    // Both have come to the ends of their routes and stay there.
    for (car, route) in traffic.cars().zip([&from_side, &across]) {
        assert!((car.s - route.end).abs() < 0.5 && car.speed < 0.05, "{car:?}");
    }
}

#[test]
fn four_who_each_have_another_at_their_right_find_an_order() {
    let arm = |name: &str| RoadSegment::new(80.0).named(name);
    let cross = CrossIntersection::new().named("cross").connect("one", arm("east"), "one");
    let cross = cross.connect("two", arm("south"), "one").connect("three", arm("west"), "one");
    let net = cross.connect("four", arm("north"), "one").build().unwrap();
    let ways = [("east", "west"), ("south", "north"), ("west", "east"), ("north", "south")];
    let cars = ways
        .map(|(from, to)| TrafficCar::following(&route(&net, place(&net, from, -1, 40.0), place(&net, to, 1, 70.0))));
    let mut traffic = Traffic::new(net, cars.to_vec(), 0).unwrap();
    for _ in 0..ticks(60.0) {
        traffic.step(DT, &[]);
        assert_eq!(collision(&traffic), None);
    }
    assert!(traffic.cars().all(|car| car.s > 69.0), "all are over");
}

#[test]
fn a_car_lets_the_car_under_test_cross_before_it() {
    let net = tee();
    let from_side = route(&net, place(&net, "south", -1, 60.0), place(&net, "west", 1, 60.0));
    let cars = vec![TrafficCar::following(&from_side).speed(6.0)];
    let mut traffic = Traffic::new(net, cars, 0).unwrap();
    for tick in 0..ticks(25.0) {
        // Along the main road from west to east at 10 m/s, over the intersection after 5 s.
        let x = -50.0 + 10.0 * DT * tick as f64;
        let pose = Pose { position: Vector2::new(x, -1.75), heading: 0.0 };
        traffic.step(DT, &[Obstacle { pose, length: 4.5, width: 1.6, velocity: Vector2::new(10.0, 0.0) }]);
        let car = traffic.car(0);
        let foreign = CarState { pose: Pose { position: pose.position + Vector2::new(10.0 * DT, 0.0), ..pose }, ..car };
        assert!(!touch(&car, &foreign), "they touch at {x} m");
    }
    assert!(traffic.car(0).s > 40.0, "{:?}", traffic.car(0));
}

#[test]
fn a_car_on_the_main_road_does_not_brake_for_the_car_under_test_until_that_is_in_its_way() {
    let net = tee();
    let across = route(&net, place(&net, "west", -1, 50.0), place(&net, "east", 1, 95.0));
    // From the side road at 8 m/s, up to the line in time with the car on the main road, and not beyond, or beyond.
    let least = |line: f64| {
        let cars = vec![TrafficCar::following(&across).speed(8.0).desired_speed(8.0)];
        let mut traffic = Traffic::new(net.clone(), cars, 0).unwrap();
        let (mut y, mut least, mut speed) = (-50.0, f64::INFINITY, 8.0_f64);
        for _ in 0..ticks(12.0) {
            let braking = (2.0 * 4.0 * (line - y - 2.25_f64).max(0.0)).sqrt();
            speed = speed.min(braking);
            y += speed * DT;
            let pose = Pose { position: Vector2::new(1.75, y), heading: FRAC_PI_2 };
            traffic.step(DT, &[Obstacle { pose, length: 4.5, width: 1.6, velocity: Vector2::new(0.0, speed) }]);
            least = least.min(traffic.car(0).speed);
        }
        least
    };
    assert!(least(-10.0) > 7.5, "{} m/s: it waits", least(-10.0));
    assert!(least(-1.5) < 2.0, "{} m/s: it stands in the way", least(-1.5));
}

#[test]
fn a_commanded_lane_change_takes_its_time_and_ends_in_the_middle_of_the_lane() {
    let net = road(500.0);
    let car = TrafficCar::at(place(&net, "road", 1, 20.0)).speed(12.0).desired_speed(12.0);
    let mut traffic = Traffic::new(net.clone(), vec![car], 0).unwrap();
    assert!(!traffic.change_lane(0, Side::Left, 3.0), "there is no lane to the left");
    assert!(traffic.change_lane(0, Side::Right, 3.0));
    assert!(!traffic.change_lane(0, Side::Left, 3.0), "one at a time");
    assert_eq!(traffic.car(0).indicator, Some(Side::Right));
    let mut before = traffic.car(0).pose;
    for tick in 0..ticks(3.0) {
        traffic.step(DT, &[]);
        let car = traffic.car(0);
        let way = car.pose.position - before.position;
        assert!((way.norm() - 12.0 * DT).abs() < 0.02, "it does not jump: {way:?} at tick {tick}");
        let along = libm::atan2(way.y, way.x);
        assert!((along - 0.5 * (before.heading + car.pose.heading)).abs() < 1e-2, "it faces where it drives");
        before = car.pose;
        if tick == ticks(1.5) {
            assert!((car.pose.position.y + 3.5).abs() < 0.1, "half way after half the time: {car:?}");
        }
    }
    let car = traffic.car(0);
    assert!((car.pose.position.y + 5.25).abs() < 1e-3 && car.offset.abs() < 1e-3, "{car:?}");
    run(&mut traffic, 0.1, &[]);
    assert_eq!((traffic.car(0).indicator, traffic.car(0).lane), (None, net.lane_of("road", 2).unwrap()));
}

#[test]
fn a_route_leads_over_to_the_lane_of_its_end() {
    let net = road(400.0);
    let way = route(&net, place(&net, "road", 1, 10.0), place(&net, "road", 2, 380.0));
    assert_eq!(way.changes, 1);
    let mut traffic = Traffic::new(net.clone(), vec![TrafficCar::following(&way)], 0).unwrap();
    run(&mut traffic, 60.0, &[]);
    let car = traffic.car(0);
    assert!(car.lane == net.lane_of("road", 2).unwrap() && (car.s - 380.0).abs() < 0.5, "{car:?}");
}

#[test]
fn routes_through_a_roundabout_change_lanes_before_it() {
    let net = cloverleaf(4);
    for (from, to) in [(-1, 2), (-2, 1), (-1, 1), (-2, 2)] {
        for (arm, out) in [("in one", "out three"), ("in three", "out one"), ("in one", "out one")] {
            let way = route(&net, place(&net, arm, -from, 10.0), place(&net, out, to, 40.0));
            let mut traffic = Traffic::new(net.clone(), vec![TrafficCar::following(&way)], 0).unwrap();
            for _ in 0..ticks(60.0) {
                let before = traffic.car(0);
                traffic.step(DT, &[]);
                let [old, new] = [before, traffic.car(0)].map(|car| net.lane(car.lane));
                assert!(old.kind == LaneKind::Road || !old.beside().any(|lane| lane == traffic.car(0).lane), "{new:?}");
            }
            let car = traffic.car(0);
            assert!(car.lane == *way.lanes.last().unwrap() && (car.s - 40.0).abs() < 0.5, "{from} {to} {arm}: {car:?}");
        }
    }
}

#[test]
fn who_cannot_get_to_the_lane_of_its_route_finds_another_way() {
    let net = grid_city(3, 3, 80.0, 4).build().unwrap();
    // It is to turn left at the next junction, for which it has to be on lane 1; there others stand.
    let from = place(&net, "street 1,0 east", 2, 40.0);
    let to = place(&net, "street 0,1 south", -1, 50.0);
    let way = route(&net, from, to);
    assert_eq!(way.changes, 1);
    let standing = (0..6).map(|i| TrafficCar::at(place(&net, "street 1,0 east", 1, 30.0 + 8.0 * f64::from(i))));
    let cars: Vec<_> = [TrafficCar::following(&way)].into_iter().chain(standing).collect();
    let mut traffic = Traffic::new(net.clone(), cars, 0).unwrap();
    for index in 1..7 {
        traffic.set_speed(index, Some(0.0));
    }
    for tick in 0..ticks(150.0) {
        if tick == ticks(40.0) {
            (1..7).for_each(|index| traffic.set_speed(index, None));
        }
        traffic.step(DT, &[]);
        assert_eq!(collision(&traffic), None);
        if tick == ticks(40.0) {
            assert!(traffic.car(0).travelled > 100.0, "it does not wait until they have gone");
        }
    }
    let car = traffic.car(0);
    assert!(car.lane == to.lane && (car.s - 50.0).abs() < 0.5, "{car:?}");
}

#[test]
fn who_may_change_lanes_overtakes() {
    let net = road(1500.0);
    for changes in [true, false] {
        let slow = TrafficCar::at(place(&net, "road", 2, 60.0)).desired_speed(5.0).speed(5.0);
        let fast = TrafficCar::at(place(&net, "road", 2, 20.0)).speed(12.0);
        let fast = if changes { fast.changing_lanes() } else { fast };
        let mut traffic = Traffic::new(net.clone(), vec![slow, fast], 0).unwrap();
        for _ in 0..ticks(60.0) {
            traffic.step(DT, &[]);
            assert_eq!(collision(&traffic), None);
        }
        assert_eq!(traffic.car(1).s > traffic.car(0).s, changes);
    }
}

#[test]
fn lorries_and_fast_cars_share_a_motorway() {
    // Two roads, so that lane changes reach over their joint.
    let half = |name: &str| RoadSegment::new(3000.0).lanes(6).lane_width(3.75).sidewalk(0.0).named(name);
    let net = half("first").connect("two", half("second"), "one").build().unwrap();
    let cars = (0..90).map(|i| {
        let car = TrafficCar::at(place(&net, "first", 1 + i % 3, 20.0 + 25.0 * f64::from(i / 3))).changing_lanes();
        match i % 5 {
            0 => car.size(12.0, 2.5).desired_speed(22.0).speed(20.0),
            _ => car.desired_speed(26.0 + f64::from(i % 7) * 2.0).speed(20.0),
        }
    });
    let mut traffic = Traffic::new(net.clone(), cars.collect(), 0).unwrap();
    let rank = |traffic: &Traffic| {
        let mut order: Vec<usize> = (0..90).collect();
        order.sort_by(|a, b| traffic.car(*a).travelled.total_cmp(&traffic.car(*b).travelled));
        order
    };
    run(&mut traffic, 10.0, &[]);
    let (before, mut changes) = (rank(&traffic), 0);
    for tick in 0..ticks(120.0) {
        let lanes: Vec<_> = traffic.cars().map(|car| net.lane(car.lane).number).collect();
        traffic.step(DT, &[]);
        changes += traffic.cars().zip(lanes).filter(|(car, lane)| net.lane(car.lane).number != *lane).count();
        if tick % 5 == 0 {
            assert_eq!(collision(&traffic), None);
        }
    }
    assert!(changes > 30, "{changes} lane changes");
    assert_ne!(before, rank(&traffic));
    let faster = |fast: bool| {
        let cars = (0..90).filter(|i| (i % 5 != 0) == fast).map(|i| traffic.car(i).travelled);
        cars.clone().sum::<f64>() / cars.count() as f64
    };
    assert!(faster(true) > faster(false) + 200.0, "cars come past lorries: {} m, {} m", faster(true), faster(false));
}

#[test]
fn a_given_speed_is_kept_unless_something_is_in_the_way() {
    let net = road(500.0);
    let cars = [80.0, 20.0].map(|s| TrafficCar::at(place(&net, "road", 1, s)));
    let mut traffic = Traffic::new(net, cars.to_vec(), 0).unwrap();
    traffic.set_speed(0, Some(0.0));
    for tick in 0..ticks(3.0) {
        let speed = 1.0 + tick as f64 * DT;
        traffic.set_speed(1, Some(speed));
        traffic.step(DT, &[]);
        assert_eq!(traffic.car(1).speed, speed);
    }
    traffic.set_speed(1, Some(20.0));
    run(&mut traffic, 10.0, &[]);
    let gap = traffic.car(0).s - traffic.car(1).s - 4.5;
    assert!(traffic.car(1).speed < 0.1 && (0.3..1.0).contains(&gap), "{gap} m");
    traffic.set_speed(0, None);
    traffic.set_speed(1, None);
    traffic.set_desired_speed(0, 10.0);
    run(&mut traffic, 20.0, &[]);
    assert!((traffic.car(0).speed - 10.0).abs() < 0.5 && traffic.car(1).speed > 8.0);
}

#[test]
fn who_is_given_a_speed_at_a_stroke_still_stops_before_an_intersection_that_others_have_claimed() {
    let net = tee();
    let across = route(&net, place(&net, "west", -1, 40.0), place(&net, "east", 1, 95.0));
    let from_side = route(&net, place(&net, "south", -1, 88.0), place(&net, "west", 1, 95.0));
    for quarter in 0..24 {
        let cars = [&across, &from_side].map(|route| TrafficCar::following(route).desired_speed(8.0));
        let mut traffic = Traffic::new(net.clone(), vec![cars[0].clone().moving(), cars[1].clone()], 0).unwrap();
        // It stands some metres before the line, and is off at 15 m/s about when the other one comes.
        let off = 3.0 + 0.25 * f64::from(quarter);
        for tick in 0..ticks(30.0) {
            traffic.set_speed(1, Some(if (tick as f64) * DT < off { 0.0 } else { 15.0 }));
            traffic.step(DT, &[]);
            assert_eq!(collision(&traffic), None, "off after {off} s");
        }
        assert!(traffic.cars().all(|car| car.travelled > 80.0));
    }
}

#[test]
fn where_the_network_ends_cars_leave_it() {
    let net = road(100.0);
    let cars = [20.0, 60.0].map(|s| TrafficCar::at(place(&net, "road", 1, s)));
    let mut traffic = Traffic::new(net, cars.to_vec(), 0).unwrap();
    run(&mut traffic, 30.0, &[]);
    assert!(traffic.cars().all(|car| car.gone && car.travelled > 40.0));
}

#[test]
fn a_circling_car_comes_by_again_and_again() {
    let net = grid_city(2, 2, 60.0, 2).build().unwrap();
    let start = place(&net, "street 0,0 east", 1, 10.0);
    let there = route(&net, start, place(&net, "street 0,0 south", -1, 30.0));
    let back = route(&net, place(&net, "street 0,0 south", -1, 30.0), start);
    let lanes = [&there.lanes[..], &back.lanes[1..]].concat();
    let round = Route { lanes, start: 10.0, end: 10.0, length: there.length + back.length, changes: 0 };
    let mut traffic = Traffic::new(net, vec![TrafficCar::circling(&round)], 0).unwrap();
    let mut rounds = 0;
    for _ in 0..ticks(300.0) {
        let before = traffic.car(0);
        traffic.step(DT, &[]);
        let car = traffic.car(0);
        rounds += usize::from(car.lane == start.lane && before.lane != start.lane);
        assert!(round.lanes.contains(&car.lane));
    }
    assert!(rounds >= 4, "{rounds} rounds of {} m", round.length);
}

#[test]
fn the_same_seed_gives_the_same_traffic_and_another_one_another() {
    let net = grid_city(3, 4, 70.0, 4).build().unwrap();
    let drive = |seed| {
        let cars = TrafficCar::scattered(&net, 60, 11).into_iter().map(TrafficCar::changing_lanes).collect();
        let mut traffic = Traffic::new(net.clone(), cars, seed).unwrap();
        run(&mut traffic, 100.0, &[standing(30.0, 0.0)]);
        traffic.cars().collect::<Vec<_>>()
    };
    assert_eq!(drive(1), drive(1));
    assert_ne!(drive(1), drive(2));
}

#[test]
fn no_step_allocates() {
    let net = grid_city(4, 4, 80.0, 4).build().unwrap();
    let mut traffic = scattered(&net, 80, 12, |_, car| car.changing_lanes());
    let people = [standing(30.0, 2.0), standing(90.0, -30.0)];
    run(&mut traffic, 60.0, &people);
    let after = allocation_counter::measure(|| run(&mut traffic, 60.0, &people));
    assert_eq!((after.count_total, after.bytes_total), (0, 0));
}

#[test]
fn cars_that_cannot_be_are_refused_by_their_indices() {
    let net = road(100.0);
    let good = || TrafficCar::at(place(&net, "road", 1, 20.0));
    let refusal = |car: TrafficCar| {
        let other = TrafficCar::at(place(&net, "road", 2, 20.0));
        Traffic::new(net.clone(), vec![other, car], 0).unwrap_err().to_string()
    };
    let beyond = TrafficCar::at(place(&net, "road", 1, 101.0));
    assert_eq!(refusal(beyond), "car 1 has 101 as its place in metres along its lane, expected 0 to 100");
    assert_eq!(refusal(good().size(0.0, 1.8)), "car 1 has 0 as its length in metres, expected 0.1 to 30");
    assert!(refusal(good().desired_speed(f64::NAN)).contains("NaN as its desired speed"));
    let idm = Idm { acceleration: 0.0, ..Idm::default() };
    assert!(refusal(good().idm(idm)).contains("acceleration of IDM"));
    let lanes = [1, -1].map(|lane| net.lane_of("road", lane).unwrap());
    let way = Route { lanes: lanes.to_vec(), start: 10.0, end: 20.0, length: 0.0, changes: 0 };
    assert_eq!(
        refusal(TrafficCar::following(&way)),
        "the route of car 1 leads from lane 0 to lane 2, neither its successor nor beside it on a road"
    );
}
