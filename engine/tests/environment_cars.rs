//! Environment cars in a scenario: what they can be told, what can be read of them, and what they stop for.

use nalgebra::Vector2;
use paracosm_engine::object::{BodyState, VehicleKind};
use paracosm_engine::road::{RoadSegment, grid_city};
use paracosm_engine::traffic::TrafficCar;
use paracosm_engine::vehicle::VehicleModel;
use paracosm_engine::{
    AutonomousVehicle, Control, Environment, EnvironmentCars, Fleet, Outcome, Pedestrian, Program, Road, Run, Scenario,
    Setup, Side, Step, Stream, eventually, never,
};
use paracosm_oracles::Verdict;
use paracosm_space::Values;

/// Runs a program in which the ego vehicle only rolls: the bodies of the others tick by tick, and how it ended.
fn run(build: fn(&mut Scenario)) -> (Vec<Vec<BodyState>>, Outcome) {
    let program = Program::new("environment-cars", "environment cars", build);
    let setup = Setup { vehicle: VehicleModel::SingleTrack.into(), ..Setup::asking_every(0.01) };
    let mut run = Run::new(&program, &Values::default(), setup).unwrap_or_else(|error| panic!("{error}"));
    let mut seen = Vec::new();
    loop {
        let outcome = match run.advance() {
            Step::Need(_) => None,
            Step::Done(outcome) => Some(*outcome),
        };
        seen.push(run.bodies()[1..].to_vec());
        match outcome {
            Some(outcome) => return (seen, outcome),
            None => run.supply(Control::default()),
        }
    }
}

fn refusal(build: fn(&mut Scenario)) -> String {
    let program = Program::new("environment-cars", "environment cars", build);
    program.declare().expect_err("it is refused").to_string()
}

fn signal(outcome: &Outcome, name: &str) -> Vec<f64> {
    let trace = outcome.trace.as_ref().unwrap_or_else(|| panic!("there is no trace: {:?}", outcome.ending.message()));
    trace.signal(name).unwrap_or_else(|| panic!("no `{name}` in {:?}", trace.signals())).collect()
}

#[test]
fn every_kind_of_vehicle_is_in_the_traffic_with_its_class_and_its_dimensions() {
    let (seen, _) = run(|s| {
        let road = road(s);
        let place = |index: i32| road.streets().place_on("road", 1, 20.0 + 30.0 * f64::from(index)).unwrap();
        let cars = vec![
            TrafficCar::at(place(0)),
            TrafficCar::van(place(1)),
            TrafficCar::truck(place(2)),
            TrafficCar::bus(place(3)),
            TrafficCar::motorcycle(place(4)),
            TrafficCar::bicycle(place(5)),
        ];
        s.place(EnvironmentCars::on(road.streets(), cars));
        s.require("time", eventually(Stream::time().at_least(1.0)));
    });
    let kinds = [
        VehicleKind::CAR,
        VehicleKind::VAN,
        VehicleKind::TRUCK,
        VehicleKind::BUS,
        VehicleKind::MOTORCYCLE,
        VehicleKind::BICYCLE,
    ];
    for (state, kind) in seen[0].iter().zip(kinds) {
        let half = state.body.outline.half_extent();
        assert_eq!((state.body.class, [2.0 * half.x, 2.0 * half.y, state.body.height]), (kind.class, kind.size));
    }
}

/// A road of 300 m with two lanes for each direction, on which the ego vehicle stands far away, the other way.
fn road(s: &mut Scenario) -> Road {
    let road = s.place(RoadSegment::new(300.0).lanes(4).named("road"));
    s.place(AutonomousVehicle::at(road.on_lane(-2, 290.0)));
    s.duration(10.0);
    road
}

/// Two cars on lane 1: car 0 at 20 m, car 1 at 120 m.
fn two(s: &mut Scenario, road: &Road, change: fn(TrafficCar) -> TrafficCar) -> Fleet {
    let start = |at| road.streets().place_on("road", 1, at).map(TrafficCar::at).map(change);
    let cars = [20.0, 120.0].into_iter().filter_map(start).collect();
    s.place(EnvironmentCars::on(road.streets(), cars))
}

