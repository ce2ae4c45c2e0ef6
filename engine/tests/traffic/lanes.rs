//! Changes of lanes: commanded, for a route, and for more speed.

use super::*;

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
