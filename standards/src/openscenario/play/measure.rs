//! The numbers that conditions compare, as the world is at the moment.

use super::actor::{Actor, Whereabouts};
use super::cast::Cast;
use super::find::find;
use crate::openscenario::condition::{Direction, Goal, Measure, Metric, MetricKind, System};
use crate::openscenario::state::State;
use crate::xml::Value;
use nalgebra::Vector2;
use paracosm_engine::Pose;

/// A target of a distance: a position with its heading, and the box around it.
struct Mark {
    at: Whereabouts,
    pose: Pose,
    middle: Vector2<f64>,
    half: Vector2<f64>,
    velocity: Vector2<f64>,
}

impl Cast {
    /// Returns the value of a measure. A distance that does not exist is infinite. `is_in` tells whether an element with a name and of
    /// a kind is in a state.
    pub fn measure(&self, measure: &Measure, is_in: impl Fn(&str, &str, State) -> bool) -> f64 {
        let actor = |index: usize| &self.actors[index];
        match measure {
            Measure::Time => self.time,
            Measure::Constant(number) => *number,
            Measure::Variable(index) => match &self.variables[*index].value {
                Value::Number(number) => *number,
                Value::Truth(truth) => f64::from(u8::from(*truth)),
                Value::Text(_) => f64::INFINITY,
            },
            Measure::VariableIs(index, value) => f64::from(u8::from(self.variables[*index].value == *value)),
            Measure::State { element, kind, state } => f64::from(u8::from(is_in(element, kind, *state))),
            Measure::Speed { entity, direction } => speed(actor(*entity), *direction),
            Measure::Acceleration { entity } => actor(*entity).acceleration,
            Measure::RelativeSpeed { entity, other, direction } => {
                speed(actor(*entity), *direction) - speed(actor(*other), *direction)
            }
            Measure::Standing { entity } => actor(*entity).standing,
            Measure::Travelled { entity } => actor(*entity).travelled,
            Measure::Distance { entity, to, how } => self.distance(actor(*entity), &self.mark(to), *how).abs(),
            Measure::Headway { entity, to, how } => {
                let from = actor(*entity);
                let distance = self.distance(from, &self.mark(&Goal::Entity(*to)), *how);
                if distance < 0.0 || from.speed <= 0.0 { f64::INFINITY } else { distance / from.speed }
            }
            Measure::TimeToCollision { entity, to, how } => {
                let (from, mark) = (actor(*entity), self.mark(to));
                let closing = mark.as_ref().map_or(0.0, |mark| {
                    let away = mark.pose.position - from.pose.position;
                    let apart = mark.velocity - from.pose.forward() * from.speed;
                    -apart.dot(&away) / away.norm().max(f64::MIN_POSITIVE)
                });
                let distance = self.distance(from, &mark, *how).abs();
                if closing <= 0.0 { f64::INFINITY } else { distance / closing }
            }
            Measure::Touching { entity, other } => f64::from(u8::from(touching(actor(*entity), actor(*other)))),
            Measure::EndOfRoad { entity } => actor(*entity).stuck,
        }
    }

    fn mark(&self, goal: &Goal) -> Option<Mark> {
        match goal {
            Goal::Entity(other) => {
                let Actor { place, pose, entity, speed, .. } = &self.actors[*other];
                let velocity = pose.forward() * *speed;
                Some(Mark { at: *place, pose: *pose, middle: entity.middle, half: entity.half, velocity })
            }
            Goal::Place(position) => {
                let at = find(position, &self.actors, &self.map).ok()?;
                let pose = match at {
                    Whereabouts::OnLane(place) => place.pose(&self.map),
                    Whereabouts::Free(pose) => pose,
                };
                Some(Mark { at, pose, middle: Vector2::zeros(), half: Vector2::zeros(), velocity: Vector2::zeros() })
            }
        }
    }

    /// Returns the distance from an entity to a mark in metres; negative if the mark is behind, or to the right.
    pub(super) fn distance_to(&self, from: &Actor, other: usize, how: Metric) -> f64 {
        self.distance(from, &self.mark(&Goal::Entity(other)), how)
    }

    fn distance(&self, from: &Actor, mark: &Option<Mark>, how: Metric) -> f64 {
        let Some(mark) = mark else { return f64::INFINITY };
        let local = from.pose.to_local(mark.pose.position);
        let boxes = || gaps(from, mark);
        // Beside all roads there are no lanes: the entity's own axes replace them.
        let is_on_roads = from.on_lane().is_some() && matches!(mark.at, Whereabouts::OnLane(_));
        match (how.kind, if is_on_roads { how.system } else { System::Entity }) {
            (MetricKind::Straight, _) if how.freespace => boxes().map(|gap| gap.max(0.0)).norm(),
            (MetricKind::Straight, _) => local.norm(),
            (MetricKind::Longitudinal, System::Entity) if how.freespace => signed(boxes().x, local.x),
            (MetricKind::Lateral, System::Entity) if how.freespace => signed(boxes().y, local.y),
            (MetricKind::Longitudinal, System::Entity) => local.x,
            (MetricKind::Lateral, System::Entity) => local.y,
            (kind, System::Lane | System::Road) => {
                let (Some(here), Whereabouts::OnLane(there)) = (from.on_lane(), &mark.at) else { return f64::INFINITY };
                if kind == MetricKind::Lateral {
                    return there.t(&self.map) - here.t(&self.map);
                }
                let Some(along) = here.distance_to(there, &self.map) else { return f64::INFINITY };
                if !how.freespace {
                    return along;
                }
                let (front, rear) =
                    (from.entity.middle.x + from.entity.half.x, from.entity.middle.x - from.entity.half.x);
                let (theirs, half) = (mark.middle.x, mark.half.x);
                let gap = if along >= 0.0 { along + theirs - half - front } else { rear - (along + theirs + half) };
                signed(gap, along)
            }
        }
    }
}

/// Returns a gap with the sign of the direction in which it lies; 0 if boxes overlap.
fn signed(gap: f64, direction: f64) -> f64 {
    gap.max(0.0).copysign(direction)
}

/// Returns the gaps between the box of an entity and the box of a mark along and across the entity, negative if they overlap.
fn gaps(from: &Actor, mark: &Mark) -> Vector2<f64> {
    let middle = from.middle();
    let there = mark.pose.position + mark.pose.turn_to_plane(mark.middle);
    let between = middle.to_local(there);
    let turn = mark.pose.heading - from.pose.heading;
    let (sin, cos) = (libm::sin(turn).abs(), libm::cos(turn).abs());
    let reach = Vector2::new(mark.half.x * cos + mark.half.y * sin, mark.half.x * sin + mark.half.y * cos);
    between.abs() - from.entity.half - reach
}

/// Returns `true` if the boxes of two entities overlap, by the theorem of separating axes.
fn touching(a: &Actor, b: &Actor) -> bool {
    let overlaps = |one: &Actor, other: &Actor| {
        let pose = other.pose;
        let mark = Mark {
            at: other.place,
            pose,
            middle: other.entity.middle,
            half: other.entity.half,
            velocity: Vector2::zeros(),
        };
        gaps(one, &mark).max() <= 0.0
    };
    overlaps(a, b) && overlaps(b, a)
}

fn speed(actor: &Actor, direction: Direction) -> f64 {
    match direction {
        Direction::Longitudinal | Direction::Total => actor.speed,
        Direction::Lateral => actor.lateral_speed,
    }
}
