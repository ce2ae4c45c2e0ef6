//! The roads and the bodies of a run as a scene of Foxglove, with the frames of the bodies.

use super::WORLD;
use super::recorder::{Recorder, Scene};
use super::tape::Tape;
use crate::birds_eye::ground::colour;
use foxglove::messages::{
    Color, CubePrimitive, CylinderPrimitive, FrameTransform, FrameTransforms, KeyValuePair, Point3, Quaternion,
    SceneEntity, SceneEntityDeletion, SceneUpdate, Timestamp, TriangleListPrimitive, Vector3, scene_entity_deletion,
};
use nalgebra::{Isometry3, Translation3, UnitQuaternion};
use paracosm_campaign::Error;
use paracosm_engine::Pose;
use paracosm_engine::object::{Body, Outline};
use paracosm_engine::road::{Bounds, RoadNetwork, Surface};
use std::io::{Seek, Write};

/// The topics of the frames, the roads and the bodies.
const FRAMES: &str = "/tf";
const ROADS: &str = "/roads";
const BODIES: &str = "/bodies";

/// The distance in metres around the way of the ego vehicle within which roads are shown.
const AROUND: f64 = 200.0;
/// The accuracy in metres of the edges of roads.
const FAITHFUL: f64 = 0.1;
/// The thickness in metres of all surfaces of the roads together: a later surface lies above an earlier surface.
const THICKNESS: f64 = 0.05;
/// The colour of a body that the ego vehicle touches, in sRGB.
const TOUCHED: [u8; 3] = [215, 40, 40];

/// Adds the messages of the scene.
pub(super) fn tell<W: Write + Seek>(recorder: &Recorder, tape: &mut Tape<W>) -> Result<(), Error> {
    let (Some(scene), Some(first)) = (&recorder.scene, recorder.moments.first()) else { return Ok(()) };
    let (frames, roads, bodies) = (
        tape.topic::<FrameTransforms>(FRAMES, &[])?,
        tape.topic::<SceneUpdate>(ROADS, &[])?,
        tape.topic::<SceneUpdate>(BODIES, &[])?,
    );
    let mut bounds = Bounds::empty();
    let ego = recorder.moments.iter().filter_map(|moment| moment.bodies.first().copied().flatten());
    ego.for_each(|(pose, _)| bounds.include(pose.position));
    tape.say(roads, first.time, &ground(&scene.network, &bounds.grown(AROUND), first.time));

    let mut there = vec![None; scene.bodies.len()];
    let last = recorder.moments.len() - 1;
    for (number, moment) in recorder.moments.iter().enumerate() {
        let time = stamp(moment.time);
        let moved = moment.bodies.iter().enumerate().filter_map(|(body, state)| {
            let (pose, altitude) = (*state)?;
            // A body that rests needs no second message.
            let is_moved = there[body] != Some((pose, altitude));
            is_moved.then(|| frame(time, WORLD, &scene.bodies[body].0, &placed(&pose, altitude)))
        });
        let transforms: Vec<_> = moved.collect();
        if !transforms.is_empty() {
            tape.say(frames, moment.time, &FrameTransforms { transforms });
        }
        let mut update = SceneUpdate::default();
        for (body, state) in moment.bodies.iter().enumerate() {
            let is_touched = number == last && recorder.touched == Some(body);
            match (there[body], state) {
                (None, Some(_)) => update.entities.push(entity(scene, body, is_touched, moment.time)),
                (Some(_), Some(_)) if is_touched => update.entities.push(entity(scene, body, true, moment.time)),
                (Some(_), None) => update.deletions.push(SceneEntityDeletion {
                    timestamp: time,
                    r#type: scene_entity_deletion::Type::MatchingId.into(),
                    id: scene.bodies[body].0.clone(),
                }),
                (None, None) | (Some(_), Some(_)) => {}
            }
        }
        if !(update.entities.is_empty() && update.deletions.is_empty()) {
            tape.say(bodies, moment.time, &update);
        }
        there.clone_from(&moment.bodies);
    }
    Ok(())
}

/// Returns a time in the form of messages.
pub(super) fn stamp(seconds: f64) -> Option<Timestamp> {
    Some(Timestamp::saturating_from_epoch_secs_f64(seconds))
}

