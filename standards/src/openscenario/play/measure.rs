//! The numbers that conditions compare, as the world is at the moment.

use super::actor::{Actor, Whereabouts};
use super::cast::Cast;
use super::find::find;
use crate::openscenario::measure::{Bearing, Clearance, Direction, Goal, Measure, Metric, MetricKind, System};
use crate::openscenario::place::Place;
use crate::openscenario::state::State;
use crate::xml::Value;
use nalgebra::Vector2;
use paracosm_engine::Pose;
use paracosm_engine::road::wrapped;
use std::f64::consts::{FRAC_PI_2, PI};

/// A target of a distance: a position with its heading, and the box around it.
struct Mark {
    at: Whereabouts,
    pose: Pose,
    middle: Vector2<f64>,
    half: Vector2<f64>,
    velocity: Vector2<f64>,
}

impl Mark {
    /// Makes the mark of an entity that need not be on a lane.
    fn of(actor: &Actor) -> Self {
        let Actor { pose, entity, velocity, .. } = actor;
        let at = Whereabouts::Free(*pose);
        Self { at, pose: *pose, middle: entity.middle, half: entity.half, velocity: *velocity }
    }
}

impl Cast {
    /// Returns the value of a measure. A distance that does not exist is infinite. `is_in` tells whether the element
    /// with an index is in a state.
    pub fn measure(&self, measure: &Measure, is_in: impl Fn(usize, State) -> bool) -> f64 {
        let actor = |index: usize| &self.actors[index];
        match measure {
            Measure::Time => self.time,
            Measure::TimeOfDay => self.surroundings.seconds(self.time),
            Measure::Constant(number) => *number,
            Measure::Variable(index) => match &self.variables[*index].value {
                Value::Number(number) => *number,
                Value::Truth(truth) => f64::from(u8::from(*truth)),
                Value::Text(_) => f64::INFINITY,
            },
            Measure::VariableIs(index, value) => f64::from(u8::from(self.variables[*index].value == *value)),
            Measure::State { element, state } => f64::from(u8::from(is_in(*element, *state))),
            Measure::Speed { entity, direction } => speed(actor(*entity), *direction),
            Measure::Acceleration { entity, direction } => acceleration(actor(*entity), *direction),
            Measure::RelativeSpeed { entity, other, direction } => {
                let (from, other) = (actor(*entity), actor(*other));
                // The entity's own axes count for both.
                let theirs = match direction {
                    Direction::Total => other.speed,
                    Direction::Longitudinal => other.velocity.dot(&from.pose.forward()),
                    Direction::Lateral => other.velocity.dot(&from.pose.left()),
                };
                speed(from, *direction) - theirs
            }
            Measure::Standing { entity } => actor(*entity).standing,
            Measure::Travelled { entity } => actor(*entity).travelled,
            Measure::Distance { entity, to, how } => self.distance(actor(*entity), &self.mark(to, *how), *how).abs(),
            Measure::Headway { entity, to, how } => {
                let from = actor(*entity);
                let distance = self.distance(from, &self.mark(&Goal::Entity(*to), *how), *how);
                if distance < 0.0 || from.speed <= 0.0 { f64::INFINITY } else { distance / from.speed }
            }
            Measure::TimeToCollision { entity, to, how } => {
                let (from, mark) = (actor(*entity), self.mark(to, *how));
                let closing = mark.as_ref().map_or(0.0, |mark| self.closing(from, mark, *how));
                let distance = self.distance(from, &mark, *how).abs();
                // At the very place there is no direction, and so no number.
                if closing > 0.0 { distance / closing } else { f64::INFINITY }
            }
            Measure::Touching { entity, others } => {
                f64::from(u8::from(others.iter().any(|other| touching(actor(*entity), actor(*other)))))
            }
            Measure::EndOfRoad { entity } => actor(*entity).stuck,
            Measure::Offroad { entity } => actor(*entity).offroad.unwrap_or(0.0),
            Measure::Clearance(area) => f64::from(u8::from(self.is_clear(area))),
            Measure::Turned { entity, from, wanted } => {
                let actor = actor(*entity);
                let from = match from {
                    Bearing::World => 0.0,
                    Bearing::Lane => {
                        actor.on_lane(&self.map).map_or(0.0, |place| place.pose(&self.map).heading - place.turn)
                    }
                    Bearing::Entity(other) => self.actors[*other].pose.heading,
                };
                wrapped(actor.pose.heading - from - wanted).abs()
            }
        }
    }

