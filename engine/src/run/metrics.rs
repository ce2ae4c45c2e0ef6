//! What is measured of a run beside its requirements: the figures by which runs, and failures above all, are told apart.

use super::scene::Scene;
use crate::contact::{Contact, ContactMotion};
use crate::outcome::Measurements;
use crate::vehicle::VehicleState;

/// Speed in m/s below which the car stands at a contact.
const STANDING: f64 = 0.1;
/// Deceleration in m/s² above which the car brakes at a contact: more than rolling resistance and sensor noise make.
const BRAKING: f64 = 0.5;

/// What there is to measure of a run as it ends.
pub(super) fn measured(scene: &Scene, triggered: bool) -> Measurements {
    let car = scene.ego.dynamics.state();
    let contact = scene.contact.map(|touching| {
        let touched = &scene.bodies[touching.body];
        Contact {
            with: scene.name(touching.body).to_owned(),
            class: touched.body.class,
            face: touching.face,
            motion: motion(car),
            speed: car.speed(),
            other_speed: touched.velocity.norm(),
        }
    });
    Measurements { travelled: car.travelled, contact, triggered }
}

/// What the car does at a contact.
fn motion(car: &VehicleState) -> ContactMotion {
    if car.speed() < STANDING {
        ContactMotion::Standing
    } else if car.acceleration.x < -BRAKING {
        ContactMotion::Braking
    } else {
        ContactMotion::Driving
    }
}
