//! The measurements of a run besides its requirements. They tell runs apart, above all failures.

use super::scene::Scene;
use crate::contact::{Contact, ContactMotion};
use crate::outcome::Measurements;
use crate::vehicle::VehicleState;

/// The speed in m/s below which the car counts as standing at a contact.
const STANDING: f64 = 0.1;
/// The deceleration in m/s² above which the car brakes at a contact. Rolling resistance and noise make less.
const BRAKING: f64 = 0.5;

/// Returns the measurements of a run at the end of the run.
pub(super) fn measured(scene: &Scene, triggered: bool) -> Measurements {
    // A run may begin with a contact.
    let contact = scene.touched.as_deref().cloned().or_else(|| scene.touch());
    Measurements { travelled: scene.ego.travelled(), contact, triggered }
}

impl Scene {
    /// Describes the contact of the car at the present tick; `None` without a contact.
    pub(super) fn touch(&self) -> Option<Contact> {
        let touching = self.contact?;
        let (car, touched) = (self.ego.dynamics().state(), &self.bodies[touching]);
        Some(Contact {
            with: self.name(touching).to_owned(),
            class: touched.body.class,
            face: self.face(touching),
            motion: motion(car),
            speed: car.speed(),
            other_speed: touched.velocity.norm(),
        })
    }
}

/// Returns the motion of the car at a contact.
fn motion(car: &VehicleState) -> ContactMotion {
    if car.speed() < STANDING {
        ContactMotion::Standing
    } else if car.acceleration.x < -BRAKING {
        ContactMotion::Braking
    } else {
        ContactMotion::Driving
    }
}
