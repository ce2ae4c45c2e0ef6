//! Animates walking people: their limbs swing with the distance they have walked, and farther at higher speed.
//!
//! A leg swings about the hip as a sine of the distance. The knee bends while the leg comes forward, and the arms swing
//! against the legs. The hips are as high as the lower of the two soles requires. A walk is therefore a function of the
//! state of the run.

use super::{CHILD, Figure, variety};
use crate::Look;
use crate::mesh::models::Models;
use crate::mesh::person::{HIP, SHIN, SHOULDER, SIZE, SOLE, THIGH};
use crate::scene::Instance;
use nalgebra::{Isometry3, Vector3};
use std::f32::consts::{PI, TAU};

/// The greatest swing of a leg in a walk, in radians from the middle, and the additional swing in a run.
const SWING: f32 = 0.45;
const RUN: f32 = 0.25;
/// Speeds in m/s of a person of 1.8 m: a brisk walking pace, and the range over which walking turns into running.
const PACE: f32 = 1.4;
const RUNS: [f32; 2] = [2.0, 4.5];
/// The length of two steps as a share of the height: at a brisk pace the soles do not slide.
const STRIDE: f32 = 0.89;
/// The bend of the knee and the swing of the arm, relative to the swing of the leg.
const KNEE: f32 = 2.0;
const ARM: f32 = 0.8;
/// A person slower than this faces the heading of the pose, a faster one the direction of motion, in m/s.
const STANDS: f64 = 0.05;

/// The angles of a leg: the forward swing, and the bend of the knee, in radians.
#[derive(Debug, Clone, Copy)]
struct Leg {
    hip: f32,
    knee: f32,
}

/// Adds the parts of a person to the scene.
pub(super) fn walker(figure: &Figure<'_>, models: &Models, scene: &mut Vec<Instance>) {
    let velocity = figure.state.velocity;
    let speed = velocity.norm();
    let mut figure = Figure { ..*figure };
    if speed > STANDS {
        let heading = libm::atan2(velocity.y, velocity.x) as f32;
        figure.pose.rotation = nalgebra::UnitQuaternion::from_axis_angle(&Vector3::z_axis(), heading);
    }
    let height = figure.size[2];
    let [x, y, z] = [0, 1, 2].map(|axis| figure.size[axis] / SIZE[axis]);
    let swing = swing(speed as f32 * SIZE[2] / height);
    // In 64 bits, because the distance may be long.
    let steps = figure.state.travelled / f64::from(STRIDE * height);
    let phase = TAU * (steps - steps.floor()) as f32;
    let legs = [phase, phase + PI].map(|phase| leg(phase, swing));
    let hips = legs.iter().map(|leg| leg.reach(x, z)).fold(0.0, f32::max);
    let lift = hips - HIP[1] * z;
    let child = height < CHILD;
    let person = match figure.look {
        Look::Flat => models.usual[usize::from(child)].clone(),
        Look::Textured => models.person(variety::lot(figure.id, variety::KIND), child),
    };
    scene.push(figure.part(&person.trunk, Isometry3::translation(0.0, 0.0, lift), [x, y, z]));
    for ((side, leg), arm) in [1.0, -1.0].into_iter().zip(legs).zip(&person.arms) {
        let shoulder = Vector3::new(0.0, side * SHOULDER[0] * y, SHOULDER[1] * z + lift);
        scene.push(figure.part(arm, forward(shoulder, -ARM * leg.hip), [x, y, z]));
        let hip = forward(Vector3::new(0.0, side * HIP[0] * y, hips), leg.hip);
        scene.push(figure.part(&person.thigh, hip, [x, y, z]));
        let knee = hip * forward(Vector3::z() * (-THIGH * z), -leg.knee);
        scene.push(figure.part(&person.shin, knee, [x, y, z]));
    }
}

/// Returns the angle by which the legs of a person of 1.8 m swing at a speed in m/s.
fn swing(speed: f32) -> f32 {
    let run = (speed - RUNS[0]) / (RUNS[1] - RUNS[0]);
    SWING * (speed / PACE).min(1.0) + RUN * run.clamp(0.0, 1.0)
}

fn leg(phase: f32, swing: f32) -> Leg {
    let (sin, cos) = libm::sincosf(phase);
    Leg { hip: swing * sin, knee: KNEE * swing * cos.max(0.0) }
}

/// Returns the pose of a joint whose limb swings forward by an angle.
fn forward(joint: Vector3<f32>, angle: f32) -> Isometry3<f32> {
    Isometry3::new(joint, Vector3::y() * -angle)
}

impl Leg {
    /// Returns the vertical distance from the hip to the lowest point of the leg, for a person scaled by `x` and `z`.
    fn reach(&self, x: f32, z: f32) -> f32 {
        let (thigh, (sin, cos)) = (libm::cosf(self.hip), libm::sincosf(self.hip - self.knee));
        let sole = SOLE.map(|along| SHIN * z * cos - along * x * sin);
        THIGH * z * thigh + sole[0].max(sole[1])
    }
}
