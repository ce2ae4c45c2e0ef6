//! Bodies that the physics moves: their programs and collisions push them, gravity and friction hold them.

use super::{Solid, isometry};
use crate::object::BodyState;
use crate::vehicle::GRAVITY;
use nalgebra::Vector2;
use paracosm_road::Pose;
use rapier3d::prelude::{CoefficientCombineRule, ColliderBuilder, ColliderHandle, PhysicsWorld, SharedShape};

/// The bodies that rapier integrates.
pub(super) struct Physics {
    /// The indices of the bodies that the physics moves.
    moved: Vec<usize>,
    ground: ColliderHandle,
}

impl Physics {
    /// Prepares the physical bodies and the ground on which they lie.
    pub fn new(world: &mut PhysicsWorld, masses: &[(usize, f64)]) -> Self {
        world.gravity = [0.0, 0.0, -GRAVITY as f32].into();
        // Bodies on the ground have no friction of their own.
        let ground = ColliderBuilder::new(SharedShape::halfspace(parry3d::math::Vector::Z));
        let ground = world.colliders.insert(ground.friction_combine_rule(CoefficientCombineRule::Max));
        Self { moved: masses.iter().map(|(index, _)| *index).collect(), ground }
    }

    /// Moves the physical bodies on by `dt` seconds. `pushes` has one force for each of them.
    pub fn step(
        &mut self,
        world: &mut PhysicsWorld,
        solids: &[Solid],
        bodies: &mut [BodyState],
        pushes: &[Vector2<f64>],
        friction: f64,
        dt: f64,
    ) {
        world.integration_parameters.dt = dt as f32;
        world.colliders[self.ground].set_friction(friction as f32);
        for (solid, state) in solids.iter().zip(&*bodies) {
            let body = &mut world.bodies[solid.handle];
            if body.is_kinematic() {
                body.set_next_kinematic_position(isometry(&state.pose, solid.middle));
            }
        }
        for (&index, push) in self.moved.iter().zip(pushes) {
            let body = &mut world.bodies[solids[index].handle];
            body.reset_forces(true);
            body.add_force([push.x as f32, push.y as f32, 0.0].into(), true);
        }
        world.step();
        for &index in &self.moved {
            let (solid, state) = (&solids[index], &mut bodies[index]);
            let body = &world.bodies[solid.handle];
            let (at, ahead) = (body.translation(), body.rotation() * parry3d::math::Vector::X);
            let heading = libm::atan2(f64::from(ahead.y), f64::from(ahead.x));
            let position = Vector2::new(f64::from(at.x), f64::from(at.y));
            let before = *state;
            state.follow(&before, Some(Pose { position, heading }), dt);
            state.altitude = f64::from(at.z) - solid.middle;
        }
    }
}
