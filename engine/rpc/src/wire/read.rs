//! Reads the observation that a client sends to a server of drivers.

use super::{Other as WireOther, Rectangle, Step, other};
use nalgebra::Vector2;
use paracosm_engine::object::{Class, Outline};
use paracosm_engine::{Ahead, Observation, Other, Pose, Way};

/// Reads an observation from a step. A field that is missing in the step is 0.
pub fn read(step: &Step, observation: &mut Observation) {
    (observation.time, observation.speed, observation.travelled) = (step.time, step.speed, step.travelled);
    let odometry = step.odometry.unwrap_or_default();
    observation.odometry = Pose { position: Vector2::new(odometry.x, odometry.y), heading: odometry.heading };
    observation.way = Way::default();
    if let Some(way) = &step.way {
        (observation.way.offset, observation.way.heading) = (way.offset, way.heading);
        for (ahead, point) in observation.way.ahead.iter_mut().zip(way.ahead.chunks_exact(3)) {
            *ahead = Ahead { position: Vector2::new(point[0], point[1]), curvature: point[2] };
        }
    }
    observation.others.clear();
    observation.others.extend(step.others.iter().map(Other::from));
}

impl From<&WireOther> for Other {
    fn from(other: &WireOther) -> Self {
        let outline = match other.outline {
            Some(other::Outline::Rectangle(Rectangle { length, width })) => Outline::Rectangle { length, width },
            Some(other::Outline::Radius(radius)) => Outline::Disc { radius },
            None => Outline::Disc { radius: 0.0 },
        };
        // The protocol sends the names of the classes.
        let class = Class::ALL.into_iter().find(|class| class.to_string() == other.class);
        Self {
            id: other.id as usize,
            class: class.unwrap_or(Class::Prop),
            position: Vector2::new(other.x, other.y),
            velocity: Vector2::new(other.velocity_x, other.velocity_y),
            heading: other.heading,
            outline,
        }
    }
}
