use super::super::find;
use super::*;
use crate::outcome::{Ending, Outcome};
use crate::program::Program;
use crate::road::{CrossIntersection, RoadNetwork, RoadSegment, Roundabout, TIntersection};
use crate::run::simulate;
use crate::scenario::Scenario;
use crate::traffic::TrafficCar;
use crate::vehicle::{Vehicle, VehicleModel};
use crate::{
    AutonomousVehicle, EnvironmentCars, Monitor, Mover, Pedestrian, Side, Stream, object::Class, object::Outline,
};
use nalgebra::Vector2;
use paracosm_space::Values;
use std::sync::Arc;

/// Lets the driver drive a world, with some settings changed.
fn driven(changes: &[(&str, f64)], build: impl Fn(&mut Scenario) + Send + Sync + 'static) -> Outcome {
    let changes: Vec<_> = changes.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
    let mut driver = find("planner").unwrap().build(&changes).unwrap();
    let program = Program::of("planned", "a world for the planner", build);
    simulate(&program, &Values::default(), VehicleModel::SingleTrack, driver.as_mut())
}

fn signal(outcome: &Outcome, name: &str) -> Vec<f64> {
    outcome.trace.as_ref().unwrap().signal(name).unwrap_or_else(|| panic!("no `{name}`")).collect()
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// A junction of four roads, on which the car comes from the west and goes straight on.
fn crossroads() -> Arc<RoadNetwork> {
    let arm = |name: &str| RoadSegment::new(150.0).named(name);
    CrossIntersection::new()
        .connect("one", arm("east"), "one")
        .connect("two", arm("south"), "one")
        .connect("three", arm("west"), "one")
        .connect("four", arm("north"), "one")
        .build()
        .unwrap()
}

/// The car and another car come to the crossroads. The other comes from a distance in metres, goes straight on at a
/// speed in m/s, heedless of the car, and stops after some seconds.
fn meeting(
    (from, to): (&'static str, &'static str),
    distance: f64,
    speed: f64,
    until: f64,
) -> impl Fn(&mut Scenario) + Send + Sync {
    move |s| {
        let network = crossroads();
        let streets = s.place(network.clone());
        let car = s.place(AutonomousVehicle::along(streets.way(("west", -1, 60.0), ("east", 1, 120.0))).speed(10.0));
        let [start, end] =
            [(from, -1, distance), (to, 1, 140.0)].map(|(road, lane, at)| streets.place_on(road, lane, at).unwrap());
        let other = TrafficCar::following(&network.route(start, end, 0.0).unwrap()).heedless();
        s.place(EnvironmentCars::on(&streets, vec![other]))
            .drive(0, Stream::time().below(until).map(move |goes| if goes { speed } else { 0.0 }));
        s.duration(45.0);
        s.monitor(Monitor::no_collision(&car));
        s.monitor(Monitor::right_of_way(&car, 1.0));
        s.monitor(Monitor::progress(&car, 100.0));
    }
}

#[test]
fn it_lets_a_car_from_the_right_go_first_at_a_crossing() {
    for distance in [40.0, 55.0, 70.0] {
        let outcome = driven(&[], meeting(("south", "north"), distance, 8.0, 60.0));
        assert_eq!(outcome.ending, Ending::Pass, "{distance}: {:?}", outcome.judgements);
        assert!(least(&signal(&outcome, "car.speed")) < 8.0, "{distance}: it does not slow down");
    }
}

#[test]
fn it_does_not_wait_for_a_car_from_the_left_that_can_still_stop_nor_for_one_far_away_at_the_right() {
    for (from, to, distance) in [("north", "south", 60.0), ("south", "north", 140.0)] {
        let outcome = driven(&[], meeting((from, to), distance, 8.0, 3.0));
        assert_eq!(outcome.ending, Ending::Pass, "{from}: {:?}", outcome.judgements);
        assert!(least(&signal(&outcome, "car.speed")) > 6.0, "{from}: it waits");
    }
}

#[test]
fn it_waits_for_its_patience_and_then_inches_forward_before_a_car_that_stands_at_its_right() {
    for patience in [2.0, 6.0] {
        let outcome = driven(&[("patience", patience)], meeting(("south", "north"), 5.0, 0.0, 60.0));
        assert_eq!(outcome.ending, Ending::Pass, "{:?}", outcome.judgements);
        let speeds = signal(&outcome, "car.speed");
        let standing = speeds.iter().filter(|speed| **speed < 0.3).count() as f64 * outcome.trace.unwrap().dt();
        // It needs several attempts, each after its patience.
        assert!((patience..5.0 * patience.max(3.0)).contains(&standing), "{standing} s, patience {patience} s");
    }
}

#[test]
fn it_stays_before_a_junction_while_there_is_no_room_behind() {
    let outcome = driven(&[], |s| {
        let streets = s.place(crossroads());
        let car = s.place(AutonomousVehicle::along(streets.way(("west", -1, 60.0), ("east", 1, 120.0))).speed(10.0));
        s.place(Mover::car(streets.way(("east", 1, 4.0), ("east", 1, 120.0))).speed(0.0));
        s.duration(20.0);
        s.monitor(Monitor::no_collision(&car));
        s.require("stands", crate::always(car.travelled().at_most(62.0))).unit("m");
    });
    assert_eq!(outcome.ending, Ending::Pass, "{:?}", outcome.judgements);
    assert!(*signal(&outcome, "car.travelled").last().unwrap() > 50.0);
}

#[test]
fn it_enters_a_roundabout_behind_a_car_and_before_one_that_comes_late() {
    for (distance, speed, waits) in [(70.0, 7.0, true), (10.0, 3.0, false)] {
        let outcome = driven(&[], move |s| {
            let arm = |name: &str| RoadSegment::new(120.0).named(name);
            let ring = Roundabout::new()
                .connect("one", arm("east"), "one")
                .connect("two", arm("south"), "one")
                .connect("three", arm("west"), "one")
                .connect("four", arm("north"), "one")
                .build()
                .unwrap();
            let streets = s.place(ring.clone());
            let car =
                s.place(AutonomousVehicle::along(streets.way(("south", -1, 60.0), ("north", 1, 80.0))).speed(8.0));
            let [from, to] = [("west", -1, 110.0), ("north", 1, 110.0)]
                .map(|(road, lane, at)| streets.place_on(road, lane, at).unwrap());
            let route = ring.rest_of(&ring.route(from, to, 0.0).unwrap(), distance);
            s.place(EnvironmentCars::on(&streets, vec![TrafficCar::following(&route)])).drive(0, speed);
            s.duration(45.0);
            s.monitor(Monitor::no_collision(&car));
            s.monitor(Monitor::right_of_way(&car, 0.5));
            s.monitor(Monitor::route_completion(&car, 60.0));
        });
        assert_eq!(outcome.ending, Ending::Pass, "{distance}: {:?}", outcome.judgements);
        assert_eq!(least(&signal(&outcome, "car.speed")) < 1.0, waits, "{distance}");
    }
}

#[test]
fn behind_a_leader_it_keeps_the_gap_of_the_intelligent_driver_model() {
    for headway in [1.0, 2.0] {
        let outcome = driven(&[("headway", headway)], |s| {
            let road = s.place(RoadSegment::new(2000.0));
            let car = s.place(AutonomousVehicle::along(road.path(1)).starting(10.0).speed(15.0));
            s.place(Mover::car(road.path(1)).starting(60.0).speed(10.0));
            s.duration(60.0);
            s.monitor(Monitor::no_collision(&car));
        });
        let expected = (2.0 + 10.0 * headway) / (1.0 - libm::pow(10.0 / 15.0, 4.0)).sqrt();
        let gap = *signal(&outcome, "car.clearance").last().unwrap();
        assert!((gap - expected).abs() < 0.2, "{gap} m, expected {expected} m");
    }
}

#[test]
fn it_stops_for_a_walker_who_comes_into_its_way() {
    let outcome = driven(&[], |s| {
        let road = s.place(RoadSegment::new(300.0));
        let car = s.place(AutonomousVehicle::along(road.path(1)).starting(10.0).speed(12.0));
        let walker = s.place(Pedestrian::at(road.on_sidewalk(Side::Left, 70.0)));
        walker.walk(road.on_sidewalk(Side::Right, 70.0), 1.2);
        s.duration(20.0);
        s.monitor(Monitor::clearance(&car, 1.0));
        s.monitor(Monitor::progress(&car, 100.0));
    });
    assert_eq!(outcome.ending, Ending::Pass, "{:?}", outcome.judgements);
}

/// The driver's throttle for a body at a place with a velocity, at 15 m/s on a straight road, without a map.
fn throttle(position: [f64; 2], velocity: [f64; 2]) -> f64 {
    let mut driver = find("planner").unwrap().build(&[]).unwrap();
    driver.reset(&Briefing { cruise_speed: 15.0, vehicle: Vehicle::BMW_320I, navigation: None }).unwrap();
    let body = Other {
        id: 0,
        class: Class::Pedestrian,
        position: Vector2::from(position),
        velocity: Vector2::from(velocity),
        heading: 0.0,
        outline: Outline::Disc { radius: 0.25 },
    };
    let mut way = Way::default();
    for (i, point) in way.ahead.iter_mut().enumerate() {
        point.position.x = Way::SPACING * (i + 1) as f64;
    }
    driver.step(&Observation { speed: 15.0, others: vec![body], way, ..Observation::default() }).unwrap().throttle
}

#[test]
fn it_brakes_for_those_who_will_be_in_its_way_when_it_comes_and_for_no_others() {
    assert!(throttle([40.0, 0.0], [0.0, 0.0]) < -0.1);
    assert!(throttle([40.0, 4.0], [0.0, -1.5]) < -0.1);
    // Beside the road; behind; gone by when the car comes; coming when the car has passed.
    for (position, velocity) in
        [([40.0, 3.0], [0.0, 0.0]), ([-5.0, 0.0], [0.0, 0.0]), ([60.0, 2.0], [0.0, -3.0]), ([8.0, 6.0], [0.0, -2.0])]
    {
        assert_eq!(throttle(position, velocity), 0.0, "{position:?} {velocity:?}");
    }
}

#[test]
fn it_goes_on_if_it_can_no_longer_stop_and_passes_just_before() {
    // The way to a stop takes 12.5 m. The walker steps into the way when the car has just passed.
    let passes = 8.0 + 2.0 * 0.5 * Vehicle::BMW_320I.length;
    assert_eq!(throttle([8.0, 3.2], [0.0, -2.19 / (passes / 15.0)]), 0.0);
    assert_eq!(throttle([8.0, 3.2], [0.0, -4.0 / (passes / 15.0)]), -9.0 / Vehicle::BMW_320I.max_acceleration);
}

#[test]
fn it_takes_the_bend_of_a_junction_at_its_comfortable_lateral_acceleration() {
    for lateral in [1.0, 2.0] {
        let outcome = driven(&[("lateral", lateral)], |s| {
            let arm = |name: &str| RoadSegment::new(80.0).named(name);
            let tee = TIntersection::new().connect("one", arm("end"), "one").connect("two", arm("aside"), "one");
            let streets = s.place(tee.connect("three", arm("start"), "one").build().unwrap());
            let way = streets.way(("start", -1, 70.0), ("aside", 1, 70.0));
            let car = s.place(AutonomousVehicle::along(way).speed(12.0));
            s.duration(25.0);
            s.monitor(Monitor::new("lateral", crate::never(car.lateral_acceleration().above(9.0)), "m/s²", 1.0));
            s.monitor(Monitor::progress(&car, 120.0));
        });
        assert_eq!(outcome.ending, Ending::Pass, "{:?}", outcome.judgements);
        let most = signal(&outcome, "car.lateral_acceleration").iter().fold(0.0, |most: f64, a| most.max(a.abs()));
        assert!((0.5 * lateral..1.8 * lateral).contains(&most), "{most} m/s², comfortable {lateral} m/s²");
    }
}