    /// Returns `true` if there is an area of the lanes around an entity, and if no other entity is in it.
    fn is_clear(&self, area: &Clearance) -> bool {
        let from = &self.actors[area.entity];
        let Some(here) = from.on_lane(&self.map) else { return true };
        let lane = here.lane_below(&self.map);
        let how = Metric { kind: MetricKind::Longitudinal, freespace: area.freespace, system: System::Road };
        // There is no lane 0 to drive on.
        let left = |other: i32| {
            let skipped = if lane.signum() == other.signum() { 0 } else { other.signum() };
            f64::from(other - lane - skipped) * if here.is_against() { -1.0 } else { 1.0 }
        };
        let covers = |other: i32, along: bool| {
            (area.lanes.is_empty() || area.lanes.iter().any(|[first, last]| (*first..=*last).contains(&left(other))))
                && (area.opposite || along == here.leads_along(lane, &self.map))
        };
        let mut lanes = here.driven_lanes(&self.map);
        let exists = lanes.any(|other| covers(other, here.leads_along(other, &self.map)));
        let is_in = |index: usize| {
            let actor = &self.actors[index];
            let Some(there) = actor.on_lane(&self.map).filter(|_| actor.present) else { return false };
            let other = there.lane_below(&self.map);
            covers(other, there.leads_along(other, &self.map))
                && (-area.reach[1]..=area.reach[0]).contains(&self.distance_to(from, index, how))
        };
        let counts = |index: &usize| *index != area.entity && (area.others.is_empty() || area.others.contains(index));
        exists && !(0..self.actors.len()).filter(counts).any(is_in)
    }

