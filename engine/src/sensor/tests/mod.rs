//! Sensors against what can be computed by hand, by brute force or by another library.

mod depth;
mod lidar;
mod noise;
mod radar;
mod rig;
mod truth;

use super::{Air, SensorError, SensorView};
use crate::object::{Body, BodyState, Class};
use crate::road::{RoadNetwork, RoadSegment};
use crate::vehicle::VehicleState;
use crate::weather::Weather;
use nalgebra::Vector2;
use paracosm_road::Pose;
use proptest::prelude::*;
use std::sync::Arc;

/// A car and what is around it.
struct World {
    car: VehicleState,
    bodies: Vec<BodyState>,
    network: Arc<RoadNetwork>,
    extinction: f64,
}

impl World {
    /// A car that stands here, and nothing else.
    fn of(pose: Pose) -> Self {
        let car = VehicleState {
            position: pose.position,
            heading: pose.heading,
            velocity: Vector2::zeros(),
            yaw_rate: 0.0,
            steering_angle: 0.0,
            acceleration: Vector2::zeros(),
            travelled: 0.0,
        };
        let network = RoadSegment::new(100.0).build().unwrap();
        Self { car, bodies: vec![BodyState::at_rest(Body::car(), pose)], network, extinction: 0.0 }
    }

    /// With a body that moves so over the ground.
    fn with(mut self, body: Body, pose: Pose, velocity: Vector2<f64>) -> Self {
        self.bodies.push(BodyState { velocity, ..BodyState::at_rest(body, pose) });
        self
    }

    fn view(&self, time: f64) -> SensorView<'_> {
        let air = Air { extinction: self.extinction, ..Air::default() };
        let weather = Weather::default();
        let bodies = &self.bodies;
        SensorView { time, car: &self.car, bodies, before: bodies, dt: 0.01, network: &self.network, weather, air }
    }
}

fn pose(x: f64, y: f64, heading: f64) -> Pose {
    Pose { position: Vector2::new(x, y), heading }
}

fn poses(within: f64) -> impl Strategy<Value = Pose> {
    (-within..within, -within..within, -3.2..3.2).prop_map(|(x, y, heading)| pose(x, y, heading))
}

fn bodies() -> impl Strategy<Value = Body> {
    prop_oneof![
        (0.2..40.0, 0.2..20.0, 0.1..15.0).prop_map(|(l, w, h)| Body::block(Class::Building, l, w, h)),
        (1.0..6.0, 0.5..2.5, 0.5..3.0).prop_map(|(l, w, h)| Body::block(Class::Car, l, w, h)),
        (0.05..3.0, 0.1..10.0).prop_map(|(r, h)| Body::disc(Class::Tree, r, h)),
    ]
}

/// The message of what must not be built.
fn refusal<S>(built: Result<S, SensorError>) -> String {
    built.err().expect("a sensor that cannot be").to_string()
}

/// Holds a mean against what is expected, within five of its standard deviations.
fn check_mean(what: &str, numbers: &[f64], expected: f64, deviation: f64) {
    let n = numbers.len() as f64;
    let mean = numbers.iter().sum::<f64>() / n;
    let most = 5.0 * deviation / n.sqrt();
    assert!((mean - expected).abs() < most, "{what}: mean {mean}, expected {expected} within {most}");
}

/// Holds mean and standard deviation of normal numbers against what is expected, within five of theirs.
fn check_normal(what: &str, numbers: &[f64], mean: f64, deviation: f64) {
    check_mean(what, numbers, mean, deviation);
    let squares: Vec<f64> = numbers.iter().map(|x| (x - mean) * (x - mean)).collect();
    let variance = deviation * deviation;
    check_mean(&format!("{what}, squared"), &squares, variance, variance * 2_f64.sqrt());
}
