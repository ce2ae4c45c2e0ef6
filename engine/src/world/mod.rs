//! The bodies of a run and their contacts. This module calls rapier and parry for them.
//!
//! Bodies follow poses that the vehicle model and the programs compute in 64 bits. Rapier finds the contacts, and moves
//! [`Physical`](crate::object::Physical) bodies. Its pipeline takes longer than everything else in a tick
//! (docs/decisions/002-*). Therefore, if nothing is physical, it runs only if a body is within [`REACH`] of the car:
//! nothing is integrated then, so that a tick without it leaves no gap.

mod physical;

use crate::contact::Face;
use crate::object::{Body, BodyState, Outline, gap};
use nalgebra::Vector2;
use paracosm_road::Pose;
use parry3d::query::{ShapeCastOptions, cast_shapes};
use physical::Physics;
use rapier3d::prelude::{
    ActiveCollisionTypes, ColliderBuilder, ColliderHandle, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle, SharedShape,
};

/// The height above the road of the underside of bodies with wheels, in metres.
const FLOOR: f64 = 0.2;
/// The clearance in metres below which rapier looks for contacts. Bodies approach by at most about 0.3 m a tick (30 m/s
/// at 10 ms), and an overlap is noticed at the tick at which it exists.
const REACH: f64 = 0.05;
/// The distance in metres that counts as touching: the resolution of rapier's 32-bit numbers at some hundred metres.
pub(crate) const TOUCH: f64 = 1e-5;

/// A body in rapier.
#[derive(Debug, Clone)]
struct Solid {
    handle: RigidBodyHandle,
    collider: ColliderHandle,
    shape: SharedShape,
    /// The height of the shape's middle above the ground, in metres.
    middle: f64,
}

/// The ego vehicle and the other bodies. The ego vehicle is the first body.
pub(crate) struct World {
    physics: PhysicsWorld,
    solids: Vec<Solid>,
    /// The bodies that the physics moves, if there are any.
    pushed: Option<Physics>,
}

impl World {
    /// Makes a world of the given bodies. `masses` gives the indices and masses in kg of the physical bodies.
    pub fn new(bodies: &[BodyState], masses: &[(usize, f64)]) -> Self {
        let mut physics = PhysicsWorld::default();
        let solids: Vec<Solid> = bodies
            .iter()
            .enumerate()
            .map(|(index, state)| {
                let mass = masses.iter().find(|(at, _)| *at == index).map(|(_, mass)| *mass);
                insert(&mut physics, state, mass)
            })
            .collect();
        let pushed = (!masses.is_empty()).then(|| Physics::new(&mut physics, masses));
        Self { physics, solids, pushed }
    }

    /// Moves the physical bodies on by a tick of `dt` seconds, under the friction of the ground and the given forces.
    /// The other bodies have already moved.
    pub fn advance(&mut self, bodies: &mut [BodyState], pushes: &[Vector2<f64>], friction: f64, dt: f64) {
        if let Some(pushed) = &mut self.pushed {
            pushed.step(&mut self.physics, &self.solids, bodies, pushes, friction, dt);
        }
    }

    /// Returns the distance in metres between the ego vehicle and the nearest other body; infinite if no other body is
    /// present. If both touch or overlap, it returns [`TOUCH`], and the contact gives the details.
    pub fn clearance(&self, bodies: &[BodyState]) -> f64 {
        let Some((car, others)) = bodies.split_first() else { return f64::INFINITY };
        let square = |other: &BodyState| (car.pose.position - other.pose.position).norm_squared();
        let present = || others.iter().enumerate().filter(|(_, other)| other.present);
        let squares = present().map(|(index, other)| (square(other), index));
        // The body with the nearest middle comes first. Most other bodies are then too far away. This test needs no
        // square root.
        let Some((_, first)) = squares.reduce(|least, next| if next.0 < least.0 { next } else { least }) else {
            return f64::INFINITY;
        };
        let reach = car.body.outline.reach_at_most();
        let mut nearest = distance(car, &others[first]);
        for (index, other) in present() {
            let near = nearest + reach + other.body.outline.reach_at_most();
            if square(other) <= near * near && index != first {
                nearest = nearest.min(distance(car, other));
            }
        }
        nearest.max(TOUCH)
    }

    /// Returns the index of the first body that touches the ego vehicle at this tick. `clearance` is the [clearance](World::clearance)
    /// from all bodies.
    pub fn contact(&mut self, bodies: &[BodyState], clearance: f64) -> Option<usize> {
        if clearance > REACH {
            return None;
        }
        self.show(bodies);
        let car = self.solids.first()?;
        let touches = |(solid, state): (&Solid, &BodyState)| {
            let pair = self.physics.narrow_phase.contact_pair(car.collider, solid.collider);
            let deepest = pair.and_then(|pair| pair.find_deepest_contact());
            state.present && deepest.is_some_and(|(_, contact)| contact.dist <= 0.0)
        };
        self.solids[1..].iter().zip(&bodies[1..]).position(touches).map(|body| 1 + body)
    }

    /// Sets the present poses in rapier and finds contacts.
    fn show(&mut self, bodies: &[BodyState]) {
        let physics = &mut self.physics;
        for (solid, state) in self.solids.iter().zip(bodies) {
            let body = &mut physics.bodies[solid.handle];
            if body.is_kinematic() {
                body.set_position(isometry(&state.pose, solid.middle), true);
            }
        }
        let near = physics.integration_parameters.prediction_distance();
        physics.collision_pipeline.step(
            near,
            &mut physics.islands,
            &mut physics.broad_phase,
            &mut physics.narrow_phase,
            &mut physics.bodies,
            &mut physics.colliders,
            &(),
            &(),
        );
    }

