//! What every kind of thing looks like, on one sheet: a person should know a car for a car. The example `gallery` draws
//! them larger and from all sides.

mod support;

use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use paracosm_engine::Pose;
use paracosm_engine::object::{Body, BodyState, Class};
use paracosm_engine::road::RoadSegment;
use paracosm_render::{Atmosphere, Camera, Stage, View, WantedImages};
use support::golden::compare;
use support::{NOTHING, renderer};

const WIDTH: usize = 160;
const HEIGHT: usize = 120;
const COLUMNS: usize = 3;

fn standing(body: Body, y: f64, speed: f64) -> BodyState {
    let pose = Pose { position: [100.0, y].into(), heading: 0.0 };
    BodyState { body, pose, velocity: [speed, 0.0].into(), altitude: 0.0, travelled: 0.3, present: true }
}

/// Things side by side, and from how far they are looked at.
fn sitters() -> [(Vec<BodyState>, f64); 12] {
    let disc = |class, width, height, y| standing(Body::disc(class, width, height), y, 0.0);
    let block =
        |class, [length, width, height]: [f64; 3], y| standing(Body::block(class, length, width, height), y, 0.0);
    [
        (vec![standing(Body::car().coloured([170, 30, 30]), 0.0, 0.0)], 7.0),
        (vec![standing(Body::truck(), 0.0, 0.0)], 15.0),
        (vec![standing(Body::van(), 0.0, 0.0)], 9.5),
        (vec![standing(Body::bus(), 0.0, 0.0)], 17.0),
        (vec![standing(Body::motorcycle().coloured([30, 60, 150]), 0.0, 0.0)], 4.2),
        (
            vec![
                standing(Body::bicycle().coloured([20, 120, 60]), 0.0, 4.0),
                standing(Body::parked_bicycle().coloured([150, 60, 20]), -1.0, 0.0),
            ],
            4.2,
        ),
        (vec![standing(Body::adult(), 0.0, 1.4), standing(Body::child(), 1.2, 0.0)], 4.0),
        (vec![block(Class::Building, [10.0, 8.0, 7.0], 0.0)], 22.0),
        (vec![block(Class::Building, [24.0, 14.0, 21.0], 0.0)], 55.0),
        (vec![disc(Class::Tree, 0.3, 6.0, -1.5), disc(Class::Tree, 0.3, 7.0, 4.0)], 16.0),
        (vec![disc(Class::Sign, 0.05, 2.5, 0.0), disc(Class::Sign, 0.05, 2.5, 1.2)], 6.0),
        (vec![disc(Class::Prop, 0.2, 0.7, 0.0), block(Class::Prop, [0.6, 0.8, 0.6], 1.4)], 4.0),
    ]
}

/// The pose of who stands at `eye` and looks at `target`.
fn looking(eye: Point3<f64>, target: Point3<f64>) -> Isometry3<f64> {
    let way = target - eye;
    let (yaw, pitch) = (libm::atan2(way.y, way.x), -libm::atan2(way.z, way.xy().norm()));
    Isometry3::from_parts(eye.into(), UnitQuaternion::from_euler_angles(0.0, pitch, yaw))
}

#[test]
fn every_kind_of_thing_looks_as_it_did() {
    let Some(mut renderer) = renderer() else { return };
    let network = RoadSegment::new(200.0).build().expect("a sound road");
    let stage = Stage::of(&network);
    let camera = Camera::new(WIDTH as u32, HEIGHT as u32, 50.0, 36.0).expect("a sound camera");
    let scenes = sitters().map(|(bodies, far)| {
        let middle = Point3::new(100.0, 0.0, 0.5 * bodies[0].body.height);
        let pose = looking(middle + Vector3::new(0.8, 0.6, 0.35) * far, middle);
        (stage.scene_of(bodies.iter().enumerate(), Atmosphere::default()), pose)
    });
    let views: Vec<_> = scenes.iter().map(|(scene, pose)| View::new(scene, &camera, *pose)).collect();
    let wanted = WantedImages { rgb: true, shadows: true, ..NOTHING };
    let frames = renderer.render(&views, wanted).expect("the adapter works");
    let images: Vec<_> =
        frames.into_iter().map(|frame| frame.expect("the view is sound").rgb.expect("asked for")).collect();
    let mut sheet = Vec::new();
    for row in images.chunks(COLUMNS) {
        for line in 0..HEIGHT {
            sheet.extend(row.iter().flat_map(|image| &image[3 * WIDTH * line..3 * WIDTH * (line + 1)]));
        }
    }
    compare("portraits", (COLUMNS * WIDTH) as u32, &sheet);
}
