use super::*;
use crate::sensor::{Chance, GroundTruth, GroundTruthSettings, Sensor, TrueBody};
use nalgebra::Vector3;
use std::f64::consts::FRAC_PI_2;

fn truth(world: &World) -> Vec<TrueBody> {
    let mut truth = Vec::new();
    let mut sensor = GroundTruth::new(GroundTruthSettings::default()).unwrap();
    sensor.sense(&world.view(0.0), &mut Chance::of(0, "truth", 0), &mut truth);
    truth
}

#[test]
fn the_truth_of_a_body_is_as_seen_from_the_car() {
    // The car points along y; a person walks towards it.
    let world =
        World::of(pose(10.0, 20.0, FRAC_PI_2)).with(Body::adult(), pose(8.0, 50.0, 0.0), Vector2::new(0.0, -1.5));
    let [body] = truth(&world)[..] else { panic!("one body") };
    assert_eq!((body.body, body.class, body.hidden), (1, Class::Pedestrian, false));
    assert!((body.position - Vector3::new(30.0, 2.0, 0.9)).norm() < 1e-9);
    assert_eq!(body.size, Vector3::new(0.5, 0.5, 1.8));
    assert!((body.velocity - Vector2::new(-1.5, 0.0)).norm() < 1e-9);
    assert!((body.heading + FRAC_PI_2).abs() < 1e-9);
    // From the corner of the car, at (2.25, 0.9).
    assert!((body.distance - (Vector2::<f64>::new(27.75, 1.1).norm() - 0.25)).abs() < 1e-9, "{}", body.distance);
}

#[test]
fn the_hidden_are_known_and_the_far_and_the_gone_are_not() {
    let mut world = World::of(pose(0.0, 0.0, 0.0))
        .with(Body::truck(), pose(20.0, 0.0, 0.0), Vector2::zeros())
        .with(Body::adult(), pose(40.0, 0.0, 0.0), Vector2::zeros())
        .with(Body::adult(), pose(40.0, 20.0, 0.0), Vector2::zeros())
        .with(Body::adult(), pose(300.0, 0.0, 0.0), Vector2::zeros())
        .with(Body::adult(), pose(0.0, 20.0, 0.0), Vector2::zeros());
    world.bodies[5].present = false;
    let known: Vec<_> = truth(&world).iter().map(|body| (body.body, body.hidden)).collect();
    assert_eq!(known, [(1, false), (2, true), (3, false)]);
}