    /// Returns the target of a distance; `None` if the target has no place.
    fn mark(&self, goal: &Goal, how: Metric) -> Option<Mark> {
        match goal {
            Goal::Entity(other) if !self.actors[*other].present => None,
            Goal::Entity(other) => {
                let actor = &self.actors[*other];
                let at = if how.is_along_lanes() { actor.place(&self.map) } else { Whereabouts::Free(actor.pose) };
                Some(Mark { at, ..Mark::of(actor) })
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
        self.distance(from, &self.mark(&Goal::Entity(other), how), how)
    }

    /// Returns the speed in m/s at which the distance from an entity to a mark becomes shorter.
    fn closing(&self, from: &Actor, mark: &Mark, how: Metric) -> f64 {
        let away = mark.pose.position - from.pose.position;
        let velocity = from.velocity;
        let along = |axis: Vector2<f64>| -(mark.velocity - velocity).dot(&axis) * away.dot(&axis).signum();
        let here = Some(from).filter(|_| how.is_along_lanes()).and_then(|from| from.on_lane(&self.map));
        match (how.kind, here, &mark.at) {
            (MetricKind::Straight, ..) => along(away.normalize()),
            (MetricKind::Longitudinal, Some(here), Whereabouts::OnLane(there)) => {
                let speed = |place: &Place, velocity: Vector2<f64>| {
                    let heading = place.heading(&self.map);
                    velocity.dot(&Pose { position: Vector2::zeros(), heading }.forward())
                };
                let theirs = speed(there, mark.velocity);
                let seen = here.seen(there, &self.map);
                let theirs = if seen.is_against == here.is_against() { theirs } else { -theirs };
                let metres = here.distance_to(there, &self.map).unwrap_or(0.0);
                (speed(&here, velocity) - theirs) * metres.signum()
            }
            (MetricKind::Longitudinal, ..) => along(from.pose.forward()),
            (MetricKind::Lateral, ..) => along(from.pose.left()),
        }
    }

    fn distance(&self, from: &Actor, mark: &Option<Mark>, how: Metric) -> f64 {
        let Some(mark) = mark else { return f64::INFINITY };
        let local = from.pose.to_local(mark.pose.position);
        let boxes = || gaps(from, mark);
        // Beside all roads there are no lanes: the entity's own axes replace them.
        let places = match (how.is_along_lanes(), &mark.at) {
            (true, Whereabouts::OnLane(there)) => from.on_lane(&self.map).map(|here| (here, there)),
            _ => None,
        };
        match (how.kind, places) {
            (MetricKind::Straight, _) if how.freespace => boxes().map(|gap| gap.max(0.0)).norm(),
            (MetricKind::Straight, _) => local.norm(),
            (MetricKind::Longitudinal, None) if how.freespace => signed(boxes().x, local.x),
            (MetricKind::Lateral, None) if how.freespace => signed(boxes().y, local.y),
            (MetricKind::Longitudinal, None) => local.x,
            (MetricKind::Lateral, None) => local.y,
            (kind, Some((here, there))) => {
                let seen = here.seen(there, &self.map);
                // The directions in which the entity goes, at its own place and at the mark.
                let own = from.pose.heading - here.heading(&self.map);
                let same = if seen.is_against == here.is_against() { 0.0 } else { PI };
                let theirs = mark.pose.heading - there.heading(&self.map) - same;
                if kind == MetricKind::Lateral {
                    let aside = seen.t - here.t(&self.map);
                    if !how.freespace {
                        return aside;
                    }
                    let side = if here.is_against() { -aside } else { aside };
                    let left = FRAC_PI_2;
                    let (right, leftmost) = reach(from.entity.middle, from.entity.half, own - left);
                    let (last, first) = reach(mark.middle, mark.half, theirs - left);
                    let gap = if side >= 0.0 { side + last - leftmost } else { right - (side + first) };
                    return signed(gap, aside);
                }
                let Some(along) = here.distance_to(there, &self.map) else { return f64::INFINITY };
                if !how.freespace {
                    return along;
                }
                let (rear, front) = reach(from.entity.middle, from.entity.half, own);
                let (last, first) = reach(mark.middle, mark.half, theirs);
                let gap = if along >= 0.0 { along + last - front } else { rear - (along + first) };
                signed(gap, along)
            }
        }
    }
}

/// Returns a gap with the sign of the direction in which it lies; 0 if boxes overlap.
fn signed(gap: f64, direction: f64) -> f64 {
    gap.max(0.0).copysign(direction)
}

/// Returns how far a box reaches along a way, from the reference point: its least and its greatest distance in metres. `turn` is the
/// angle from the way to the heading of the box.
fn reach(middle: Vector2<f64>, half: Vector2<f64>, turn: f64) -> (f64, f64) {
    let (sin, cos) = (libm::sin(turn), libm::cos(turn));
    let at = middle.x * cos - middle.y * sin;
    let extent = half.x * cos.abs() + half.y * sin.abs();
    (at - extent, at + extent)
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
        let mark = Mark::of(other);
        gaps(one, &mark).max() <= 0.0
    };
    a.present && b.present && overlaps(a, b) && overlaps(b, a)
}

fn speed(actor: &Actor, direction: Direction) -> f64 {
    match direction {
        Direction::Longitudinal | Direction::Total => actor.speed,
        Direction::Lateral => actor.lateral_speed,
    }
}

fn acceleration(actor: &Actor, direction: Direction) -> f64 {
    match direction {
        Direction::Longitudinal => actor.acceleration,
        Direction::Lateral => actor.lateral_acceleration,
        Direction::Total => libm::hypot(actor.acceleration, actor.lateral_acceleration),
    }
}