#[test]
fn a_car_drives_at_the_speed_that_it_is_given_and_as_it_likes_where_that_is_absent() {
    let (seen, _) = run(|s| {
        let road = road(s);
        let fleet = two(s, &road, |car| car);
        let given = Stream::from(5.0).take_until(&Stream::time().at_least(3.0));
        fleet.drive(0, given);
    });
    let speed = |second: usize| seen[100 * second].first().unwrap().velocity.norm();
    assert!((0..3).all(|second| (speed(second) - 5.0).abs() < 1e-9), "it begins at that speed, and keeps it");
    assert!((seen[250][0].pose.position.x - 32.5).abs() < 1e-9);
    assert!(speed(6) > 7.0 && seen[100][1].velocity.norm() > 1.0);
}

#[test]
fn a_car_wants_the_speed_that_it_is_told_to() {
    let (seen, _) = run(|s| {
        let road = road(s);
        let fleet = two(s, &road, |car| car.speed(10.0));
        fleet.wish(0, 4.0);
    });
    let last = seen.last().unwrap();
    assert!((last[0].velocity.norm() - 4.0).abs() < 0.3 && last[1].velocity.norm() > 11.0, "{last:?}");
}

#[test]
fn a_car_changes_lanes_when_something_happens() {
    let (seen, outcome) = run(|s| {
        let road = road(s);
        let fleet = two(s, &road, |car| car.speed(10.0).desired_speed(10.0));
        // When the other one, which is 100 m ahead, has come to 150 m: after 3 s.
        let there = fleet.position(1).x().at_least(150.0);
        fleet.change_lane(0, Side::Right, 3.0, &there);
        s.require("there", eventually(there));
    });
    assert_eq!(outcome.verdict(), Verdict::Pass, "{:?}", outcome.ending.message());
    let y = |tick: usize| seen[tick][0].pose.position.y;
    assert!((y(300) + 1.75).abs() < 0.01, "{}", y(300));
    assert!((y(453) + 3.5).abs() < 0.2, "{}", y(453));
    assert!((y(620) + 5.25).abs() < 0.01 && seen.iter().all(|bodies| (bodies[1].pose.position.y + 1.75).abs() < 1e-9));
}

#[test]
fn what_is_read_of_a_car_is_what_its_body_does() {
    let (seen, outcome) = run(|s| {
        let road = road(s);
        let fleet = two(s, &road, |car| car.speed(6.0));
        assert_eq!(fleet.count(), 2);
        s.require("speed", never(fleet.speed(0).named("v").above(50.0)));
        s.require("place", never(fleet.position(1).x().named("x").above(1e3)));
    });
    let (v, x) = (signal(&outcome, "v"), signal(&outcome, "x"));
    assert!(v.len() == 1001 && v[0] == 6.0 && x[0] == 120.0);
    for ((bodies, v), x) in seen.iter().zip(v).zip(x) {
        assert!((bodies[0].velocity.norm() - v).abs() < 0.02 && bodies[1].pose.position.x == x);
    }
}

#[test]
fn cars_stop_for_the_car_under_test_and_for_who_stands_on_the_road() {
    let (seen, outcome) = run(|s| {
        let road = s.place(RoadSegment::new(300.0).lanes(4).named("road"));
        let car = s.place(AutonomousVehicle::at(road.on_lane(1, 100.0)));
        s.place(Pedestrian::at(road.on_lane(1, 200.0)));
        two(s, &road, |car| car.speed(10.0));
        s.duration(25.0);
        s.require("no-collision", never(car.collides()));
    });
    assert_eq!(outcome.verdict(), Verdict::Pass, "{:?}", outcome.ending.message());
    let last = seen.last().unwrap();
    let gaps = [100.0 - 2.254 - 2.25, 200.0 - 0.25 - 2.25];
    for (body, at) in last[1..].iter().zip(gaps) {
        let gap = at - body.pose.position.x;
        assert!((1.0..3.0).contains(&gap) && body.velocity.norm() < 0.1, "{gap} m: {body:?}");
    }
}

