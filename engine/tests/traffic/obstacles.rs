//! What is no part of the traffic: who stands, walks or drives in its way.

use super::*;

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
