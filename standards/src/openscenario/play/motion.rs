//! Actions that take time: the share of each in the motion of its entity within a tick.

use super::actor::Actor;
use super::cast::Cast;
use super::synchronize::synchronize;
use super::track::Track;
use crate::openscenario::action::{Beside, Gap, Synchronization, Target};
use crate::openscenario::measure::Metric;
use crate::openscenario::profile::Course;
use crate::openscenario::project::project;
use crate::openscenario::transition::Transition;

/// An action under way.
#[derive(Debug, Clone)]
pub(super) enum Motion {
    Speed {
        transition: Transition,
        follows: Option<Target>,
    },
    /// `time` is the time in seconds since the beginning.
    Profile {
        course: Course,
        time: f64,
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
    /// `metres` is the wanted distance to the left of the other entity, and `speed` the speed to the left in m/s.
    Beside {
        beside: Beside,
        metres: f64,
        speed: f64,
    },
    Synchronize(Box<Synchronization>),
    /// `timing` is the factor and the offset of the times of the vertices.
    Trajectory {
        track: Track,
        s: f64,
        timing: Option<(f64, f64)>,
    },
}

/// A time that falls short of another by less than this many seconds is the other: ticks are sums of rounded numbers.
const TOLERANCE: f64 = 1e-6;
/// The stiffness of the spring that brings an entity to its distance, in 1/s² for a limit of 1 m/s².
const STIFFNESS: f64 = 0.4;
/// An entity that misses its distance by less than this many metres has reached it.
const CLOSE: f64 = 0.1;

impl Motion {
    /// Returns `true` if the action moves its entity along, and `true` if it moves the entity aside.
    pub fn domains(&self) -> (bool, bool) {
        match self {
            Self::Speed { .. } | Self::Profile { .. } | Self::Gap { .. } | Self::Synchronize(_) => (true, false),
            Self::LaneChange(_) | Self::LaneOffset { .. } | Self::Beside { .. } => (false, true),
            // An entity that keeps its speed on its way can still be accelerated.
            Self::Trajectory { timing, .. } => (timing.is_some(), true),
        }
    }

    /// Carries the action out for a tick of `dt` seconds. Returns `true` if the action is over.
    pub fn carry_out(&mut self, entity: usize, cast: &mut Cast, dt: f64) -> bool {
        match self {
            Self::Speed { transition, follows } => {
                transition.advance(dt, 0.0);
                if let Some(target) = follows {
                    transition.target = cast.target(*target);
                }
                cast.actors[entity].speed = transition.value();
                transition.is_over() && follows.is_none()
            }
            Self::Profile { course, time } => {
                *time += dt;
                let (speed, over) = course.at(*time);
                cast.actors[entity].speed = speed;
                over
            }
            Self::LaneChange(transition) => {
                let actor = &mut cast.actors[entity];
                let Some(place) = actor.on_lane(&cast.map) else { return true };
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
                let Some(place) = actor.on_lane(&cast.map) else { return true };
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
                let limits = limits.map(|limits| actor.entity.within(limits));
                actor.speed = match limits {
                    Some(limits) => approach(actor.speed, theirs, missing, limits, dt),
                    None => theirs + missing / dt,
                };
                !*continuous && missing.abs() < CLOSE
            }
            Self::Beside { beside, metres, speed } => {
                let other = &cast.actors[beside.entity];
                let (Some(here), Some(there)) = (cast.actors[entity].on_lane(&cast.map), other.on_lane(&cast.map))
                else {
                    return true;
                };
                // All distances and speeds are to the left of the road.
                let seen = here.seen(&there, &cast.map);
                let wanted = seen.t + if seen.is_against { -*metres } else { *metres };
                let missing = wanted - here.t(&cast.map);
                let theirs = if seen.is_against { -other.lateral_speed } else { other.lateral_speed };
                let limits = beside.limits.map(|limits| cast.actors[entity].entity.within(limits));
                *speed = limits.map_or(missing / dt, |limits| approach(*speed, theirs, missing, limits, dt));
                let (offset, left) = (here.offset + *speed * dt, if here.is_against() { -*speed } else { *speed });
                let actor = &mut cast.actors[entity];
                actor.step.offset = Some(offset);
                let over = !beside.continuous && (missing - *speed * dt).abs() < CLOSE;
                actor.step.angle = if over || actor.speed == 0.0 || limits.is_none() {
                    0.0
                } else {
                    libm::atan2(left, actor.speed.abs())
                };
                over
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

/// Returns the speed at the end of a tick of an entity that makes up a missing distance within its limits. The standard leaves the
/// controller open. This one is a spring with critical damping, which does not pass its distance while no limit counts: its acceleration is
/// `k missing - 2 sqrt(k) (speed - theirs)`. The spring is stiffer for an entity with greater limits.
fn approach(speed: f64, theirs: f64, missing: f64, limits: [f64; 3], dt: f64) -> f64 {
    let [acceleration, deceleration, most] = limits;
    let stiffness = STIFFNESS * if missing < 0.0 { acceleration } else { deceleration };
    let wanted = if stiffness.is_finite() {
        stiffness * missing - 2.0 * stiffness.sqrt() * (speed - theirs)
    } else {
        // Without a limit, the distance is made up within the tick.
        (theirs + missing / dt - speed) / dt
    };
    let next = speed + wanted.clamp(-deceleration, acceleration) * dt;
    // The entity gets no faster than it can brake within the missing distance.
    let fastest = |limit: f64| if missing == 0.0 { 0.0 } else { (2.0 * limit * missing.abs()).sqrt() };
    let next = if missing >= 0.0 {
        next.min((theirs + fastest(deceleration)).max(speed - deceleration * dt))
    } else {
        next.max((theirs - fastest(acceleration)).min(speed + acceleration * dt))
    };
    next.clamp(-most, most)
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
            time >= track.end() - TOLERANCE
        }
    };
    *s = s.clamp(0.0, track.length());
    let pose = track.at(*s);
    // The vertices may give a heading against the way.
    if timing.is_some() && (pose.position - track.at(before).position).dot(&pose.forward()) < 0.0 {
        actor.speed = -actor.speed;
    }
    actor.step.pose = Some(pose);
    actor.on_track = (!over).then_some(*s);
    if over && let Some(place) = project(&pose, &cast.map) {
        // The entity goes on along the lane that it has come to.
        actor.step.landed = Some(place);
    }
    over
}
