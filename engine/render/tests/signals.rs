//! Brake lamps and direction indicators of vehicles in the look `textured`.

mod support;

use nalgebra::{Isometry3, Vector2};
use paracosm_engine::Pose;
use paracosm_engine::object::{Body, BodyState};
use paracosm_engine::road::RoadSegment;
use paracosm_engine::sensor::Moment;
use paracosm_render::{Cast, Frame, Look, Renderer, Stage, View, WantedImages};
use support::{NOTHING, camera, one, renderer};

/// The ego vehicle, and a vehicle 9 m ahead of it that does this.
fn moment(body: Body, velocity: [f64; 2], acceleration: f64, time: f64) -> Moment {
    let state = |body: Body, x: f64| BodyState {
        body,
        pose: Pose { position: [x, -1.75].into(), heading: 0.0 },
        velocity: Vector2::from(velocity),
        altitude: 0.0,
        travelled: 0.0,
        present: true,
    };
    let bodies = vec![state(Body::car(), 50.0), state(body, 61.0)];
    Moment { bodies, accelerations: vec![0.0, acceleration], time, ..Moment::default() }
}

fn seen(renderer: &mut Renderer, look: Look, moment: &Moment) -> Frame {
    let network = RoadSegment::new(200.0).build().expect("a sound road");
    let scene = Stage::in_look(&network, look).scene_at(&Cast::new(), moment);
    let camera = camera(320, 240);
    let wanted = WantedImages { rgb: true, instance: true, shadows: true, ..NOTHING };
    let view = View { without: Some(1), ..View::new(&scene, &camera, Isometry3::translation(50.0, -1.75, 0.0)) };
    one(renderer, &view, wanted)
}

/// The numbers of bright red and of bright amber pixels in the left half and the right half of an image.
fn lamps(frame: &Frame) -> [[usize; 2]; 2] {
    let rgb = frame.rgb.as_deref().expect("asked for");
    let count = |is_lamp: fn([u8; 3]) -> bool| {
        let mut halves = [0; 2];
        for (index, pixel) in rgb.chunks_exact(3).enumerate() {
            if is_lamp([pixel[0], pixel[1], pixel[2]]) {
                halves[usize::from(index % 320 >= 160)] += 1;
            }
        }
        halves
    };
    let red = |[r, g, b]: [u8; 3]| r > 240 && g < 130 && b < 120;
    let amber = |[r, g, b]: [u8; 3]| r > 240 && (150..230).contains(&g) && b < 90;
    [count(red), count(amber)]
}

#[test]
fn a_vehicle_that_brakes_has_bright_rear_lamps_and_one_that_coasts_has_none() {
    let Some(mut renderer) = renderer() else { return };
    for body in [Body::car(), Body::van(), Body::truck(), Body::bus()] {
        let mut red = |acceleration: f64| {
            lamps(&seen(&mut renderer, Look::Textured, &moment(body, [10.0, 0.0], acceleration, 0.0)))[0]
        };
        let (coasts, brakes) = (red(-0.5), red(-1.5));
        assert_eq!(coasts, [0, 0], "{:?}", body.class);
        assert!(brakes.iter().all(|pixels| *pixels > 8), "{:?}: {brakes:?}", body.class);
    }
}

#[test]
fn a_vehicle_that_changes_lanes_flashes_on_that_side_one_and_a_half_times_a_second() {
    let Some(mut renderer) = renderer() else { return };
    let mut amber = |across: f64, time: f64| {
        lamps(&seen(&mut renderer, Look::Textured, &moment(Body::car(), [10.0, across], 0.0, time)))[1]
    };
    let times = || (0..40).map(|tick| 0.05 * f64::from(tick));
    for (across, side) in [(0.8, 0), (-0.8, 1)] {
        let shown: Vec<[usize; 2]> = times().map(|time| amber(across, time)).collect();
        let is_lit: Vec<bool> = shown.iter().map(|pixels| pixels[side] > 4).collect();
        assert!(shown.iter().all(|pixels| pixels[1 - side] == 0), "{shown:?}");
        let flashes = is_lit.windows(2).filter(|pair| !pair[0] && pair[1]).count();
        assert!((2..=3).contains(&flashes), "{flashes} flashes in 2 s");
        let lit = is_lit.iter().filter(|is_lit| **is_lit).count();
        assert!((16..=24).contains(&lit), "lit in {lit} of 40 images");
    }
    assert!(times().all(|time| amber(0.1, time) == [0, 0]), "a vehicle that keeps its lane indicates nothing");
}

#[test]
fn the_look_flat_has_no_signals() {
    let Some(mut renderer) = renderer() else { return };
    let mut rgb = |acceleration: f64, across: f64, time: f64| {
        seen(&mut renderer, Look::Flat, &moment(Body::car(), [10.0, across], acceleration, time)).rgb
    };
    let plain = rgb(0.0, 0.0, 0.0);
    for tick in 0..7 {
        assert!(rgb(-8.0, 0.8, 0.1 * f64::from(tick)) == plain);
    }
}

#[test]
fn a_vehicle_that_turns_at_an_intersection_indicates_the_turn() {
    use paracosm_engine::road::{CrossIntersection, LaneKind};
    let Some(mut renderer) = renderer() else { return };
    let network = CrossIntersection::new().build().expect("a sound crossing");
    let stage = Stage::in_look(&network, Look::Textured);
    for (kind, expected) in
        [(LaneKind::Left, [true, false]), (LaneKind::Right, [false, true]), (LaneKind::Straight, [false; 2])]
    {
        let lane = network.lanes().iter().find(|lane| lane.kind == kind).expect("it has such lanes");
        let pose = lane.curve.at(0.5 * lane.length());
        let state = |pose: Pose| BodyState {
            body: Body::car(),
            pose,
            velocity: pose.forward() * 5.0,
            altitude: 0.0,
            travelled: 9.0,
            present: true,
        };
        let eye = Pose { position: pose.position - pose.forward() * 10.0, heading: pose.heading };
        let mut lit = [false; 2];
        for tick in 0..8 {
            let bodies = vec![state(eye), state(pose)];
            let moment =
                Moment { bodies, accelerations: vec![0.0; 2], time: 0.1 * f64::from(tick), ..Moment::default() };
            let scene = stage.scene_at(&Cast::new(), &moment);
            let camera = camera(320, 240);
            let carrier = Isometry3::new(eye.position.push(0.0), nalgebra::Vector3::z() * eye.heading);
            let view = View { without: Some(1), ..View::new(&scene, &camera, carrier) };
            let shown = lamps(&one(&mut renderer, &view, WantedImages { rgb: true, ..NOTHING }))[1];
            (0..2).for_each(|side| lit[side] |= shown[side] > 4);
        }
        assert_eq!(lit, expected, "{kind:?}");
    }
}
