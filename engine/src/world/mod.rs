//! The bodies of a run and where they touch: the one module that speaks to rapier and parry.
//!
//! Bodies follow poses that the vehicle model and the programs compute in 64 bits; rapier finds the contacts.
//! Its pipeline takes longer than all else in a tick (BENCHMARKS.md), so it is asked only when a body is within
//! [`REACH`] of the car: nothing is integrated there, so a tick that was left out leaves no gap.

use crate::scenario::Pose;
use crate::vehicle::Vehicle;
use nalgebra::Vector2;
use parry3d::query::{ShapeCastOptions, cast_shapes};
use parry3d::shape::{Capsule, Cuboid};
use rapier3d::prelude::{
    ActiveCollisionTypes, ColliderBuilder, ColliderHandle, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle,
};
use std::fmt;

/// Radius in metres of a person as seen from above: the Euro NCAP adult dummy is 0.5 m wide.
pub(crate) const WALKER_RADIUS: f64 = 0.25;
/// Height in metres of that dummy, rounded.
const WALKER_HEIGHT: f64 = 1.8;
/// Height in metres of the car's floor above the road.
const FLOOR: f64 = 0.2;
/// Clearance in metres below which rapier is asked for contacts. Bodies approach by some 0.3 m a tick at most
/// (30 m/s at 10 ms), and overlap is noticed at the tick at which it is there.
const REACH: f64 = 0.05;
/// What counts as touching, in metres: the resolution of rapier's 32-bit numbers some hundred metres out.
const TOUCH: f64 = 1e-5;

/// A side of the car's body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Face {
    Front,
    Left,
    Right,
    Rear,
}

impl fmt::Display for Face {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Face::Front => "front",
            Face::Left => "left",
            Face::Right => "right",
            Face::Rear => "rear",
        })
    }
}

/// A contact of the car with a walker.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Contact {
    pub walker: usize,
    pub face: Face,
}

/// Where a body was at this tick and at the one before.
#[derive(Debug, Clone, Copy)]
struct Body {
    handle: RigidBodyHandle,
    collider: ColliderHandle,
    now: Pose,
    before: Pose,
    middle: f64,
}

/// The car and the walkers around it.
pub(crate) struct World {
    physics: PhysicsWorld,
    outline: Cuboid,
    /// Half of the car's length and width, in metres.
    half_extent: Vector2<f64>,
    car: Body,
    walkers: Vec<Body>,
}

impl World {
    pub fn new(vehicle: &Vehicle, car: Pose, walkers: impl Iterator<Item = Pose>) -> Self {
        let mut physics = PhysicsWorld::default();
        let half = [0.5 * vehicle.length, 0.5 * vehicle.width, 0.5 * (vehicle.height - FLOOR)].map(|x| x as f32);
        let outline = Cuboid::new(half.into());
        let middle = 0.5 * (vehicle.height + FLOOR);
        let car = insert(&mut physics, ColliderBuilder::cuboid(half[0], half[1], half[2]), car, middle);
        let (segment, radius) = (0.5 * WALKER_HEIGHT - WALKER_RADIUS, WALKER_RADIUS as f32);
        let person = || ColliderBuilder::capsule_z(segment as f32, radius);
        let walkers = walkers.map(|pose| insert(&mut physics, person(), pose, 0.5 * WALKER_HEIGHT)).collect();
        let half_extent = 0.5 * Vector2::new(vehicle.length, vehicle.width);
        Self { physics, outline, half_extent, car, walkers }
    }

    /// Moves everything to where it is at the next tick.
    pub fn advance(&mut self, car: Pose, walkers: impl Iterator<Item = Pose>) {
        self.car.advance(car);
        for (body, pose) in self.walkers.iter_mut().zip(walkers) {
            body.advance(pose);
        }
    }

    /// Metres between the car and the nearest walker; infinite without any. Where they touch or overlap it is
    /// the contact that says more, and this says [`TOUCH`].
    pub fn clearance(&self) -> f64 {
        let gaps = self.walkers.iter().map(|walker| self.gap(walker));
        gaps.fold(f64::INFINITY, f64::min)
    }

    /// Between the car's box and an upright person the distance is that of rectangle and circle seen from above.
    fn gap(&self, walker: &Body) -> f64 {
        let at = self.car.now.to_local(walker.now.position).abs();
        let beyond = (at - self.half_extent).sup(&Vector2::zeros());
        (beyond.norm() - WALKER_RADIUS).max(TOUCH)
    }

    /// The first walker that touches the car at this tick, and where it came upon it.
    pub fn contact(&mut self) -> Option<Contact> {
        if self.clearance() > REACH {
            return None;
        }
        self.place_all();
        let walker = self.walkers.iter().position(|walker| {
            let pair = self.physics.narrow_phase.contact_pair(self.car.collider, walker.collider);
            pair.and_then(|pair| pair.find_deepest_contact()).is_some_and(|(_, contact)| contact.dist <= 0.0)
        })?;
        Some(Contact { walker, face: self.face(&self.walkers[walker]) })
    }

    /// Shows rapier the present poses and lets it look for contacts.
    fn place_all(&mut self) {
        let physics = &mut self.physics;
        for body in self.walkers.iter().chain([&self.car]) {
            physics.bodies[body.handle].set_position(isometry(&body.now, body.middle), true);
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

    /// The side of the car that a walker came upon: where the two shapes first met on their way through the
    /// last tick. The deepest overlap does not tell: a car that took a person with its corner at 15 m/s
    /// overlaps more from the front than from the side.
    fn face(&self, walker: &Body) -> Face {
        // Seen from the car, whose turning within one tick is left out.
        let start = self.car.before.to_local(walker.before.position);
        let end = self.car.now.to_local(walker.now.position);
        let (from, motion) = (at_height(start, 0.0), at_height(end - start, 0.0));
        let person = Capsule::new_z((0.5 * WALKER_HEIGHT - WALKER_RADIUS) as f32, WALKER_RADIUS as f32);
        let options = ShapeCastOptions { max_time_of_impact: 1.0, ..ShapeCastOptions::default() };
        let identity = parry3d::math::Pose::IDENTITY;
        let person_at = parry3d::math::Pose::from_translation(from);
        let hit = cast_shapes(
            &identity,
            at_height(Vector2::zeros(), 0.0),
            &self.outline,
            &person_at,
            motion,
            &person,
            options,
        );
        let side = match hit {
            Ok(Some(hit)) => Vector2::new(f64::from(hit.normal1.x), f64::from(hit.normal1.y)),
            // They overlapped already: the side that the person stands nearest to.
            _ => start.component_div(&self.half_extent),
        };
        match (side.x.abs() >= side.y.abs(), side.x > 0.0, side.y > 0.0) {
            (true, true, _) => Face::Front,
            (true, false, _) => Face::Rear,
            (false, _, true) => Face::Left,
            (false, _, false) => Face::Right,
        }
    }
}

impl Body {
    fn advance(&mut self, pose: Pose) {
        self.before = self.now;
        self.now = pose;
    }
}

fn insert(physics: &mut PhysicsWorld, collider: ColliderBuilder, pose: Pose, middle: f64) -> Body {
    let body = RigidBodyBuilder::kinematic_position_based().pose(isometry(&pose, middle));
    let collider = collider.active_collision_types(ActiveCollisionTypes::all());
    let (handle, collider) = physics.insert(body, collider);
    Body { handle, collider, now: pose, before: pose, middle }
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