    /// Returns the side of the ego vehicle that a body touched: the side where the two shapes first met on their way
    /// through the last tick. The deepest overlap is not enough: a car that hits a person with its corner at 15 m/s
    /// overlaps more from the front than from the side. `before` are the bodies at the previous tick.
    pub fn face(&self, before: &[BodyState], bodies: &[BodyState], other: usize) -> Face {
        let (car, solid) = (&self.solids[0], &self.solids[other]);
        let [car_before, other_before] = [0, other].map(|body| before[body].pose);
        // The motion as seen from the car; the rotation of the car within one tick is neglected.
        let start = car_before.to_local(other_before.position);
        let end = bodies[0].pose.to_local(bodies[other].pose.position);
        let turned = Pose { position: start, heading: other_before.heading - car_before.heading };
        let hit = cast_shapes(
            &parry3d::math::Pose::IDENTITY,
            at_height(Vector2::zeros(), 0.0),
            &*car.shape,
            &isometry(&turned, 0.0),
            at_height(end - start, 0.0),
            &*solid.shape,
            ShapeCastOptions { max_time_of_impact: 1.0, ..ShapeCastOptions::default() },
        );
        let side = match hit {
            Ok(Some(hit)) => Vector2::new(f64::from(hit.normal1.x), f64::from(hit.normal1.y)),
            // They overlapped already, so this is the side that the other body is nearest to.
            _ => start.component_div(&bodies[0].body.outline.half_extent()),
        };
        match (side.x.abs() >= side.y.abs(), side.x > 0.0, side.y > 0.0) {
            (true, true, _) => Face::Front,
            (true, false, _) => Face::Rear,
            (false, _, true) => Face::Left,
            (false, _, false) => Face::Right,
        }
    }
}

/// Returns the smallest indices of two bodies that cover the same ground at the start, if there are any. Two bodies that are
/// both `joined` may do so. The bodies after the first `told` bodies are scenery, which is only in the way of the first body,
/// the car.
pub(crate) fn overlapping(bodies: &[BodyState], told: usize, joined: &[bool]) -> Option<(usize, usize)> {
    let others = move |i: usize| i + 1..if i == 0 { bodies.len() } else { told };
    let pairs = (0..told).flat_map(|i| others(i).map(move |j| (i, j)));
    pairs.into_iter().find(|&(i, j)| {
        if joined[i] && joined[j] {
            return false;
        }
        let (a, b) = (&bodies[i], &bodies[j]);
        let reach = a.body.outline.reach() + b.body.outline.reach();
        let is_near = (a.pose.position - b.pose.position).norm() <= reach;
        is_near && a.present && b.present && distance(a, b) <= 0.0
    })
}

/// Returns the distance in metres between two bodies, seen from above.
fn distance(a: &BodyState, b: &BodyState) -> f64 {
    gap((&a.body.outline, &a.pose), (&b.body.outline, &b.pose))
}

/// Returns the shape of a body and the height of its middle above the ground: a box, perhaps with space below it, an
/// upright capsule, or a ball.
fn shape(body: &Body, lies: bool) -> (SharedShape, f64) {
    match body.outline {
        Outline::Rectangle { length, width } => {
            let floor = if lies || body.height <= 2.0 * FLOOR { 0.0 } else { FLOOR };
            let half = [0.5 * length, 0.5 * width, 0.5 * (body.height - floor)].map(|metres| metres as f32);
            (SharedShape::cuboid(half[0], half[1], half[2]), 0.5 * (body.height + floor))
        }
        Outline::Disc { radius } if body.height > 2.0 * radius => {
            (SharedShape::capsule_z((0.5 * body.height - radius) as f32, radius as f32), 0.5 * body.height)
        }
        Outline::Disc { radius } => (SharedShape::ball(radius as f32), radius),
    }
}

fn insert(physics: &mut PhysicsWorld, state: &BodyState, mass: Option<f64>) -> Solid {
    let (shape, middle) = shape(&state.body, mass.is_some());
    let at = isometry(&state.pose, middle);
    let body = match mass {
        Some(_) => RigidBodyBuilder::dynamic(),
        None => RigidBodyBuilder::kinematic_position_based(),
    };
    let collider = ColliderBuilder::new(shape.clone()).active_collision_types(ActiveCollisionTypes::all());
    let collider = match mass {
        // The friction between the body and the ground is that of the ground.
        Some(mass) => collider.mass(mass as f32).friction(0.0),
        None => collider,
    };
    let (handle, collider) = physics.insert(body.pose(at), collider);
    Solid { handle, collider, shape, middle }
}

fn isometry(pose: &Pose, middle: f64) -> parry3d::math::Pose {
    let (sin, cos) = libm::sincos(0.5 * pose.heading);
    let turn = parry3d::math::Rotation::from_xyzw(0.0, 0.0, sin as f32, cos as f32);
    parry3d::math::Pose::from_parts(at_height(pose.position, middle), turn)
}

fn at_height(position: Vector2<f64>, height: f64) -> parry3d::math::Vector {
    [position.x as f32, position.y as f32, height as f32].into()
}

#[cfg(test)]
mod tests;