/// Returns the frame of a thing in the frame of another thing.
pub(super) fn frame(time: Option<Timestamp>, parent: &str, child: &str, at: &Isometry3<f64>) -> FrameTransform {
    let (place, turn) = (at.translation, at.rotation);
    FrameTransform {
        timestamp: time,
        parent_frame_id: parent.to_owned(),
        child_frame_id: child.to_owned(),
        translation: Some(Vector3 { x: place.x, y: place.y, z: place.z }),
        rotation: Some(Quaternion { x: turn.i, y: turn.j, z: turn.k, w: turn.w }),
    }
}

/// Returns the frame of an upright body: its origin is the middle of the body at its lowest point, and x is ahead.
pub(super) fn placed(pose: &Pose, altitude: f64) -> Isometry3<f64> {
    let turn = UnitQuaternion::from_euler_angles(0.0, 0.0, pose.heading);
    Isometry3::from_parts(Translation3::new(pose.position.x, pose.position.y, altitude), turn)
}

/// Returns a body in its own frame, which moves it.
fn entity(scene: &Scene, body: usize, is_touched: bool, time: f64) -> SceneEntity {
    let (name, Body { class, outline, height, colour }) = &scene.bodies[body];
    let half = outline.half_extent();
    let middle = pose(0.5 * height);
    let size = Some(Vector3 { x: 2.0 * half.x, y: 2.0 * half.y, z: *height });
    let color = Some(paint(if is_touched { TOUCHED } else { *colour }, 1.0));
    let (cubes, cylinders) = match outline {
        Outline::Rectangle { .. } => (vec![CubePrimitive { pose: middle, size, color }], Vec::new()),
        Outline::Disc { .. } => {
            let cylinder = CylinderPrimitive { pose: middle, size, bottom_scale: 1.0, top_scale: 1.0, color };
            (Vec::new(), vec![cylinder])
        }
    };
    let class = KeyValuePair { key: "class".to_owned(), value: class.to_string() };
    SceneEntity {
        timestamp: stamp(time),
        frame_id: name.clone(),
        id: name.clone(),
        frame_locked: true,
        metadata: vec![class],
        cubes,
        cylinders,
        ..SceneEntity::default()
    }
}

/// Returns a pose at this height above the origin of a frame.
fn pose(height: f64) -> Option<foxglove::messages::Pose> {
    let position = Some(Vector3 { x: 0.0, y: 0.0, z: height });
    Some(foxglove::messages::Pose { position, orientation: Some(Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 }) })
}

fn paint([red, green, blue]: [u8; 3], alpha: f64) -> Color {
    let [r, g, b] = [red, green, blue].map(|part| f64::from(part) / 255.0);
    Color { r, g, b, a: alpha }
}

/// Returns the surfaces of the roads within some bounds, each as triangles of one colour.
fn ground(network: &RoadNetwork, bounds: &Bounds, time: f64) -> SceneUpdate {
    let mut surfaces: Vec<(Surface, Vec<Point3>, Vec<u32>)> = Vec::new();
    for strip in network.strips() {
        for part in strip.solid_parts() {
            let aside = part.left.abs().max(part.right.abs());
            if !part.curve.bounds().grown(aside).meets(bounds) {
                continue;
            }
            if surfaces.last().is_none_or(|(surface, ..)| *surface != part.surface) {
                surfaces.push((part.surface, Vec::new(), Vec::new()));
            }
            let Some((_, points, indices)) = surfaces.last_mut() else { continue };
            let (right, left) = part.sides(FAITHFUL);
            let first = points.len() as u32;
            let both = right.iter().zip(&left).flat_map(|(right, left)| [right, left]);
            points.extend(both.map(|point| Point3 { x: point.x, y: point.y, z: 0.0 }));
            // Each piece between two pairs of points is two triangles, counter-clockwise from above.
            let pieces = (0..right.len().saturating_sub(1) as u32).map(|piece| first + 2 * piece);
            indices.extend(pieces.flat_map(|at| [at, at + 2, at + 1, at + 1, at + 2, at + 3]));
        }
    }
    let layers = surfaces.len().max(1) as f64;
    let triangles = surfaces.into_iter().enumerate().map(|(layer, (surface, points, indices))| {
        let height = THICKNESS * ((layer + 1) as f64 / layers - 1.0);
        TriangleListPrimitive {
            pose: pose(height),
            points,
            color: Some(paint(colour(surface), 1.0)),
            colors: Vec::new(),
            indices,
        }
    });
    let entity = SceneEntity {
        timestamp: stamp(time),
        frame_id: WORLD.to_owned(),
        id: "roads".to_owned(),
        triangles: triangles.collect(),
        ..SceneEntity::default()
    };
    SceneUpdate { entities: vec![entity], deletions: Vec::new() }
}
