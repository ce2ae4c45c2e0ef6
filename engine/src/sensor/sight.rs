//! The line of sight between a sensor and a body.

use crate::object::{BodyState, Class, crosses};
use nalgebra::Vector2;

/// Returns `true` if bodies of this class are large enough to hide other bodies.
pub(crate) fn hides(class: Class) -> bool {
    matches!(class, Class::Car | Class::Van | Class::Truck | Class::Bus | Class::Building)
}

/// Returns `true` if a large body other than the car (the first body) and `target` is between two places.
pub(super) fn hidden(bodies: &[BodyState], target: usize, from: Vector2<f64>, to: Vector2<f64>) -> bool {
    let between = bodies.iter().enumerate().skip(1).filter(|(index, body)| *index != target && body.present);
    between.filter(|(_, body)| hides(body.body.class)).any(|(_, body)| {
        let (way, offset) = (to - from, body.pose.position - from);
        // A body farther away than the place cannot be in between: a cheap check before the exact one.
        let reach = body.body.outline.reach();
        let near = offset.norm_squared() <= (way.norm() + reach) * (way.norm() + reach);
        near && crosses((&body.body.outline, &body.pose), from, to)
    })
}