#[test]
fn on_a_slippery_road_cars_brake_with_no_more_than_it_gives_and_stop_in_time() {
    // Car 1 stands 100 m ahead of car 0.
    let slippery = |s: &mut Scenario| {
        let road = road(s);
        s.place(Environment::new().friction(0.1));
        let fleet = two(s, &road, |car| car.speed(13.0));
        fleet.drive(1, 0.0);
        s.duration(30.0);
    };
    let (seen, _) = run(slippery);
    let speeds: Vec<f64> = seen.iter().map(|bodies| bodies[0].velocity.norm()).collect();
    let hardest = speeds.windows(2).map(|pair| (pair[0] - pair[1]) / 0.01).fold(0.0, f64::max);
    assert!((0.9..=0.1 * 9.80665 + 0.02).contains(&hardest), "{hardest} m/s²");
    let gap = 120.0 - 4.5 - seen.last().unwrap()[0].pose.position.x;
    assert!((0.0..4.0).contains(&gap) && *speeds.last().unwrap() < 0.3, "{gap} m");
}

#[test]
fn who_drives_out_of_the_network_leaves_the_world() {
    let (seen, _) = run(|s| {
        let road = road(s);
        let fleet = two(s, &road, |car| car.desired_speed(30.0).speed(30.0));
        s.require("place", never(fleet.position(1).x().named("x").above(1e3)));
    });
    let left = seen.iter().position(|bodies| !bodies[1].present).expect("the first one leaves");
    assert!(seen[left - 1][1].pose.position.x > 300.0 && seen[left][0].present);
    assert!(seen[left..].iter().all(|bodies| !bodies[1].present && bodies[1].velocity == Vector2::zeros()));
}

fn city<const SEED: u64>(s: &mut Scenario) {
    let streets = s.place(grid_city(3, 3, 80.0, 2).build().unwrap());
    let start = streets.on_lane("street 1,0 east", 1, 10.0);
    s.place(AutonomousVehicle::at(start));
    let fleet = s.place(EnvironmentCars::scattered(&streets, 20, SEED).away_from(start.position, 80.0));
    assert_eq!(fleet.count(), 20, "those that would be too near start elsewhere");
}

#[test]
fn chance_is_the_seed_s() {
    let places = |build| {
        let seen = run(build).0;
        [0, 1000].map(|tick| seen[tick].iter().map(|body: &BodyState| body.pose).collect::<Vec<_>>())
    };
    let once = places(city::<1>);
    assert_eq!(once, places(city::<1>));
    assert_ne!(once[0], places(city::<2>)[0]);
}

#[test]
fn where_there_is_no_room_for_more_there_are_fewer() {
    let (seen, _) = run(|s| {
        let road = road(s);
        let crowd = EnvironmentCars::scattered(road.streets(), 1000, 1);
        let fleet = s.place(crowd.away_from(road.on_lane(-2, 290.0).position, 20.0));
        assert!((80..140).contains(&fleet.count()), "{} cars", fleet.count());
        s.duration(0.1);
        s.require("count", never(Stream::from(fleet.count() as f64).named("count").below(1.0)));
    });
    assert!((80..140).contains(&seen[0].len()));
}

#[test]
fn a_car_that_is_not_there_is_a_mistake_of_the_scenario() {
    let refusal = refusal(|s| {
        let road = road(s);
        let fleet = two(s, &road, |car| car);
        s.require("place", never(fleet.position(2).x().above(0.0)));
        s.require("speed", never(fleet.speed(3).above(0.0)));
        fleet.drive(4, 3.0);
        fleet.wish(5, 3.0);
        fleet.change_lane(6, Side::Left, 3.0, &Stream::from(true));
    });
    for car in 2..=6 {
        let expected =
            format!("traffic: car {car} does not exist: the number of cars is 2, and they are counted from 0");
        assert_eq!(refusal.matches(&expected).count(), 1, "{refusal}");
    }
}

#[test]
fn of_traffic_that_cannot_begin_it_is_said_why_and_nothing_else() {
    let refusal = refusal(|s| {
        let road = road(s);
        let fleet = two(s, &road, |car| car.speed(f64::NAN));
        fleet.drive(7, fleet.speed(7));
    });
    assert!(refusal.contains("car 0 has NaN as its speed") && !refusal.contains("no car 7"), "{refusal}");
}

#[test]
fn a_lane_change_takes_a_finite_time() {
    let refusal = refusal(|s| {
        let road = road(s);
        let fleet = two(s, &road, |car| car);
        for seconds in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            fleet.change_lane(1, Side::Right, seconds, &Stream::from(true));
        }
    });
    for seconds in ["0", "-1", "NaN", "inf"] {
        let expected = format!("traffic: the lane change of car 1 takes {seconds} s, expected a finite number above 0");
        assert!(refusal.contains(&expected), "{refusal}");
    }
}
