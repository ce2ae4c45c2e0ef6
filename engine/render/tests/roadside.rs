//! What stands beside a road, as a camera of the car sees it. UPDATE_GOLDEN=1 writes the images; look at what changed.

mod support;

use nalgebra::{Isometry3, Point3, Vector3};
use paracosm_engine::{AutonomousVehicle, Environment, Program, RoadSegment, Roadside, Run, Scenario, Setup};
use paracosm_render::{Camera, Frame, Semantic, Stage, View, WantedImages, boxes_in_space};
use paracosm_space::Values;
use support::golden::compare;
use support::{NOTHING, one, renderer};

const WIDTH: u32 = 320;
const HEIGHT: u32 = 160;

fn street(s: &mut Scenario) {
    let road = s.place(RoadSegment::new(200.0).zebra(40.0));
    s.place(AutonomousVehicle::at(road.on_lane(1, 20.0)).speed(10.0));
    let elevation = s.nominal("elevation", 0.0..=1.5, 0.9);
    let azimuth = s.nominal("azimuth", -3.0..=3.0, 2.3);
    let light = s.nominal("light", 0.0..=1.0, 1.0);
    s.place(Environment::new().light(light).sun(elevation, azimuth));
    s.place(Roadside::new(1.0));
}

/// The street with these values, from the car, and how many things are before it.
fn seen(values: &[(&str, f64)]) -> Option<(Frame, usize)> {
    let mut renderer = renderer()?;
    let program = Program::new("street", "a street with things beside it", street);
    let mut test: Values = program.declare().expect("a sound program").nominal();
    values.iter().for_each(|(name, value)| test.set(*name, *value));
    let run = Run::new(&program, &test, Setup::asking_every(0.1)).expect("a sound world");
    let scene = Stage::of(run.network()).scene(&run);
    let camera = Camera::new(WIDTH, HEIGHT, 24.0, 36.0).expect("a sound camera");
    let camera = camera.mounted(Point3::new(0.3, 0.0, 1.4), 0.0, 0.0, 0.0).expect("a sound place");
    let car = run.bodies()[0].pose;
    let pose = Isometry3::new(car.position.push(0.0), Vector3::z() * car.heading);
    let view = View { without: Some(1), ..View::new(&scene, &camera, pose) };
    let things = boxes_in_space(&scene, &camera, &pose).len();
    let wanted = WantedImages { rgb: true, semantic: true, instance: true, depth: true, shadows: true, ..NOTHING };
    Some((one(&mut renderer, &view, wanted), things))
}

#[test]
fn a_street_with_all_that_stands_beside_it() {
    let Some((frame, things)) = seen(&[]) else { return };
    compare("roadside", WIDTH, frame.rgb.as_deref().expect("asked for"));
    compare("roadside-classes", WIDTH, &frame.semantic_colours().expect("asked for"));
    assert!(things > 10, "{things} things");
    let mut ids = frame.instance.expect("asked for");
    ids.sort_unstable();
    ids.dedup();
    assert!(ids.len() > 8, "{ids:?} are seen one by one");
    let classes = frame.semantic.expect("asked for");
    for class in [Semantic::Vegetation, Semantic::Building, Semantic::RoadLine] {
        assert!(classes.iter().filter(|id| **id == class as u8).count() > 50, "{class:?}");
    }
}

#[test]
fn a_street_with_the_sun_low_at_the_side() {
    let Some((frame, _)) = seen(&[("elevation", 0.25), ("azimuth", 1.3)]) else { return };
    compare("roadside-low-sun", WIDTH, frame.rgb.as_deref().expect("asked for"));
}
