//! How cars follow one another, against the formulas.

use super::*;

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
fn cars_slow_down_before_a_speed_limit_and_keep_it() {
    let centre = Curve::new(Pose { position: Vector2::zeros(), heading: 0.0 }, 0.0, 1000.0);
    let limits =
        vec![SpeedLimit { from: 0.0, to: 300.0, speed: 25.0 }, SpeedLimit { from: 300.0, to: 600.0, speed: 10.0 }];
    let lane = SurveyedLane { limits, ..SurveyedLane::new(0, 1, [0.0, 1000.0], centre.into()) };
    let road = SurveyedRoad { name: "road".to_owned(), length: 1000.0, centre: centre.into(), junction: None };
    let net = Survey { roads: vec![road], lanes: vec![lane], ..Survey::default() }.build().unwrap();
    let car = TrafficCar::at(place(&net, "road", 1, 5.0)).desired_speed(33.0).speed(20.0);
    let mut traffic = Traffic::new(net, vec![car], 1).unwrap();
    let mut fastest = [0.0_f64; 3];
    while traffic.car(0).s < 950.0 {
        traffic.step(DT, &[]);
        let CarState { s, speed, .. } = traffic.car(0);
        let part = usize::from(s > 300.0) + usize::from(s > 600.0);
        fastest[part] = fastest[part].max(speed);
    }
    assert!(fastest[0] > 22.0 && fastest[0] <= 25.0, "{fastest:?}");
    assert!(fastest[1] > 9.5 && fastest[1] <= 10.5, "{fastest:?}");
    // Beyond the limits the car drives as fast as it wants to.
    assert!(fastest[2] > 25.0, "{fastest:?}");
}
