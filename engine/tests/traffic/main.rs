//! Traffic as scenarios use it: how cars follow, give way, change lanes and stop, and that they never touch nor get
//! stuck.

mod following;
mod grids;
mod junctions;
mod lanes;
mod obstacles;
mod orders;

use nalgebra::Vector2;
use paracosm_engine::object::Body;
use paracosm_engine::road::{
    Composite, CrossIntersection, Curve, LaneKind, RoadNetwork, RoadSegment, Roundabout, Route, RoutePosition,
    SpeedLimit, Survey, SurveyedLane, SurveyedRoad, TIntersection, grid_city,
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
fn road(length: f64) -> Arc<RoadNetwork> {
    RoadSegment::new(length).lanes(4).named("road").build().unwrap()
}

fn place(net: &RoadNetwork, element: &str, lane: i32, s: f64) -> RoutePosition {
    RoutePosition { lane: net.lane_of(element, lane).unwrap(), s }
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

fn scattered(
    net: &Arc<RoadNetwork>,
    count: usize,
    seed: u64,
    with: impl Fn(usize, TrafficCar) -> TrafficCar,
) -> Traffic {
    let cars: Vec<_> =
        TrafficCar::scattered(net, count, seed).into_iter().enumerate().map(|(i, c)| with(i, c)).collect();
    assert_eq!(cars.len(), count);
    Traffic::new(net.clone(), cars, seed).unwrap()
}

/// A roundabout whose arms are connected in pairs by roads around three bends.
fn cloverleaf(lanes: i32) -> Arc<RoadNetwork> {
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

/// Something that stands across lane 1 of the road.
fn standing(x: f64, y: f64) -> Obstacle {
    let pose = Pose { position: Vector2::new(x, y), heading: FRAC_PI_2 };
    Obstacle { pose, length: 0.6, width: 0.5, velocity: Vector2::zeros() }
}

/// Three arms of 100 m: `east` and `west` of the main road, `south`, which ends at it.
fn tee() -> Arc<RoadNetwork> {
    let arm = |name: &str| RoadSegment::new(100.0).named(name);
    let net = TIntersection::new().named("tee").connect("one", arm("east"), "one").connect("two", arm("south"), "one");
    net.connect("three", arm("west"), "one").build().unwrap()
}

fn route(net: &RoadNetwork, from: RoutePosition, to: RoutePosition) -> Route {
    net.route(from, to, 20.0).expect("there is a way")
}
