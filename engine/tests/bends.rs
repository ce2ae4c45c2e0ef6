//! Drivers on a bend: what is ahead is what is on the way, not what is straight ahead.

use nalgebra::Vector2;
use paracosm_engine::driver::find;
use paracosm_engine::object::{Class, Outline};
use paracosm_engine::vehicle::Vehicle;
use paracosm_engine::{Ahead, Briefing, Observation, Other, Pose, Way};

/// All drivers that brake for others.
const NAMES: [&str; 6] = ["aeb", "cc", "rss", "fsm", "reg157", "ideal"];
/// Speed in m/s of the ego vehicle.
const SPEED: f64 = 10.0;
/// Radius of the bend in metres, so wide that nobody brakes for the bend itself.
const RADIUS: f64 = 60.0;

/// A car on the circular way of the ego vehicle or beside it.
#[derive(Clone, Copy)]
struct OnCircle {
    /// Metres along the way ahead of the ego vehicle at the beginning.
    ahead: f64,
    /// Metres to the left of the way.
    left: f64,
    /// m/s along the way.
    speed: f64,
}

/// The pose of a point along a way that bends like this, as seen from its beginning.
fn on_way(curvature: f64, along: f64, left: f64) -> Pose {
    if curvature == 0.0 {
        return Pose { position: Vector2::new(along, left), heading: 0.0 };
    }
    let (sin, cos) = libm::sincos(along * curvature);
    let radius = 1.0 / curvature;
    let position = Vector2::new((radius - left) * sin, radius - (radius - left) * cos);
    Pose { position, heading: along * curvature }
}

/// When the driver first brakes, if the car goes on along the way at constant speed whatever it does.
fn brakes_at(name: &str, curvature: f64, other: OnCircle) -> Option<f64> {
    // What comes of the noise of a sensor is no matter of bends.
    let exact = if name == "aeb" { vec![("noise".to_owned(), 0.0)] } else { vec![] };
    let mut driver = find(name).unwrap().build(&exact).unwrap();
    driver.reset(&Briefing { cruise_speed: SPEED, vehicle: Vehicle::BMW_320I, navigation: None }).unwrap();
    let period = driver.period();
    (0..(4.0 / period).round() as usize).map(|i| i as f64 * period).find(|time| {
        let travelled = SPEED * time;
        let place = on_way(curvature, other.ahead + other.speed * time - travelled, other.left);
        let velocity = place.forward() * other.speed * (1.0 - curvature * other.left);
        let body = Other {
            id: 0,
            class: Class::Car,
            position: place.position,
            velocity,
            heading: place.heading,
            outline: Outline::Rectangle { length: 4.5, width: 1.8 },
        };
        let ahead = std::array::from_fn(|i| Ahead {
            position: on_way(curvature, Way::SPACING * (i + 1) as f64, 0.0).position,
            curvature,
        });
        let observation = Observation {
            time: *time,
            speed: SPEED,
            travelled,
            odometry: on_way(curvature, travelled, 0.0),
            way: Way { ahead, ..Way::default() },
            others: vec![body],
        };
        driver.step(&observation).unwrap().throttle < 0.0
    })
}

#[test]
fn whoever_brakes_for_a_standing_car_on_a_straight_way_brakes_for_it_in_time_on_a_bend() {
    let standing = OnCircle { ahead: 45.0, left: 0.0, speed: 0.0 };
    for name in NAMES {
        let straight = brakes_at(name, 0.0, standing).unwrap();
        for curvature in [1.0 / RADIUS, -1.0 / RADIUS] {
            let bend = brakes_at(name, curvature, standing);
            assert!(
                bend.is_some_and(|bend| (bend - straight).abs() < 0.25),
                "{name}: {bend:?}, straight on {straight}"
            );
        }
    }
}

#[test]
fn nobody_brakes_on_a_bend_for_a_car_that_comes_in_the_lane_beside() {
    let oncoming = OnCircle { ahead: 40.0, left: 3.5, speed: -SPEED };
    for name in NAMES {
        for curvature in [0.0, 1.0 / RADIUS, -1.0 / RADIUS] {
            assert_eq!(brakes_at(name, curvature, oncoming), None, "{name}, curvature {curvature}");
        }
    }
}

#[test]
fn nobody_brakes_on_a_bend_for_what_stands_straight_ahead_beside_the_road() {
    let beside = OnCircle { ahead: 38.0, left: 4.0, speed: 0.0 };
    for name in NAMES {
        assert_eq!(brakes_at(name, -1.0 / RADIUS, beside), None, "{name}");
    }
}
