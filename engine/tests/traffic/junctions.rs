//! Who goes first.

use super::*;

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
