//! The arrival of an entity at its target at the moment at which another entity arrives at another target.
//!
//! The standard leaves the profile of the speed open. Here the entity stands, or keeps its speed, until a constant acceleration brings it
//! to its target in time with its final speed.

use super::actor::Whereabouts;
use super::cast::Cast;
use super::find::find;
use crate::openscenario::action::{Steady, Synchronization};
use crate::openscenario::position::Position;

/// The least time in seconds and the least distance in metres before an arrival.
const CLOSE: f64 = 1e-6;
/// An entity whose speed differs by less than this many m/s from a speed has this speed.
const CLOSE_SPEED: f64 = 0.1;

/// Sets the speed of an entity for a tick of `dt` seconds. Returns `true` if the entity or its master has arrived.
pub(super) fn synchronize(sync: &Synchronization, entity: usize, cast: &mut Cast, dt: f64) -> bool {
    let (Some(theirs), Some(ours)) =
        (distance(sync.master, &sync.master_target, cast), distance(entity, &sync.target, cast))
    else {
        return true;
    };
    let [theirs, ours] = [theirs - sync.tolerances[0], ours - sync.tolerances[1]];
    let master = cast.actors[sync.master].speed;
    let last = sync.final_speed.map(|speed| cast.target(speed));
    let time = if master > 0.0 { theirs / master } else { f64::INFINITY };
    // It ends at the tick in which the master or the entity arrives.
    if time <= CLOSE || ours <= CLOSE {
        return true;
    }
    let speed = cast.actors[entity].speed;
    cast.actors[entity].speed = match last {
        Some(last) if last >= 0.0 => {
            let steady = match sync.steady {
                // An entity that is to stand covers no distance before.
                _ if last == 0.0 => 0.0,
                Steady::Metres(metres) => metres,
                Steady::Seconds(seconds) => seconds * last,
            };
            let steady = steady.min(ours);
            let seconds = if steady > 0.0 { steady / last } else { 0.0 };
            faster(speed, last, ours - steady, time - seconds, dt)
        }
        _ => ours / time,
    };
    false
}

/// Returns the speed at the end of a tick of an entity that is to cover `metres` metres in `seconds` seconds and to have the speed
/// `last` then.
///
/// A constant acceleration does this at the speed `2 metres / seconds - last`. An entity with another speed first accelerates and then
/// brakes, or the other way round, both times with the same acceleration. With the speed `turn` in between, the times give the
/// acceleration `(2 turn - speed - last) / seconds`, and the distances give a quadratic equation for `turn`. An entity that would have to
/// move backwards in between stops, and waits.
fn faster(speed: f64, last: f64, metres: f64, seconds: f64, dt: f64) -> f64 {
    if metres <= CLOSE || seconds <= 2.0 * dt {
        return last;
    }
    let mean = metres / seconds;
    let steady = 2.0 * mean - last;
    if speed == 0.0 && seconds >= 2.0 * metres / last + dt {
        return 0.0;
    }
    if (speed - steady).abs() < CLOSE_SPEED {
        return (steady + (last - steady) / seconds * dt).max(0.0);
    }
    let bend = (mean * mean - mean * (speed + last) + 0.5 * (speed * speed + last * last)).max(0.0).sqrt();
    let acceleration = if speed < steady {
        (2.0 * (mean + bend) - speed - last) / seconds
    } else if mean < bend {
        -0.5 * (speed * speed + last * last) / metres
    } else {
        (2.0 * (mean - bend) - speed - last) / seconds
    };
    (speed + acceleration * dt).max(0.0)
}

/// Returns the distance of an entity to a target along its way, or in a straight line without a way. `None` if there is no target.
fn distance(entity: usize, target: &Position, cast: &Cast) -> Option<f64> {
    let actor = &cast.actors[entity];
    if let (Position::Along { s, .. }, Some(done)) = (target, actor.on_track) {
        return Some(s - done);
    }
    match (find(target, &cast.actors, &cast.map).ok()?, actor.on_lane(&cast.map)) {
        (Whereabouts::OnLane(there), Some(here)) => here.distance_along(&there, actor.route.as_ref(), &cast.map),
        (Whereabouts::OnLane(there), None) => Some((there.pose(&cast.map).position - actor.pose.position).norm()),
        (Whereabouts::Free(pose), _) => Some((pose.position - actor.pose.position).norm()),
    }
}
