//! What stands between a sensor and what it looks at.

use crate::object::{BodyState, Class, crosses};
use nalgebra::Vector2;

/// Whether bodies of this class are large enough to hide others.
pub(crate) fn hides(class: Class) -> bool {
    matches!(class, Class::Car | Class::Truck | Class::Building)
}

/// Whether something large stands between two places, but for the car, which carries who looks, and the body `target`.
pub(super) fn hidden(bodies: &[BodyState], target: usize, from: Vector2<f64>, to: Vector2<f64>) -> bool {
    let between = bodies.iter().enumerate().skip(1).filter(|(index, body)| *index != target && body.present);
    between.filter(|(_, body)| hides(body.body.class)).any(|(_, body)| {
        let (way, offset) = (to - from, body.pose.position - from);
        // What is farther away than the place cannot be in between: a cheap look before the exact one.
        let reach = body.body.outline.reach();
        let near = offset.norm_squared() <= (way.norm() + reach) * (way.norm() + reach);
        near && crosses((&body.body.outline, &body.pose), from, to)
    })
}
