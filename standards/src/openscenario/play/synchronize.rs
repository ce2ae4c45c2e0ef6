//! The arrival of an entity at its target at the moment at which another entity arrives at another target.
//!
//! The standard leaves the profile of the speed open. Here the entity stands, or keeps its speed, until a constant acceleration brings it
//! to its target in time with its final speed.

use super::actor::Whereabouts;
use super::cast::Cast;
use super::find::find_target;
use crate::openscenario::action::Synchronization;
use crate::openscenario::way::Target;

/// The least time in seconds and the least distance in metres before an arrival.
const CLOSE: f64 = 1e-6;

/// Sets the speed of an entity for a tick of `dt` seconds. Returns `true` if the entity or its master has arrived.
pub(super) fn synchronize(sync: &Synchronization, entity: usize, cast: &mut Cast, dt: f64) -> bool {
    let (Some(theirs), Some(ours)) =
        (distance(sync.master, &sync.master_target, cast), distance(entity, &sync.target, cast))
    else {
        return true;
    };
    let master = cast.actors[sync.master].speed;
    let time = if master > 0.0 { theirs / master } else { f64::INFINITY };
    if time <= CLOSE || ours <= CLOSE {
        return true;
    }
    let speed = cast.actors[entity].speed;
    cast.actors[entity].speed = match sync.final_speed {
        Some(last) if last > 0.0 => {
            let steady = sync.steady.min(ours);
            faster(speed, last, ours - steady, time - steady / last, dt)
        }
        _ => ours / time,
    };
    false
}

/// Returns the speed at the end of a tick of an entity that is to cover `metres` metres in `seconds` seconds and to have the speed
/// `last` then.
fn faster(speed: f64, last: f64, metres: f64, seconds: f64, dt: f64) -> f64 {
    if metres <= CLOSE {
        return last;
    }
    // The time that the entity needs at a constant acceleration.
    let needed = 2.0 * metres / (speed + last);
    if seconds >= needed + dt {
        if speed == 0.0 {
            return 0.0;
        }
        // Too early: slower first, and faster later, in equal times.
        let middle = 0.5 * (4.0 * metres / seconds - speed - last);
        return (speed + (middle.max(0.0) - speed) * (2.0 * dt / seconds).min(1.0)).max(0.0);
    }
    let acceleration = (last * last - speed * speed) / (2.0 * metres);
    let next = speed + acceleration * dt;
    if acceleration > 0.0 { next.min(last) } else { next.max(last) }
}

/// Returns the distance of an entity to a target along its way, or in a straight line without a way. `None` if there is no target.
fn distance(entity: usize, target: &Target, cast: &Cast) -> Option<f64> {
    let actor = &cast.actors[entity];
    if let (Target::Along { s, .. }, Some(done)) = (target, actor.on_track) {
        return Some(s - done);
    }
    match (find_target(target, &cast.actors, &cast.map).ok()?, actor.on_lane()) {
        (Whereabouts::OnLane(there), Some(here)) => here.distance_to(&there, &cast.map),
        (Whereabouts::OnLane(there), None) => Some((there.pose(&cast.map).position - actor.pose.position).norm()),
        (Whereabouts::Free(pose), _) => Some((pose.position - actor.pose.position).norm()),
    }
}
