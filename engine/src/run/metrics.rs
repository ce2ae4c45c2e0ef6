//! What is measured of a run beside its requirements: the figures and words by which runs, and failures above all, are
//! told apart.

use super::scene::Scene;
use crate::outcome::Metric;
use crate::vehicle::VehicleState;

/// Speed in m/s below which the car stands at a contact.
const STANDING: f64 = 0.1;
/// Deceleration in m/s² above which the car brakes at a contact: more than rolling resistance and sensor noise make.
const BRAKING: f64 = 0.5;

/// The metrics of a run as it ends.
pub(super) fn of_run(scene: &Scene, triggered: bool) -> Vec<(String, Metric)> {
    let car = scene.ego.dynamics.state();
    let contact = scene.contact;
    let touched = contact.map(|contact| &scene.bodies[contact.body]);
    let metrics = [
        ("travelled", Metric::Number(car.travelled)),
        ("impact_speed", Metric::Number(if contact.is_some() { car.speed() } else { 0.0 })),
        ("contact_face", Metric::Word(contact.map(|contact| contact.face.to_string()))),
        ("contact_with", Metric::Word(contact.map(|contact| scene.name(contact.body).to_owned()))),
        ("contact_class", Metric::Word(touched.map(|touched| touched.body.class.to_string()))),
        ("contact_motion", Metric::Word(touched.map(|_| motion(car).to_owned()))),
        ("other_speed", Metric::Number(touched.map_or(0.0, |touched| touched.velocity.norm()))),
        ("triggered", Metric::Flag(triggered)),
    ];
    metrics.map(|(name, metric)| (name.to_owned(), metric)).into()
}

/// What the car does at a contact.
fn motion(car: &VehicleState) -> &'static str {
    if car.speed() < STANDING {
        "standing"
    } else if car.acceleration.x < -BRAKING {
        "braking"
    } else {
        "driving"
    }
}
