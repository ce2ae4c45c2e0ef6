//! What cars are told, where they leave, and what does not change from run to run.

use super::*;

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
        "the route of car 1 leads from lane 0 to lane 2, which neither follows nor is beside it on a road"
    );
}
