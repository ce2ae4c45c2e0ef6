//! Actions that take time: the share of each in the motion of its entity within a tick.

use super::actor::Actor;
use super::cast::Cast;
use super::synchronize::synchronize;
use super::track::Track;
use crate::openscenario::action::{Gap, Synchronization, Target};
use crate::openscenario::condition::Metric;
use crate::openscenario::project::project;
use crate::openscenario::transition::Transition;

/// An action under way.
#[derive(Debug, Clone)]
pub(super) enum Motion {
    Speed {
        transition: Transition,
        follows: Option<Target>,
    },
    LaneChange(Transition),
    LaneOffset {
        transition: Transition,
        continuous: bool,
    },
    Gap {
        other: usize,
        gap: Gap,
        how: Metric,
        continuous: bool,
        ahead: Option<bool>,
        limits: Option<[f64; 3]>,
    },
    Synchronize(Box<Synchronization>),
    /// `timing` is the factor and the offset of the times of the vertices.
    Trajectory {
        track: Track,
        s: f64,
        timing: Option<(f64, f64)>,
    },
}

/// The share of the missing distance that an entity without limits makes up in a second.
const EAGERNESS: f64 = 1.0;
/// The distance in metres and the speed in m/s below which a distance has been reached.
const CLOSE: f64 = 0.01;

impl Motion {
    /// Returns `true` if the action moves its entity along, and `true` if it moves the entity aside.
    pub fn domains(&self) -> (bool, bool) {
        match self {
            Self::Speed { .. } | Self::Gap { .. } | Self::Synchronize(_) => (true, false),
            Self::LaneChange(_) | Self::LaneOffset { .. } => (false, true),
            // An entity that keeps its speed on its way can still be accelerated.
            Self::Trajectory { timing, .. } => (timing.is_some(), true),
        }
    }

    /// Carries the action out for a tick of `dt` seconds. Returns `true` if the action is over.
    pub fn carry_out(&mut self, entity: usize, cast: &mut Cast, dt: f64) -> bool {
        match self {
            Self::Speed { transition, follows } => {
                let travelled = cast.actors[entity].speed.abs() * dt;
                transition.advance(dt, travelled);
                if let Some(target) = follows {
                    transition.target = cast.target(*target);
                }
                cast.actors[entity].speed = transition.value();
                transition.is_over() && follows.is_none()
            }
            Self::LaneChange(transition) => {
                let actor = &mut cast.actors[entity];
                let Some(place) = actor.on_lane() else { return true };
                let metres = actor.speed * dt;
                transition.advance(dt, metres.abs());
                let aside = transition.value() - place.offset;
                let left = if place.is_against() { -aside } else { aside };
                actor.step.angle = if metres == 0.0 { 0.0 } else { libm::atan2(left, metres.abs()) };
                (actor.step.offset, actor.step.aside) = (Some(transition.value()), aside);
                finished(transition, actor)
            }
            Self::LaneOffset { transition, continuous } => {
                let actor = &mut cast.actors[entity];
                let Some(place) = actor.on_lane() else { return true };
                let rate = if place.is_against() { -transition.rate() } else { transition.rate() };
                actor.step.angle = if actor.speed == 0.0 { 0.0 } else { libm::atan2(rate, actor.speed.abs()) };
                actor.step.offset = Some(transition.value());
                let over = finished(transition, actor);
                transition.advance(dt, actor.speed.abs() * dt);
                over && !*continuous
            }
            Self::Gap { other, gap, how, continuous, ahead, limits } => {
                let actor = &cast.actors[entity];
                let missing = cast.missing(actor, *other, *gap, *how, *ahead);
                if !missing.is_finite() {
                    return false;
                }
                let theirs = cast.actors[*other].speed;
                let actor = &mut cast.actors[entity];
                actor.speed = match limits {
                    Some(limits) => approach(actor.speed, theirs, missing, *limits, dt),
                    None => theirs + missing / dt,
                };
                !*continuous && missing.abs() < CLOSE && (actor.speed - theirs).abs() < CLOSE
            }
            Self::Synchronize(sync) => synchronize(sync, entity, cast, dt),
            Self::Trajectory { track, s, timing } => follow(track, s, *timing, entity, cast, dt),
        }
    }
}

/// Returns `true` if a motion aside has reached its target. The entity faces along its lane then.
fn finished(transition: &Transition, actor: &mut Actor) -> bool {
    if transition.is_over() {
        actor.step.angle = 0.0;
    }
    transition.is_over()
}

/// Returns the speed at which an entity makes up a missing distance within its limits, so that it arrives at the speed `theirs`.
fn approach(speed: f64, theirs: f64, missing: f64, limits: [f64; 3], dt: f64) -> f64 {
    let [acceleration, deceleration, most] = limits;
    let limit = if missing >= 0.0 { deceleration } else { acceleration };
    let faster = (2.0 * limit * missing.abs()).sqrt().min(EAGERNESS * missing.abs());
    let wanted = (theirs + faster.copysign(missing)).clamp(0.0, most);
    wanted.clamp(speed - deceleration * dt, speed + acceleration * dt)
}

/// Moves an entity along a way for a tick. Returns `true` at the end of the way.
fn follow(track: &Track, s: &mut f64, timing: Option<(f64, f64)>, entity: usize, cast: &mut Cast, dt: f64) -> bool {
    let now = cast.time + dt;
    let actor = &mut cast.actors[entity];
    let before = *s;
    let over = match timing {
        None => {
            *s += actor.speed * dt;
            *s >= track.length()
        }
        Some((scale, offset)) => {
            let time = if scale > 0.0 { (now - offset) / scale } else { f64::INFINITY };
            *s = track.at_time(time);
            actor.speed = (*s - before) / dt;
            time >= track.end()
        }
    };
    *s = s.clamp(0.0, track.length());
    let pose = track.at(*s);
    actor.step.pose = Some(pose);
    actor.on_track = (!over).then_some(*s);
    if over && let Some(place) = project(&pose, &cast.map) {
        // The entity goes on along the lane that it has come to.
        actor.step.landed = Some(place);
    }
    over
}
